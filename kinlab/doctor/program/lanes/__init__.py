"""A program run once for many combinations of edits: each combination has a lane of its own.

================  =================================================================================
module            what it holds
================  =================================================================================
``functions``     What a program calls of numpy and the standard library, for numbers with lanes
``numbers``       A number that has another value in each lane
``room``          Lines that put numbers into an array, for numbers with lanes
``run``           A program run in lanes, and what it answers in each
``ways``          Loops that turn more or less often, and conditions that are others, for some lanes
``woven``         The trees of a program with all edits in them, each asked for its lanes
================  =================================================================================
"""
