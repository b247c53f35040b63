"""The syntax tree of a function whose source text cannot be had.

================  =================================================================================
module            what it holds
================  =================================================================================
``expressions``   The stack of syntax trees on which byte code is read, and what else lies on it
``instructions``  A code object as a graph of steps, and whether two code objects do the same
``recover``       The tree, proved by compiling it again
``steps``         What each step of the byte code does to that stack
================  =================================================================================
"""
