"""The formula doctor: not only that a formula differs, but what is wrong in it.

================  =================================================================================
module            what it holds
================  =================================================================================
``changes``       A reading: one thing that people take differently, and what the engine says if
                  one does; the answer's single entries
``derived``       The engine's quantities as derived formulas, entry by entry, for arms with a DH
                  table
``examine``       The examination: compare, try the readings, look for slips in the entries, rank
                  what explains
``excuses``       Right all the same, or right here only: what a difference, or none, is before it
                  is a slip
``file``          A file of formulas as text, each examined entry by entry
``numbers``       The robot's numbers taken otherwise: one of them another, or all of a kind
                  rounded
``report``        Diagnoses by every door: of a function, a text, a file, a row of a report,
                  typeset and marked
``rounding``      Rounded numbers of a function and of the robot's data, and whether they explain a
                  difference
``shapes``        Matrices of fewer rows than the engine's: a planar arm's 3 x 3 pose, a SCARA's
                  4 x 4 Jacobian; one entry that is asked for, of a whole that is given
``slips``         Slips of the pen in the entries that are off, alone or after a reading of the
                  whole answer
``solved``        Forward dynamics of an arm as a reference: the accelerations that its equations
                  of motion have
``verdicts``      Right in another way: with numbers for names, or another valid formula
``bytecode/``      The syntax tree of a function whose source text cannot be had
``confusions/``   What people take differently: a known confusion, and what the engine would say if
                  one does
``derivations/``  The textbooks' derivations, walked with any of their steps taken otherwise
``entries/``       Slips within single entries: the derived formula beside a text or function
``glossary/``      What a value in somebody's program is, by the arm's own quantities
``linkages/``     Formulas of a five-bar as text: their names, what they are held against, what is
                  right too
``program/``       A student's Python function, read: which edit of which line makes it right
``solutions/``    Inverse kinematics by hand: which branches are right, and which step of the
                  closed form is not
``tables/``       The table doctor: two descriptions of one arm disagree; which cell of the table
                  is wrong?
``text/``         A formula as its writer typed it: its line, its numbers, its slips of the pen
``marking/``      The formulas of a class, judged and marked
================  =================================================================================
"""
