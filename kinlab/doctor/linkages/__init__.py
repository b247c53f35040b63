"""Formulas of a five-bar as text: their names, what they are held against, what is right too.

=================  ================================================================================
module             what it holds
=================  ================================================================================
``as_right``       A five-bar's answers that are as right as the engine's own: an equation times a
                   factor, a branch
``five_bar``       What the names in formulas of a five-bar claim and stand for: J11, C2, theta1,
                   w1x, uHw1, I_A
``looked_up``      A five-bar's quantity as the engine has it, at this and at other five-bars, as a
                   reference
``mechanisms``     The arm or the five-bar that formulas are of: from a name, a path, or what
                   one has
``named_numbers``  The robot's numbers by the names that they have in formulas, an arm's or a
                   five-bar's
=================  ================================================================================
"""
