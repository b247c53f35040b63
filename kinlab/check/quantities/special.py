"""Engine quantities of note 000 beyond the usual ones: frames, singular and isotropic poses, IK.

Each is computed from Pinocchio's placements and Jacobians by another road than the note's.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.quantity import Quantity
from kinlab.check.quantities.serial import SERIAL, planar_jacobian, planar_pose, positions
from kinlab.engine import kinematics, links
from kinlab.errors import StructureError
from kinlab.model.link import Convention
from kinlab.model.robot import Robot, frame_id, scratch
from kinlab.tolerances import TOLERANCES

_LESS_THAN_HALF = 3.0
"""Less than half a turn, rad."""


def dh_poses(robot: Robot, q: Any) -> Array:
    """Poses of the DH frames of the robot's table, as Pinocchio places them."""
    if robot.table is not None and robot.table.convention is Convention.STANDARD:
        frames = [frame_id(robot, f"dh_{i}") for i in range(1, robot.n + 1)]
        return np.stack([_dh_frames(robot, one, frames) for one in q])
    return links.link_poses(robot, q)


def link_transforms(robot: Robot, q: Any) -> Array:
    """^{i-1}T_i between the DH frames."""
    base = np.eye(4) if robot.table is None else np.asarray(robot.table.base)
    poses = dh_poses(robot, q)
    first = np.broadcast_to(base, (len(poses), 1, 4, 4))
    before = np.concatenate([first, poses[:, :-1]], axis=1)
    return np.linalg.solve(before, poses)


def _dh_frames(robot: Robot, q: Array, frames: list[int]) -> Array:
    import pinocchio as pin

    data = scratch(robot)
    pin.framesForwardKinematics(robot.model, data, q)
    return np.stack([data.oMf[frame].homogeneous for frame in frames])


def common_normals(robot: Robot, q: Any) -> Any:
    """Projectors on x_{i-1}, zero where z_{i-1} and z_i are parallel."""
    base = np.eye(4) if robot.table is None else np.asarray(robot.table.base)
    poses = links.link_poses(robot, q)
    all_poses = np.concatenate([np.broadcast_to(base, (len(poses), 1, 4, 4)), poses], axis=1)
    x, z = all_poses[..., :-1, :3, 0], all_poses[..., :3, 2]
    along = np.abs(np.einsum("aij,aij->ai", z[:, :-1], z[:, 1:]))
    x = np.where((along < 1.0 - 1e-12)[..., None], x, 0.0)
    return x[..., :, None] * x[..., None, :]


def angular_jacobian_last(robot: Robot, q: Any) -> Array:
    """Angular rows of the last joint's Jacobian in its own axes."""
    poses = links.link_poses(robot, q)[:, -1, :3, :3]
    return np.swapaxes(poses, -1, -2) @ kinematics.jacobian(robot, q)[:, 3:]


def planar_determinant(robot: Robot, q: Any) -> Any:
    """det of the rows vx, vy, wz."""
    return np.linalg.det(planar_jacobian(robot, q))


def planar_position_determinant(robot: Robot, q: Any) -> Any:
    """det of the rows vx, vy."""
    return np.linalg.det(kinematics.jacobian(robot, q)[:, :2])


def square_rows(robot: Robot) -> list[int]:
    """The first n rows of J, in base axes, that are not zero everywhere (0 to 5, linear first).

    Raises:
        StructureError: there are fewer.
    """
    states = np.random.default_rng(0).uniform(-1.0, 1.0, (8, robot.n))
    sizes = np.abs(kinematics.jacobian(robot, states)).max(axis=(0, 2))
    rows = np.flatnonzero(sizes > TOLERANCES.no_effect * sizes.max())[: robot.n]
    if len(rows) < robot.n:
        raise StructureError(
            f"jacobian_determinant is for arms whose Jacobian is square: the {robot.n} joints of "
            f"{robot.name!r} move {len(rows)} rows"
        )
    return [int(row) for row in rows]


def jacobian_determinant(robot: Robot, q: Any) -> Any:
    """det of the first n rows of J, in base axes, that are not zero everywhere."""
    return np.linalg.det(kinematics.jacobian(robot, q)[:, square_rows(robot)])


def planar_angle(robot: Robot, q: Any) -> Any:
    """phi of a planar arm's tool, in (-pi, pi]."""
    pose = planar_pose(robot, q)
    return np.arctan2(pose[..., 3], pose[..., 2])


def isotropy_defect(robot: Robot, q: Any) -> Any:
    """Sum of (sigma_i^2 / mean - 1)^2 over the singular values of the rows vx, vy."""
    squares = np.linalg.svd(kinematics.jacobian(robot, q)[:, :2], compute_uv=False) ** 2
    return np.sum((squares / squares.mean(axis=1, keepdims=True) - 1.0) ** 2, axis=1)


def isotropy_conditions(robot: Robot, q: Any) -> Array:
    """|row 1|² - |row 2|² and row 1 · row 2 of the rows vx, vy: both 0 where J J^T = a I."""
    one, two = np.moveaxis(kinematics.jacobian(robot, q)[:, :2], 1, 0)
    longer = np.linalg.norm(one, axis=1) ** 2 - np.linalg.norm(two, axis=1) ** 2
    return np.stack([longer, np.einsum("ai,ai->a", one, two)], axis=-1)


def orthogonal_columns_cosine(robot: Robot, q: Any) -> Any:
    """cos theta2 in (0, pi) where the two columns of vx, vy become orthogonal, by bisection."""
    return _root(robot, q, lambda j: np.einsum("ai,ai->a", j[..., 0], j[..., 1]))


def equal_columns_cosine(robot: Robot, q: Any) -> Any:
    """cos theta2 in (0, pi) where the two columns of vx, vy become equally long, by bisection."""
    return _root(
        robot,
        q,
        lambda j: (
            np.einsum("ai,ai->a", j[..., 0], j[..., 0])
            - np.einsum("ai,ai->a", j[..., 1], j[..., 1])
        ),
    )


def _root(robot: Robot, q: Any, miss: Any) -> Any:
    low, high = np.zeros(len(q)), np.full(len(q), np.pi)

    def at(theta: Array) -> Any:
        states = np.stack([q[:, 0], theta], axis=-1)
        return miss(kinematics.jacobian(robot, states)[:, :2])

    sign = np.sign(at(low))
    for _ in range(54):
        middle = 0.5 * (low + high)
        same = np.sign(at(middle)) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.cos(0.5 * (low + high))


def newton_step(robot: Robot, q: Any, target: Any) -> Any:
    """q + J^-1 (x_d - f(q)) for x = (x, y, phi)."""
    return (
        q + np.linalg.solve(planar_jacobian(robot, q), _miss(robot, q, target)[..., None])[..., 0]
    )


def newton_stops(robot: Robot, q: Any, target: Any) -> Array:
    """|x_d - f(q)| and |q_{k+1} - q_k|, what the stopping rules look at."""
    move = newton_step(robot, q, target) - q
    return np.stack(
        [np.linalg.norm(_miss(robot, q, target), axis=1), np.linalg.norm(move, axis=1)], axis=1
    )


def loss_gradient(robot: Robot, q: Any, target: Any) -> Array:
    """Gradient of ½|x_d - f|², each entry from its own column of J."""
    miss, jacobian = _miss(robot, q, target), planar_jacobian(robot, q)
    return np.stack([-np.sum(miss * jacobian[..., k], axis=1) for k in range(robot.n)], axis=1)


def gradient_step(robot: Robot, q: Any, target: Any) -> Any:
    """q - 0.1 times the gradient."""
    return q - 0.1 * loss_gradient(robot, q, target)


def loss(robot: Robot, q: Any, target: Any) -> Any:
    """½|x_d - f|²."""
    return 0.5 * np.linalg.norm(_miss(robot, q, target), axis=1) ** 2


def least_rates(robot: Robot, q: Any, twist: Any) -> Array:
    """Shortest qdot of least |J qdot - twist|, from singular values."""
    jacobian = kinematics.jacobian(robot, q)
    return np.stack(
        [np.linalg.lstsq(j, t, rcond=1e-12)[0] for j, t in zip(jacobian, twist, strict=True)]
    )


def _miss(robot: Robot, q: Any, target: Any) -> Any:
    pose = planar_pose(robot, q)
    here = np.stack([pose[:, 0], pose[:, 1], np.sum(q, axis=1)], axis=1)
    return target - here


def _with_second_joint(*choices: float) -> Any:
    """Draws states with theta2 taken from ``choices``."""

    def draw(robot: Robot, arguments: Any, count: int, rng: np.random.Generator) -> Any:
        del arguments
        q = positions(robot, count, rng)
        q[:, 1] = np.resize(np.array(choices), count)
        return (q,)

    return draw


def _within_a_turn(robot: Robot, arguments: Any, count: int, rng: np.random.Generator) -> Any:
    """Draws states at which the joints of a planar arm turn its tool by less than half a turn.

    A sum of joint positions and an atan2 are the same there.
    """
    del arguments
    q = rng.uniform(-_LESS_THAN_HALF, _LESS_THAN_HALF, (count, robot.n)) / robot.n
    q[:, 0] -= planar_angle(robot, np.zeros((1, robot.n)))
    return (q,)


def _with_target(robot: Robot, arguments: Any, count: int, rng: np.random.Generator) -> Any:
    """Draws states away from the stretched and folded poses, and random targets."""
    del arguments
    q = positions(robot, count, rng)
    q[:, 1] = rng.uniform(0.2, 2.9, count) * rng.choice([-1.0, 1.0], count)
    return q, rng.uniform(-1.0, 1.0, (count, 3))


def _well_conditioned(robot: Robot, arguments: Any, count: int, rng: np.random.Generator) -> Any:
    """Draws states where J keeps its rank plainly, and random twists."""
    del arguments
    kept = np.empty((0, robot.n))
    while len(kept) < count:
        q = positions(robot, count, rng)
        values = np.linalg.svd(kinematics.jacobian(robot, q), compute_uv=False)
        kept = np.concatenate([kept, q[values[:, -1] > 0.02 * values[:, 0]]])
    return kept[:count], rng.standard_normal((count, 6))


_planar_2r, _planar_3r = (partial(SERIAL.quantity, joints=n) for n in (2, 3))


def _towards(name: str, engine: Any, about: str) -> Quantity:
    """A quantity of the planar 3R arm on its way to a target."""
    return _planar_3r(name, "q target", engine, about, sample=_with_target)


QUANTITIES = (
    SERIAL.quantity(
        "link_transforms",
        "q",
        link_transforms,
        "^{i-1}T_i of every DH row in the table's own convention, (n, 4, 4)",
    ),
    SERIAL.quantity("dh_poses", "q", dh_poses, "poses of the DH frames in the base, (n, 4, 4)"),
    SERIAL.quantity("common_normals", "q", common_normals, "projectors on x_{i-1}, (n, 3, 3)"),
    SERIAL.quantity(
        "angular_jacobian_last",
        "q",
        angular_jacobian_last,
        "angular rows of J in the last link's axes, (3, n)",
    ),
    _planar_3r(
        "singular_jacobian",
        "q",
        kinematics.jacobian,
        "Jacobian at poses with theta2 = 0 or pi, (6, n)",
        sample=_with_second_joint(0.0, np.pi),
    ),
    SERIAL.quantity(
        "jacobian_determinant",
        "q",
        jacobian_determinant,
        "det of the first n rows of J that are not zero everywhere",
    ),
    _planar_3r("planar_determinant", "q", planar_determinant, "det of rows vx, vy, wz"),
    _planar_2r(
        "planar_position_determinant", "q", planar_position_determinant, "det of rows vx, vy"
    ),
    SERIAL.quantity(
        "planar_angle",
        "q",
        planar_angle,
        "phi of a planar arm's tool, rad, at |phi| < 3",
        sample=_within_a_turn,
    ),
    SERIAL.quantity(
        "isotropy_defect", "q", isotropy_defect, "sum of (sigma_i^2 / mean - 1)^2 of rows vx, vy"
    ),
    SERIAL.quantity(
        "isotropy_conditions",
        "q",
        isotropy_conditions,
        "|vx row|² - |vy row|² and their product, 0 where J is isotropic, (2,)",
    ),
    _planar_2r("orthogonal_columns_cosine", "q", orthogonal_columns_cosine, "cos theta2, a number"),
    _planar_2r("equal_columns_cosine", "q", equal_columns_cosine, "cos theta2, a number"),
    _planar_2r(
        "isotropic_jacobian",
        "q",
        lambda robot, q: kinematics.jacobian(robot, q, "tool")[:, :2],
        "rows vx, vy in tool axes at theta2 = ±135°, (2, 2)",
        sample=_with_second_joint(0.75 * np.pi, -0.75 * np.pi),
    ),
    _towards("newton_step", newton_step, "next q of a planar 3R arm, (3,)"),
    _towards("newton_stops", newton_stops, "|x_d - f| and |step|, (2,)"),
    _towards("loss", loss, "½|x_d - f|², a number"),
    _towards("loss_gradient", loss_gradient, "its gradient, (3,)"),
    _towards("gradient_step", gradient_step, "q - 0.1 gradient, (3,)"),
    SERIAL.quantity(
        "least_rates",
        "q twist",
        least_rates,
        "shortest qdot for a twist, (n,)",
        sample=_well_conditioned,
    ),
)
