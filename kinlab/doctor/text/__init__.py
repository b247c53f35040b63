"""A formula as its writer typed it: its line, its numbers, its slips of the pen.

================  ================================================================================
module            what it holds
================  ================================================================================
``alternatives``  What may stand at a place of a text instead of what stands there, tried place by
                  place
``claims``        What the names in a file of formulas claim to be: tau1, g2, M12, C11, J11, x, T,
                  V
``habits``        Names by habit: ``L1`` for l1, ``a1`` for a length, ``t1`` for an angle, ``d3`` of
                  a slide
``joints``        Joint positions as text: q1 = atan2(y, x) - ..., q2 = acos(...), each from the
                  target's numbers
``line``          One formula as a line: the names in it, its places, their values, and what a
                  change does to the whole
``meanings``      What a number in a formula may stand for: the robot's own, products and sums of
                  these, constants
``mend``          One slip of the pen, two or three: the changes that make a line right, and the
                  line then
``numbers_off``   Several numbers of a text that are off, beside others that are only rounded
``own_names``     A file's formulas in the robot's names: the writer's own names and numbers, what
                  they mean
``pairs``         Pairs of effects that make up a difference, found without trying each with each
``stand_ins``     Numbers of a text within their digits: what they may stand for, and whether that
                  explains it
``throughout``    One thing for another in the whole text: a name, a number, the joints, sines and
                  cosines
``written``       A formula as its writer wrote it: names, literals with their digits, and values
                  at any numbers
================  ================================================================================
"""
