"""Figures with matplotlib (the optional extra ``plots``), one file per subject.

Each function draws into axes that it is given, or into a new figure, and returns the axes; none
opens a window. :func:`kinlab.plots.canvas.save` writes a file.
"""
