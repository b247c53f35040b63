"""What a value in a program is: named rightly against recursions written out here, or not at all.

The oracle walks the rows of a DH table from link to link in the links' own axes, as the textbooks
do (Craig 6.5 for modified tables, Siciliano 7.5 for standard ones); nothing of it is kinlab's.
"""

from __future__ import annotations

from dataclasses import replace

import newton_euler
import numpy as np
import pytest
from random_tables import random_inertia, random_pose, random_table

import kinlab as kl
from kinlab.doctor.glossary.linkage import linkage_meanings
from kinlab.doctor.glossary.meaning import PHRASES, meaning_of, said
from kinlab.doctor.glossary.textbook import Sense, meanings
from kinlab.host.language import speaking

E_Z = np.array([0.0, 0.0, 1.0])


def row_transform(link, convention, q):
    """Rz Tz Tx Rx of a standard row, Rx Tx Rz Tz of a modified one."""
    move = -q if link.flip else q
    theta = link.theta + (move if link.joint == "revolute" else 0.0)
    d = link.d + (move if link.joint == "prismatic" else 0.0)
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(link.alpha), np.sin(link.alpha)
    about_z = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1.0]])
    about_x = np.array([[1, 0, 0, link.a], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1.0]])
    return about_z @ about_x if convention == "standard" else about_x @ about_z


def textbook(table, state):
    """Each thing by (what, number, frame, of), from one recursion out and one in."""
    q, v, a = state["q"], state["v"], state["a"]
    standard, n = str(table.convention) == "standard", table.n
    gravity, cross = np.asarray(table.gravity), np.cross
    things = {("g", None, "base", ""): gravity}
    T = [np.asarray(table.base)]
    w, dw = [np.zeros(3)], [np.zeros(3)]
    u, du = [np.zeros(3)], [-T[0][:3, :3].T @ gravity]  # of the origins, gravity counted in
    steps, F, N, levers = [], [], [], []
    for i, link in enumerate(table.links, 1):
        step = row_transform(link, str(table.convention), q[i - 1])
        R, p = step[:3, :3], step[:3, 3]
        T.append(T[-1] @ step)
        steps.append(step)
        s = -1.0 if link.flip else 1.0
        qd, qdd = s * v[i - 1], s * a[i - 1]
        turns, slides = (1.0, 0.0) if link.joint == "revolute" else (0.0, 1.0)
        before = R.T @ w[-1]
        z = R.T @ E_Z if standard else E_Z
        w_i = before + turns * qd * z
        dw_i = R.T @ dw[-1] + turns * (qdd * z + cross(before, qd * z))
        lever = R.T @ p
        at, rate = (w_i, dw_i) if standard else (before, R.T @ dw[-1])
        u_i = R.T @ u[-1] + cross(at, lever) + slides * qd * z
        du_i = R.T @ du[-1] + cross(rate, lever) + cross(at, cross(at, lever))
        du_i = du_i + slides * (qdd * z + 2.0 * cross(w_i, qd * z))
        c, m, tensor = np.asarray(link.com), link.mass, np.asarray(link.inertia)
        u_c = u_i + cross(w_i, c)
        du_c = du_i + cross(dw_i, c) + cross(w_i, cross(w_i, c))
        g = T[-1][:3, :3].T @ gravity
        w.append(w_i), dw.append(dw_i), u.append(u_i), du.append(du_i)
        F.append(m * du_c)
        N.append(tensor @ dw_i + cross(w_i, tensor @ w_i))
        levers.append(lever)
        if standard:
            r = lever + c
            for what, value in (
                ("wr", cross(w_i, r)), ("wwr", cross(w_i, cross(w_i, r))), ("ar", cross(dw_i, r)),
            ):  # fmt: skip
                things[what, i, "own", ""] = value
        own = {
            "axis": s * z, "lever": lever, "own_centre": c, "w": w_i, "dw": dw_i, "v": u_i, "vc": u_c,
            "dv": du_i + g, "dv-g": du_i, "dvc": du_c + g, "dvc-g": du_c, "F": m * (du_c + g),
            "F-g": F[-1], "N": N[-1], "p": m * u_c, "L": tensor @ w_i,
            "w x Iw": cross(w_i, tensor @ w_i), "wwc": cross(w_i, cross(w_i, c)),
            "wwP": cross(at, cross(at, lever)), "aP": cross(rate, lever), "ac": cross(dw_i, c),
            "wc": cross(w_i, c), "wP": cross(at, lever), "joint_centre": lever + c,
            "I dw": tensor @ dw_i, "z qd": s * z * v[i - 1],
        }  # fmt: skip
        for what, value in own.items():
            things[what, i, "own", ""] = value
            things[what, i, "base", ""] = T[-1][:3, :3] @ value
            if i > 1:
                things[what, i, "before", ""] = R @ value
        if i > 1:
            for (what, k, frame, of), value in list(things.items()):
                if k == i - 1 and frame == "own" and np.ndim(value) == 1:
                    things[what, k, "next", of] = R.T @ value
        turn = T[-1][:3, :3]
        things["inertia", i, "own", ""] = tensor
        things["inertia", i, "base", ""] = turn @ tensor @ turn.T
        about = tensor + m * (c @ c * np.eye(3) - np.outer(c, c))
        things["frame_inertia", i, "own", ""] = about
        things["k_linear", i, "", ""] = 0.5 * m * u_c @ u_c
        things["k_rotational", i, "", ""] = 0.5 * w_i @ tensor @ w_i
        things["k", i, "", ""] = things["k_linear", i, "", ""] + things["k_rotational", i, "", ""]
        things["u", i, "", ""] = -m * gravity @ (T[-1][:3, 3] + turn @ c)
        things["T0", i, "", ""], things["R0", i, "", ""] = T[-1], turn
        things["T", i, "", ""], things["R", i, "", ""] = step, R
        things["T_inverse", i, "", ""] = np.linalg.inv(step)
        things["origin", i, "", ""] = T[-1][:3, 3]
        things["centre", i, "", ""] = T[-1][:3, 3] + turn @ c
        things["z_axis", i, "", ""] = turn[:, 2]
        things["g", i, "own", ""] = turn.T @ gravity
        if link.joint == "revolute":
            things["sine", None, "", f"q{i}"] = np.sin(q[i - 1])
    f, nn, tau = np.zeros(3), np.zeros(3), np.zeros(n)
    for i in range(n, 0, -1):
        link, c = table.links[i - 1], np.asarray(table.links[i - 1].com)
        R = steps[i][:3, :3] if i < n else np.eye(3)  # f and nn are still those of link i + 1
        beyond = R @ f
        if standard:  # about the origin before, force i + 1 acts at the origin of frame i
            things["r x F", i, "own", ""] = cross(levers[i - 1] + c, F[i - 1])
            nn = R @ nn + cross(levers[i - 1], beyond) + things["r x F", i, "own", ""] + N[i - 1]
            z = steps[i - 1][:3, :3].T @ E_Z
        else:
            arm = steps[i][:3, 3] if i < n else np.zeros(3)
            nn = R @ nn + cross(arm, beyond) + cross(c, F[i - 1]) + N[i - 1]
            z = E_Z
        things["c x F", i, "own", ""] = cross(c, F[i - 1])
        if i < n:
            things["P x f", i + 1, "before", ""] = cross(levers[i - 1] if standard else arm, beyond)
        f = beyond + F[i - 1]
        turn = T[i][:3, :3]
        for what, value in (("f", f), ("n", nn)):
            things[what, i, "own", ""], things[what, i, "base", ""] = value, turn @ value
            if i > 1:
                things[what, i, "before", ""] = steps[i - 1][:3, :3] @ value
        s = -1.0 if link.flip else 1.0
        tau[i - 1] = s * z @ (nn if link.joint == "revolute" else f) + link.armature * a[i - 1]
        things["tau_entry", i, "", ""] = tau[i - 1]
    things["tau", None, "", ""] = tau
    tool = (T[-1] @ np.asarray(table.tool))[:3, 3]
    for j, link in enumerate(table.links, 1):
        at = T[j - 1] if standard else T[j]
        z, o = at[:3, 2] * (-1.0 if link.flip else 1.0), at[:3, 3]
        if link.joint == "revolute":
            things["Jv_column", j, "", ""] = np.cross(z, tool - o)
        things["tool_lever", j, "base", ""] = tool - T[j][:3, 3]
    return things


def general_table(seed, convention, kinds="RRPRRR"):
    """No angle special, no length zero, no two numbers alike."""
    rng = np.random.default_rng(seed)
    links = [
        kl.DHLink(
            joint="prismatic" if kind == "P" else "revolute",
            a=rng.uniform(0.11, 0.8), alpha=rng.uniform(0.3, 1.2), d=rng.uniform(0.12, 0.7),
            theta=rng.uniform(0.2, 1.1), flip=bool(rng.random() < 0.3), mass=rng.uniform(0.6, 7.0),
            com=rng.uniform(-0.3, 0.3, 3), inertia=random_inertia(rng),
            armature=rng.uniform(0.1, 1.0), lower=-3.0, upper=3.0,
        )
        for kind in kinds
    ]  # fmt: skip
    return kl.DHTable("general", convention, links, base=random_pose(rng), tool=random_pose(rng),
                      gravity=rng.uniform(-10, 10, 3))  # fmt: skip


def states_of(n, seed, names="q v a"):
    rng = np.random.default_rng(seed)
    return [{name: rng.uniform(-1.5, 1.5, n) for name in names.split()} for _ in range(2)]


def looked_up(table, seed):
    """For each thing of the oracle and its negative: its name, what is said of it, all things."""
    robot, states = kl.Robot.from_dh(table), states_of(table.n, seed)
    known = [meanings(robot, state) for state in states]
    one, two = (textbook(table, state) for state in states)
    for key, value in one.items():
        for sign, form in ((1.0, ""), (-1.0, "minus")):
            yield key, form, meaning_of(known, [sign * value, sign * two[key]]), one


def same(one, two):
    if np.shape(one) != np.shape(two):
        return False
    return np.abs(np.subtract(one, two)).max() <= 1e-9 * max(np.abs(one).max(), 1e-3)


def alike(key, things):
    """The oracle's other things that have this value, or its negative."""
    value = things[key]
    return [k for k, x in things.items() if k != key and (same(x, value) or same(x, -value))]


def is_true(sense, key, form, things):
    """Whether what is said of a value holds of the oracle's own value of that name."""
    sign = -1.0 if form == "minus" else 1.0
    sign *= -1.0 if sense.form == "minus" else 1.0
    value = things[key].T if sense.form == "transpose" else things[key]
    fits = [
        k for k in things
        if k[0] == sense.what and k[3] == sense.of and sense.number in (None, k[1])
        and sense.frame in ("", k[2]) and same(things[k], sign * value)
    ]  # fmt: skip
    return bool(fits)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("kinds", ["RRPRRR", "RRR", "PRPR"])
def test_each_thing_of_a_general_arm_is_named(convention, kinds):
    named = 0
    for key, form, sense, things in looked_up(general_table(len(kinds), convention, kinds), 2):
        if sense == Sense(*key, form):
            named += 1
        else:  # at the ends of the chain, and next to a slide, two things are one
            plain = np.max(np.abs(things[key] - np.round(things[key]))) < 1e-9  # 0, or (0, 0, 1)
            assert plain or alike(key, things), key
            assert sense is None or is_true(sense, key, form, things), (key, sense)
    assert named > 150 * len(kinds)


@pytest.mark.parametrize(
    "name", ["planar2r", "planar2r_rods", "planar3r", "scara", "stanford", "puma560"]
)
def test_no_word_is_wrong_where_axes_are_parallel_and_numbers_neat(name):
    told = 0
    for key, form, sense, things in looked_up(kl.load(name).table, 5):
        if sense is not None and sense.what in {what for what, *_ in things}:
            assert is_true(sense, key, form, things), (key, sense)
            told += 1
    assert told > 150


@pytest.mark.parametrize("seed", range(2))
def test_no_word_is_wrong_on_arms_with_special_angles(seed):
    told = 0
    for convention in ("standard", "modified"):
        for key, form, sense, things in looked_up(random_table(seed, 5, convention), seed):
            if sense is not None and sense.what in {what for what, *_ in things}:
                assert is_true(sense, key, form, things), (key, sense)
                told += 1
    assert told > 1000


def test_what_is_nothing_has_no_name():
    table, rng = general_table(7, "standard"), np.random.default_rng(7)
    states = states_of(table.n, 7)
    known = [meanings(kl.Robot.from_dh(table), state) for state in states]
    one, two = (textbook(table, state) for state in states)
    for key in one:
        values = [np.asarray(one[key]), np.asarray(two[key])]
        if max(np.max(np.abs(x - np.round(x))) for x in values) < 1e-9:
            continue
        off = [x + 1e-5 * np.max(np.abs(x)) * rng.uniform(0.5, 1.0, x.shape) for x in values]
        assert meaning_of(known, off) is None, key
        assert meaning_of(known, [1.37 * x for x in values]) is None, key
        assert meaning_of(known, [values[0], off[1]]) is None, key  # right at one state only
        assert meaning_of(known, [rng.normal(size=x.shape) for x in values]) is None, key


def test_what_is_plain_or_has_no_number_has_no_name():
    states = states_of(6, 1)
    known = [meanings(kl.load("ur5"), state) for state in states]
    for value in (0.0, 1.0, -2, 0.5, np.pi / 2, E_Z, np.eye(3), np.eye(4), np.zeros(6), 1e-12, np.nan,
                  "w", None, [], [[1.0], [2.0, 3.0]], 3j):  # fmt: skip
        assert meaning_of(known, [value, value]) is None, value
    assert meaning_of([], []) is None
    assert meaning_of(known, [np.ones(3) / 3, np.ones(6) / 3]) is None


def test_an_arm_without_a_table_is_not_known():
    robot = kl.Robot.from_urdf(kl.load("ur5").urdf)
    known = [meanings(robot, state) for state in states_of(6, 0)]
    assert not any(one.things for one in known)
    assert meaning_of(known, [np.ones(3) / 3] * 2) is None
    assert not meanings(kl.load("ur5"), {}).things
    assert not meanings(kl.load("ur5"), {"q": np.zeros((2, 6))}).things
    assert not meanings(kl.load("ur5"), {"q": np.zeros(6), "v": np.zeros((2, 6))}).things


def test_a_plane_arm_is_written_in_the_plane():
    """Two numbers for a vector, one for an angular velocity, (2, 2) and (3, 3) for what turns."""
    table = kl.load("planar3r").table
    robot, states = kl.Robot.from_dh(table), states_of(3, 2)
    known = [meanings(robot, state) for state in states]

    def told(of):
        return meaning_of(known, [np.asarray(of(state["q"], state["v"])) for state in states])

    l1, l2 = (
        kl.jacobian(robot, np.zeros(3))[1, :2] - kl.jacobian(robot, np.zeros(3))[1, 1:]
    ).tolist()

    def elbow(q):
        return l1 * np.array([np.cos(q[0]), np.sin(q[0])])

    def turn(angle):
        return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])

    def transform(q):
        wrist = elbow(q) + l2 * np.array([np.cos(q[0] + q[1]), np.sin(q[0] + q[1])])
        out = np.eye(3)
        out[:2, :2], out[:2, 2] = turn(np.sum(q)), wrist
        return out

    assert told(lambda q, v: elbow(q)) == Sense("origin", 2)
    assert told(lambda q, v: elbow(q)[:, None]) == Sense("origin", 2)
    assert told(lambda q, v: v[0] + v[1]) == Sense("w", 2)
    assert told(lambda q, v: -v[0] - v[1]) == Sense("w", 2, form="minus")
    assert told(lambda q, v: v[0]) == Sense("qd", 1)
    assert told(lambda q, v: turn(q[0] + q[1])) == Sense("R0", 2)
    assert told(lambda q, v: turn(q[1]).T) == Sense("R", 2, form="transpose")
    assert told(lambda q, v: transform(q)) == Sense("T0", 3)
    assert told(lambda q, v: np.cos(q[1] + q[2])) == Sense("cosine", of="q2 + q3")
    assert told(lambda q, v: q[0] + q[1] + q[2]) == Sense("angle", of="q1 + q2 + q3")
    assert told(lambda q, v: l1 * np.cos(q[0]) + v[1]) is None


def test_whole_matrices_are_named():
    table = general_table(3, "modified")
    robot, states = kl.Robot.from_dh(table), states_of(6, 3)
    for state in states:
        state["wrench"] = np.cos(state["q"] + 1.0)
    known = [meanings(robot, state) for state in states]

    def told(of):
        return meaning_of(known, [of(state) for state in states])

    still = np.zeros(6)
    weight = [newton_euler.torques(table, s["q"], still, still) for s in states]
    rates = [newton_euler.torques(table, s["q"], s["v"], still) for s in states]
    masses = [newton_euler.mass_matrix(table, s["q"]) for s in states]
    assert meaning_of(known, masses) == Sense("M")
    assert meaning_of(known, [M[2] for M in masses]) == Sense("M_row", 3)
    assert meaning_of(known, [M[3, 1] for M in masses]) == Sense("M_entry", of="2, 4")
    assert meaning_of(known, [np.linalg.inv(M) for M in masses]) == Sense("M_inverse")
    assert meaning_of(known, weight) == Sense("gravity")
    assert meaning_of(known, np.subtract(rates, weight)) == Sense("C v")
    assert meaning_of(known, [M @ s["a"] for M, s in zip(masses, states, strict=True)]) == Sense(
        "M a"
    )
    assert told(lambda s: s["wrench"][:3]) == Sense("load_force")

    def columns(s):
        axes, points = newton_euler.axes(table, s["q"])
        arms = table.fk(s["q"])[-1][:3, 3] - points
        hinge = np.array([x.joint == "revolute" for x in table.links])[:, None]
        return np.hstack(
            [np.where(hinge, np.cross(axes, arms), axes), np.where(hinge, axes, 0.0)]
        ).T

    assert told(columns) == Sense("J", frame="base")
    assert told(lambda s: columns(s).T) == Sense("J", frame="base", form="transpose")
    assert told(lambda s: np.linalg.inv(columns(s))) == Sense("J_inverse")
    assert told(lambda s: columns(s)[3:]) == Sense("Jw")
    assert told(lambda s: columns(s).T @ s["wrench"]) == Sense("J^T F")
    assert told(lambda s: columns(s) @ s["v"]) == Sense("twist")


def test_what_needs_an_argument_that_is_missing_is_not_known():
    table = general_table(4, "standard")
    robot, states = kl.Robot.from_dh(table), states_of(6, 4)
    full, half = (textbook(table, state)["w", 4, "own", ""] for state in states)
    for names, sense in (("q", None), ("q v", Sense("w", 4, "own"))):
        known = [meanings(robot, {k: s[k] for k in names.split()}) for s in states]
        assert meaning_of(known, [full, half]) == sense
    pushed = [{"q": s["q"], "v": s["v"], "tau": s["a"]} for s in states]
    a = [kl.forward_dynamics(robot, s["q"], s["v"], s["tau"]) for s in pushed]
    assert meaning_of([meanings(robot, s) for s in pushed], a) == Sense("accelerations")


def test_a_mass_of_one_makes_nobody_say_force_for_acceleration():
    table = general_table(5, "standard", "RRR")
    links = [replace(link, mass=1.0) for link in table.links]
    table = replace(table, links=links)
    states = states_of(3, 5)
    known = [meanings(kl.Robot.from_dh(table), state) for state in states]
    for what in ("dvc", "F", "vc", "p"):
        values = [textbook(table, state)[what, 2, "own", ""] for state in states]
        assert meaning_of(known, values) is None


def test_the_arms_own_numbers_are_named_where_no_sum_or_product_meets_them():
    table = general_table(6, "standard", "RRR")
    neat = replace(table, links=[replace(table.links[0], a=0.7, d=0.31), replace(table.links[1], a=0.39),
                                 *table.links[2:]])  # fmt: skip
    for arm, value, sense in (
        (table, table.links[1].a, Sense("cell", 2, of="a")),
        (table, table.links[2].mass, Sense("mass", 3)),
        (neat, 0.7, None),  # 0.31 + 0.39
    ):
        known = [meanings(kl.Robot.from_dh(arm), state) for state in states_of(3, 6)]
        assert meaning_of(known, [value, value]) == sense


def test_it_is_said_in_english_and_chinese():
    with speaking("en"):
        assert said(Sense("w", 2, "own")) == "the angular velocity of link 2 in its own axes"
        assert (
            said(Sense("axis", 2, "base", form="minus")) == "minus the axis of joint 2 in base axes"
        )
        assert said(Sense("f", 3, "before")) == "the force through joint 3 in the axes of frame 2"
        assert (
            said(Sense("R", 2, form="transpose"))
            == "the transpose of the rotation matrix of frame 2 in frame 1"
        )
        assert said(Sense("sine", of="q1 + q2")) == "the sine of q1 + q2"
        assert said(Sense("w")) == "the angular velocity of a link"
    with speaking("zh"):
        assert said(Sense("w", 2, "own")) == "连杆 2的角速度（用自身坐标系表示）"
    for what in PHRASES:
        for number in (None, 2):
            for spoken in ("en", "zh"):
                with speaking(spoken):
                    text = said(Sense(what, number, "next", "x", "minus"))
                assert "{" not in text and "None" not in text
                assert text.isascii() == (spoken == "en")


def test_every_phrase_is_of_something_that_is_known():
    found = set()
    tables = [general_table(1, "standard"), kl.load("planar2r").table]
    for table in tables:
        state = states_of(table.n, 0)[0] | {"wrench": np.ones(6)}
        for rows, values in meanings(kl.Robot.from_dh(table), state).things.values():
            assert len(rows) == len(values)
            found |= {sense.what for _, sense in rows}
    linkage = linkage_meanings(kl.FiveBar.load("isotropic"), FIVE_BAR_STATE)
    for rows, values in linkage.things.values():
        assert len(rows) == len(values)
        found |= {sense.what for _, sense in rows}
    assert found == set(PHRASES)


FIVE_BAR_STATE = {
    "xy": np.array([0.05, -0.55]), "v": np.array([0.3, -0.2]), "a": np.array([1.0, 2.0]),
    "mode": np.array([1.0, -1.0]),
}  # fmt: skip


def test_a_five_bars_bars_rates_and_torques_are_known_by_the_notes_names() -> None:
    """From the triangles of the legs, with nothing of kinlab's."""
    l1, l2, e = 0.3, 0.5, 0.2 / np.sqrt(2)
    known = linkage_meanings(kl.FiveBar.load("isotropic"), FIVE_BAR_STATE)

    def named(value) -> set[str]:
        rows, gaps = known.gaps(np.asarray(value, dtype=float))
        return {rows[k][1].of for k in np.flatnonzero(gaps <= 1e-9)}

    rates = np.empty(2)
    for i, (base, mode) in enumerate(zip((e, -e), FIVE_BAR_STATE["mode"], strict=True)):
        leg, away = str(i + 1), FIVE_BAR_STATE["xy"] - [base, 0.0]
        r = np.hypot(*away)
        inner = np.arccos((l1**2 + r**2 - l2**2) / (2 * l1 * r))
        for theta in np.arctan2(away[1], away[0]) + inner * np.array([1, -1]):
            u = np.array([np.cos(theta), np.sin(theta)])
            w = (away - l1 * u) / l2
            if np.sign(u[0] * w[1] - u[1] * w[0]) == mode:
                break
        assert f"u_{leg}" in named(u) and f"w_{leg}" in named(w)
        assert f"elbow {leg}" in named([base + l1 * u[0], l1 * u[1]])
        assert f"A_{leg}" in named(2 * l1 * -away[0])
        rates[i] = (w @ FIVE_BAR_STATE["v"]) / (l1 * (u[0] * w[1] - u[1] * w[0]))
    assert "thetad" in named(rates)
    assert not named([0.123, 0.456])


def test_angles_and_rates_of_a_plane_arm_are_about_the_bases_axis() -> None:
    arm = kl.DHTable(
        name="turned over", convention="standard",
        links=[kl.DHLink("revolute", a=0.5, alpha=np.pi, mass=1.0),
               kl.DHLink("revolute", a=0.4, theta=0.3, flip=True, mass=1.0),
               kl.DHLink("revolute", a=0.3, mass=1.0)],
    )  # fmt: skip
    robot, q, v = kl.Robot.from_dh(arm), np.array([0.3, -0.8, 1.1]), np.array([0.7, 0.4, -0.9])
    known = meanings(robot, {"q": q, "v": v})
    turned, rate = kl.fk(robot, q)[:3, :3], (kl.jacobian(robot, q) @ v)[5]
    rows, values = known.things[(3,)]
    told = {sense.what: value for (_rank, sense), value in zip(rows, values, strict=True)}
    # the second link's frame lies upside down: its x axis tells how far it is turned
    assert np.isclose(np.cos(told["angles"][-1]), turned[0, 0])
    assert np.isclose(np.sin(told["angles"][-1]), turned[1, 0])
    assert np.isclose(told["rates"][-1], rate)
