"""Figures with matplotlib (the optional extra ``plots``), one file per subject.

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``arms``        The arm as a line, with its ellipses
``canvas``      Figures and files, and the one place that imports matplotlib
``counts``      The number of solutions over a section of the workspace
``curves``      Curves in joint space and along paths
``drives``      Torque over speed of the drives of an arm, with the limits of each motor
``maps``        Workspace maps: filled for planar arms, a section or a cloud for spatial ones
``mechanisms``  Pictures of a five-bar: its workspace in one mode, a cycle, and what sizing rests
                on
``searches``    Errors of inverse kinematics over its iterations
==============  ==================================================================================

Each function draws into ``ax``, axes that it is given, or into a new figure, and returns the axes;
none opens a window. :func:`save` writes a file; in a notebook, ``ax.figure`` shows itself::

    kl.plots.save(kl.plots.workspace("spatial3r"), "workspace.png")

The public names stand in ``__init__.pyi`` and are imported when first asked for.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
