"""What a value in somebody's program is: the axis of joint 2, the angular velocity of link 1.

A value that equals one of the arm's own quantities at every random state is that thing. What
several things are called alike stays without a number, what is called differently without a name:
nothing is said rather than a wrong word.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.glossary.textbook import Glossary, Row, Sense
from kinlab.host.language import N_, _
from kinlab.tolerances import TOLERANCES

PHRASES = {
    "T0": N_("the transform of {frame} in the base"),
    "T": N_("the transform of {frame} in {before}"),
    "T0_inverse": N_("the inverse of the transform of {frame} in the base"),
    "T_inverse": N_("the inverse of the transform of {frame} in {before}"),
    "tool_pose": N_("the tool's pose"),
    "R0": N_("the rotation matrix of {frame} in the base"),
    "R": N_("the rotation matrix of {frame} in {before}"),
    "tool_rotation": N_("the tool's rotation matrix"),
    "axis": N_("the axis of {joint}"),
    "z_axis": N_("the z axis of {frame}"),
    "origin": N_("the origin of {frame}"),
    "tool_point": N_("the tool point"),
    "centre": N_("the position of the centre of mass of {link}"),
    "coordinate": N_("the {of} coordinate of the origin of {frame}"),
    "tool_coordinate": N_("the {of} coordinate of the tool point"),
    "centre_coordinate": N_("the {of} coordinate of the centre of mass of {link}"),
    "lever": N_("the vector from {before} to {frame}"),
    "far_lever": N_("the vector from frame {of} to {frame}"),
    "tool_lever": N_("the vector from {frame} to the tool point"),
    "own_centre": N_("the vector from the origin of its frame to the centre of mass of {link}"),
    "joint_centre": N_("the vector from the frame before to the centre of mass of {link}"),
    "far_centre": N_("the vector from frame {of} to the centre of mass of {link}"),
    "w": N_("the angular velocity of {link}"),
    "dw": N_("the angular acceleration of {link}"),
    "v": N_("the velocity of the origin of {frame}"),
    "vc": N_("the velocity of the centre of mass of {link}"),
    "tool_velocity": N_("the velocity of the tool point"),
    "dv": N_("the acceleration of the origin of {frame}"),
    "dv-g": N_("the acceleration of the origin of {frame} less g"),
    "dvc": N_("the acceleration of the centre of mass of {link}"),
    "dvc-g": N_("the acceleration of the centre of mass of {link} less g"),
    "F": N_("the inertial force of {link}"),
    "F-g": N_("the inertial force of {link} less its weight"),
    "N": N_("the inertial moment of {link}"),
    "p": N_("the momentum of {link}"),
    "L": N_("the angular momentum of {link} about its centre of mass"),
    "g": N_("the acceleration of gravity"),
    "weight": N_("the weight of {link}"),
    "f": N_("the force through {joint}"),
    "n": N_("the moment through {joint}"),
    "load_force": N_("the force at the tool"),
    "load_moment": N_("the moment at the tool"),
    "load": N_("the wrench at the tool"),
    "I dw": N_("the inertia tensor times the angular acceleration of {link}"),
    "w x Iw": N_("the gyroscopic moment w x (I w) of {link}"),
    "wwP": N_("the centripetal term w x (w x r) of the origin of {frame}"),
    "wwc": N_("the centripetal term w x (w x r) of the centre of mass of {link}"),
    "wwr": N_("the centripetal term of the centre of mass of {link}, r from the frame before"),
    "aP": N_("the tangential term of the origin of {frame}"),
    "ac": N_("the tangential term of the centre of mass of {link}"),
    "ar": N_("the tangential term of the centre of mass of {link}, r from the frame before"),
    "wP": N_("w x r of the origin of {frame}"),
    "wc": N_("w x r of the centre of mass of {link}"),
    "wr": N_("w x r of the centre of mass of {link}, r from the frame before"),
    "Coriolis": N_("the Coriolis acceleration of the slide of {joint}"),
    "z qd": N_("the velocity of {joint} times its axis"),
    "z qdd": N_("the acceleration of {joint} times its axis"),
    "w x z qd": N_("w x (z qd) of {joint}"),
    "c x F": N_("the moment of the inertial force of {link} about the origin of its frame"),
    "r x F": N_("the moment of the inertial force of {link} about the origin of the frame before"),
    "P x f": N_("the moment of the force through {joint} about the joint before"),
    "inertia": N_("the inertia tensor of {link} about its centre of mass"),
    "frame_inertia": N_("the inertia tensor of {link} about the origin of its frame"),
    "mass": N_("the mass of {link}"),
    "cell": N_("{of} in {row} of the table"),
    "centre_distance": N_("the distance from {joint} to its link's centre of mass"),
    "Izz": N_("the moment of inertia of {link} about its centre of mass"),
    "joint_Izz": N_("the moment of inertia of {link} about its joint"),
    "sine": N_("the sine of {of}"),
    "cosine": N_("the cosine of {of}"),
    "angle": N_("the angle {of}"),
    "q": N_("the position of {joint}"),
    "qd": N_("the velocity of {joint}"),
    "qdd": N_("the acceleration of {joint}"),
    "positions": N_("the joint positions"),
    "angles": N_("the links' angles from the base"),
    "velocities": N_("the joint velocities"),
    "rates": N_("the links' rates from the base"),
    "accelerations": N_("the joint accelerations"),
    "J": N_("the Jacobian"),
    "J_inverse": N_("the inverse of the Jacobian"),
    "Jv": N_("the linear rows of the Jacobian"),
    "Jw": N_("the angular rows of the Jacobian"),
    "Jv_column": N_("the linear part of {column} of the Jacobian"),
    "J_column": N_("{column} of the Jacobian"),
    "J_entry": N_("entry ({of}) of the Jacobian"),
    "Jvc": N_("the linear Jacobian of the centre of mass of {link}"),
    "Jwc": N_("the angular Jacobian of {link}"),
    "Jvc_column": N_("column {of} of the linear Jacobian of the centre of mass of {link}"),
    "twist": N_("the tool's twist"),
    "J^T F": N_("the joint torques that hold the wrench"),
    "M": N_("the mass matrix"),
    "M_inverse": N_("the inverse of the mass matrix"),
    "M_row": N_("{row} of the mass matrix"),
    "M_entry": N_("entry ({of}) of the mass matrix"),
    "m Jv^T Jv": N_("m Jv^T Jv of {link}, its mass's part of the mass matrix"),
    "Jw^T I Jw": N_("Jw^T I Jw of {link}, its inertia tensor's part of the mass matrix"),
    "M a": N_("the mass matrix times the accelerations"),
    "C": N_("the Coriolis matrix"),
    "C_entry": N_("entry ({of}) of the Coriolis matrix"),
    "C v": N_("the Coriolis and centrifugal torques"),
    "bias": N_("the torques of Coriolis, centrifugal and gravity together"),
    "C_v_entry": N_("the Coriolis and centrifugal torque of {joint}"),
    "christoffel": N_("Christoffel's symbols"),
    "christoffel_entry": N_("Christoffel's symbol ({of})"),
    "M_slopes": N_("the derivatives of the mass matrix"),
    "M_slope": N_("the derivative of the mass matrix by the position of {joint}"),
    "M_dot": N_("the time derivative of the mass matrix"),
    "symbol": N_("{of} of the five-bar"),
    "parameter": N_("{of} of the five-bar"),
    "given": N_("{of} of the tool"),
    "gravity": N_("the gravity torques"),
    "gravity_entry": N_("the gravity torque of {joint}"),
    "tau": N_("the joint torques"),
    "tau_entry": N_("the torque of {joint}"),
    "tau_without_rotor": N_("the torque of {joint} without its rotor"),
    "k": N_("the kinetic energy of {link}"),
    "k_linear": N_("the translational kinetic energy of {link}"),
    "k_rotational": N_("the rotational kinetic energy of {link}"),
    "u": N_("the potential energy of {link}"),
    "kinetic": N_("the kinetic energy"),
    "potential": N_("the potential energy"),
    "screw": N_("the screw axis of {joint}"),
    "home_screw": N_("the screw axis of {joint} at home"),
    "exponential": N_("the exponential of the screw of {joint}"),
    "exponentials": N_("the product of the exponentials up to {joint}"),
    "home": N_("the home pose of {frame}"),
    "home_inverse": N_("the inverse of the home pose of {frame}"),
    "home_tool": N_("the home pose of the tool"),
    "centred": N_("the pose of the centre of mass of {link}"),
    "centred_step": N_("the pose of the centre of mass of {link} from the one before"),
    "centred_inverse": N_("the pose of a centre of mass as seen from that of {link}"),
    "adjoint": N_("the adjoint of the transform of {frame} in {before}"),
    "adjoint_inverse": N_("the adjoint of the inverse transform of {frame} in {before}"),
    "adjoint0": N_("the adjoint of the transform of {frame} in the base"),
    "adjoint0_inverse": N_("the adjoint of the inverse transform of {frame} in the base"),
    "exponential_adjoint": N_("the adjoint of the exponential of {joint}"),
    "exponential_adjoint_inverse": N_("the adjoint of the inverse exponential of {joint}"),
    "exponentials_adjoint": N_("the adjoint of the exponentials up to {joint}"),
    "exponentials_adjoint_inverse": N_("the adjoint of the inverse exponentials up to {joint}"),
    "spatial_inertia": N_("the spatial inertia of {link}"),
    "composite_inertia": N_("the composite spatial inertia of {link} and all behind it"),
    "composite_centre": N_("the centre of mass of {link} and all behind it"),
    "composite_tensor": N_("the composite inertia tensor of {link} and all behind it"),
    "V": N_("the twist of {link}"),
    "S qd": N_("the velocity of {joint} times its screw axis"),
    "S qdd": N_("the acceleration of {joint} times its screw axis"),
    "V x S qd": N_("the twist of {link} crossed with its joint's twist"),
    "dV": N_("the spatial acceleration of {link}"),
    "dV-g": N_("the spatial acceleration of {link} less g"),
    "I V": N_("the spatial momentum of {link}"),
    "V x I V": N_("the twist of {link} crossed with its spatial momentum"),
    "I dV": N_("the spatial inertia times the spatial acceleration of {link}"),
    "net": N_("the inertial wrench of {link}"),
    "wrench": N_("the wrench through {joint}"),
}
"""What things are called, by their key."""

_KINDS = (
    ("axis", "z_axis", "R0", "R", "tool_rotation", "sine", "cosine"),
    ("origin", "centre", "coordinate", "centre_coordinate", "tool_coordinate", "tool_point")
    + ("lever", "far_lever", "tool_lever", "own_centre", "joint_centre", "far_centre")
    + ("centre_distance",),
    ("w",),
    ("dw",),
    ("v", "vc", "tool_velocity", "wP", "wc", "wr"),
    ("dv", "dv-g", "dvc", "dvc-g", "g", "wwP", "wwc", "wwr", "aP", "ac", "ar", "Coriolis"),
    ("F", "F-g", "weight", "f", "load_force"),
    ("N", "n", "I dw", "w x Iw", "c x F", "r x F", "P x f", "load_moment"),
    ("k", "k_linear", "k_rotational", "u", "kinetic", "potential"),
    ("inertia", "frame_inertia", "Izz", "joint_Izz"),
    ("mass",),
    ("p",),
    ("L",),
)
"""What has one unit. Things of different units that have one value (a mass of 1 kg makes force and
acceleration alike) leave it without a name; what is not listed goes with any."""

_OF_POINTS = ("coordinate", "centre_coordinate", "tool_coordinate")
"""Coordinates of points in the base, which move with the arm."""
_CELLS = ("cell", "mass", "centre_distance", "Izz", "joint_Izz")
"""The arm's own numbers, which do not vary: of these, sums and products may meet another."""


def meaning_of(known_at_states: Sequence[Glossary], values: Sequence[Array]) -> Sense | None:
    """What a value is, if it is one thing at all the states and nothing else.

    Args:
        known_at_states: :func:`kinlab.doctor.glossary.textbook.meanings` at each state.
        values: the value at each of them.

    Returns:
        None where it is nothing known, or several things that have different names, or where it is
        so plain a value (0, 1, an axis of coordinates) that anything could have it.
    """
    arrays = [_plain(value) for value in values]
    if not arrays or len({x.shape if x is not None else None for x in arrays}) > 1:
        return None
    seen = [x for x in arrays if x is not None and not _trivial(x)]
    if len(seen) < len(arrays):
        return None
    found: list[tuple[int, int, Sense]] = []
    for k, (form, change) in enumerate(_FORMS.items()):
        if form != "transpose" or seen[0].ndim == 2:
            hits = _hits(known_at_states, [change(x) for x in seen])
            found += [(rank, k, replace(sense, form=form)) for rank, sense in hits]
    kinds = {k for *_rank, sense in found for k, kind in enumerate(_KINDS) if sense.what in kind}
    if len(kinds) > 1:
        return None
    if seen[0].ndim == 0 and all(one == seen[0] for one in seen):  # what never moves is typed
        found = [one for one in found if one[2].what not in _OF_POINTS]
    best = min((rank, k) for rank, k, _sense in found) if found else None
    return _one(known_at_states[0], [x for *rank, x in found if tuple(rank) == best], seen[0])


_FORMS: dict[str, Callable[[Array], Array]] = {
    "": np.array,
    "minus": np.negative,
    "transpose": np.transpose,
}


def _hits(known: Sequence[Glossary], values: Sequence[Array]) -> Iterator[Row]:
    for k, embed in enumerate(_EMBEDDINGS if known[0].plane else _EMBEDDINGS[:1]):
        shown = [embed(value) for value in values]
        same: Any = None
        rows: list[Row] = []
        for one, value in zip(known, shown, strict=True):
            if value is None:
                break
            rows, gap = one.gaps(value)
            if not rows:
                break
            here = gap <= TOLERANCES.same_relation * float(np.max(np.abs(value)))
            same = here if same is None else same & here
        else:
            assert same is not None
            found = (rows[int(row)] for row in np.flatnonzero(same))
            yield from ((rank + (k > 0), sense) for rank, sense in found)


def as_vector(value: Array) -> Array | None:
    """Of a plane arm: a number about z, or two in x and y."""
    if value.shape == ():
        return np.array([0.0, 0.0, float(value)])
    return np.append(value, 0.0) if value.shape == (2,) else None


def _as_rotation(value: Array) -> Array | None:
    if value.shape != (2, 2):
        return None
    out = np.eye(3)
    out[:2, :2] = value
    return out


def _as_transform(value: Array) -> Array | None:
    """Homogeneous in the plane."""
    if value.shape != (3, 3) or np.any(value[2] != (0.0, 0.0, 1.0)):
        return None
    out = np.eye(4)
    out[np.ix_((0, 1, 3), (0, 1, 3))] = value
    return out


def _as_rows(value: Array) -> Array | None:
    """The two rows of a Jacobian."""
    if value.ndim != 2 or len(value) != 2:
        return None
    return np.vstack([value, np.zeros_like(value[:1])])


_EMBEDDINGS: tuple[Callable[[Array], Array | None], ...] = (
    np.asarray,
    as_vector,
    _as_rotation,
    _as_transform,
    _as_rows,
)
"""A value as one in space: as it is, and what a plane arm's formulas leave out."""


def in_space(values: Sequence[Array]) -> Iterator[list[Array]]:
    """Values of a plane arm's formula as ones in space, in each way that there is."""
    for embed in _EMBEDDINGS[1:]:
        shown = [embed(value) for value in values]
        if all(one is not None for one in shown):
            yield [one for one in shown if one is not None]


def _one(known: Glossary, senses: list[Sense], value: Array) -> Sense | None:
    """The one thing that several are: its number and frame only where all have the same."""
    if len({(sense.what, sense.of) for sense in senses}) != 1:
        return None
    first = senses[0]
    if first.what in _CELLS and not _one_way(known, float(abs(value)), first.what):
        return None
    numbers, frames = ({getattr(x, name) for x in senses} for name in ("number", "frame"))
    number = first.number if len(numbers) == 1 else None
    return replace(first, number=number, frame=first.frame if len(frames) == 1 else "")


def _one_way(known: Glossary, size: float, what: str) -> bool:
    """Whether one of the arm's numbers is no simple sum, product or part of the others."""
    rows, values = known.things[()]
    own = [row[1].what in _CELLS for row in rows]
    cells = np.unique(np.abs(values[own]))
    near = TOLERANCES.same_relation * size
    others = cells[(np.abs(cells - size) > near) & (cells > near)]
    parts = () if what == "centre_distance" else (2.0, 0.5, 3.0, 1.0 / 3.0, 4.0, 0.25)
    made = [np.add.outer(others, others), np.subtract.outer(others, others)]
    made += [np.multiply.outer(others, others), *(k * others for k in parts)]
    return not any(bool(np.any(np.abs(x - size) <= near)) for x in made)


def _plain(value: object) -> Array | None:
    """A value as numbers without sides of length one; None where it has none."""
    try:
        array = np.squeeze(np.asarray(value, dtype=np.float64))
    except (TypeError, ValueError):
        return None
    return array if array.size and bool(np.all(np.isfinite(array))) else None


def _trivial(value: Array) -> bool:
    """Whether a value is too plain to tell: nearly 0, halves and whole numbers, parts of pi."""
    if float(np.max(np.abs(value))) < TOLERANCES.plain_value:
        return True
    units = (0.5, np.pi / 12.0) if value.ndim == 0 else (0.5,)
    within = bool(np.all(np.abs(value) <= 10.0))
    return within and any(
        bool(np.all(np.abs(value / x - np.round(value / x)) <= TOLERANCES.plain_value))
        for x in units
    )


def said(sense: Sense) -> str:
    """A noun phrase: ``the angular velocity of link 2 in its own axes``."""
    k, phrase = sense.number, PHRASES[sense.what]
    told = _(phrase).format(
        link=_("a link") if k is None else _("link {number}").format(number=k),
        joint=_("a joint") if k is None else _("joint {number}").format(number=k),
        frame=_("a frame") if k is None else _("frame {number}").format(number=k),
        before=_("the frame before") if k is None else _("frame {number}").format(number=k - 1),
        row=_("a row") if k is None else _("row {number}").format(number=k),
        column=_("a column") if k is None else _("column {number}").format(number=k),
        of=sense.of,
    )
    if sense.frame == "base":
        told = _("{what} in base axes").format(what=told)
    elif sense.frame == "tool":
        told = _("{what} in tool axes").format(what=told)
    elif sense.frame == "own" and "{link}" in phrase:
        told = _("{what} in its own axes").format(what=told)
    elif sense.frame and k is not None:
        other = k + {"before": -1, "own": 0, "next": 1}[sense.frame]
        told = _("{what} in the axes of frame {number}").format(what=told, number=other)
    if sense.form == "minus":
        return _("minus {what}").format(what=told)
    return _("the transpose of {what}").format(what=told) if sense.form else told
