"""What a value in somebody's program is, by the arm's own quantities, and what is true of an arm.

============  ====================================================================================
module        what it holds
============  ====================================================================================
``facts``     What is true of an arm, or of a five-bar: which way it hangs, what slides, where its
              centres are
``linkage``   The notes' vectors, matrices and numbers of a five-bar at one state, each with what it
              is
``meaning``   What a value is: the axis of joint 2, the angular velocity of link 1
``spatial``   Vectors and matrices of six: screws, twists, wrenches, adjoints, and spatial inertias
``textbook``  The textbooks' vectors, matrices and numbers of an arm at one state, each with what it
              is
============  ====================================================================================
"""
