"""The words around a formula: which of them are read, passed over, or may change what it claims.

===============  ==================================================================================
module           what it holds
===============  ==================================================================================
``cases``        Special cases in front of a formula, and parts of the arm
``clauses``      Clauses that say what may be true of an arm: ``gravity acts along -y``
``derivations``  What a derivation of several steps comes to: the entry's equations, and their names
``prose``        Which words beside a formula may change what it claims
``sentences``    The equations in a text with sentences
``vocabulary``   Words that say nothing of what a formula claims
``words``        Words around a formula
===============  ==================================================================================
"""
