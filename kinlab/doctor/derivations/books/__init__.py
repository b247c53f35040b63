"""The textbooks' derivations as text, each written once, for any serial arm and for the five-bar.

==============  ===================================================================================
module          what it holds
==============  ===================================================================================
``columns``     Jacobians column by column, what is made of them: statics, rates, steps, isotropy.
``energies``    Masses and energies: the mass matrix, Christoffel symbols, Lagrange's equation.
``five_bar``    The five-bar: its loop, rates, torques, rods with mass.
``lines``       What the derivations' lines are called.
``matrices``    The links' matrices, entry by entry and as products.
``recursions``  Recursions from link to link: Newton-Euler in three forms, spatial vectors,
                composite bodies.
==============  ===================================================================================
"""
