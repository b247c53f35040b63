"""Measured poses: a slip is named where it stands clear of the noise."""

from __future__ import annotations


def judge(table, reference, notes):
    return None
