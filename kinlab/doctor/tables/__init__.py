"""The table doctor: two descriptions of one arm disagree; which cell of the table is wrong?

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``bodies``      Dynamic slips: masses, centres, inertias, armatures and gravity, link by link
``body_slips``  What is wrong with a body's number, told from what is written and what is meant
``cells``       Cells that are solved for: which one or two numbers, changed, give the reference's
                poses?
``chain``       A DH table as plain arrays: its frames at many states, and the elementary motions
                of its cells
``diagnosis``   Two descriptions of one arm disagree: which cell of the table is wrong?
``noise``       Measured poses: a cell is named where its slip stands clear of the noise
``readings``    Other readings of a whole table: what it would mean had one slip of a known form
                been made
``report``      Diagnoses of tables written down: one self-contained HTML page, or Markdown
``result``      What the table doctor says: verdict, causes, evidence; as text, HTML and plain
                data
``rows``        Whole rows: which one is left out, doubled or too many?
``search``      The search for kinematic slips: one, then two, the simplest first
``words``       What is wrong with a cell, told from what is written and what is meant
``zeros``       The same arm in other frames: other zeros of its joints, another base, another
                tool
``reference/``  What a table is held against: another description of the arm, or measured poses
==============  ==================================================================================
"""
