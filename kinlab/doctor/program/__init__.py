"""A student's Python function, read: which single edit of which line makes it right.

================  ==========================================================================module            what it holds
================  ==========================================================================``read``          The functions that a formula is made of, as syntax trees, and the data they use
``observed``      What every expression of a program was when it ran: its values, their shapes
``edits``         What could stand in a place of a program instead
``trial``         A program run with edits in it
``repair``        The edits that make a program right: one, or several together
``words``         A repair in words: the line, what stands there, what should
================  =========================================================================="""
