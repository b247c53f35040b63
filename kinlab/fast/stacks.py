"""The engine's functions with a faster road for long stacks of states.

Short stacks and single states are the engine's own (:mod:`kinlab.engine.kinematics`,
:mod:`kinlab.engine.dynamics`); long ones go through compiled kernels and Pinocchio's parallel calls
(:mod:`kinlab.fast.batches`), with the same answers to rounding. Check and doctor do not use this
module: what they call the engine is Pinocchio for any number of states.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.engine import dynamics, kinematics
from kinlab.engine.states import finite_answer, joint_vector, joint_vectors
from kinlab.fast import batches
from kinlab.model.robot import Robot, require_inertia

COMPILED_FROM = 256
"""Stacks at least this long take the faster road. Below, loading the kernels (0.5 s, once a
process) is out of proportion to a loop of 1 to 2 µs a state."""

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _documented(engine: Callable[..., Any]) -> Callable[[_Function], _Function]:
    """Gives a function the docstring of the engine's, whose arguments and answers it shares."""

    def mark(function: _Function) -> _Function:
        function.__doc__ = engine.__doc__
        return function

    return mark


@_documented(kinematics.fk)
def fk(robot: Robot, q: ArrayLike) -> Array:
    if _long(q):
        stack = joint_vector(robot, q, "q")
        if stack.ndim == 2:
            return batches.poses(robot, stack)
    return kinematics.fk(robot, q)


@_documented(kinematics.jacobian)
def jacobian(robot: Robot, q: ArrayLike, frame: str = "base") -> Array:
    if _long(q):
        stack = joint_vector(robot, q, "q")
        kinematics.reference(frame)
        if stack.ndim == 2:
            return batches.jacobians(robot, stack, frame)
    return kinematics.jacobian(robot, q, frame)


@_documented(kinematics.statics)
def statics(robot: Robot, q: ArrayLike, wrench: ArrayLike, frame: str = "base") -> Array:
    if _long(q):
        stack = joint_vector(robot, q, "q")
        force = kinematics.wrench_for(robot, stack, wrench)
        return kinematics.held(jacobian(robot, stack, frame), force)
    return kinematics.statics(robot, q, wrench, frame)


@_documented(dynamics.mass_matrix)
def mass_matrix(robot: Robot, q: ArrayLike) -> Array:
    if _long(q):
        require_inertia(robot)
        stack = joint_vector(robot, q, "q")
        if stack.ndim == 2:
            return batches.mass_matrices(robot, stack)
    return dynamics.mass_matrix(robot, q)


@_documented(dynamics.coriolis_matrix)
def coriolis_matrix(robot: Robot, q: ArrayLike, v: ArrayLike) -> Array:
    if _long(q, v):
        require_inertia(robot)
        q, v = joint_vectors(robot, q=q, v=v)
        if q.ndim == 2:
            return batches.coriolis_matrices(robot, q, v)
    return dynamics.coriolis_matrix(robot, q, v)


@_documented(dynamics.gravity_torques)
def gravity_torques(robot: Robot, q: ArrayLike) -> Array:
    if _long(q):
        require_inertia(robot)
        stack = joint_vector(robot, q, "q")
        if stack.ndim == 2:
            rest = np.zeros_like(stack)
            return batches.inverse_dynamics(robot, stack, rest, rest)
    return dynamics.gravity_torques(robot, q)


@_documented(dynamics.inverse_dynamics)
def inverse_dynamics(
    robot: Robot, q: ArrayLike, v: ArrayLike, a: ArrayLike, wrench: ArrayLike | None = None
) -> Array:
    if _long(q, v, a):
        require_inertia(robot)
        q, v, a = joint_vectors(robot, q=q, v=v, a=a)
        if q.ndim == 2:
            tau = batches.inverse_dynamics(robot, q, v, a)
            if wrench is not None:
                tau = tau + statics(robot, q, wrench)
            return finite_answer(robot, tau, "inverse_dynamics")
    return dynamics.inverse_dynamics(robot, q, v, a, wrench)


@_documented(dynamics.forward_dynamics)
def forward_dynamics(
    robot: Robot, q: ArrayLike, v: ArrayLike, tau: ArrayLike, wrench: ArrayLike | None = None
) -> Array:
    if _long(q, v, tau):
        require_inertia(robot)
        q, v, tau = joint_vectors(robot, q=q, v=v, tau=tau)
        if q.ndim == 2:
            if wrench is not None:
                tau = tau - statics(robot, q, wrench)
            a = batches.forward_dynamics(robot, q, v, tau)
            return finite_answer(robot, a, "forward_dynamics")
    return dynamics.forward_dynamics(robot, q, v, tau, wrench)


@_documented(dynamics.kinetic_energy)
def kinetic_energy(robot: Robot, q: ArrayLike, v: ArrayLike) -> Array | float:
    if _long(q, v):
        require_inertia(robot)
        q, v = joint_vectors(robot, q=q, v=v)
        return dynamics.moving(robot, mass_matrix(robot, q), v)
    return dynamics.kinetic_energy(robot, q, v)


@_documented(dynamics.potential_energy)
def potential_energy(robot: Robot, q: ArrayLike) -> Array | float:
    if _long(q):
        require_inertia(robot)
        stack = joint_vector(robot, q, "q")
        if stack.ndim == 2:
            return batches.potential_energies(robot, stack)
    return dynamics.potential_energy(robot, q)


def _long(*values: Any) -> bool:
    """Whether one may be a stack worth the kernels; says nothing about its shape."""
    for value in values:
        try:
            if len(value) >= COMPILED_FROM:
                return True
        except TypeError:  # a number, which the engine's function refuses by name
            continue
    return False
