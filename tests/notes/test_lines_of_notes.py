"""The ledger of the notes: every line of every note has a row of the catalogue, or a reason."""

from __future__ import annotations

from pathlib import Path

import pytest

import kinlab.notes
from kinlab.check.catalogue import catalogue

LEDGER = Path(kinlab.notes.__file__).with_name("lines.tsv")
LENGTHS = {"000": 251, "001": 182, "002": 936, "003": 69}
"""Lines of each note."""


def entries():
    out = []
    for line in LEDGER.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            continue
        note, span, ids, words, *_ = line.split("\t")
        first, _, last = span.partition("-")
        out.append((note, int(first), int(last or first), ids.split() if ids != "-" else [], words))
    return out


@pytest.mark.parametrize("note", LENGTHS)
def test_no_line_is_left_out(note):
    spans = [(first, last) for n, first, last, _, _ in entries() if n == note]
    expected = 1
    for first, last in spans:
        assert first == expected and last >= first
        expected = last + 1
    assert expected == LENGTHS[note] + 1


def test_every_id_is_in_the_catalogue_and_every_row_in_the_ledger():
    known = {record.id for record in catalogue()}
    named = {one for *_, ids, _ in entries() for one in ids}
    assert named == known


def test_where_there_is_no_row_there_is_a_reason():
    for note, first, _, ids, words in entries():
        assert words.strip(), (note, first)
        if not ids:
            assert len(words) >= 5, (note, first)
