"""Inverse kinematics by hand: right where Pinocchio's forward kinematics brings the target back."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

import kinlab as kl
from kinlab.check.quantities.registry import quantity
from kinlab.doctor.file import examine_formulas, robot_of
from kinlab.errors import ExpressionError
from kinlab.formulas.files import formula_file

XY, XYPHI = "inverse_kinematics_xy", "inverse_kinematics_xyphi"


def elbow_arm_of(
    l1: float = 0.5,
    l2: float = 0.4,
    cosine: Callable[..., Any] = lambda r2, a, b: (r2 - a * a - b * b) / (2 * a * b),
    first: Callable[..., Any] = np.arctan2,
    inner: Callable[..., Any] = lambda a, b, s, c: math.atan2(b * s, a + b * c),
    sense: float = -1.0,
    sine: Callable[..., Any] = lambda c: np.sqrt(1 - c * c),
) -> Callable[..., Any]:
    """The planar 2R arm by the cosine law, each line to be spoilt."""

    def solve(x: float, y: float, elbow: float) -> tuple[float, float]:
        with np.errstate(all="ignore"):
            c = cosine(x * x + y * y, l1, l2)
            s = elbow * sine(c)
            return first(y, x) + sense * inner(l1, l2, s, c), np.arctan2(s, c)

    return solve


def both(solve: Callable[..., Any]) -> Callable[..., Any]:
    return lambda x, y: [solve(x, y, 1.0), solve(x, y, -1.0)]


@pytest.mark.parametrize(
    ("function", "branches"),
    [
        (elbow_arm_of(), "2 solutions of each of 60 targets"),
        (both(elbow_arm_of()), "2 solutions of each of 60 targets"),
        (lambda x, y: elbow_arm_of()(x, y, -1.0), "1 solution of each of 60 targets"),
        (lambda x, y: np.add(elbow_arm_of()(x, y, 1.0), [2 * np.pi, -2 * np.pi]), "gives 1"),
    ],
)
def test_a_right_solution_is_right_on_any_branch(function: Any, branches: str) -> None:
    found = kl.diagnose("planar2r", XY, function, samples=60)
    assert found.agrees
    assert branches in found.sentence
    assert kl.compare("planar2r", XY, function, samples=60).agrees


SLIPS = [
    ({"first": lambda y, x: np.arctan2(x, y)}, "atan2(x, y) for atan2(y, x)"),
    ({"first": lambda y, x: np.arctan(y / x)}, "atan(y/x) for atan2(y, x) (the quadrant is lost)"),
    ({"sense": 1.0}, "atan2(l2*s2, l1 + l2*c2) with the opposite sign in the angle q1"),
    ({"inner": lambda a, b, s, c: math.atan2(a * s, b + a * c)}, "l1 and l2 exchanged"),
    ({"inner": lambda a, b, s, c: math.atan2(b * s, a + b)}, "leaves the factor c2 out of l2*c2"),
    (
        {"cosine": lambda r2, a, b: (a * a + b * b - r2) / (2 * a * b)},
        "with the opposite sign in the cosine of q2",
    ),
    ({"cosine": lambda r2, a, b: (r2 - a * a - b * b) / (a * b)}, "l1 for 2*l1 (the factor)"),
    (
        {"cosine": lambda r2, a, b: np.clip((r2 - a * a - b * b) / (a * b), -1, 1)},
        "l1 for 2*l1 (the factor)",
    ),
    ({"cosine": lambda r2, a, b: (r2 - a * a - b * b) / 2 * a * b}, "/2*l1*l2 for"),
    ({"sine": lambda c: 1 - c * c}, "leaves the root out"),
]


@pytest.mark.usefixtures("without_lines")
@pytest.mark.parametrize(("spoilt", "words"), SLIPS)
def test_a_slip_of_the_cosine_law_is_named(spoilt: dict[str, Any], words: str) -> None:
    found = kl.diagnose("planar2r", XY, both(elbow_arm_of(**spoilt)), samples=60)
    assert not found.agrees
    assert words in found.sentence
    assert found.causes[0].error_after <= 1e-9


@pytest.mark.usefixtures("without_lines")
def test_one_branch_right_and_the_other_not() -> None:
    def mixed(x: float, y: float) -> Any:
        one, two = both(elbow_arm_of())(x, y)
        return [one, (one[0], two[1])]

    found = kl.diagnose("planar2r", XY, mixed, samples=60)
    assert found.causes[0].kinds == ("branches mixed",)
    assert "in solution 2; the others are right" in found.sentence

    def lost(x: float, y: float) -> Any:
        one, two = both(elbow_arm_of())(x, y)
        return [one, (two[0] + 0.1 * x, two[1])]

    found = kl.diagnose("planar2r", XY, lost, samples=60)
    assert found.verdict == "differs, cause unknown"
    assert "solution 1: right at 60 of 60 targets" in found.proved
    assert "solution 2: right at 0 of 60 targets" in found.proved


@pytest.mark.usefixtures("without_lines")
def test_degrees_none_and_an_acos_without_a_value() -> None:
    solve = elbow_arm_of()
    found = kl.diagnose("planar2r", XY, lambda x, y: np.degrees(solve(x, y, 1.0)), samples=60)
    assert "answers in degrees" in found.sentence
    found = kl.diagnose(
        "planar2r", XY, lambda x, y: solve(x, y, 1.0) if x > 0 else None, samples=60
    )
    (x, _y) = quantity(XY).states(kl.load("planar2r"), 60, 0)
    assert f"no solution at {np.sum(x <= 0)} of 60 targets" in found.sentence

    def by_math(x: float, y: float) -> tuple[float, float]:
        q2 = math.acos((x * x + y * y - 0.41) / 0.2)
        return math.atan2(y, x) - math.atan2(0.4 * math.sin(q2), 0.5 + 0.4 * math.cos(q2)), q2

    assert "(the factor) in the cosine of q2" in kl.diagnose("planar2r", XY, by_math).sentence


@pytest.mark.parametrize(
    ("half_turn", "verdict"),
    [(3.14159265, "agrees to its digits"), (3.1416, "agrees, with rounded numbers")],
)
def test_a_rounded_constant_is_no_slip(half_turn: float, verdict: str) -> None:
    def solve(x: float, y: float) -> tuple[float, float]:
        inner = math.acos((0.41 - x * x - y * y) / 0.4)
        lean = math.acos((x * x + y * y + 0.09) / math.hypot(x, y))
        return math.atan2(y, x) - lean, half_turn - inner

    assert kl.diagnose("planar2r", XY, solve, samples=60).verdict == verdict


def test_beyond_reach_a_limited_cosine_answers_too() -> None:
    limited = elbow_arm_of(cosine=lambda r2, a, b: np.clip((r2 - a**2 - b**2) / (2 * a * b), -1, 1))
    found = kl.diagnose("planar2r", XY, limited, samples=60)
    assert found.agrees
    assert "beyond reach it answers as well" in found.sentence
    assert "beyond reach" not in kl.diagnose("planar2r", XY, elbow_arm_of(), samples=60).sentence


def wrist_arm(
    x: float, y: float, phi: float, elbow: float, back: float = 0.25, last: float = -1.0
) -> Any:
    q1, q2 = elbow_arm_of()(x - back * np.cos(phi), y - back * np.sin(phi), elbow)
    return q1, q2, phi - q1 + last * q2


def scara(
    x: float, y: float, z: float, phi: float, elbow: float, down: float = 1, turn: float = 1
) -> Any:
    q1, q2 = elbow_arm_of(0.325, 0.275)(x, y, elbow)
    return q1, q2, down * (0.387 - z), turn * (q1 + q2 - phi)


def turned_hand(x: float, y: float, z: float, asin: bool = False) -> Any:
    rows = []
    for front in (1.0, -1.0):
        with np.errstate(all="ignore"):
            s3 = z / 0.3
            c3 = front * np.sqrt(1 - s3 * s3)
            q3 = np.arcsin(s3) if asin else np.arctan2(s3, c3)
        rows += [(*q, q3) for q in both(elbow_arm_of(0.45, 0.35 + 0.3 * c3))(x, y)]
    return rows


@pytest.mark.usefixtures("without_lines")
@pytest.mark.parametrize(
    ("robot", "name", "right", "wrong", "words"),
    [
        ("planar3r", XYPHI, wrist_arm, {"last": 1.0}, "q2 with the opposite sign in the angle q3"),
        ("planar3r", XYPHI, wrist_arm, {"back": 0.0}, "leaves l3 out in every line"),
        ("scara", "inverse_kinematics_xyzphi", scara, {"down": -1}, "the way of the slide with"),
        ("scara", "inverse_kinematics_xyzphi", scara, {"turn": -1}, "the angle q4 with the opp"),
        ("spatial3r", "inverse_kinematics_xyz", turned_hand, {"asin": True}, "asin(s3) for atan2"),
    ],
)
def test_arms_of_three_and_four_joints(
    robot: str, name: str, right: Any, wrong: dict[str, Any], words: str
) -> None:
    assert kl.diagnose(robot, name, right, samples=40).agrees

    def spoilt(*given: Any, elbow: float | None = None) -> Any:
        return right(*given, **wrong)

    function: Any = spoilt
    if robot != "spatial3r":

        def function(*given: Any) -> Any:
            return [right(*given, side, **wrong) for side in (1.0, -1.0)]

    found = kl.diagnose(robot, name, function, samples=40)
    assert not found.agrees
    assert words in found.sentence


def slide_on_hinge(tmp_path: Any) -> Any:
    path = tmp_path / "slider.toml"
    path.write_text(
        'name = "slider"\nconvention = "standard"\nsource = "a hinge with a slide across it"\n'
        "links = [\n"
        '  { joint = "revolute", a = 0.1, alpha = "pi/2", d = 0, theta = 0, lower = "-pi",'
        ' upper = "pi", mass = 1 },\n'
        '  { joint = "prismatic", a = 0, alpha = 0, d = 0, theta = 0, lower = 0.3, upper = 0.9,'
        " mass = 1 },\n]\n"
    )
    return kl.load(path)


def test_a_slide_on_a_hinge(tmp_path: Any) -> None:
    robot = slide_on_hinge(tmp_path)

    def solve(x: float, y: float, offset: float = 0.1) -> tuple[float, float]:
        d = math.sqrt(x * x + y * y - offset**2)
        return math.atan2(y, x) - math.atan2(0.1, d) + math.pi / 2, d

    assert kl.diagnose(robot, XY, solve, samples=40).agrees
    found = kl.diagnose(robot, XY, lambda x, y: solve(x, y, 0.0), samples=40)
    assert "`return solve(x, y, 0.0)` should be `return solve(x, y, 0.1)`" in found.sentence
    found = kl.diagnose(robot, XY, partial(solve, offset=0.0), samples=40)
    assert "leaves e**2 out in side*sqrt(x**2 + y**2 - e**2)" in found.sentence


def puma(pose: Any, shoulder: float = 1.0, kept: float = 1.0) -> list[Any]:
    """The first three angles by Craig's section 4.7; the wrist from the rotation that is left."""
    a2, a3, d3, d4 = 0.4318, 0.0203, 0.15005, 0.4318
    (px, py, pz), rotation, robot = pose[:3, 3], pose[:3, :3], kl.load("puma560_modified")
    rows = []
    for front in (1.0, -1.0):
        q1 = math.atan2(py, px) + shoulder * math.atan2(
            d3, front * math.sqrt(px**2 + py**2 - d3**2)
        )
        k = (px**2 + py**2 + pz**2 - a2**2 - a3**2 - kept * d3**2 - d4**2) / (2 * a2)
        for elbow in (1.0, -1.0):
            with np.errstate(all="ignore"):
                q3 = math.atan2(a3, d4) - np.arctan2(k, elbow * np.sqrt(a3**2 + d4**2 - k * k))
            c1, s1, c3, s3 = np.cos(q1), np.sin(q1), np.cos(q3), np.sin(q3)
            r = c1 * px + s1 * py
            up, out = a3 + a2 * c3, d4 - a2 * s3
            q23 = np.arctan2(up * pz - out * r, out * pz + up * r)
            for wrist in (1.0, -1.0):
                c23, s23 = np.cos(q23), np.sin(q23)
                x, y = (
                    c1 * rotation[0, 2] + s1 * rotation[1, 2],
                    s1 * rotation[0, 2] - c1 * rotation[1, 2],
                )
                q4 = np.arctan2(wrist * y, wrist * (-x * c23 - rotation[2, 2] * s23))
                if not np.isfinite(q4):
                    continue
                held = kl.fk(robot, np.array([q1, q23 - q3, q3, q4, 0.0, 0.0]))[:3, :3]
                left = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]) @ held.T @ rotation
                q5, q6 = np.arctan2(-left[0, 2], left[1, 2]), np.arctan2(-left[2, 0], -left[2, 1])
                rows.append((q1, q23 - q3, q3, q4, q5, q6))
    return rows


def test_the_puma_with_its_wrist() -> None:
    found = kl.diagnose("puma560_modified", "inverse_kinematics", puma, samples=12)
    assert found.agrees
    assert "8 solutions of each of 12 targets" in found.sentence
    found = kl.diagnose(
        "puma560_modified", "inverse_kinematics", lambda pose: puma(pose, kept=0.0), samples=12
    )
    assert "leaves d3**2 out in Craig's K" in found.sentence


def judged(robot: str, symbols: dict[str, str], **formulas: str) -> Any:
    file = formula_file({"robot": robot, "symbols": symbols, "formulas": formulas}, "hand in")
    (found,) = examine_formulas(file, robot_of(file), 60, 0)
    return found


D = {"D": "(x^2 + y^2 - l1^2 - l2^2)/(2*l1*l2)"}


def test_joint_angles_as_text() -> None:
    first = "atan2(y, x) - atan2(l2*s2, l1 + l2*c2)"
    assert "gives 1" in judged("planar2r", D, q1=first, q2="acos(D)").sentence
    found = judged("planar2r", D, q1=first, theta2="elbow*acos(D)")
    assert found.agrees
    assert "2 solutions of each of 60 targets" in found.sentence
    found = judged("planar2r", D, q1="atan(y/x) - atan2(l2*s2, l1 + l2*c2)", q2="acos(D)")
    assert "atan(y/x) for atan2(y, x)" in found.sentence


@pytest.mark.parametrize(
    ("formulas", "words"),
    [
        ({"q2": "acos(D)"}, "q1 is missing"),
        ({"q1": "q2", "q2": "q1"}, "stand on each other"),
        ({"q1": "x", "q2": "acos(D)", "q3": "y"}, "the arm has 2 joints"),
        ({"q1": "x + z", "q2": "y"}, "'z' is unknown"),
    ],
)
def test_texts_that_are_no_solution_are_refused(formulas: dict[str, str], words: str) -> None:
    with pytest.raises(ExpressionError, match=words):
        judged("planar2r", D, **formulas)


@pytest.mark.parametrize("beyond", [0.895, 0.8999])
def test_what_is_wrong_only_near_the_limit_of_reach_is_seen(beyond: float) -> None:
    right = elbow_arm_of()
    limited = lambda x, y: np.add(right(x, y, 1.0), 0.1 * (np.hypot(x, y) > beyond))  # noqa: E731
    assert not kl.diagnose("planar2r", XY, limited).agrees


def test_rounded_answers_are_right_to_their_digits_and_complex_ones_are_no_solution() -> None:
    rounded = kl.diagnose("planar2r", XY, lambda x, y: np.round(elbow_arm_of()(x, y, 1.0), 4))
    assert (rounded.agrees, rounded.form) == (True, "rounded")
    assert "4 decimals" in str(rounded)
    off = lambda x, y: np.add(elbow_arm_of()(x, y, 1.0), 0.1j)  # noqa: E731
    told = kl.diagnose("planar2r", XY, off)
    assert not told.agrees
    assert "right at 0 of 200 targets" in told.sentence


FIRST = "atan2(y, x) - atan2(l2*sin(q2), l1 + l2*cos(q2))"
INNER = "acos((l1^2 + l2^2 - x^2 - y^2)/(2*l1*l2))"


@pytest.mark.parametrize(
    ("robot", "lines", "said"),
    [
        ("planar2r", {"q1": FIRST, "q2": f"3.1416 - {INNER}"}, "3.1416 stands for pi"),
        ("planar2r", {"q1": FIRST, "q2": f"elbow*(3.14 - {INNER})"}, "3.14 stands for pi"),
        (
            "scara",
            {
                "q1": "atan2(y, x) - atan2(0.275*s2, 0.325 + 0.275*c2)",
                "q2": "acos((x^2 + y^2 - 0.181)/0.179)",
                "q3": "0.387 - z",
                "q4": "q1 + q2 - phi",
            },
            "0.181 stands for 0.18125",
        ),
    ],
)
def test_a_text_with_rounded_numbers_is_right(robot: str, lines: dict[str, str], said: str) -> None:
    found = judged(robot, {}, **lines)
    assert (found.agrees, found.form) == (True, "rounded")
    assert said in found.sentence


@pytest.mark.parametrize(
    ("first", "second", "said"),
    [
        (FIRST, "asin(D)", "asin(c2) for acos(c2)"),
        (FIRST, "acos((x^2 + y^2 - 0.4)/0.4)", "q2: 0.4 should be 0.41"),
        (FIRST, "acos((x^2 + y^2 - 0.4)/(2*l1*l2))", "q2: 0.4 should be 0.41"),
        (FIRST, "acos((x^2 + y^2 - 0.41)/0.5)", "q2: 0.5 should be 0.4"),
        (FIRST, f"3.15 - {INNER}", "q2: 3.15 should be pi"),
        (FIRST, f"180 - {INNER}", "q2: 180 should be pi"),
        ("atan2(y, x) - atan2(0.3*s2, 0.5 + 0.4*c2)", "acos(D)", "q1: 0.3 should be 0.4"),
    ],
)
def test_only_the_line_that_is_wrong_is_accused(first: str, second: str, said: str) -> None:
    found = judged("planar2r", D, q1=first, q2=second)
    assert not found.agrees
    assert said in found.sentence
    assert ("q1" in found.sentence) == (first != FIRST)
    assert len(found.causes[0].kinds) == 1


@pytest.mark.parametrize(
    ("first", "second", "joint"),
    [
        ("atan2(y, x) + atan2(l2*sin(q2), l1 + l2*cos(q2))", "acos({law})", "q1"),
        ("atan2(y, x) - atan2(l2*sin(q2), l1 + l1*cos(q2))", "acos({law})", "q1"),
        ("atan2(y, x) - atan2(l2*sin(q2), l1 + l2*cos(q2))", "-acos({law}) + pi/2", "q2"),
    ],
)
def test_the_place_of_a_cause_is_the_joint_whose_line_it_is_in(
    first: str, second: str, joint: str
) -> None:
    law = "(x**2 + y**2 - l1**2 - l2**2)/(2*l1*l2)"
    found = judged("planar2r", {}, q1=first, q2=second.format(law=law))
    assert found.causes[0].places == (joint,)


def test_numbers_alone_give_no_cause_by_their_values() -> None:
    found = judged("planar2r", {}, q1=FIRST, q2="acos((x^2 + y^2 - 0.16)/0.5)")
    assert (found.agrees, found.causes) == (False, ())


def test_one_sign_of_a_sum_is_one_slip() -> None:
    def added(x: float, y: float, phi: float) -> Any:
        q1, q2, _q3 = wrist_arm(x, y, phi, 1.0)
        return q1, q2, phi + (q1 + q2)

    found = kl.diagnose("planar3r", XYPHI, added, samples=40)
    assert found.causes[0].kinds == ("sign",)
    assert "q1 + q2 with the opposite sign in the angle q3" in found.sentence


@pytest.mark.usefixtures("without_lines")
def test_a_constant_that_is_forgotten_in_one_joint() -> None:
    def flipped(pose: Any) -> Any:
        q = np.array(puma(pose)[0])
        # the wrist the other way is (q4 + pi, -q5, q6 + pi)
        return [q, q * [1, 1, 1, 1, -1, 1] + [0, 0, 0, 0, 0, np.pi]]

    found = kl.diagnose("puma560_modified", "inverse_kinematics", flipped, samples=12)
    assert len(found.causes) == 1
    assert "q4 is off by a constant: with pi added it is right (in solution 2" in found.sentence
    found = kl.diagnose(
        "scara",
        "inverse_kinematics_xyzphi",
        lambda *given: np.add(scara(*given, 1.0), [0, 0, 0, np.pi / 2]),
    )
    assert "q4 is off by a constant: with -pi/2 added" in found.sentence


def test_a_branch_that_is_given_twice_is_one_solution() -> None:
    solve = elbow_arm_of()
    twice = lambda x, y: [solve(x, y, 1.0), np.add(solve(x, y, 1.0), 2 * np.pi)]  # noqa: E731
    found = kl.diagnose("planar2r", XY, twice, samples=60)
    assert found.agrees
    assert "1 solution of each of 60 targets" in found.sentence


def test_answers_that_are_no_rows_are_refused_in_plain_words() -> None:
    for answer in ([(0.1, 0.2), None], [(0.1, 0.2), (0.1,)], {"up": (0.1, 0.2)}):
        with pytest.raises(kl.KinlabError, match="rows of 2 numbers; a solution that does not"):
            kl.diagnose("planar2r", XY, lambda x, y, answer=answer: answer, samples=20)


SOLVED = """c2 = (x^2 + y^2 - l1^2 - l2^2)/(2*l1*l2)
s2 = sqrt(1 - c2^2)
q1 = atan2(y, x) - atan2(l2*s2, l1 + l2*c2)
q2 = atan2(s2, c2)"""


def test_a_whole_solution_may_be_several_lines() -> None:
    found = kl.diagnose("planar2r", XY, SOLVED, samples=60)
    assert found.agrees and "of the 2 branches of the closed form it gives 1" in found.remarks
    assert not kl.diagnose("planar2r", XY, "q1 = atan2(y, x)\nq2 = 0", samples=60).agrees


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("- l1^2 - l2^2", "+ l1^2 - l2^2", "l1**2 with the opposite sign in the cosine of q2"),
        ("1 - c2^2", "1 + c2^2", "c2**2 with the opposite sign in the sine of q2"),
        ("l2*s2, l1", "l1*s2, l1", "l1 for l2 in atan2(l2*s2, l1 + l2*c2), in the angle q1"),
        ("l1 + l2*c2", "l2 + l1*c2", "l1 and l2 exchanged in l1 + l2*c2, in the angle q1"),
        ("atan2(s2, c2)", "atan2(c2, s2)", "atan2(c2, s2) for atan2(s2, c2)"),
    ],
)
def test_a_slip_in_one_of_its_lines_is_told(old, new, told) -> None:
    assert SOLVED.count(old) == 1
    found = kl.diagnose("planar2r", XY, SOLVED.replace(old, new), samples=60)
    assert found.causes and told in found.causes[0].sentence, str(found)


def clipped(most: float, l1: float, l2: float, jump: float = np.inf) -> Callable[..., Any]:
    """Two links with a cosine that is cut off, or q1 off by 0.1 beyond a distance."""

    def solve(x: float, y: float) -> tuple[float, float]:
        c = min(most, (x * x + y * y - l1 * l1 - l2 * l2) / (2 * l1 * l2))
        q2 = math.acos(max(-1.0, min(1.0, c)))
        inner = math.atan2(l2 * math.sin(q2), l1 + l2 * math.cos(q2))
        return math.atan2(y, x) - inner + 0.1 * (math.hypot(x, y) > jump), q2

    return solve


@pytest.mark.parametrize(("most", "jump"), [(0.99, np.inf), (1.0, 0.9944)])
def test_what_is_cut_off_near_the_limit_of_reach_is_wrong(most: float, jump: float) -> None:
    def wrist(x: float, y: float, phi: float) -> Any:
        q1, q2 = clipped(most, 0.5, 0.4, 0.9 * jump)(
            x - 0.25 * math.cos(phi), y - 0.25 * math.sin(phi)
        )
        return q1, q2, phi - q1 - q2

    def slid(x: float, y: float, z: float, phi: float) -> Any:
        q1, q2 = clipped(most, 0.325, 0.275, 0.6 * jump)(x, y)
        return q1, q2, 0.387 - z, q1 + q2 - phi

    def hand(x: float, y: float, z: float) -> Any:
        q3 = math.asin(z / 0.3)
        length = 0.35 + 0.3 * math.cos(q3)
        try:
            return *clipped(most, 0.45, length, (0.45 + length) * jump)(x, y), q3
        except ValueError:
            return None

    for robot, name, function in (
        ("planar2r", XY, clipped(most, 0.5, 0.4, 0.9 * jump)),
        ("planar3r", XYPHI, wrist),
        ("scara", "inverse_kinematics_xyzphi", slid),
        ("spatial3r", "inverse_kinematics_xyz", hand),
    ):
        assert kl.diagnose(robot, name, function).verdict.startswith("differs")


def test_the_wrong_line_of_a_function_with_both_solutions() -> None:
    def both(px, py, l1=0.5, l2=0.4):
        c2 = (px**2 + py**2 - l1**2 - l2**2) / (2 * l1 * l2)
        rows = []
        for elbow in (1, -1):
            s2 = elbow * np.sqrt(1 - c2**2)
            rows.append(
                [np.arctan2(py, px) + np.arctan2(l2 * s2, l1 + l2 * c2), np.arctan2(s2, c2)]
            )
        return np.array(rows)

    found = kl.diagnose("planar2r", "inverse_kinematics_xy", both, samples=20)
    assert "opposite sign in the angle q1" in found.sentence
    assert "should be `[np.arctan2(py, px) - np.arctan2(" in found.sentence
