"""Formulas as they are handed in: with words, code and units around them.

==============  ===================================================================================
module          what it holds
==============  ===================================================================================
``clauses``     Clauses that say what may be true of an arm: ``gravity acts along -y``
``code``        Formulas as they stand in programs: ``lambda``, ``def``, ``self.l1``, comments
``columns``     A column of names before a column of formulas
``constants``   A free constant behind a potential
``equations``   Equations that give an entry otherwise than by its name alone, solved for it
``letters``     Letters and signs of word processors and web pages
``prose``       Which words beside a formula may change what it claims
``rates``       Rates by the names that programs of algebra give them
``reading``     All that is done to a formula as it is handed in, in the order in which it is done
``sentences``   The equations in a text with sentences
``units``       Units behind numbers and formulas
``vocabulary``  Words that say nothing of what a formula claims
``words``       Words around a formula
==============  ===================================================================================
"""
