"""Derivations of the textbooks, written by hand and spoiled in one step.

Newton-Euler in base axes (Craig, chapter 6; Siciliano, 7.5), the Jacobian's columns (Siciliano,
3.1), M, G and T by the links' Jacobians (Siciliano, 7.2; Murray, 4.3), Christoffel's symbols
(Spong, 7.3), and the five-bar of Huang et al. 2005. Each slip is one that students and authors
make, with the words that a sentence has to have to name it; the doctor's own lists are not known
here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pinocchio as pin

import kinlab as kl
from kinlab.check.quantities.registry import quantity as find_quantity

Function = Callable[..., Any]
Spoiled = tuple[str, Function]
"""A quantity, and the spoiled function of one state."""


class Links:
    """Frames, centres and tensors of all links at one state, in base axes; index 0 is link 1."""

    def __init__(self, arm: Any, q: Any) -> None:
        model, data = arm.model, arm.model.createData()
        pin.forwardKinematics(model, data, np.array(q, dtype=float))
        self.n = arm.n
        self.turn = [np.array(one.rotation) for one in data.oMi[1:]]
        self.o = [np.array(one.translation) for one in data.oMi[1:]]
        self.z = [turn[:, 2] for turn in self.turn]
        self.mass = [body.mass for body in model.inertias[1:]]
        self.lever = [np.array(body.lever) for body in model.inertias[1:]]
        self.tensor = [np.array(body.inertia) for body in model.inertias[1:]]
        self.slide = [joint.shortname() == "JointModelPZ" for joint in model.joints[1:]]
        self.rotor = np.array(model.armature)
        self.g = np.array(model.gravity.linear)
        self.p = kl.fk(arm, np.array(q, dtype=float))[:3, 3]


def newton_euler(arm: Any, slip: str) -> Spoiled:
    """Torques by the recursion outward and inward, with one step spoiled."""

    def tau(q: Any, v: Any, a: Any) -> Any:
        at = Links(arm, q)
        w, dw = np.zeros(3), np.zeros(3)
        acc = -at.g if slip != "gravity downwards" else at.g
        before = np.zeros(3)
        forces, moments, arms = [], [], []
        for i in range(at.n):
            r, z = at.o[i] - before, at.z[i]
            step = np.zeros(3)
            if slip != "omega_dot x P left out":
                step = step + np.cross(dw, r)
            if slip != "omega x (omega x P) left out":
                step = step + np.cross(w, np.cross(w, r))
            acc, before = acc + step, at.o[i]
            if at.slide[i]:
                twice = 1.0 if slip == "Coriolis acceleration of a slide halved" else 2.0
                if slip != "Coriolis acceleration of a slide left out":
                    acc = acc + twice * np.cross(w, z * v[i])
                acc = acc + z * a[i]
            else:
                if slip != "omega x z qd left out":
                    dw = dw + np.cross(w, z * v[i])
                dw, w = dw + z * a[i], w + z * v[i]
            turn = at.turn[i]
            c = at.lever[i] if slip == "centre not rotated" else turn @ at.lever[i]
            centre = acc + np.cross(dw, c)
            if slip != "omega x (omega x P_C) left out":
                centre = centre + np.cross(w, np.cross(w, c))
            tensor = turn @ at.tensor[i] @ turn.T
            if slip == "tensor not rotated":
                tensor = at.tensor[i]
            if slip == "R^T I R for R I R^T":
                tensor = turn.T @ at.tensor[i] @ turn
            moment = tensor @ dw
            if slip == "omega x I omega with the other sign":
                moment = moment - np.cross(w, tensor @ w)
            elif slip != "omega x I omega left out":
                moment = moment + np.cross(w, tensor @ w)
            forces.append(at.mass[i] * centre)
            moments.append(moment)
            arms.append(c)
        f, n, torque = np.zeros(3), np.zeros(3), np.zeros(at.n)
        for i in reversed(range(at.n)):
            lever = at.o[i + 1] - at.o[i] if i + 1 < at.n else np.zeros(3)
            carried = f + forces[i] if slip == "P x f with the link's own f" else f
            n = n + moments[i]
            if slip != "P_C x F left out":
                n = n + np.cross(arms[i], forces[i])
            if slip != "P x f left out":
                n = n + np.cross(lever, carried)
            f = f + forces[i]
            along = f if at.slide[i] else n
            if slip == "moment at a slide":
                along = n
            axis = at.z[i - 1] if slip == "z of the joint before" and i else at.z[i]
            torque[i] = axis @ along
        return torque + at.rotor * np.asarray(a)

    return "inverse_dynamics", tau


def jacobian(arm: Any, slip: str) -> Spoiled:
    """The geometric Jacobian column by column, with one step spoiled."""

    def columns(q: Any) -> Any:
        at = Links(arm, q)
        out = np.zeros((6, at.n))
        for i in range(at.n):
            z, o = at.z[i], at.o[i]
            if slip == "z of the joint before":
                z = at.z[i - 1] if i else np.array(arm.table.base[:3, 2])
            if slip == "z of the next joint":
                z = at.z[min(i + 1, at.n - 1)]
            if slip == "point of the joint before":
                o = at.o[i - 1] if i else np.array(arm.table.base[:3, 3])
            if at.slide[i] and slip != "slide as hinge":
                out[:3, i] = z
            else:
                linear = np.cross(z, at.p - o)
                if slip == "p x z":
                    linear = -linear
                if slip == "p for p - o":
                    linear = np.cross(z, at.p)
                out[:, i] = np.concatenate([linear, z])
        if slip == "columns exchanged":
            out[:, [0, 1]] = out[:, [1, 0]]
        return out

    return "jacobian", columns


def statics(arm: Any, slip: str) -> Spoiled:
    """Torques of a wrench, with J or its inverse for its transpose."""
    given = {"J for J^T": lambda jac: jac, "inverse for transpose": np.linalg.inv}[slip]
    return "statics", lambda q, f: given(kl.jacobian(arm, q)) @ f


def of_links(at: Links, i: int, point: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Jacobians of a point of link i and of its turning, (3, n) each."""
    linear, turning = np.zeros((3, at.n)), np.zeros((3, at.n))
    for k in range(i + 1):
        if at.slide[k]:
            linear[:, k] = at.z[k]
        else:
            linear[:, k], turning[:, k] = np.cross(at.z[k], point - at.o[k]), at.z[k]
    return linear, turning


def energy_matrix(arm: Any, q: Any, slip: str) -> Any:
    """M as the sum of the links' parts."""
    at = Links(arm, q)
    out = np.diag(at.rotor)
    for i in range(at.n):
        turn, c = at.turn[i], at.turn[i] @ at.lever[i]
        point = at.o[i] if slip == "joint for centre of mass" else at.o[i] + c
        if slip == "centre not rotated":
            point = at.o[i] + at.lever[i]
        linear, turning = of_links(at, i, point)
        tensor = turn @ at.tensor[i] @ turn.T
        if slip == "tensor not rotated":
            tensor = at.tensor[i]
        if slip == "R^T I R for R I R^T":
            tensor = turn.T @ at.tensor[i] @ turn
        if slip == "m c^2 twice":
            tensor = tensor + at.mass[i] * (c @ c * np.eye(3) - np.outer(c, c))
        out = out + at.mass[i] * linear.T @ linear
        if slip != "tensors left out":
            out = out + turning.T @ tensor @ turning
    return out


def mass(arm: Any, slip: str) -> Spoiled:
    """M, spoiled."""
    return "mass_matrix", lambda q: energy_matrix(arm, q, slip)


def kinetic(arm: Any, slip: str) -> Spoiled:
    """T, spoiled as M is, or without its half."""
    half = 1.0 if slip == "half left out" else 0.5
    return "kinetic_energy", lambda q, v: half * v @ energy_matrix(arm, q, slip) @ v


def gravity(arm: Any, slip: str) -> Spoiled:
    """G by the centres' Jacobians, spoiled."""

    def torque(q: Any) -> Any:
        at = Links(arm, q)
        out = np.zeros(at.n)
        for i in range(at.n):
            c = at.lever[i] if slip == "centre not rotated" else at.turn[i] @ at.lever[i]
            point = at.o[i] if slip == "joint for centre of mass" else at.o[i] + c
            own = at.n - 1 if slip == "last link left out" else at.n
            if i < own:
                out = out - at.mass[i] * of_links(at, i, point)[0].T @ at.g
        return out if slip != "sign" else -out

    return "gravity_torques", torque


def absolute(arm: Any, slip: str) -> Spoiled:
    """Every angle counted from the base, as it is convenient for energies of planar arms."""
    chosen = kl.mass_matrix if slip.startswith("M") else kl.gravity_torques
    name = "mass_matrix" if slip.startswith("M") else "gravity_torques"
    return name, lambda q: chosen(arm, np.concatenate([q[:1], np.diff(q)]))


def christoffel(arm: Any, slip: str) -> Spoiled:
    """C by Christoffel's symbols, an index or a term of them spoiled."""
    engine = find_quantity("mass_matrix_derivatives").engine

    def matrix(q: Any, v: Any) -> Any:
        d = np.asarray(engine(arm, np.array([q], dtype=float)))[0]  # d[i, j, k] = dM_ij / dq_k
        first, second, third = d, np.swapaxes(d, 1, 2), np.transpose(d, (2, 0, 1))
        terms = {
            "half left out": 2.0 * (first + second - third),
            "first term left out": second - third,
            "second term left out": first - third,
            "third term left out": first + second,
            "third term added": first + second + third,
            "second for third": first + second - second,
            "first for third": first + second - first,
        }[slip]
        return 0.5 * np.einsum("ijk,k->ij", terms, v)

    return "coriolis_torques", lambda q, v: matrix(q, v) @ v


def degrees(arm: Any, slip: str) -> Spoiled:
    """Rates given in degrees per second."""
    turned = np.deg2rad
    if slip == "C v":
        return "coriolis_torques", lambda q, v: kl.coriolis_matrix(arm, q, turned(v)) @ turned(v)
    return "kinetic_energy", lambda q, v: kl.kinetic_energy(arm, q, turned(v))


def neighbour(arm: Any, slip: str) -> Spoiled:
    """The first entry where the second belongs."""
    chosen = kl.gravity_torques if slip == "G" else kl.inverse_dynamics
    name = "gravity_torques" if slip == "G" else "inverse_dynamics"

    def torque(*state: Any) -> Any:
        out = np.array(chosen(arm, *state))
        out[1] = out[0]
        return out

    return name, torque


BOOKS: list[tuple[Callable[[Any, str], Spoiled], str, str]] = [
    (newton_euler, "gravity downwards", r"gravity"),
    (newton_euler, "omega_dot x P left out", r"leaves .*(tangential|omega_dot x P)"),
    (newton_euler, "omega x (omega x P) left out", r"leaves .*(centripetal|w x \(w x P\))"),
    (newton_euler, "Coriolis acceleration of a slide halved", r"half|factor|Coriolis"),
    (newton_euler, "Coriolis acceleration of a slide left out", r"leaves .*(Coriolis|w x .*qd)"),
    (newton_euler, "omega x z qd left out", r"leaves .*(w x \(?qd|w\) x \(?qd|w x z)"),
    (newton_euler, "centre not rotated", r"centre.*(rotat|frame|axes)|P_C.*for R P_C"),
    (newton_euler, "omega x (omega x P_C) left out", r"leaves .*(centripetal|w x \(w x)"),
    (newton_euler, "tensor not rotated", r"(inertia|tensor| I ).*(rotat|frame|axes|for R I)"),
    (newton_euler, "R^T I R for R I R^T", r"R\^T I R|(tensor|inertia).*(transpose|inverse)"),
    (newton_euler, "omega x I omega with the other sign", r"opposite sign.*|sign.*gyroscopic"),
    (newton_euler, "omega x I omega left out", r"gyroscopic|w x \(I w\)"),
    (newton_euler, "P x f with the link's own f", r"force|link|\bf\b"),
    (newton_euler, "P_C x F left out", r"leaves .*(P_C x F|moment)"),
    (newton_euler, "P x f left out", r"leaves .*(P x|lever arm)"),
    (newton_euler, "moment at a slide", r"slide"),
    (newton_euler, "z of the joint before", r"axis|\bz\b"),
    (jacobian, "z of the joint before", r"axis|\bz\b"),
    (jacobian, "z of the next joint", r"axis|\bz\b"),
    (jacobian, "point of the joint before", r"origin|point|\bo\b"),
    (jacobian, "slide as hinge", r"slide|prismatic"),
    (jacobian, "p x z", r"sign|x z|order"),
    (jacobian, "p for p - o", r"origin|point|\bo\b"),
    (jacobian, "columns exchanged", r"column|exchang|swap"),
    (statics, "J for J^T", r"transpos|J for J\^T"),
    (statics, "inverse for transpose", r"inverse"),
    (mass, "joint for centre of mass", r"centre"),
    (mass, "centre not rotated", r"centre.*(rotat|frame|axes)|P_C"),
    (mass, "tensor not rotated", r"(inertia|tensor| I ).*(rotat|frame|axes|for R I)"),
    (mass, "R^T I R for R I R^T", r"R\^T I R|(tensor|inertia).*(transpose|inverse)"),
    (mass, "m c^2 twice", r"inertia.*(joint|point|centre|about)|twice"),
    (mass, "tensors left out", r"leaves .*(tensor|inertia|Jw)"),
    (kinetic, "half left out", r"twice|factor|half|½"),
    (kinetic, "joint for centre of mass", r"centre"),
    (kinetic, "tensors left out", r"leaves .*(tensor|inertia|w)"),
    (gravity, "centre not rotated", r"centre.*(rotat|frame|axes)|P_C"),
    (gravity, "joint for centre of mass", r"centre|leaves P_C x F"),
    (gravity, "last link left out", r"leaves .*(\bmass\b|last|\blink \d)"),
    (gravity, "sign", r"sign|gravity"),
    (absolute, "M in absolute angles", r"from the base"),
    (absolute, "G in absolute angles", r"from the base"),
    (christoffel, "half left out", r"leaves .*(½|half)|twice|factor"),
    (christoffel, "first term left out", r"leaves .*dM_i(j/dq_k|k/dq_j)"),
    (christoffel, "second term left out", r"leaves .*dM_i(j/dq_k|k/dq_j)"),
    (christoffel, "third term left out", r"leaves .*dM_jk/dq_i|Mdot"),
    (christoffel, "third term added", r"sign"),
    (christoffel, "second for third", r"for D|for .*dM_jk|takes D|Mdot"),
    (christoffel, "first for third", r"for D|for .*dM_jk|takes D|Mdot"),
    (degrees, "C v", r"degrees"),
    (degrees, "T", r"degrees"),
    (neighbour, "G", r"entr|joint|row|another"),
    (neighbour, "tau", r"entr|joint|row|another"),
]
"""How it is derived, what is spoiled, and the words that a sentence has to have to name it."""

# -------- The five-bar of Huang et al., leg by leg

FIVEBAR: list[tuple[str, str, str]] = [
    # quantity, spoiled formula of one leg (see ``fivebar``), words
    ("fivebar_rod_length", "hypot(-s*e + l1*cos(th) - x, l1*sin(th) - y)", r"sign"),
    ("fivebar_rod_length", "hypot(l1*cos(th) - x, l1*sin(th) - y)", r"leaves .*\be\b"),
    ("fivebar_rod_length", "hypot(s*e + l2*cos(th) - x, l2*sin(th) - y)", r"l2|rod"),
    ("fivebar_rod_length", "hypot(s*e + l1*sin(th) - x, l1*cos(th) - y)", r"sin|cos|exchang"),
    ("fivebar_rod_length", "hypot(s*e + l1*cos(th) + x, l1*sin(th) + y)", r"sign"),
    ("fivebar_projection", "l2**2 - l1**2 - e**2 - x**2 - y**2", r"leaves 2\*s\*e\*x"),
    ("fivebar_projection", "l2**2 - l1**2 - e**2 - x**2 - y**2 - 2*s*e*x", r"sign"),
    ("fivebar_projection", "l2**2 - l1**2 - e**2 - x**2 - y**2 + s*e*x", r"half|factor|2"),
    ("fivebar_projection", "l2**2 + l1**2 - e**2 - x**2 - y**2 + 2*s*e*x", r"sign.*|l1"),
    ("fivebar_projection", "l2**2 - l1**2 - x**2 - y**2 + 2*s*e*x", r"leaves .*e"),
    ("fivebar_projection", "l2**2 - l1**2 - e**2 - x**2 + 2*s*e*x", r"leaves .*y"),
    ("fivebar_jacobian", "u/(l1*h)", r"\bu\b|crank"),
    ("fivebar_jacobian", "w/(l2*h)", r"l2|rod"),
    ("fivebar_jacobian", "w/l1", r"leaves .*k|sine|triple|u x w"),
    ("fivebar_jacobian", "-w/(l1*h)", r"sign"),
    ("fivebar_jacobian", "w/(l1*(u@w))", r"\bu w\b|dot|product"),
    ("fivebar_jacobian", "w*(l1*h)", r"power|divi|multipl|inverse|\^-1"),
    ("fivebar_turn", "w@a/(l1*h)", r"leaves .*(velocity|f)"),
    ("fivebar_turn", "w@a/(l1*h) - ((v@w)**2*(u@w)/l1 + (v@u)**2/l2)/(l1*h**3)", r"sign"),
    ("fivebar_turn", "w@a/(l1*h) + ((v@w)**2*(u@w)/l1 + (v@u)**2/l2)/(l1*h**2)", r"power|k\*\*2"),
    ("fivebar_turn", "w@a/(l1*h) + ((v@w)**2/l1 + (v@u)**2/l2)/(l1*h**3)", r"leaves .*u|w for u"),
    ("fivebar_turn", "w@a/(l1*h) + ((v@w)**2*(u@w)/l1 - (v@u)**2/l2)/(l1*h**3)", r"sign"),
    ("fivebar_turn", "w@a/(l1*h) + ((v@w)**2*(u@w)/l1)/(l1*h**3)", r"leaves .*u"),
    ("fivebar_turn", "w@a/(l1*h) + ((v@w)**2*(u@w)/l2 + (v@u)**2/l1)/(l1*h**3)", r"l1|l2|exchang"),
    ("fivebar_torque_massless", "I*th2 + grav + held", r"leaves .*(m|payload|J)"),
    ("fivebar_torque_massless", "I*th2 + push + held", r"leaves .*(crank|gravity|weight)"),
    ("fivebar_torque_massless", "I*th2 + push + grav", r"leaves .*(payload|weight|gravity|g)"),
    ("fivebar_torque_massless", "I*th2 + push + grav - held", r"sign"),
    ("fivebar_torque_massless", "I*th2 + push - grav + held", r"sign"),
    ("fivebar_torque_massless", "I*(J@a) + push + grav + held", r"leaves .*(velocity|f)"),
    ("fivebar_torque_massless", "I*th2 + push_J + grav + held", r"J|transpos|inverse"),
    ("fivebar_torque_massless", "push + grav + held", r"leaves .*(I|inertia|crank)"),
]  # fmt: skip


def fivebar(name: str, quantity: str, text: str) -> Function:
    """A formula of both legs as a function of one state."""
    bar = find_quantity(quantity).domain.numbers(find_quantity(quantity).domain.load(name))
    code = compile(text, quantity, "eval")
    wanted = find_quantity(quantity).arguments

    def given(*state: Any) -> Any:
        at = {k: np.asarray(x, dtype=float) for k, x in zip(wanted, state, strict=True)}
        xy = at["xy"]
        legs = []
        for k, s in enumerate((1.0, -1.0)):
            l1, l2 = bar.l1[k], bar.l2[k]
            one = {"s": s, "e": bar.e, "l1": l1, "l2": l2, "x": xy[0], "y": xy[1],
                   "hypot": np.hypot, "sin": np.sin, "cos": np.cos}  # fmt: skip
            if "theta" in at:
                one["th"] = at["theta"][k]
            else:  # the elbow: on the circle about the base pin, at l2 from the tool
                away = xy - np.array([s * bar.e, 0.0])
                far = np.hypot(*away)
                inside = np.arccos((l1**2 + far**2 - l2**2) / (2 * l1 * far))
                th = np.arctan2(away[1], away[0]) - at["mode"][k] * inside
                u = np.array([np.cos(th), np.sin(th)])
                w = (away - l1 * u) / l2
                one |= {"u": u, "w": w, "h": u[0] * w[1] - u[1] * w[0]}
            if "v" in at:
                v, a, u, w, h = at["v"], at["a"], one["u"], one["w"], one["h"]
                row = w / (l1 * h)
                bend = ((v @ w) ** 2 * (u @ w) / l1 + (v @ u) ** 2 / l2) / (l1 * h**3)
                one |= {"v": v, "a": a, "J": row, "th2": row @ a + bend, "I": bar.arm[k]}
                one["grav"] = bar.crank[k] * bar.crank_com[k] * bar.g * u[0]
            legs.append(one)
        if "v" in at:
            rows = np.array([one["J"] for one in legs])
            back = np.linalg.inv(rows).T
            for k, one in enumerate(legs):
                one["push"] = bar.payload * (back @ at["a"])[k]
                one["push_J"] = bar.payload * (rows @ at["a"])[k]
                one["held"] = bar.payload * bar.g * (back @ np.array([0.0, 1.0]))[k]
        return np.array([eval(code, {"__builtins__": {}}, one) for one in legs])  # noqa: S307

    return given


def right_of(quantity: str) -> str:
    """The right formula of each of the five-bar's quantities, to look at this file itself."""
    return {
        "fivebar_rod_length": "hypot(s*e + l1*cos(th) - x, l1*sin(th) - y)",
        "fivebar_projection": "l2**2 - l1**2 - e**2 - x**2 - y**2 + 2*s*e*x",
        "fivebar_jacobian": "w/(l1*h)",
        "fivebar_turn": "th2",
        "fivebar_torque_massless": "I*th2 + push + grav + held",
    }[quantity]


def suits(make: Function, slip: str, arm: Any) -> bool:
    """Whether an arm has what is spoiled."""
    kinds = [joint.shortname() for joint in arm.model.joints[1:]]
    if "slide" in slip and "JointModelPZ" not in kinds:
        return False
    if make is statics:
        return bool(arm.n == 6)
    if make in (newton_euler, mass, kinetic, gravity) and str(arm.table.convention) != "modified":
        return False  # Craig's frames are meant: at the joint, in the link
    return bool(arm.n > 1)
