"""Two or three slips in one program.

================  =================================================================================
module            what it holds
================  =================================================================================
``effects``       What tried edits do to a program's answer, number by number: which of them may go
                  together
``in_order``      Slips one after another, in the order in which a program runs into them
``in_stages``     Slips of one part of an answer after another: at rest, without speeds, the last
                  rows alone
``repairs``       Two or three edits that together make a program right
``rest``          A wrong program asked where parts of its answer are silent: at rest, with one
                  motion alone
``together``      Two or three edits that change the same numbers of an answer, tried in lanes
``two_of_one``    Two slips with which a statement gives what a textbook has, looked for in lanes
``witnesses``     What statements give while edits are tried: which of them are a textbook's
================  =================================================================================
"""
