"""The numbers of a program otherwise: those of its text, of its data, and the arm's.

===============  ==================================================================================
module           what it holds
===============  ==================================================================================
``as_the_arm``   The numbers of a program as the arm's table has them
``data``         The numbers of a program: those in its text, and those in the data that it uses
``exchanged``    Two numbers of the data that become each other: they were exchanged
``kinds``        The kinds of joints in the rows of a table, one for another
``left_out``     What a program leaves out though it has its like: the tool's offset, a rotor's term
``own_numbers``  The arm's own numbers: one for another, one for a number of nobody's, one that is
                 missing
===============  ==================================================================================
"""
