"""What the names in formulas of a five-bar claim and stand for: J11, C2, theta1, w1x, uHw1, I_A.

The names are note 003's: l1, l2 and I_A are those of the entry's leg, s is its sign, theta_i the
crank's angle, u_i and w_i the directions of crank and rod, uHw_i = u_i^T H w_i. Their values are
the engine's. An entry without a leg's number (A, C, theta, w_x) is that of either leg, by s.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.fivebar import leg_of
from kinlab.check.quantities.fivebar import numbers as plain_numbers
from kinlab.check.quantities.quantity import Quantity
from kinlab.check.quantities.registry import quantities, split_name
from kinlab.errors import ExpressionError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile
from kinlab.formulas.signs.refusals import near_names
from kinlab.formulas.text import canonical, parse
from kinlab.formulas.tree import Node
from kinlab.host.language import _

# -------- What an entry claims to be

_AXES = {"x": 0, "y": 1}
_EQUATION = {"A": 0, "B": 1, "C": 2}
_OF_LEGS = {"loop": "loop", "A": "equation", "B": "equation", "C": "equation", "theta": "angles"}
_OF_CRANKS = {
    "q": "fivebar_angles",
    "qd": "fivebar_rates",
    "qdd": "fivebar_turn",
    "tau": "fivebar_torque_massless",
    "P": "fivebar_power_massless",
    "IL": "fivebar_load_inertia_massless",
    "Thetad": "fivebar_worst_rate",
    "Tmax": "fivebar_worst_torque",
}
_ROD = re.compile("(?:r|rho)([12])")
"""What the length of a leg's rod is called, where the cranks' angles are given."""
_OF_SERVOS = {
    "j": "servo_ratio",
    "IMmin": "servo_inertias[0]",
    "IMmax": "servo_inertias[1]",
    "tauMmax": "servo_torque",
    "tauM": "servo_torque",
}
_MATRICES = {"J": "fivebar_jacobian", "G": "fivebar_torque_per_acceleration"}
_BARS = {"u": "fivebar_cranks", "w": "fivebar_rods"}
ENTRY_NAMES = (
    "loop1", "A1", "B1", "C1", "C", "theta1", "u1x", "w1x", "w_x", "J11", "thetad1", "thetadd1",
    "tau1", "G11", "P1", "I_L1", "Thetad1", "Tmax1", "j", "tau_M", "I_Mmin",
)  # fmt: skip
"""Names of entries, one of each kind."""
_ENTRY = re.compile(r"(loop|theta|[ABC])([12]?)|(q|qd|qdd|tau|P|IL|Thetad|Tmax)([12])")
_MATRIX = re.compile(r"([JG])([12])([12])")
_BAR = re.compile(r"([uw])([12]?)([xy])([12]?)")


def claimed(entry: str) -> str:
    """The quantity that an entry's name stands for, such as ``"fivebar_jacobian[0,1]"``.

    Raises:
        ExpressionError: a name that says nothing, with those that are known.
    """
    if entry.split("[")[0].strip() in READ:
        return entry.strip()
    plain = entry.replace("_", "")
    meant = canonical(entry)
    word = (
        str(meant.value)
        if meant.op == "sym" and re.fullmatch(r"qd{0,2}\d", str(meant.value))
        else plain
    )
    if plain in _OF_SERVOS:
        return _OF_SERVOS[plain]
    if length := _ROD.fullmatch(plain):
        return f"fivebar_rod_length[{int(length[1]) - 1}]"
    if matrix := _MATRIX.fullmatch(plain):
        return f"{_MATRICES[matrix[1]]}[{int(matrix[2]) - 1},{int(matrix[3]) - 1}]"
    if (bar := _BAR.fullmatch(plain)) and not (bar[2] and bar[4]):
        leg = bar[2] or bar[4]
        if leg:
            return f"{_BARS[bar[1]]}[{int(leg) - 1},{_AXES[bar[3]]}]"
        if bar[1] == "w":
            return f"fivebar_leg_rods[{_AXES[bar[3]]}]"
    if found := _ENTRY.fullmatch(word):
        if found[3]:
            return f"{_OF_CRANKS[found[3]]}[{int(found[4]) - 1}]"
        name, leg = _OF_LEGS[found[1]], found[2]
        places = [str(int(leg) - 1)] if leg else []
        places += [str(_EQUATION[found[1]])] if found[1] in _EQUATION else []
        whole = f"fivebar_{name}" if leg else f"fivebar_leg_{name}"
        return f"{whole}[{','.join(places)}]" if places else whole
    said = _("{entry!r} names no quantity of a five-bar; {choices}")
    choices = near_names(entry, [*ENTRY_NAMES, *READ])
    raise ExpressionError(said.format(entry=entry, choices=choices))


def is_claim(entry: str) -> bool:
    """Whether an entry's name says something."""
    try:
        return bool(claimed(entry))
    except ExpressionError:
        return False


def entry_count(quantity: str) -> int:
    """How many numbers a quantity has."""
    if quantity.startswith("fivebar_leg_"):
        return {"fivebar_leg_equation": 3, "fivebar_leg_rods": 2}.get(quantity, 1)
    if quantity == "fivebar_equation":
        return 6
    if quantity in ("servo_ratio", "servo_torque"):
        return 1
    square = (*_MATRICES.values(), *_BARS.values())
    return 4 if quantity in square else 2


def refuse_massless(quantity: str, fivebar: FiveBar) -> None:
    """Refuses torques of a five-bar without masses, which are zero whatever is written.

    Raises:
        ExpressionError: the quantity has masses in it, and the five-bar has none.
    """
    pairs = _pairs(fivebar)
    moving = "m" in words_of(quantities()[split_name(quantity)[0]]).numbers
    if moving and not np.any(pairs["IA"]) and not np.any(pairs["m"]):
        said = _("{name} has no masses: its torques are zero; give it a payload, or cranks of mass")
        raise ExpressionError(said.format(name=fivebar.name))


def whole_claimed(entry: str) -> str:
    """The whole matrix or vector that a letter alone is, or ``""``: J, G, tau."""
    return _MATRICES.get(entry) or ("fivebar_torque_massless" if entry == "tau" else "")


# -------- Names, with the powers of kilogram, metre and second in their units

READ = {
    "fivebar_loop": (0, 2, 0),
    "fivebar_leg_loop": (0, 2, 0),
    "fivebar_rod_length": (0, 1, 0),
    "fivebar_equation": (0, 2, 0),
    "fivebar_leg_equation": (0, 2, 0),
    "fivebar_angles": (0, 0, 0),
    "fivebar_leg_angles": (0, 0, 0),
    "fivebar_cranks": (0, 0, 0),
    "fivebar_rods": (0, 0, 0),
    "fivebar_leg_rods": (0, 0, 0),
    "fivebar_jacobian": (0, -1, 0),
    "fivebar_rates": (0, 0, -1),
    "fivebar_turn": (0, 0, -2),
    "fivebar_torque_massless": (1, 2, -2),
    "fivebar_torque_per_acceleration": (1, 1, 0),
    "fivebar_power_massless": (1, 2, -3),
    "fivebar_load_inertia_massless": (1, 2, 0),
    "fivebar_rate_per_speed": (0, -1, 0),
    "fivebar_torque_per_acceleration_worst": (1, 1, 0),
    "fivebar_worst_rate": (0, 0, -1),
    "fivebar_worst_torque": (1, 2, -2),
    "servo_ratio": (0, 0, 0),
    "servo_inertias": (1, 2, 0),
    "servo_torque": (1, 2, -2),
}
"""The quantities whose formulas are read as text."""
_NUMBERS = {
    "l1": (0, 1, 0),
    "l2": (0, 1, 0),
    "e": (0, 1, 0),
    "m": (1, 0, 0),
    "g": (0, 1, -2),
    "IA": (1, 2, 0),
    "m1": (1, 0, 0),
    "lc1": (0, 1, 0),
}
_DYNAMIC = ("m", "g", "IA", "m1", "lc1")
_VECTORS = {
    "fivebar_cranks": ("u{i}{k}", (0, 0, 0)),
    "fivebar_rods": ("w{i}{k}", (0, 0, 0)),
    "fivebar_jacobian": ("J{i}{j}", (0, -1, 0)),
    "fivebar_torque_per_acceleration": ("G{i}{j}", (1, 1, 0)),
    "fivebar_rates": ("qd{i}", (0, 0, -1)),
    "fivebar_turn": ("qdd{i}", (0, 0, -2)),
    "fivebar_torque_massless": ("tau{i}", (1, 2, -2)),
}
"""Quantities that have names in the formulas of those that come after them."""
_BEFORE = {
    "fivebar_rods": ("fivebar_cranks",),
    "fivebar_leg_rods": ("fivebar_cranks",),
    "fivebar_jacobian": ("fivebar_cranks", "fivebar_rods"),
    "fivebar_rates": ("fivebar_cranks", "fivebar_rods", "fivebar_jacobian"),
}
_BEFORE["fivebar_rate_per_speed"] = _BEFORE["fivebar_worst_rate"] = _BEFORE["fivebar_rates"]
_BEFORE["fivebar_turn"] = (*_BEFORE["fivebar_rates"], "fivebar_rates")
_BEFORE["fivebar_torque_per_acceleration"] = _BEFORE["fivebar_rates"]
_BEFORE["fivebar_load_inertia_massless"] = _BEFORE["fivebar_rates"]
_BEFORE["fivebar_torque_massless"] = (
    *_BEFORE["fivebar_turn"], "fivebar_turn", "fivebar_torque_per_acceleration",
)  # fmt: skip
_BEFORE["fivebar_power_massless"] = (*_BEFORE["fivebar_torque_massless"], "fivebar_torque_massless")
_BEFORE["fivebar_worst_torque"] = _BEFORE["fivebar_torque_per_acceleration_worst"] = (
    *_BEFORE["fivebar_rates"], "fivebar_torque_per_acceleration",
)  # fmt: skip
_CHOSEN_BY = {
    "vmax": (0, 1, -1),
    "amax": (0, 1, -2),
    "Nmax": (0, 0, -1),
    "Thetadmax": (0, 0, -1),
    "Tmax": (1, 2, -2),
    "IL": (1, 2, 0),
    "j": (0, 0, 0),
}
"""What a servo is chosen by, among the arguments of a quantity."""
_WITHOUT_ANGLES = ("equation", "angles")
"""Ends of the names of quantities that stand on the tool's place alone."""


def is_either(quantity: str) -> bool:
    """Whether a quantity is that of either leg, by s."""
    return quantity.startswith("fivebar_leg_")


@dataclass(frozen=True)
class Words:
    """The names that a quantity's formula may have.

    Attributes:
        numbers: of the five-bar's numbers, those that are zero among them.
        states: what moves, but the cranks' angles, each with its unit.
        letters: which of q, qd and qdd.
    """

    numbers: tuple[str, ...]
    states: dict[str, tuple[int, int, int]]
    letters: tuple[str, ...]

    @property
    def of_the_linkage(self) -> bool:
        """Whether it is the five-bar's, and not a servo's."""
        return bool(self.numbers)


def words_of(quantity: Quantity) -> Words:
    """The names that a quantity's formula may have: a servo's are those that it is chosen by."""
    chosen = {name: unit for name, unit in _CHOSEN_BY.items() if name in quantity.arguments}
    if quantity.name.startswith("servo_"):
        return Words((), chosen, ())
    moving = quantity.name not in READ or READ[quantity.name][0] > 0
    numbers = tuple(n for n in _NUMBERS if moving or n not in _DYNAMIC)
    return Words(numbers, chosen | _states(quantity), _letters(quantity.name))


def numbers_of(fivebar: FiveBar, leg: int = 0) -> dict[str, float]:
    """The numbers of a five-bar by name, of one leg where the legs differ."""
    return {name: float(pair[leg]) for name, pair in _pairs(fivebar).items()}


def _pairs(fivebar: FiveBar) -> dict[str, Array]:
    plain = plain_numbers(fivebar)
    both = {"e": plain.e, "m": plain.payload, "g": plain.g}
    return {
        "l1": plain.l1,
        "l2": plain.l2,
        **{name: np.full(2, value) for name, value in both.items()},
        "IA": plain.arm,
        "m1": plain.crank,
        "lc1": plain.crank_com,
    }


def with_numbers(fivebar: FiveBar, values: dict[str, Array]) -> FiveBar:
    """The five-bar with other numbers for some names, a pair each; rods and rotors as they are."""
    now = {**_pairs(fivebar), **values}
    rotor = fivebar.reflected_inertia
    return replace(
        fivebar,
        l1=now["l1"],
        l2=now["l2"],
        e=float(now["e"][0]),
        payload=float(now["m"][0]),
        gravity=(0.0, -float(now["g"][0])),
        crank_mass=now["m1"],
        crank_com=now["lc1"],
        crank_inertia=np.maximum(now["IA"] - now["m1"] * now["lc1"] ** 2 - rotor, 0.0),
    )


def parameters(quantity: Quantity, fivebar: FiveBar) -> tuple[str, ...]:
    """The names of numbers that a quantity's formula may have, but those that are zero."""
    pairs = _pairs(fivebar)
    return tuple(n for n in words_of(quantity).numbers if np.any(pairs[n]))


def _states(quantity: Quantity) -> dict[str, tuple[int, int, int]]:
    """What moves in a formula of the five-bar's, but the cranks' angles, with its unit."""
    given = quantity.arguments
    found = {"x": (0, 1, 0), "y": (0, 1, 0)}
    if is_either(quantity.name):
        found["s"] = (0, 0, 0)
    if "v" in given:
        found |= {"vx": (0, 1, -1), "vy": (0, 1, -1)}
    if "a" in given:
        found |= {"ax": (0, 1, -2), "ay": (0, 1, -2)}
    for before in _BEFORE.get(quantity.name, ()):
        name, unit = _VECTORS[before]
        for i, j in np.ndindex(2, 2):
            found[name.format(i=i + 1, j=j + 1, k="xy"[j])] = unit
        if before == "fivebar_rods":
            found |= {"uHw1": (0, 0, 0), "uHw2": (0, 0, 0)}
    if quantity.name in ("fivebar_torque_massless", "fivebar_power_massless"):
        found |= {f"{n}{i}": u for i in "12" for n, u in (("f", (0, 0, -2)), ("tauAg", (1, 2, -2)))}
    if quantity.name.endswith("angles"):
        found |= {f"{letter}{i}": (0, 2, 0) for i in ("1", "2") for letter in "ABC"}
    if is_either(quantity.name):
        own = {"A": (0, 2, 0), "B": (0, 2, 0), "C": (0, 2, 0)}
        found |= own if quantity.name.endswith("angles") else {}
        found |= {"ux": (0, 0, 0), "uy": (0, 0, 0)} if quantity.name.endswith("rods") else {}
        found = {n: unit for n, unit in found.items() if not re.search("[12]", n)}
    return {n: u for n, u in found.items() if not re.fullmatch(r"qd{1,2}\d", n)}


def _letters(quantity: str) -> tuple[str, ...]:
    """The cranks' angles and what is known of their rates in a formula of the five-bar's."""
    if quantity.endswith(_WITHOUT_ANGLES) or is_either(quantity):
        return ()
    before = _BEFORE.get(quantity, ())
    rates = ("qd",) * ("fivebar_rates" in before) + ("qdd",) * ("fivebar_turn" in before)
    return ("q", *rates)


def values_at(
    fivebar: FiveBar, quantity: Quantity, arguments: dict[str, Array], index: tuple[Any, ...]
) -> dict[str, Array]:
    """The values of every name in a formula of an entry, (N,) each, from the engine.

    Args:
        fivebar: the five-bar.
        quantity: the quantity.
        arguments: the states.
        index: the entry's; its leg is the first of it.
    """
    words = words_of(quantity)
    if not words.of_the_linkage:
        return arguments
    count = len(arguments["xy"])
    leg = np.full(count, index[0] if index else 0)
    if "s" in arguments:
        leg = leg_of(arguments["s"])
    every = np.arange(count)
    at = {n: pair[leg] for n, pair in _pairs(fivebar).items() if n in words.numbers}
    moving = _moving(fivebar, quantity, arguments)
    at |= {n: moving[n] for n in moving if n in words.states or n[0] == "q"}
    at["s"] = np.where(leg, -1.0, 1.0)
    own = {"theta": "q{i}", "uHw": "uHw{i}", "A": "A{i}", "B": "B{i}", "C": "C{i}"}
    own |= {f"{bar}{k}": f"{bar}{{i}}{k}" for bar in "uw" for k in "xy"}
    for name, pattern in own.items():
        both = [pattern.format(i=i) for i in "12"]
        if all(one in moving for one in both):
            at[name] = np.stack([moving[one] for one in both], axis=1)[every, leg]
    if is_either(quantity.name):
        at = {n: x for n, x in at.items() if not re.fullmatch(r"[quwABC]\w*[12]\w*|uHw[12]", n)}
    return at


def _moving(fivebar: FiveBar, quantity: Quantity, arguments: dict[str, Array]) -> dict[str, Array]:
    x, y = arguments["xy"].T
    found = {"x": x, "y": y} | {n: arguments[n] for n in _CHOSEN_BY if n in arguments}
    for letter in ("v", "a"):
        if letter in arguments:
            found |= {f"{letter}{k}": arguments[letter][:, j] for j, k in enumerate("xy")}
    if quantity.name.endswith(_WITHOUT_ANGLES):
        if "mode" in arguments:
            found |= _equations(fivebar, arguments["xy"])
        return found
    angles = arguments.get("theta")
    if angles is None:
        angles = asked("fivebar_angles", fivebar, arguments)
    found |= {f"q{i + 1}": angles[:, i] for i in range(2)}
    for before in _BEFORE.get(quantity.name, ()):
        name, _unit = _VECTORS[before]
        answer = asked(before, fivebar, arguments)
        for index in np.ndindex(answer.shape[1:]):
            i, j = (*index, 0)[:2]
            shown = name.format(i=i + 1, j=j + 1, k="xy"[j])
            found[shown] = answer[(slice(None), *index)]
    for i in "12" if "w1x" in found else ():
        across = found[f"u{i}x"] * found[f"w{i}y"] - found[f"u{i}y"] * found[f"w{i}x"]
        found[f"uHw{i}"] = across
    if "f1" in words_of(quantity).states:
        for i, (turn, held) in enumerate(zip(*turn_and_weight(fivebar, arguments), strict=True)):
            found |= {f"f{i + 1}": turn, f"tauAg{i + 1}": held}
    return found


def turn_and_weight(fivebar: FiveBar, arguments: Mapping[str, Array]) -> tuple[Array, Array]:
    """The notes' f, what theta_ddot has of the rates alone, and tau_Ag, each (2 legs, N)."""
    still = {**arguments, "a": np.zeros_like(arguments["a"])}
    rest = {**still, "v": still["a"]}
    turn = asked("fivebar_turn", fivebar, still)
    held = asked("fivebar_torque_massless", replace(fivebar, payload=0.0), rest)
    return turn.T, held.T


def _equations(fivebar: FiveBar, xy: Array) -> dict[str, Array]:
    found = quantities()["fivebar_equation"].engine(fivebar, xy)
    return {f"{letter}{i + 1}": found[:, i, k] for i in range(2) for letter, k in _EQUATION.items()}


def asked(name: str, fivebar: FiveBar, arguments: Mapping[str, Array]) -> Array:
    """A quantity of the five-bar at the states of its arguments."""
    quantity = quantities()[name]
    return np.asarray(quantity.engine(fivebar, *(arguments[a] for a in quantity.arguments)))


# -------- Names by habit

_OTHERS = {
    "I": "IA", "Ia": "IA", "mp": "m", "eta": "m/IA", "detJ": "(J11*J22 - J12*J21)",
    "xdot": "vx", "xd": "vx", "dx": "vx", "ydot": "vy", "yd": "vy", "dy": "vy",
    "xddot": "ax", "xdd": "ax", "ddx": "ax", "yddot": "ay", "ydd": "ay", "ddy": "ay",
    "th": "theta", "m1c1": "m1*lc1", "r1": "lc1", "px": "x", "py": "y",
}  # fmt: skip
_TURNED = re.compile(r"([uw])([xy])([12])")


def with_habits(file: FormulaFile, fivebar: FiveBar) -> FormulaFile:
    """The file with a meaning for names that are written in another way: I_A, w_1x, xdot, eta.

    What this five-bar has none of is nothing: e where both cranks are on one axis.

    Args:
        file: the formulas.
        fivebar: whose they are.
    """
    known = set().union(*(known_names(entry) for entry in file.formulas if is_claim(entry)))
    none = {name for name, pair in _pairs(fivebar).items() if not np.any(pair)}
    words = known - none
    nodes = (*file.formulas.values(), *file.symbols.values())
    used = {name for node in nodes for name in tree.names(node)} - {*file.symbols} - words
    new: dict[str, str] = {}
    for name in sorted(used):
        plain = _TURNED.sub(r"\1\3\2", name.replace("_", ""))
        if tree.names(canonical(name)) <= words:
            continue
        plain = plain.lower() if plain in ("L1", "L2") else plain
        if plain in words:
            new[name] = plain
        elif plain in none & known:
            new[name] = "0"
        elif plain in _OTHERS:
            new[name] = _OTHERS[plain]
    symbols = file.symbols | {name: parse(value) for name, value in new.items()}
    return replace(file, symbols=symbols, symbol_texts=file.symbol_texts | new)


def of_entry(symbols: dict[str, str], entry: str) -> dict[str, str]:
    """The meanings of names that have a value in a formula of an entry: of J11 there is no I_A."""
    known, kept, before = known_names(entry), dict(symbols), -1
    while len(kept) != before:
        before = len(kept)
        kept = {
            name: text
            for name, text in kept.items()
            if all(n in kept or tree.names(canonical(n)) <= known for n in tree.names(parse(text)))
        }
    return kept


def with_equations(file: FormulaFile) -> FormulaFile:
    """The file with a loop's equation as the difference of its sides: it is no chain."""
    for entry in file.formulas:
        if not is_claim(entry) or not split_name(claimed(entry))[0].endswith("_loop"):
            continue
        others = [one for one in file.others if one.texts[entry] != file.texts[entry]]
        if len(others) == 1:
            right = file.texts[entry]
            behind = right if re.fullmatch(r"[\w.*]+", right) else f"({right})"
            text = others[0].texts[entry] + (f" - {behind}" if right != "0" else "")
            file = replace(
                file,
                texts=file.texts | {entry: text},
                formulas=file.formulas | {entry: parse(text, entry)},
                as_typed=file.as_typed | {entry: text},
                others=tuple(one for one in file.others if one is not others[0]),
            )
    return file


def known_names(entry: str) -> set[str]:
    """Every name that may have a value in a formula of an entry."""
    words = words_of(quantities()[split_name(claimed(entry))[0]])
    own = {"s", "theta", "ux", "uy", "wx", "wy", "uHw", "A", "B", "C"}
    moving = {f"{letter}{i}" for letter in ("q", "qd", "qdd") for i in "12"}
    return {*words.numbers, *words.states, *own, *moving}


# -------- Terms that may be missing

_FACTORS = 3
"""Factors of a term at most, beside a number, s and a cosine."""


@lru_cache(maxsize=64)
def terms_of(quantity: Quantity, names: tuple[str, ...]) -> tuple[Node, ...]:
    """Products of names that have the unit of a quantity, as terms that may be missing in it."""
    words = words_of(quantity)
    if not words.of_the_linkage:
        return ()  # a ratio has no unit: anything could be added
    units = {**_NUMBERS, **words.states}
    units |= {"qd1": (0, 0, -1), "qd2": (0, 0, -1), "qdd1": (0, 0, -2), "qdd2": (0, 0, -2)}
    usable = [n for n in names if n in units and n != "s"]
    wanted = READ[quantity.name]
    found: list[Node] = []
    for count in range(1, _FACTORS + 1):
        for some in combinations_with_replacement(usable, count):
            total = tuple(int(k) for k in np.sum([units[n] for n in some], axis=0))
            if total == wanted:
                found.append(tree.mul(*map(tree.sym, some)))
    if "m1" in names and "g" in names and "m1" in usable:
        found += [
            tree.mul(tree.sym("m1"), tree.sym("g"), tree.sym("lc1"), tree.call("cos", tree.sym(q)))
            for q in ("q1", "q2")
        ]
    signed = [tree.mul(tree.sym("s"), term) for term in found] if "s" in names else []
    return tuple(
        tree.mul(tree.num(k), term) if k != 1 else term
        for term in (*found, *signed)
        for k in (1, 2, -1, -2)
    )
