"""The syntax tree of a function whose source text cannot be had.

==================  ===============================================================================
module              what it holds
==================  ===============================================================================
``comprehensions``  Loops that gather as comprehensions, lines that only return as expressions
``conditions``      Conditions of byte code: the tests and jumps of one expression taken together
``expressions``     The stack of syntax trees on which byte code is read, and what else lies on it
``instructions``    A code object as a graph of steps, and whether two code objects do the same
``reading``         Steps as statements: loops and branches by where paths part and meet
``recover``         The tree, proved by compiling it again
``steps``           What each step of the byte code does to that stack
``syntax``          The nodes, names and text of syntax trees
==================  ===============================================================================
"""
