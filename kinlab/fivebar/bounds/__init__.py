"""The worst case over a rectangle, with a proved bound: no place between grid points is missed.

=============  ===================================================================================
module         what it holds
=============  ===================================================================================
``enclosure``  Numbers over a whole cell of the plane: value at its centre, slope, and a bound of
               the rest
``worst``      The worst case over a rectangle, with a proved bound: branch and bound on cells
=============  ===================================================================================
"""
