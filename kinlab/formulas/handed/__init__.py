"""Formulas as they are handed in: with code, units, a word processor's letters around them.

==============  ===================================================================================
module          what it holds
==============  ===================================================================================
``code``        Formulas as they stand in programs: ``lambda``, ``def``, ``self.l1``, comments
``columns``     A column of names before a column of formulas
``constants``   A free constant behind a potential
``displays``    Equations that LaTeX sets in lines of their own
``equations``   Equations that give an entry otherwise than by its name alone, solved for it
``letters``     Letters and signs of word processors and web pages
``rates``       Rates by the names that programs of algebra give them
``reading``     All that is done to a formula as it is handed in, in the order in which it is done
``units``       Units behind numbers and formulas
==============  ===================================================================================
"""
