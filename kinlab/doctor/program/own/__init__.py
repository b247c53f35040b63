"""What a program is made of beside its functions, and what of it may be run again.

================  =================================================================================
module            what it holds
================  =================================================================================
``calls``         What a program calls of others, as it is run here: quicker, and never without end
``definitions``   Definitions as they are run in a trial, and classes whose methods can be changed
``loaded``        The lines of a module that run when it is loaded
``plain``         Whether a program is plain arithmetic, and may be run with edits in it
``typed``         Where the numbers of a program's data were typed
================  =================================================================================
"""
