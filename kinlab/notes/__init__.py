"""The hand formulas of the notes, one file per note or part of a note.

They use numpy and :mod:`kinlab.formula` and nothing else, so that each is an oracle for the
engine: the two meet in :mod:`kinlab.check` only. The ids are ``<note>.<name>``.
"""
