"""Figures with matplotlib (the optional extra ``plots``), one file per subject.

==================  ================================================================================
module              what it holds
==================  ================================================================================
``arms``            The arm as a line, with its ellipses
``canvas``          Figures and files, and the one place that imports matplotlib
``curves``          Curves in joint space and along paths
``drives``          Torque over speed of the drives of an arm, with the limits of each motor
``fivebar``         Pictures of a five-bar: its workspace in one mode, a cycle, and what sizing
                    rests on
``fivebar_design``  Pictures of designed five-bars: one design over its rectangle, and a Pareto
                    front
``maps``            Workspace maps: filled for planar arms, a section or a cloud for spatial ones
``searches``        Errors of inverse kinematics over its iterations
``solutions``       The number of solutions over a section of the workspace
==================  ================================================================================

Each function draws into axes that it is given, or into a new figure, and returns the axes; none
opens a window. :func:`kinlab.plots.canvas.save` writes a file.
"""
