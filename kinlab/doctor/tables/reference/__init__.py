"""What a table is held against: another description of the arm, or measured poses.

===========  =====================================================================================
module       what it holds
===========  =====================================================================================
``against``  What a table is compared with: a table, a name, a URDF, a robot, or poses at joint
             positions
``poses``    Files of measured or simulated poses
``target``   What a table is held against: poses at states, and how near to them is the same
===========  =====================================================================================
"""
