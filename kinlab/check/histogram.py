"""A small picture of how errors are spread over the states, as SVG text."""

from __future__ import annotations

import numpy as np

from kinlab.arrays import Array
from kinlab.tolerances import TOLERANCES

LOW, HIGH = -17, 2
"""Decades shown; what lies outside falls into the first or last bar."""

_WIDTH, _HEIGHT, _FOOT = 380.0, 64.0, 18.0
_STEP = _WIDTH / (HIGH - LOW)


def decades(errors: Array) -> Array:
    """How many errors fall into each decade; zeros in the first, infinities in the last.

    Returns:
        (HIGH - LOW,) counts; their sum is the number of errors.
    """
    clipped = np.clip(errors, 10.0**LOW, 10.0**HIGH)
    place = np.clip(np.floor(np.log10(clipped)).astype(int) - LOW, 0, HIGH - LOW - 1)
    return np.bincount(place, minlength=HIGH - LOW).astype(float)


def svg(corrected: Array, printed: Array | None) -> str:
    """The two spreads over decades of relative error, with the line of agreement.

    Args:
        corrected: errors of the corrected form.
        printed: errors of the printed form, if there is one.
    """
    series = [("good", corrected)] + ([("bad", printed)] if printed is not None else [])
    parts = [
        f'<svg class="spread" viewBox="0 0 {_WIDTH:g} {_HEIGHT + _FOOT:g}" role="img" '
        f'aria-label="{_label(corrected, printed)}">'
    ]
    for name, errors in series:
        counts = decades(errors)
        for k, share in enumerate(counts / np.max(counts)):
            if share > 0.0:
                tall = max(2.0, share * (_HEIGHT - 4.0))
                parts.append(
                    f'<rect class="{name}" x="{k * _STEP + 1.5:.1f}" y="{_HEIGHT - tall:.1f}" '
                    f'width="{_STEP - 3:.1f}" height="{tall:.1f}" rx="1.5"/>'
                )
    parts.append(f'<path class="axis" d="M0 {_HEIGHT:g}H{_WIDTH:g}"/>')
    limit = (np.log10(TOLERANCES.formula_agrees) - LOW) * _STEP
    parts.append(f'<path class="limit" d="M{limit:.1f} 0V{_HEIGHT:g}"/>')
    for power in range(LOW + 2, HIGH, 3):
        x = (power - LOW) * _STEP
        text = "1" if power == 0 else f"10<tspan dy='-4' font-size='8'>{power}</tspan>"
        parts.append(f'<text x="{x:.1f}" y="{_HEIGHT + 14:g}">{text}</text>')
    return "".join([*parts, "</svg>"])


def _label(corrected: Array, printed: Array | None) -> str:
    text = f"relative errors: corrected form at most {np.max(corrected):.1e}"
    return text if printed is None else f"{text}, printed form up to {np.max(printed):.1e}"
