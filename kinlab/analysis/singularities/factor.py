"""Trigonometric polynomials of a few joints, with what they leave of a box around any centre.

About any centre such a polynomial can be written in 1, sin kx, 1 - cos kx, which bounds it over a
box, linear part apart, to second order: what a search with a proof needs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array


@dataclass(frozen=True)
class Factor:
    """Functions of a few joints whose common zeros are singular configurations.

    Attributes:
        joints: indices of the joints they depend on.
        degrees: degree in each.
        turns: which of them are revolute.
        coefficients: (b_1, ..., b_d, k) for k functions; along a revolute joint in the order
            1, cos, sin, cos 2q, sin 2q, ..., along a prismatic one in powers. Largest 1.
        codimension: 1 for one function, else how many equations a rank drop is.
    """

    joints: tuple[int, ...]
    degrees: tuple[int, ...]
    turns: tuple[bool, ...]
    coefficients: Array
    codimension: int

    @property
    def slack(self) -> float:
        """What rounding may do to a value."""
        return 1e-12 * float(
            np.abs(self.coefficients).sum(axis=tuple(range(len(self.joints)))).max()
        )

    def values(self, x: Array) -> tuple[Array, Array]:
        """Values (N, k) and gradients (N, k, d) at x (N, d)."""
        bases = [self._basis(i, x[:, i]) for i in range(len(self.joints))]
        gradient = np.empty((len(x), self.coefficients.shape[-1], len(self.joints)))
        for i in range(len(self.joints)):
            gradient[..., i] = self._contract([b[1 if i == j else 0] for j, b in enumerate(bases)])
        return self._contract([b[0] for b in bases]), gradient

    def _contract(self, vectors: list[Array]) -> Array:
        first, *rest = vectors
        out = np.tensordot(first, self.coefficients, axes=(1, 0))
        for vector in rest:
            out = np.einsum("nb,nb...->n...", vector, out)
        return out

    def _basis(self, i: int, x: Array) -> tuple[Array, Array]:
        degree = self.degrees[i]
        size = 2 * degree + 1 if self.turns[i] else degree + 1
        value, slope = np.zeros((len(x), size)), np.zeros((len(x), size))
        value[:, 0] = 1.0
        for k in range(1, degree + 1):
            if self.turns[i]:
                c, s = np.cos(k * x), np.sin(k * x)
                value[:, 2 * k - 1], value[:, 2 * k] = c, s
                slope[:, 2 * k - 1], slope[:, 2 * k] = -k * s, k * c
            else:
                value[:, k], slope[:, k] = x**k, k * x ** (k - 1)
        return value, slope

    def enclosures(self, centre: Array, half: Array) -> Enclosures:
        """The functions over boxes |x_i| <= half_i about centres, both (N, d)."""
        count, d = centre.shape
        local = np.broadcast_to(self.coefficients, (count, *self.coefficients.shape))
        axes = [self._local(i, centre[:, i], half[:, i]) for i in range(d)]
        for i, axis in enumerate(axes):
            shape = local.shape
            before = int(np.prod(shape[1 : 1 + i], dtype=int))
            cut = local.reshape(count, before, shape[1 + i], -1)
            local = np.einsum("nbc,nxbr->nxcr", axis.shift, cut).reshape(shape)
        origin: Array = local[_slices(d)]
        rest = np.abs(local)
        for axis in axes:
            rest = np.einsum("nb,nb...->n...", axis.bound, rest)
        rest -= np.abs(origin)
        gradient = np.empty((count, origin.shape[1], d))
        hessian = np.zeros((count, origin.shape[1], d, d))
        second = rest.copy()
        for i, one in enumerate(axes):
            along = local[_slices(d, i)]  # (N, b, k)
            gradient[..., i] = np.einsum("b,nbk->nk", one.slope, along)
            hessian[..., i, i] = np.einsum("b,nbk->nk", one.curve, along)
            # the absolute sum counted the linear part, of which only its bend stays
            rest -= np.einsum("nb,nbk->nk", one.straight - one.bend, np.abs(along))
            gone = one.bound * (one.linear | one.square) - one.bend - one.bulge
            second -= np.einsum("nb,nbk->nk", gone, np.abs(along))
            for j in range(i + 1, d):
                two = axes[j]
                cross = local[_slices(d, i, j)]  # (N, b, c, k)
                hessian[..., i, j] = np.einsum("b,c,nbck->nk", one.slope, two.slope, cross)
                hessian[..., j, i] = hessian[..., i, j]
                size = half[:, i, np.newaxis, np.newaxis] * half[:, j, np.newaxis, np.newaxis]
                product = one.slope[:, np.newaxis] * two.slope * size
                counted = (one.bound * one.linear)[:, :, np.newaxis] * (two.bound * two.linear)[
                    :, np.newaxis
                ]
                second -= np.einsum("nbc,nbck->nk", 2.0 * counted - product, np.abs(cross))
        return Enclosures(origin, gradient, rest + self.slack, hessian, second + self.slack)

    def _local(self, i: int, centre: Array, half: Array) -> _Axis:
        """From the global basis to 1, sin kx, 1 - cos kx (or powers of x) about centres (N,)."""
        degree, count = self.degrees[i], len(centre)
        size = 2 * degree + 1 if self.turns[i] else degree + 1
        shift, bound = np.zeros((count, size, size)), np.ones((count, size))
        slope, curve = np.zeros(size), np.zeros(size)
        bend, bulge = np.zeros((count, size)), np.zeros((count, size))
        shift[:, 0, 0] = 1.0
        if not self.turns[i]:
            for power in range(1, degree + 1):
                choose = 1.0
                for k in range(power + 1):
                    shift[:, power, k] = choose * centre ** (power - k)
                    choose *= (power - k) / (k + 1)
                bound[:, power] = half**power
            slope[1:2], curve[2:3] = 1.0, 2.0
            return _Axis(shift, bound, slope, curve, bend, bulge)
        for k in range(1, degree + 1):
            c, s, angle = np.cos(k * centre), np.sin(k * centre), k * half
            odd, even = 2 * k - 1, 2 * k
            shift[:, odd, 0], shift[:, odd, odd], shift[:, odd, even] = c, -s, -c
            shift[:, even, 0], shift[:, even, odd], shift[:, even, even] = s, c, -s
            bound[:, odd] = np.sin(np.minimum(angle, 0.5 * np.pi))
            bound[:, even] = 1.0 - np.cos(np.minimum(angle, np.pi))
            slope[odd], curve[even] = k, k**2
            # |kx - sin kx| and |k^2 x^2 / 2 - (1 - cos kx)| grow with |x|
            bend[:, odd] = angle - np.sin(angle)
            bulge[:, even] = 0.5 * angle**2 - (1.0 - np.cos(angle))
        return _Axis(shift, bound, slope, curve, bend, bulge)


@dataclass(frozen=True)
class Enclosures:
    """Functions over boxes, with bounds on what is left out.

    f(centre + x) = value + gradient . x + r with |r| <= rest, and
    f(centre + x) = value + gradient . x + x . hessian x / 2 + s with |s| <= second.

    Attributes:
        value: (N, k). gradient: (N, k, d). rest: (N, k). hessian: (N, k, d, d).
        second: (N, k).
    """

    value: Array
    gradient: Array
    rest: Array
    hessian: Array
    second: Array


@dataclass(frozen=True)
class _Axis:
    """One joint's local basis: shift matrices, bounds, slopes and second derivatives at zero, and
    how far each is from its linear or quadratic part."""

    shift: Array
    bound: Array
    slope: Array
    curve: Array
    bend: Array
    bulge: Array

    @property
    def linear(self) -> Any:
        return self.slope != 0.0

    @property
    def straight(self) -> Array:
        """Bounds of the linear functions; zero for the others."""
        return np.where(self.linear, self.bound, 0.0)

    @property
    def square(self) -> Any:
        return self.curve != 0.0


def _slices(d: int, *kept: int) -> tuple[Any, ...]:
    """All boxes, the whole axes ``kept``, and the constant along the others."""
    return (slice(None), *(slice(None) if i in kept else 0 for i in range(d)))
