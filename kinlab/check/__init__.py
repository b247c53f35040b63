"""Hand formulas beside the engine: comparison, catalogue, targets.

===============  =================================================================================
module           what it holds
===============  =================================================================================
``catalogue``    The catalogue: every formula of the notes, run on its robots
``compare``      The comparison of a hand formula with the engine over seeded random states
``diagnosis``    A hand formula, judged: a verdict, ranked causes with their evidence, the
                 corrected formula
``guest``        A user's file of marked functions, in a process of its own with a limit of time
``places``       What the catalogue says of a formula, and where it stands in its note: heading,
                 number, lines
``table_check``  Checks of one arm: its DH table by hand beside Pinocchio and yourdfpy
``targets``      What the arguments of ``kinlab check`` mean: robots, files, notes, ids, a user's
                 formulas
``together``     Rows of many tasks together: each mechanism's states solved once, on all cores
``unread``       What a check was asked to judge and could not: it is listed with its reason, the
                 rest goes on
``quantities/``  The engine's quantities by name: what a hand formula can be compared with
``report/``      A check written down: summary, one self-contained HTML page, or Markdown
===============  =================================================================================
"""
