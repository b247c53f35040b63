"""Note 003: inverse kinematics, Jacobian and accelerations of the five-bar.

Source: the note, "Dynamic Formulation"; Huang et al. 2005, doi 10.1115/1.1898343. The note
writes leg 1 with +e and leg 2 with -e; here s = ±1 stands for that sign, and ``mode`` holds the
signs of u_i x w_i, which choose the sign before the root.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes.loop import E1, Array, Loop, S, dot, legs, times, triple

ROBOTS = ("fivebar",)
INVERSE = "note 003, inverse kinematics"
JACOBIAN = "note 003, Jacobian"


_formula = partial(formula, source=INVERSE, robots=ROBOTS)


@_formula(
    "003.loop",
    quantity="fivebar_rod_length",
    latex=r"(s e + l_1 \cos\theta - x)^2 + (l_1 \sin\theta - y)^2 = l_2^2",
)
def rod_length(loop: Loop, theta: Array, xy: Array) -> Any:
    """Closure of a leg: the distance from elbow to tool."""
    x, y = xy[..., :1], xy[..., 1:]
    along = S * loop.e + loop.l1 * np.cos(theta) - x
    return np.sqrt(along**2 + (loop.l1 * np.sin(theta) - y) ** 2)


def _c(loop: Loop, xy: Array) -> Any:
    x, y = xy[..., :1], xy[..., 1:]
    return loop.l2**2 - loop.l1**2 - loop.e**2 - x**2 - y**2 + 2.0 * S * loop.e * x


def _c_printed(loop: Loop, theta: Array, xy: Array) -> Any:
    del theta  # on the left side only
    x, y = xy[..., :1], xy[..., 1:]
    return loop.l2**2 - loop.l1**2 - loop.e**2 - x**2 - y**2


@_formula(
    "003.ABC",
    quantity="fivebar_projection",
    latex=r"2(s e - x) l_1 \cos\theta - 2 y l_1 \sin\theta ="
    r" l_2^2 - l_1^2 - e^2 - x^2 - y^2 \fixed{+ 2 s e x}",
    printed=Printed(
        _c_printed,
        "the term 2 s e x is missing",
        r"2(s e - x) l_1 \cos\theta - 2 y l_1 \sin\theta = l_2^2 - l_1^2 - e^2 - x^2 - y^2"
        r" \wrong{\text{ (} 2 s e x \text{ missing)}}",
        robots=("isotropic", "unequal", "plotclock", "equal_links"),
    ),
    remark="With e = 0 the missing term is nothing.",
)
def right_side(loop: Loop, theta: Array, xy: Array) -> Any:
    """A cos theta + B sin theta = C: the right side C."""
    del theta  # on the left side only
    return _c(loop, xy)


@_formula(
    "003.tan",
    quantity="fivebar_cranks",
    latex=r"\theta = 2 \arctan \frac{B \pm \sqrt{A^2 + B^2 - C^2}}{A + C}",
    remark="0/0 where A + C = 0 (theta = pi in one mode); the plus sign is u x w > 0. kinlab's "
    "own inverse kinematics solves the leg's triangle instead.",
)
def cranks(loop: Loop, xy: Array, mode: Array) -> Any:
    """Crank directions by the half tangent."""
    x, y = xy[..., :1], xy[..., 1:]
    a = 2.0 * (S * loop.e - x) * loop.l1
    b = -2.0 * y * loop.l1
    c = _c(loop, xy)
    theta = 2.0 * np.arctan((b + mode * np.sqrt(a**2 + b**2 - c**2)) / (a + c))
    return np.stack([np.cos(theta), np.sin(theta)], axis=-1)


@_formula(
    "003.w",
    quantity="fivebar_rods",
    latex=r"\boldsymbol w_i = (\boldsymbol r - s e\,\boldsymbol e_1 - l_1 \boldsymbol u_i)/l_2",
)
def rods(loop: Loop, xy: Array, mode: Array) -> Any:
    """Rod directions."""
    base = S[:, None] * loop.e * E1
    arm = legs(xy) - base - loop.l1[:, None] * cranks(loop, xy, mode)
    return arm / loop.l2[:, None]


def bars(loop: Loop, xy: Array, mode: Array) -> tuple[Array, Array, Array]:
    """u (..., 2, 2), w (..., 2, 2) and u^T H w (..., 2)."""
    u, w = cranks(loop, xy, mode), rods(loop, xy, mode)
    return u, w, triple(u, w)


@_formula(
    "003.J",
    source=JACOBIAN,
    quantity="fivebar_jacobian",
    latex=r"\dot\theta_i = \frac{\boldsymbol w_i^T}{l_1 \boldsymbol u_i^T \boldsymbol H"
    r" \boldsymbol w_i} \boldsymbol v = \boldsymbol J_i \boldsymbol v",
)
def jacobian(loop: Loop, xy: Array, mode: Array) -> Any:
    """Crank rates from the tool's velocity."""
    _, w, sine = bars(loop, xy, mode)
    return w / (loop.l1 * sine)[..., None]


def bias(loop: Loop, xy: Array, v: Array, mode: Array) -> Any:
    """f(v) of 003.acc."""
    u, w, sine = bars(loop, xy, mode)
    vw, vu = dot(legs(v), w), dot(legs(v), u)
    return (vw**2 * dot(u, w) / loop.l1 + vu**2 / loop.l2) / (loop.l1 * sine**3)


@_formula(
    "003.acc",
    source=JACOBIAN,
    quantity="fivebar_turn",
    latex=r"\ddot\theta_i = \boldsymbol J_i \boldsymbol a + \frac{(\boldsymbol v \cdot"
    r" \boldsymbol w_i)^2 (\boldsymbol u_i \cdot \boldsymbol w_i)/l_1 + (\boldsymbol v \cdot"
    r" \boldsymbol u_i)^2/l_2}{l_1 (\boldsymbol u_i^T \boldsymbol H \boldsymbol w_i)^3}",
)
def turn(loop: Loop, xy: Array, v: Array, a: Array, mode: Array) -> Any:
    """Crank accelerations from the tool's motion."""
    return times(jacobian(loop, xy, mode), a) + bias(loop, xy, v, mode)
