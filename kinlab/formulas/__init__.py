"""Formulas as text: the record of a hand formula, one tree, its readers and writers.

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``arithmetic``  The one walk over Python's syntax tree of arithmetic: a whitelist, whatever the
                signs mean
``evaluate``    Plain evaluation of a formula's text as it is written: nothing opened, gathered or
                cancelled
``files``       Files of formulas: entries, symbols, and what both stand on
``grids``       Matrices and vectors as people type them: LaTeX, MATLAB, Python; their sums and
                products
``lines``       A file of formulas, line by line: one line that is no TOML costs that line and
                not the file
``marks``       Where a formula and its corrected form differ, for the eye
``numbers``     Numbers and angles written as text: ``"pi/2"``, ``"-90 deg"``, ``"sqrt(2)*0.3"``
``record``      The record of one hand formula, and the decorators that make it
``retyped``     A corrected formula in its writer's own typing: LaTeX stays LaTeX, ``q(2)``
                stays ``q(2)``
``text``        Formulas as text, read by a whitelist over Python's syntax tree. Nothing is ever
                evaluated
``tree``        Formulas as small trees that keep the writer's own form, so that a repair can
                point at it
``typed``       Formulas as people type them, made plain: LaTeX, MATLAB, Python, letters of
                Unicode, matrices
``typeset``     Formulas as LaTeX and MathML: the records' own LaTeX, and trees in the order of
                the writer
``handed/``     Formulas as they are handed in: code, units, a word processor's letters
``language/``   The words around a formula: read, passed over, or a doubt
``signs/``      The signs that formulas are typed with, made plain: LaTeX, products without a
                sign, remarks
==============  ==================================================================================
"""
