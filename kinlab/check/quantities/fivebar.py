"""Five-bars as a domain, and the engine's quantities of their closed chain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from operator import attrgetter
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array, frozen
from kinlab.check.quantities.quantity import Domain, Quantity
from kinlab.errors import MechanismError, NameUnknownError, UnreachableError, near
from kinlab.fivebar import FiveBar
from kinlab.fivebar.closed_chain import CRANKS, PASSIVE, ClosedChain
from kinlab.fivebar.files import presets
from kinlab.fivebar.linkage import as_five_bar
from kinlab.notes.loop import Loop
from kinlab.tolerances import TOLERANCES

# -------- Five-bars as a domain: names and groups, the plain numbers, random closed poses

_CLEAR = 0.15
"""Least sine between two bars in a drawn pose: what is compared is the formula, not rounding."""

_TRIES = 200
"""Poses tried for each one drawn."""

DRAWS = ("theta", "xy", "mode", "v", "a")


def numbers(fivebar: FiveBar) -> Loop:
    """The plain numbers of a five-bar.

    Raises:
        MechanismError: gravity is not along -y, as the note has it.
    """
    gravity = fivebar.gravity
    if gravity[0] != 0.0:
        raise MechanismError(f"{fivebar.name}: the note's formulas need gravity along -y")
    return Loop(
        name=fivebar.name,
        l1=fivebar.l1,
        l2=fivebar.l2,
        e=fivebar.e,
        crank=fivebar.crank_mass,
        crank_com=fivebar.crank_com,
        crank_inertia=fivebar.crank_inertia,
        rotor=fivebar.reflected_inertia,
        rod=fivebar.rod_mass,
        rod_com=fivebar.rod_com,
        rod_inertia=fivebar.rod_inertia,
        payload=fivebar.payload,
        g=-float(gravity[1]),
    )


def members(name: str) -> tuple[str, ...]:
    """``"fivebar"`` is every preset; another name stands for itself."""
    return tuple(presets()) if name == "fivebar" else (name,)


def sample(
    fivebar: FiveBar, arguments: tuple[str, ...], count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """Random closed poses away from singularities, with motions of the tool.

    Crank angles and the assembly are drawn, and Pinocchio closes the loop; so the states do not
    come from the formulas that they are to test.

    Raises:
        NameUnknownError: an argument that cannot be drawn.
        MechanismError: hardly any pose is that far from a singularity.
    """
    for name in arguments:
        if name not in DRAWS:
            raise NameUnknownError(f"argument {name!r} cannot be drawn; {near(name, DRAWS)}")
    chain = fivebar.closed_chain()
    drawn: dict[str, list[Array]] = {name: [] for name in DRAWS}
    for _ in range(_TRIES * count):
        theta = rng.uniform(-np.pi, np.pi, 2)
        assembly = int(rng.choice([-1, 1]))
        if _elbows_apart(chain, theta):
            continue
        try:
            q = chain.assemble(theta, assembly)
        except UnreachableError:
            continue
        sines = np.sin([q[1], q[3], q[2] + q[3] - q[0] - q[1]])
        if np.abs(sines).min() < _CLEAR:
            continue
        state = (theta, chain.fk(q), np.sign(sines[:2]), *rng.standard_normal((2, 2)))
        for name, value in zip(DRAWS, state, strict=True):
            drawn[name].append(value * (5.0 if name == "a" else 1.0))
        if len(drawn["theta"]) == count:
            return tuple(np.array(drawn[name]) for name in arguments)
    raise MechanismError(f"{fivebar.name}: hardly any pose is clear of singularities")


FIVEBAR = Domain("fivebar", as_five_bar, attrgetter("name"), numbers, members, sample, DRAWS)


def sample_open(
    fivebar: FiveBar, arguments: tuple[str, ...], count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """Random crank angles and tool places that do not belong together, and legs (s = 1 or -1).

    What a loop's equation says is seen only where the loop is open.
    """
    size = float(np.max(fivebar.l1 + fivebar.l2))
    drawn = {
        "theta": rng.uniform(-np.pi, np.pi, (count, 2)),
        "xy": size * rng.uniform(-1.0, 1.0, (count, 2)),
        "s": _either_leg(count),
    }
    return tuple(drawn[name] for name in arguments)


def sample_legs(
    fivebar: FiveBar, arguments: tuple[str, ...], count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """As :func:`sample`, with a leg for each state: 1 and -1 in turn."""
    stacks = dict(zip(DRAWS, sample(fivebar, DRAWS, count, rng), strict=True))
    return tuple({**stacks, "s": _either_leg(count)}[name] for name in arguments)


def _either_leg(count: int) -> Array:
    return np.where(np.arange(count) % 2, -1.0, 1.0)


_SERVO = {"vmax": 1.5, "amax": 20.0, "Nmax": 3000.0, "Thetadmax": 15.0, "Tmax": 4.0,
          "IL": 0.02, "j": 20.0}  # fmt: skip
"""What a servo is chosen by, as large as it may be: m/s, m/s², rpm, rad/s, N m, kg m², a ratio."""


def sample_servo(
    fivebar: FiveBar, arguments: tuple[str, ...], count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """As :func:`sample`, with what a servo is chosen by."""
    posed = tuple(name for name in arguments if name in DRAWS)
    stacks = dict(zip(posed, sample(fivebar, posed, count, rng), strict=True)) if posed else {}
    stacks |= {name: size * rng.uniform(0.3, 1.0, count) for name, size in _SERVO.items()}
    return tuple(stacks[name] for name in arguments)


def leg_of(s: Array) -> Any:
    """The place of each state's leg in a pair: 0 where s is 1, 1 where it is -1."""
    return (np.asarray(s) < 0).astype(int)


# -------- Engine quantities of a five-bar: Pinocchio's closed chain, state by state

EngineCall = Callable[..., Any]


def _engine(answer: EngineCall) -> EngineCall:
    """Runs ``answer(chain, *one state)`` over the states."""

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        chain = _chain(fivebar)
        return np.array([answer(chain, *state) for state in zip(*stacks, strict=True)])

    return engine


def _posed(answer: EngineCall, *, rods: bool) -> EngineCall:
    """Runs ``answer(chain, q, ...)`` with the tool at xy; without the rods' mass if asked."""

    def engine(fivebar: FiveBar, xy: Any, *stacks: Any) -> Array:
        chain = _chain(fivebar if rods else _without_rods(fivebar))
        *motion, modes = stacks
        places = zip(np.asarray(xy).tolist(), np.asarray(modes).tolist(), strict=True)
        poses = [_pose(fivebar, *point, *mode) for point, mode in places]
        return np.array([answer(chain, *state) for state in zip(poses, *motion, strict=True)])

    return engine


# A pose hangs on the bars' lengths alone, and finding one takes longer than all that is asked of
# it: each is found once, for every quantity, with and without the rods' mass.


@lru_cache(maxsize=1 << 14)
def _pose(fivebar: FiveBar, x: float, y: float, first: float, second: float) -> Array:
    """The joint angles with the tool at (x, y) in a working mode, (4,), rad, read-only."""
    return frozen(_chain(fivebar).at((x, y), (first, second)))  # type: ignore[arg-type]


@lru_cache(maxsize=64)
def _chain(fivebar: FiveBar) -> ClosedChain:
    return fivebar.closed_chain()


@lru_cache(maxsize=64)
def _without_rods(fivebar: FiveBar) -> FiveBar:
    """The five-bar with massless rods."""
    return replace(fivebar, rod_mass=0.0, rod_inertia=0.0)


def _bars(chain: ClosedChain, q: Array, joints: tuple[int, ...]) -> Array:
    """Directions of the x axes of two joints, (2, 2)."""
    data = chain.model.createData()
    pin.forwardKinematics(chain.model, data, q)
    return np.array([data.oMi[joint + 1].rotation[:2, 0] for joint in joints])


def _pins(chain: ClosedChain, theta: Array) -> tuple[Array, Array]:
    """Base pins and elbows, each (2, 2), m."""
    q = np.zeros(4)
    q[[*CRANKS]] = theta
    data = chain.model.createData()
    pin.forwardKinematics(chain.model, data, q)
    places = np.array([placement.translation[:2] for placement in data.oMi])
    return places[[1, 3]], places[[2, 4]]


def _elbows_apart(chain: ClosedChain, theta: Array) -> bool:
    """Whether the rods cannot meet, plainly: Newton finds out too, after a long search."""
    elbows = _pins(chain, theta)[1]
    span, rods = np.linalg.norm(elbows[1] - elbows[0]), np.asarray(chain.linkage.l2)
    slack = TOLERANCES.rods_miss * chain.size
    return bool(span > rods.sum() + slack or span < abs(rods[0] - rods[1]) - slack)


def _rod_length(chain: ClosedChain, theta: Array, xy: Array) -> Any:
    return np.linalg.norm(xy - _pins(chain, theta)[1], axis=1)


def _projection(chain: ClosedChain, theta: Array, xy: Array) -> Any:
    base, elbow = _pins(chain, theta)
    return 2.0 * np.sum((base - xy) * (elbow - base), axis=1)


def _gap(chain: ClosedChain, theta: Array, xy: Array) -> Any:
    return _rod_length(chain, theta, xy) ** 2 - np.asarray(chain.linkage.l2) ** 2


def _equation(chain: ClosedChain, xy: Array) -> Any:
    """A and B are the projection of a crank along x and y; C is what closes the loop."""
    across = [_projection(chain, np.full(2, angle), xy) for angle in (0.0, np.pi / 2)]
    return np.stack([*across, across[0] - _gap(chain, np.zeros(2), xy)], axis=1)


def _angles(chain: ClosedChain, q: Array) -> Any:
    u = _bars(chain, q, CRANKS)
    return np.arctan2(u[:, 1], u[:, 0])


def _torque(chain: ClosedChain, q: Array, v: Array, a: Array) -> Array:
    qd = chain.joint_rates(q, v)
    return chain.inverse_dynamics(q, qd, chain.joint_accelerations(q, qd, a))


def _crank_accelerations(chain: ClosedChain, q: Array, v: Array, a: Array) -> Any:
    return chain.joint_accelerations(q, chain.joint_rates(q, v), a)[[*CRANKS]]


def _rods(chain: ClosedChain, q: Array) -> Any:
    return _bars(chain, q, PASSIVE)


def _rates(chain: ClosedChain, q: Array, v: Array) -> Any:
    return chain.joint_rates(q, v)[[*CRANKS]]


def _power(chain: ClosedChain, q: Array, v: Array, a: Array) -> Any:
    return _torque(chain, q, v, a) * chain.joint_rates(q, v)[[*CRANKS]]


def _per_acceleration(chain: ClosedChain, q: Array) -> Any:
    """G; three quantities are made of it, so that each pose's is found once."""
    return _gains(chain.linkage, *q.tolist())


@lru_cache(maxsize=1 << 12)
def _gains(fivebar: FiveBar, *joints: float) -> Array:
    chain, q = _chain(fivebar), np.array(joints)
    still = np.zeros(2)
    held = _torque(chain, q, still, still)
    columns = [_torque(chain, q, still, unit) - held for unit in np.eye(2)]
    return frozen(np.stack(columns, axis=1))


def _load(chain: ClosedChain, q: Array) -> Any:
    return np.diag(chain.mass_matrix(q))


def _quantity(
    name: str, arguments: str, answer: EngineCall, about: str, *, rods: bool = True
) -> Quantity:
    engine = _posed(answer, rods=rods) if "mode" in arguments else _engine(answer)
    return FIVEBAR.quantity(name, arguments, engine, about)


def _open(name: str, arguments: str, answer: EngineCall, about: str) -> Quantity:
    return FIVEBAR.quantity(name, arguments, _engine(answer), about, sample=sample_open)


def _of_leg(both: Quantity) -> Quantity:
    """The same of one leg at each state, named by its sign s."""

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        *rest, s = stacks
        answers = both.engine(fivebar, *rest)
        return np.asarray(answers[np.arange(len(answers)), leg_of(s)])

    name, arguments = both.name.replace("_", "_leg_", 1), (*both.arguments, "s")
    draw = both.sample or sample_legs
    return replace(both, name=name, arguments=arguments, engine=engine, sample=draw)


def _servo(name: str, arguments: str, answer: EngineCall, about: str) -> Quantity:
    """A quantity of a servo alone, whichever five-bar it moves."""

    def engine(_fivebar: FiveBar, *stacks: Any) -> Any:
        return answer(*stacks)

    return FIVEBAR.quantity(name, arguments, engine, about, sample=sample_servo)


def _worst(one: Quantity, argument: str, name: str, about: str) -> Quantity:
    """What is worst over all directions, at the largest speed or acceleration of the tool."""

    def engine(fivebar: FiveBar, xy: Any, mode: Any, largest: Array) -> Array:
        return np.asarray(one.engine(fivebar, xy, mode) * largest[:, None])

    arguments = (*one.arguments, argument)
    return replace(
        one, name=name, arguments=arguments, engine=engine, about=about, sample=sample_servo
    )


_RATE_PER_SPEED = _quantity(
    "fivebar_rate_per_speed",
    "xy mode",
    lambda c, q: np.linalg.norm(c.jacobian(q), axis=1),
    "worst theta_dot per |v|, rad/m, (2,)",
)
_TORQUE_PER_ACCELERATION = _quantity(
    "fivebar_torque_per_acceleration_worst",
    "xy mode",
    lambda c, q: np.linalg.norm(_per_acceleration(c, q), axis=1),
    "worst torque per |a| with massless rods, kg m, (2,)",
    rods=False,
)

QUANTITIES = (
    _quantity("fivebar_rod_length", "theta xy", _rod_length, "elbow to tool, m, (2,)"),
    _quantity(
        "fivebar_projection",
        "theta xy",
        _projection,
        "2 (A - P)·(B - A) = A cos theta + B sin theta, m², (2,)",
    ),
    _open("fivebar_loop", "theta xy", _gap, "|elbow to tool|² - l2², m², (2,)"),
    _open("fivebar_equation", "xy", _equation, "A, B, C of each leg, m², (2, 3)"),
    _of_leg(_open("fivebar_loop", "theta xy", _gap, "|elbow to tool|² - l2² of a leg, m²")),
    _of_leg(_open("fivebar_equation", "xy", _equation, "A, B, C of a leg, m², (3,)")),
    _quantity("fivebar_angles", "xy mode", _angles, "theta_1, theta_2, rad, (2,)"),
    _of_leg(_quantity("fivebar_angles", "xy mode", _angles, "theta of a leg, rad")),
    _of_leg(_quantity("fivebar_rods", "xy mode", _rods, "w of a leg, (2,)")),
    _quantity("fivebar_rates", "xy v mode", _rates, "theta_dot, rad/s, (2,)"),
    _quantity("fivebar_cranks", "xy mode", lambda c, q: _bars(c, q, CRANKS), "u_1, u_2, (2, 2)"),
    _quantity("fivebar_rods", "xy mode", _rods, "w_1, w_2, (2, 2)"),
    _quantity(
        "fivebar_jacobian",
        "xy mode",
        lambda c, q: c.jacobian(q),
        "J of theta_dot = J v, rad/m, (2, 2)",
    ),
    _quantity("fivebar_turn", "xy v a mode", _crank_accelerations, "theta_ddot, rad/s², (2,)"),
    _quantity("fivebar_torque", "xy v a mode", _torque, "crank torques, N m, (2,)"),
    _quantity(
        "fivebar_torque_massless",
        "xy v a mode",
        _torque,
        "crank torques with massless rods, N m, (2,)",
        rods=False,
    ),
    _quantity(
        "fivebar_torque_per_acceleration",
        "xy mode",
        _per_acceleration,
        "G with massless rods, kg m, (2, 2)",
        rods=False,
    ),
    _quantity(
        "fivebar_torque_gains",
        "xy mode",
        lambda c, q: np.linalg.svd(_per_acceleration(c, q), compute_uv=False),
        "singular values of G with massless rods, largest first, kg m, (2,)",
        rods=False,
    ),
    _quantity(
        "fivebar_power_massless",
        "xy v a mode",
        _power,
        "power of each crank with massless rods, W, (2,)",
        rods=False,
    ),
    _RATE_PER_SPEED,
    _quantity(
        "fivebar_load_inertia_massless",
        "xy mode",
        _load,
        "diagonal of the crank-side mass matrix with massless rods, kg m², (2,)",
        rods=False,
    ),
    _TORQUE_PER_ACCELERATION,
    _worst(
        _RATE_PER_SPEED, "vmax", "fivebar_worst_rate", "worst theta_dot at vmax (m/s), rad/s, (2,)"
    ),
    _worst(
        _TORQUE_PER_ACCELERATION,
        "amax",
        "fivebar_worst_torque",
        "worst torque at amax (m/s²) with massless rods, N m, (2,)",
    ),
    _servo(
        "servo_ratio",
        "Nmax Thetadmax",
        lambda rpm, rate: rpm / 60 * 2 * np.pi / rate,
        "largest reduction j of a motor of Nmax rpm for Thetadmax rad/s, a number",
    ),
    _servo(
        "servo_inertias",
        "IL j",
        lambda load, j: np.stack([load / j**2 / 3, load / j**2], axis=-1),
        "least and largest I_M for a load's I_L, kg m², behind a reduction j, (2,)",
    ),
    _servo(
        "servo_torque",
        "Tmax j",
        lambda torque, j: torque / j,
        "motor torque tau_M for Tmax, N m, behind a reduction j",
    ),
)
