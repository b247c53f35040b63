"""A student's Python function, read: which edit of which line makes it right.

================  =================================================================================
module            what it holds
================  =================================================================================
``cuts``          Where a program rounds by itself: ``round``, single precision, whole numbers
``digits``        Whether a program is right to the digits that its numbers are written with
``elsewhere``     The lines of a function that lives in another process
``kept``          What a program's data hold, so that what an edited run writes into them is put
                  back
``named``         What the pieces of a program around an edit are: ``z`` is the axis of joint 2
``nearly``        Programs that are right up to a small number of theirs: where they stop
``observed``      What every expression of a program was when it ran: its values, their shapes
``places``        The places of a program, and what is put there instead
``read``          The functions that a formula is made of, as syntax trees, and the data they use
``trial``         A program run with edits in it
``variants``      Many edits of one function compiled together
``words``         A repair in words: the line, what stands there, what should
``own/``          What it is made of beside its functions, and what of it may be run again
``edits/``        What could stand in a program instead: every edit that undoes one kind of slip
``grounds/``      What speaks for an edit, and against it
``lanes/``        A program run once for many combinations of edits
``search/``       How the edit is looked for that makes a program right
``several/``      Two or three edits that together make a program right
================  =================================================================================
"""
