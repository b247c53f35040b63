"""Dimensional synthesis: the lengths of a five-bar for a rectangle.

=============  ===================================================================================
module         what it holds
=============  ===================================================================================
``front``      The Pareto front of two goals: for each bound on the one, the best of the other
``goals``      What a five-bar can be designed for: each goal is the worst of a few smooth
               quantities
``problem``    A design problem: what is free, what is asked, and what a candidate is worth at
               given points
``search``     The search of one design: differential evolution, an exact polish, and the proof of
               the worst
``synthesis``  ``kl.design_fivebar``: the lengths of a five-bar for a rectangle, with the proof of
               its worst
=============  ===================================================================================
"""
