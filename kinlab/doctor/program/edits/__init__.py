"""What could stand in a program instead: every edit that undoes one kind of slip.

================  =================================================================================
module            what it holds
================  =================================================================================
``additions``     What may be missing in a program: a sign, a transpose, a factor, a matrix, a term
``blocks``        Statements in other places: earlier or later, in a loop or behind it, one that is
                  missing
``chains``        Sums and products of a program otherwise: their parentheses, a factor of another
                  term
``composites``    What is missing of several names at once: a cross product, a moment about another
                  axis
``counterparts``  Terms like those of a sum with other names throughout
``elsewhere``     What a program has elsewhere in the same company, or in the line of another link
``every``         What could stand in a place of a program instead
``exchanges``     What a slip moves together: two names for one another, one name throughout a
                  statement
``forgotten``     What is forgotten as one writes: a term of two names, a vector behind its number
``frames``        A link's transform with its factors in another order, a row for a named column
``guards``        What counts for some joints alone: conditions, and masks of arrays, around a term
``subscripts``    The subscripts of a sum of products: another letter, two for one another
``scope/``        What is known in one part of a program, and so may stand in a place of it
``single/``       Single expressions of a program otherwise: their operators, calls, entries, names
``numbers/``      The numbers of a program otherwise: those of its text, of its data, and the arm's
================  =================================================================================
"""
