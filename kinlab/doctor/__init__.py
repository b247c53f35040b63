"""The formula doctor: not only that a formula differs, but what is wrong in it.

==================  ==============================================================================
module              what it holds
==================  ==============================================================================
``changes``         A reading: one thing that people take differently, and what the engine says if
                    one does
``derived``         The engine's quantities as derived formulas, entry by entry, for arms with a
                    DH table
``examine``         The examination: compare, try the readings, look for slips in the entries,
                    rank what explains
``file``            A file of formulas as text: what its names claim to be, each examined entry by
                    entry
``inverse``         Inverse kinematics judged: right where Pinocchio finds the tool at the
                    target, on any branch
``meanings``        What a number in a formula may stand for: the robot's own, products and sums
                    of these, constants
``pen``             Slips of the pen in a text, found and mended in the line itself
``regression``      The difference of a function from the derived formula as a short sum of known
                    terms
``report``          Diagnoses by every door: of a function, a text, a file, a row of a report,
                    typeset and marked
``rounding``        Rounded numbers: what a written number may stand for, and whether that explains
                    a difference
``search``          Every slip at one place of a formula, and those that turn it into another by
                    their effect
``terms``           Slips within single entries: the derived formula beside a user's text or
                    function
``verdicts``        Right in another way: with numbers for names, or another valid formula
``written``         A formula as its writer wrote it: names, literals with their digits, and
                    values at any numbers
``confusions/``     What people take differently: a known confusion, and what the engine would say
                    if one does
``tables/``         The table doctor: two descriptions of one arm disagree; which cell of the
                    table is wrong?
``marking/``        The formulas of a class, judged and marked
==================  ==============================================================================
"""
