"""What stands on a page: arms, bodies of a URDF, DH frames, the five-bar, shapes.

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``arm``         The arm itself: Pinocchio's MeshcatVisualizer, with the links nested joint in
                joint
``bodies``      The bodies of a URDF that can be drawn: read strictly, meshes tried one by one
``dh_picture``  The picture that teaches DH: frames, z axes, and each row's a, alpha, d, theta on
                the arm
``fivebar``     The five-bar drawn in its own plane, stood upright: cranks, rods, loci and
                workspace
``shapes``      What pages are drawn with: shapes, labels, camera and framing, background and
                floor
==============  ==================================================================================
"""
