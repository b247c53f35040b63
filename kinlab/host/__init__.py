"""What is asked of the machine: files written whole, processes that end with us, safe pages,
and answers as text, HTML and rows.

=================  ===============================================================================
module             what it holds
=================  ===============================================================================
``answers``        Answers kept for a while: one question about the same numbers is answered once
``evidence``       What the answer of a search rests on: what was searched, how often it was met,
                   what is proved
``files``          Files are read with a clear error and written whole or not at all
``introductions``  Answers introduce themselves: the verdict first, then the numbers that matter
``language``       The language in which kinlab speaks: English in the code, others in catalogues
``processes``      Processes of ours end with the process that started them, however that one ends
``progress``       How far a long calculation is: one line on a terminal or in a notebook, nothing
                   elsewhere
``version``        The version of the package
``web``            What every page we write has in common: a policy that runs our own scripts and no
                   others
=================  ===============================================================================
"""
