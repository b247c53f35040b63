"""The product of link transforms, with what people write otherwise in the link's matrix.

Each of the twelve entries of the matrix is a product of a cosine or sine of theta, one of alpha,
and a length; an alternative puts another such product, or another sign, into one entry of every
link's matrix, exchanges sine and cosine throughout, or multiplies in another order.
"""

from __future__ import annotations

import re
from itertools import product

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.confusions.recursion import Step
from kinlab.host.language import _
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention

_STANDARD = (
    ("ct", "-st*ca", "st*sa", "a*ct"), ("st", "ct*ca", "-ct*sa", "a*st"), ("0", "sa", "ca", "d"),
)  # fmt: skip
_MODIFIED = (
    ("ct", "-st", "0", "a"), ("st*ca", "ct*ca", "-sa", "-sa*d"), ("st*sa", "ct*sa", "ca", "ca*d"),
)  # fmt: skip
_WORDS = {"ct": "cos(theta)", "st": "sin(theta)", "ca": "cos(alpha)", "sa": "sin(alpha)"}
_PARTS = (("", "ct", "st"), ("", "ca", "sa"), ("", "a", "d"))


def matrix_steps(table: DHTable) -> list[Step]:
    """Every alternative entry of the link's matrix, and other ways to multiply."""
    rows = _STANDARD if table.convention is Convention.STANDARD else _MODIFIED
    products = ["*".join(p for p in parts if p) or "1" for parts in product(*_PARTS)]
    found = [
        Step("sin/cos", _("exchanges sin and cos of alpha (cos alpha for sin alpha) in the link's "
                          "matrix"), {"swap alpha": 1.0}, 1.1),
        Step("sin/cos", _("exchanges sin and cos of theta (cos theta for sin theta) in the link's "
                          "matrix"), {"swap theta": 1.0}, 1.1),
        Step("order", _("multiplies the link transforms in the opposite order"), {"reversed": 1.0},
             1.1),
        Step("transposed", _("has each link's rotation transposed"), {"transposed": 1.0}, 1.1),
        Step("slide as hinge", _("adds q to theta at a slide (prismatic joint) too, as at a hinge"),
             {"slide theta": 1.0}, 1.1),
        Step("slide as hinge", _("adds q to theta at a slide (prismatic joint), not to d"),
             {"slide theta": 1.0, "slide d": -1.0}, 1.1),
        Step("hinge as slide", _("adds q to d at a hinge too, as at a slide (prismatic joint)"),
             {"hinge d": 1.0}, 1.2),
        Step("slide left out", _("leaves q out at a slide (prismatic joint)"), {"slide d": -1.0},
             1.15),
    ]  # fmt: skip
    instead = _("has {written} for {meant} in {where}")
    for r, c in np.ndindex(3, 4):
        right = rows[r][c]
        where = _("entry ({row}, {column}) of the link's matrix").format(row=r + 1, column=c + 1)
        if right != "0":
            told = _("has the opposite sign in {where}: {written} for {meant}").format(
                where=where, written=_said(_minus(right)), meant=_said(right)
            )
            found.append(Step("sign", told, {f"{r}{c}:{_minus(right)}": 1.0}, 1.05))
            told = _("leaves {where} out: 0 for {meant}").format(where=where, meant=_said(right))
            found.append(Step("missing term", told, {f"{r}{c}:0": 1.0}, 1.15))
        for other in products:
            if other.lstrip("-") == right.lstrip("-"):
                continue
            for text in (other, f"-{other}"):
                same_sign = text.startswith("-") == right.startswith("-")
                cost = _cost(right, other) + (0.0 if same_sign else 0.5)
                told = instead.format(written=_said(text), meant=_said(right), where=where)
                found.append(Step(_kind(right, other), told, {f"{r}{c}:{text}": 1.0}, cost))
    return found


def _said(text: str) -> str:
    """A product in the words of the textbooks: sin(theta)*cos(alpha)."""
    for short, word in _WORDS.items():
        text = re.sub(rf"\b{short}\b", word, text)
    return text


def _minus(text: str) -> str:
    return text[1:] if text.startswith("-") else f"-{text}"


def _cost(right: str, other: str) -> float:
    mine, theirs = set(right.lstrip("-").split("*")), set(other.split("*"))
    return 1.05 + 0.1 * len(mine ^ theirs)


def _kind(right: str, other: str) -> str:
    mine, theirs = set(right.lstrip("-").split("*")), set(other.split("*"))
    if theirs < mine or (other == "1" and right != "0"):
        return "missing factor"
    if mine < theirs or right == "0":
        return "extra factor"
    return "sin/cos" if mine & theirs or {*mine, *theirs} <= {"ct", "st", "ca", "sa"} else "factor"


def products(table: DHTable, q: Array, ways: list[tuple[Step, ...]]) -> Array:
    """The tool's pose of every alternative, (B, N, 4, 4)."""
    rows = _STANDARD if table.convention is Convention.STANDARD else _MODIFIED
    count, states = len(ways), len(q)
    changed: dict[str, list[int]] = {}
    for k, way in enumerate(ways):
        for step in way:
            for term in step.weights:
                changed.setdefault(term, []).append(k)

    def rowed(term: str) -> Array:
        out = np.zeros((count, 1))
        out[changed.get(term, [])] = 1.0
        return out

    steps = []
    for i, link in enumerate(table.links):
        turn = -1.0 if link.flip else 1.0
        slide = link.joint == "prismatic"
        x = turn * q[:, i]
        theta = link.theta + (x * rowed("slide theta") if slide else x + 0 * rowed("slide theta"))
        d = link.d + (x * (1 - rowed("slide d")) if slide else x * rowed("hinge d"))
        ct, st = np.cos(theta), np.sin(theta)
        ca = np.cos(link.alpha) + 0 * ct
        sa = np.sin(link.alpha) + 0 * ct
        by_theta, by_alpha = rowed("swap theta"), rowed("swap alpha")
        ct, st = ct + by_theta * (st - ct), st + by_theta * (ct - st)
        ca, sa = ca + by_alpha * (sa - ca), sa + by_alpha * (ca - sa)
        at = {"ct": ct, "st": st, "ca": ca, "sa": sa, "a": link.a + 0 * ct, "d": d + 0 * ct,
              "1": 1 + 0 * ct, "0": 0 * ct}  # fmt: skip
        matrix = np.zeros((count, states, 4, 4))
        matrix[..., 3, 3] = 1.0
        for r, c in np.ndindex(3, 4):
            matrix[..., r, c] = _value(rows[r][c], at)
            for term, which in changed.items():
                if term.startswith(f"{r}{c}:"):
                    matrix[which, :, r, c] = _value(term[3:], at)[which]
        turned = changed.get("transposed", [])
        matrix[turned, :, :3, :3] = np.swapaxes(matrix[turned, :, :3, :3], -1, -2)
        steps.append(matrix)
    pose = np.broadcast_to(np.asarray(table.base), (count, states, 4, 4))
    for matrix in steps:
        pose = pose @ matrix
    back = changed.get("reversed", [])
    if back:
        other = np.broadcast_to(np.asarray(table.base), (len(back), states, 4, 4))
        for matrix in reversed(steps):
            other = other @ matrix[back]
        pose = np.array(pose)
        pose[back] = other
    result: Array = pose @ np.asarray(table.tool)
    return result


def _value(text: str, at: dict[str, Array]) -> Array:
    out = 1.0 + 0 * at["ct"]
    for part in text.lstrip("-").split("*"):
        out = out * at[part]
    return -out if text.startswith("-") else out
