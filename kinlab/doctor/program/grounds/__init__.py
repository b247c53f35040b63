"""What speaks for an edit of a program, and against it.

================  =================================================================================
module            what it holds
================  =================================================================================
``apart``         An arm whose numbers have nothing to do with one another
``as_called``     A link's length where a program has its centre's distance by name
``called``        What the numbers of an arm are called
``dimensions``    The dimensions of a program's expressions: nobody adds a length to a moment
``evidence``      What speaks against an edit: that what it changes is already what a textbook has
``helpers``       Functions of a program that are what textbooks have, of whatever they are given
``labels``        What the numbers of a program are called, and at which place they stand
``lacking``       Products of several factors that a number lacks to be one of a textbook's
``products``      Products that may be missing in a sum, as far as dimensions tell
``scaled``        Another arm, on which what is one by the numbers alone is two things
``suspects``      Statements that are wrong by what they are made of
``terms``         Vectors and matrices that a sum may lack, of the sum's dimension
``unread``        Terms with what a program holds and never reads
================  =================================================================================
"""
