"""What is known in one part of a program, and so may stand in a place of it.

================  =================================================================================
module            what it holds
================  =================================================================================
``counters``      What counts in a part: counters of loops, whole numbers, conditions on them
``forms``         Forms of expressions and statements: a sum's terms, rows' entries, sine for
                  cosine
``functions``     How a program may call what is not its own: pi, the sine, roots, products of
                  vectors
``idle``          What is set or given and used nowhere: names, entries, joints, rows, functions
``known``         What is known in one part of a program: its names, their shapes, its expressions
``members``       What objects and dictionaries have, with its shapes; of it, what no function uses
``names``         The names of a part: what loops, calls and assignments set them to, with their
                  shapes
``part``          What may stand in a place of a part, and what speaks for it: what is used nowhere
``pieces``        Expressions that may stand somewhere, by their shapes and their text
``terms``         What stands in the sums and products of a part: addends, factors, divisors
``values``        Values of modules and objects: which are numbers, and of which shapes
================  =================================================================================
"""
