"""A student's program in an interpreter of its own, within limits of the system.

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``arithmetic``  Programs of plain arithmetic: nothing in them reaches anything but their own
                numbers
``child``       Run by path in an interpreter of its own: a student's Python file, with limits set
                first
``lines``       Run by path in an interpreter of its own: the wrong lines of a student's function,
                in words
==============  ==================================================================================
"""
