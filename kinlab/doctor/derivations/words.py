"""The words and signs in which a derivation's expressions are told; small ways to change them."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator

from kinlab.doctor.bytecode.syntax import text_of
from kinlab.doctor.derivations.walk import again
from kinlab.host.language import N_, _

MEANT = {
    "w": N_("the angular velocity w"),
    "dw": N_("the angular acceleration omega_dot"),
    "dv": N_("the acceleration of the link's origin"),
    "dvc": N_("the acceleration of the centre of mass"),
    "F": N_("the link's own force F"),
    "N": N_("the link's own moment N"),
    "f": N_("the force f"),
    "fv": N_("the velocity terms"),
    "nn": N_("the moment n"),
    "hl": N_("the link's own momentum"),
    "ha": N_("the link's own angular momentum"),
    "bl": N_("the momentum of the links behind"),
    "ba": N_("the angular momentum of the links behind"),
    "no": N_("the moment about the base's origin"),
    "hb": N_("the angular momentum about the base's origin"),
    "P": N_("the lever arm P"),
    "c": N_("the centre of mass P_C"),
    "z": N_("the axis z"),
    "o": N_("the origin o"),
    "p": N_("the tool's point p"),
    "tool": N_("the tool"),
    "last": N_("the last frame's origin"),
    "pc": N_("the centre of mass"),
    "R": N_("the rotation R"),
    "I": N_("the inertia tensor"),
    "m": N_("the mass m"),
    "Ia": N_("the rotor inertia"),
    "T": N_("the transform T"),
    "A": N_("the matrix A"),
    "g": N_("gravity"),
    "q": "q",
    "qd": N_("the velocity qd"),
    "qdd": N_("the acceleration qdd"),
    "R_": N_("the rotation R"),
    "x_": N_("the axis x"),
    "y_": N_("the axis y"),
    "tw": N_("the twist V"),
    "fw": N_("the wrench's force"),
    "nw": N_("the wrench's moment"),
    "e": N_("the tool's offset"),
    "arm": N_("the tool's offset"),
    "dtw": N_("the acceleration as a twist"),
    "Is": N_("the spatial inertia"),
    "Ic": N_("the inertia of the links behind"),
    "Iz": N_("the inertia about the centre"),
    "dz": N_("the axis's rate"),
    "vc": N_("the velocity of the centre of mass"),
    "crank": N_("the crank's direction u"),
    "rod": N_("the rod's direction w"),
    "l1": N_("the crank's length l1"),
    "l2": N_("the rod's length l2"),
    "both": N_("the rotation R"),
    "Ib": N_("the inertia tensor"),
    "cb": N_("the centre of mass P_C"),
    "o_": N_("the frame's origin"),
    "b": N_("the boundary term"),
    "inner": N_("the integral"),
    "pull": N_("the rods' force on the tool"),
    "md": N_("the rod's mass"),
    "cd": N_("the distance of the rod's centre"),
    "Id": N_("the rod's inertia"),
}
"""What names stand for."""

_SPELT = {
    "ct": "cos(theta)",
    "st": "sin(theta)",
    "ca": "cos(alpha)",
    "sa": "sin(alpha)",
    "hl": "p",
    "ha": "L",
    "bl": "p",
    "ba": "L",
    "hb": "L_0",
    "no": "n_0",
    "tw": "V",
    "Rn": "R",
    "home": "T_0",
    "Rt": "R",
    "pc": "p_C",
    "fw": "f",
    "nw": "n",
    "dtw": "A",
    "Is": "I",
    "x_": "x",
    "y_": "y",
    "vc": "v_C",
    "dz": "z_dot",
    "dp": "p_dot",
    "u": "o_dot",
    "crank": "u",
    "rod": "w",
    "dw": "omega_dot",
    "dv": "v_dot",
    "dvc": "v_dot_C",
    "nn": "n",
    "c": "P_C",
    "R_": "R",
    "o_": "o",
    "dd": "d",
    "fv": "f(v)",
    "Jb": "J",
    "Jm": "J",
    "th": "theta",
    "Ib": "I",
    "cb": "P_C",
    "both": "R",
    "late": "dL/dqd(t2)",
    "early": "dL/dqd(t1)",
    "later": "dq(t2)",
    "earlier": "dq(t1)",
    "pull": "f",
}

_CALLED = {
    "both_": "diag",
    "arctan2": "atan2",
    "arctan": "atan",
    "arccos": "acos",
    "arcsin": "asin",
}

KNOWN = {
    "X^T Ic X": N_("the inertia of the links behind"),
    "w x (I w)": N_("the gyroscopic term"),
    "w x (w x P)": N_("the centripetal term of the link's origin"),
    "w x (w x P_C)": N_("the centripetal term of the centre of mass"),
    "omega_dot x P": N_("the tangential term of the link's origin"),
    "omega_dot x P_C": N_("the tangential term of the centre of mass"),
    "2*w x (qd*z)": N_("the Coriolis acceleration of a slide, prismatic joint"),
    "2*w x (qd*(R^T z))": N_("the Coriolis acceleration of a slide, prismatic joint"),
    "(R^T w) x (qd*z)": N_("w x z qd"),
    "w x (qd*z)": N_("w x z qd"),
    "qdd*z": N_("the acceleration d_ddot of a slide, theta_ddot of a hinge"),
    "I omega_dot": N_("the inertia tensor's moment"),
    "N": N_("the link's own moment"),
    "F": N_("the link's own force"),
    "R tool": N_("the tool"),
    "R^T n": N_("the wrench's moment"),
    "R^T f": N_("the wrench's force"),
    "P_C x F": N_("the moment of F"),
    "(P + P_C) x F": N_("the moment of F at the centre of mass"),
    "P x (R f)": N_("the lever arm of the next link's force"),
    "R f": N_("the force of the next link"),
    "R n": N_("the moment of the next link"),
    "Ia*qdd": N_("the rotor inertia"),
    "diagonal(Ia)": N_("the rotor inertia"),
    "-g": N_("gravity"),
    "g": N_("gravity"),
    "G": N_("the gravity torques"),
    "C v": N_("the velocity terms"),
    "M a": N_("the inertia terms"),
    "o": N_("the joint's origin"),
    "R P_C": N_("the centre of mass in the link"),
    "m*skew(P_C) skew(P_C)": N_("the parallel-axis term"),
    "m*skew(p_C) skew(p_C)": N_("the parallel-axis term"),
    "m*Jv^T Jv": N_("the mass's part"),
    "Jw^T (R I R^T) Jw": N_("the inertia tensor's part"),
    "D": "dM_ij/dq_k",
    "D_ikj": "dM_ik/dq_j",
    "D_jki": "dM_jk/dq_i",
}
"""What terms are called."""


def which(old: ast.expr, new: ast.expr) -> str:
    """Of which joint or link: the one before, or the next."""
    assert isinstance(old, ast.Subscript)
    assert isinstance(new, ast.Subscript)
    name = name_of(new)
    thing = "joint" if name == "z" else "frame" if name in ("o", "o_", "T", "R_") else "link"
    one, two = text_of(old.slice), text_of(new.slice)
    back = "- 1" in two or ("+ 1" in one and "+ 1" not in two)
    words = {
        ("joint", True): _("{what} of the joint before"),
        ("joint", False): _("{what} of the next joint"),
        ("frame", True): _("{what} of the frame before"),
        ("frame", False): _("{what} of the next frame"),
        ("link", True): _("{what} of the link before"),
        ("link", False): _("{what} of the next link"),
    }
    return words[thing, bool(back)].format(what=meant(new))


def minus(node: ast.expr) -> ast.expr:
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div | ast.MatMult):
        return ast.BinOp(minus(node.left), node.op, again(node.right))
    return node.operand if isinstance(node, ast.UnaryOp) else ast.UnaryOp(ast.USub(), again(node))


def times(factor: float, node: ast.expr) -> ast.expr:
    return ast.BinOp(ast.Constant(factor), ast.Mult(), again(node))


def across(node: ast.expr) -> ast.expr:
    return ast.Attribute(again(node), "T")


def name_of(node: ast.expr) -> str:
    if isinstance(node, ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def meant(node: ast.expr) -> str:
    """What a name stands for."""
    found = _meaning(node)
    return spelt(node) if found is None else _(found)


def _meaning(node: ast.expr) -> str | None:
    """Of l1, l2, z only where they have an index: alone they are a serial arm's, and a height."""
    alone = isinstance(node, ast.Name) and node.id in ("l1", "l2", "z")
    numbered = isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant)
    return None if alone or numbered else MEANT.get(name_of(node))


def told(node: ast.expr) -> str:
    """A term, with what it is called."""
    text = spelt(node)
    called = KNOWN.get(text) or _meaning(node)
    return f"{text} ({_(called)})" if called and called != text else text


def spelt(node: ast.expr, indexed: bool = False) -> str:
    """An expression as textbooks write it."""
    if isinstance(node, ast.Constant):
        return f"{float(str(node.value)):g}"
    if isinstance(node, ast.Subscript):
        name = spelt(node.value)
        if isinstance(node.slice, ast.Constant):
            return f"{name}{text_of(node.slice)}"
        index = text_of(node.slice).replace(" ", "")
        return (
            name if not indexed else f"{name}_{index}" if len(index) == 1 else f"{name}_({index})"
        )
    if isinstance(node, ast.Name):
        return _SPELT.get(node.id, node.id)
    if isinstance(node, ast.Attribute):
        return f"{_closed(node.value, indexed)}^T"
    if isinstance(node, ast.UnaryOp):
        return f"-{_closed(node.operand, indexed)}"
    if isinstance(node, ast.Call):
        assert isinstance(node.func, ast.Name)
        if node.func.id == "cross":
            return " x ".join(_closed(x, indexed) for x in node.args)
        if node.func.id in ("ikj", "jki"):
            return f"D_{node.func.id}"
        if node.func.id == "solve":
            return f"{spelt(node.args[0])}^-1 {_closed(node.args[1], indexed)}"
        if node.func.id == "clamp":
            return spelt(node.args[0], indexed)
        called = _CALLED.get(node.func.id, node.func.id)
        return f"{called}({', '.join(spelt(x, indexed) for x in node.args)})"
    if isinstance(node, ast.BinOp):
        if isinstance(node.op, ast.Pow) and text_of(node.right) == "1":
            return spelt(node.left, indexed)
        if is_sum(node):
            sign = "+" if isinstance(node.op, ast.Add) else "-"
            return f"{spelt(node.left, indexed)} {sign} {spelt(node.right, indexed)}"
        joint = {ast.MatMult: " ", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}[type(node.op)]
        one: ast.expr | None = (
            node.left if isinstance(node.left, ast.BinOp) and not is_sum(node.left) else None
        )
        if isinstance(node.left, ast.UnaryOp):
            one = node.left
        left = spelt(one, indexed) if one is not None else _closed(node.left, indexed)
        loose = isinstance(node.right, ast.Call) and isinstance(node.op, ast.Mult)
        right = spelt(node.right, indexed) if loose else _closed(node.right, indexed)
        return f"{left}{joint}{right}"
    return spelt(node.body, indexed) if isinstance(node, ast.IfExp) else text_of(node)


def _closed(node: ast.expr, indexed: bool) -> str:
    """In parentheses where it is more than a name."""
    text = spelt(node, indexed)
    plain = isinstance(node, ast.Name | ast.Subscript | ast.Constant | ast.Attribute)
    call = isinstance(node, ast.Call) and " x " not in text and " " not in text
    return text if plain or call else f"({text})"


def told_other(old: ast.expr, new: ast.expr) -> str:
    """One name for another, with what they mean where that says more."""
    one, two = spelt(new), spelt(old)
    if (meant(new), meant(old)) == (one, two):
        return _("has {new} for {old}").format(new=one, old=two)
    return _("has {new} for {old} ({what} for {other})").format(
        new=one, old=two, what=meant(new), other=meant(old)
    )


def halves(node: ast.AST) -> tuple[ast.expr, ast.expr]:
    assert isinstance(node, ast.BinOp)
    return node.left, node.right


def is_sum(node: ast.AST) -> bool:
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub)


def summands(node: ast.expr) -> Iterator[ast.expr]:
    if is_sum(node):
        assert isinstance(node, ast.BinOp)
        yield from summands(node.left)
        yield from summands(node.right)
    else:
        yield node


def together(pieces: Iterable[str]) -> str:
    """Pieces of formulas in a sentence: ``l1 = 0.5 and m2 = 1``."""
    told, *rest = [*pieces] or [""]
    pair = _("{first} and {last}")
    for piece in rest:
        told = pair.format(first=told, last=piece)
    return told


def shifted(index: ast.expr, shift: int) -> ast.expr | None:
    """An index one more or less: i - 1 from i, i from i + 1."""
    base, by = index, 0
    if isinstance(index, ast.BinOp) and isinstance(index.right, ast.Constant):
        base = index.left
        by = (1 if isinstance(index.op, ast.Add) else -1) * int(str(index.right.value))
    by += shift
    if abs(by) > 1:
        return None
    if not by:
        return base
    return ast.BinOp(base, ast.Add() if by > 0 else ast.Sub(), ast.Constant(1))
