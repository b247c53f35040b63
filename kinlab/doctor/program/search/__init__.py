"""How the edit is looked for that makes a wrong program right.

================  =================================================================================
module            what it holds
================  =================================================================================
``arms``          Whether a repair holds for other arms than the one whose numbers stand there
``asked``         A program beside what it should answer
``chosen``        Which edits of a program are tried, and what they cost
``company``       Of repairs by name of one line that nothing tells apart, which has company
``mistyped``      Numbers that are the arm's with a slip of the pen
``recognised``    Single values that a textbook has, told quickly
``repair``        Single edits that make a program right, the likeliest first
``solved``        The single number with which a program is right: what it should be is solved for
``units``         Functions of a program, each asked alone what it was asked first
``work``          What trying edits amounts to, in operations: the same on every machine
================  =================================================================================
"""
