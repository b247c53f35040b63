"""Right formulas are never called wrong: rounded numbers, numbers for names, other valid forms."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.file import examine_file

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts" / "bench"
ARM = kl.load("planar2r")


def judge(tmp_path: Path, robot: str = "planar2r", symbols: str = "", **formulas: str):
    file = tmp_path / "f.toml"
    lines = [f'"{name}" = "{text}"' for name, text in formulas.items()]
    head = [f'robot = "{robot}"', "[symbols]", symbols, "[formulas]"]
    file.write_text("\n".join([*head, *lines]) + "\n")
    return examine_file(file, samples=40)[0]


@pytest.mark.parametrize(
    ("entry", "text", "said"),
    [
        ("g2", "m2*9.8*l2*c12", "9.8 stands for g = 9.81"),
        ("g2", "m2*10*l2*c12", "10 stands for g = 9.81"),
        ("g2", "m2*9.80665*l2*c12", "9.80665 stands for g = 9.81"),
        ("g2", "5.89*cos(q1+q2)", "5.89 stands for 5.886"),
        ("g2", "m2*g*l2*sin(1.5708 - q1 - q2)", "1.5708 stands for pi/2"),
        ("g2", "m2*g*l2*sin(3.1416/2 - q1 - q2)", "3.1416 stands for pi"),
    ],
)
def test_rounded_numbers_are_named(tmp_path: Path, entry: str, text: str, said: str) -> None:
    found = judge(tmp_path, **{entry: text})
    assert found.grade == "right with rounded numbers"
    assert any(said in remark for remark in found.remarks)


def test_a_third_is_not_a_quarter(tmp_path: Path) -> None:
    assert judge(tmp_path, "planar2r_rods", M22="0.333*m2*l2**2").form == "rounded"
    assert not judge(tmp_path, "planar2r_rods", M22="0.3*m2*l2**2 + 0.1*m2*l2**2").agrees
    assert not judge(tmp_path, "planar2r_rods", M22="0.34*m2*l2**2").agrees
    assert not judge(tmp_path, "planar2r_rods", M22="0.25*m2*l2**2").agrees


@pytest.mark.parametrize("text", ["m2*9.7*l2*c12", "5.87*c12", "5.8861*c12", "m2*9.8*l2*c1",
                                  "m2*9.8*l2*s12", "1.4*9.81*0.4*c12", "2*9.8*l2*c12"])  # fmt: skip
def test_a_slip_does_not_hide_behind_rounding(tmp_path: Path, text: str) -> None:
    assert judge(tmp_path, g2=text).grade == "wrong"


@pytest.mark.parametrize("text", ["1.5*0.16*1.001", "1.501*0.16", "0.24*0.999", "m2*0.16*1.005",
                                  "m2*l2**2*0.995", "1.5*0.1602", "0.99*m2*0.16"])  # fmt: skip
def test_an_error_is_not_laid_into_an_exact_number(tmp_path: Path, text: str) -> None:
    assert judge(tmp_path, M22=text).grade == "wrong"


def test_an_error_is_not_laid_into_another_term(tmp_path: Path) -> None:
    text = "1.000*m1*l1**2 + 1.000*m2*l1**2 + 1.001*m2*l2**2 + 2.000*m2*l1*l2*c2"
    assert judge(tmp_path, M11=text).grade == "wrong"
    right = text.replace("1.001", "1.000").replace("m2*l1*l2", "0.3000")
    assert judge(tmp_path, M11=right).agrees


@pytest.mark.parametrize("text", ["1.5*0.4*9.8*c12", "0.60*9.8*c12", "9.82*0.6*c12", "m2*3.92*c12",
                                  "(1.5708/3.1416)*2*m2*9.8*l2*c12"])  # fmt: skip
def test_numbers_beside_exact_ones_are_rounded(tmp_path: Path, text: str) -> None:
    assert judge(tmp_path, g2=text).form == "rounded"


def test_two_numbers_in_one_term_are_both_rounded(tmp_path: Path) -> None:
    found = judge(tmp_path, "planar2r_rods", M22="0.33*1.5*0.16")
    only = "but it holds only for I2 = 0.02 and l2 = 0.4 and m2 = 1.5"
    assert found.remarks == ("0.33 stands for 1/3", only)
    both = judge(tmp_path, "planar2r_rods", g2="0.5*m2*0.4*9.8*c12*3.14/3.14159")
    assert "3.14 stands for pi" in both.remarks
    assert "9.8 stands for g = 9.81" in both.remarks


def test_numbers_for_names_hold_for_one_robot_only(tmp_path: Path) -> None:
    found = judge(tmp_path, M11="(m1+m2)*0.25 + m2*l2**2 + 2*m2*l1*l2*c2")
    assert found.grade == "right"
    assert found.remarks == ("but it holds only for l1 = 0.5",)
    again = judge(tmp_path, M11="(m1+m2)*0.5**2 + m2*0.4**2 + 2*m2*0.5*l2*c2")
    assert again.remarks == ("but it holds only for l1 = 0.5 and l2 = 0.4",)
    assert not judge(tmp_path, M11="(m1+m2)*l1/2 + m2*l2**2 + 2*m2*l1*l2*c2").agrees


def test_symbols_with_rounded_numbers(tmp_path: Path) -> None:
    found = judge(tmp_path, symbols="g = 9.8", g2="m2*g*l2*c12")
    assert found.form == "rounded"
    assert "g = 9.8 stands for 9.81" in found.remarks
    assert not judge(tmp_path, symbols="g = 9.8", g2="m2*g*l2*s12").agrees


def test_rounded_angles_in_the_robots_data() -> None:
    links = [replace(link, alpha=1.5708 if k == 2 else link.alpha)
             for k, link in enumerate(kl.load("spatial3r").table.links)]  # fmt: skip
    exact = kl.load("spatial3r")
    typed = kl.Robot.from_dh(replace(kl.load("spatial3r").table, links=links))
    found = kl.diagnose(typed, "fk", lambda q: kl.fk(exact, q), samples=20)
    assert found.grade == "right with rounded numbers"
    assert "alpha of link 3" in found.remarks[0]


def test_another_valid_c(tmp_path: Path) -> None:
    h = "m2*l1*l2*s2"
    rows = {"C11": f"-2*{h}*qd2", "C12": f"-{h}*qd2", "C21": f"{h}*qd1", "C22": "0"}
    found = judge(tmp_path, **rows)
    assert found.grade == "right but written unusually"
    assert "Mdot - 2C is not skew-symmetric" in found.remarks[0]
    assert not judge(tmp_path, **{**rows, "C12": f"-2*{h}*qd2"}).agrees

    def split(q, v):
        other = np.outer(np.cos(q), [-v[1], v[0]])
        return kl.coriolis_matrix(ARM, q, v) + other

    assert kl.diagnose(ARM, "coriolis_matrix", split).form == "unusual"


def test_a_potential_with_another_zero(tmp_path: Path) -> None:
    found = judge(tmp_path, V="m1*g*l1*(1 + s1) + m2*g*(l1*s1 + l2*s12 + 3)")
    assert found.form == "unusual"
    assert "another zero" in found.remarks[0]
    assert not judge(tmp_path, V="m1*g*l1*(1 - s1) + m2*g*(l1*s1 + l2*s12)").agrees
    energy = kl.diagnose(ARM, "kinetic_energy", lambda q, v: kl.kinetic_energy(ARM, q, v) + 2)
    assert not energy.agrees


def test_functions_with_rounded_numbers() -> None:
    puma = kl.load("puma560")
    weight = kl.diagnose(
        puma, "gravity_torques", lambda q: kl.gravity_torques(puma, q) * 9.8 / 9.81
    )
    assert weight.remarks == ("g = 9.8 stands for 9.81",)
    mass = kl.diagnose("planar2r_rods", "mass_matrix[0,0]", lambda q: 0.6217 + 0.3 * np.cos(q[1]))
    assert mass.grade == "right with rounded numbers"
    much = kl.diagnose(ARM, "gravity_torques", lambda q: kl.gravity_torques(ARM, q) * 9.5 / 9.81)
    assert not much.agrees


@pytest.mark.parametrize("factor", [1.001, 0.999, 0.99, 1.005, 0.9995])
def test_a_function_that_is_off_by_a_factor_is_not_rounded(factor: float) -> None:
    one = kl.diagnose(ARM, "gravity_torques[1]", lambda q: factor * 5.886 * np.cos(q[0] + q[1]))
    assert not one.agrees
    whole = kl.diagnose(ARM, "gravity_torques", lambda q: factor * kl.gravity_torques(ARM, q))
    assert not whole.agrees


def test_a_third_in_a_function_is_rounded() -> None:
    rods = kl.load("planar2r_rods")
    told = kl.diagnose(rods, "mass_matrix[1,1]", lambda q: 0.333 * 1.5 * 0.16)
    assert told.remarks == ("0.333 stands for 1/3",)

    def inertia(q):
        return (0.333 * 2.0 + 1.5) * 0.25 + 0.333 * 1.5 * 0.16 + 0.3 * np.cos(q[1])

    assert kl.diagnose(rods, "mass_matrix[0,0]", inertia).form == "rounded"


def test_no_false_alarm_in_a_sample_of_the_campaign(tmp_path: Path) -> None:
    sys.path.insert(0, str(SCRIPTS))
    try:
        import correct_forms
    finally:
        sys.path.remove(str(SCRIPTS))
    done, alarms = correct_forms.run(40, 5, tmp_path)
    assert alarms == []
    assert len(done) >= 8


@pytest.mark.parametrize(
    ("entry", "text", "said"),
    [
        ("V", "17.2*(1+s1) + 5.89*(1+s12)", "17.2 stands for 17.1675"),
        ("V", "17.1675*s1 + 5.89*(1+s12) + 3", "5.89 stands for 5.886"),
        ("C", "[[-0.61*s2*qd2, -0.3*s2*qd2], [0.3*s2*qd1, 0]]", ""),
        ("C", "[[0, -0.300*s2*(2*qd1+qd2)], [0.30*s2*qd1, 0]]", "not Christoffel's"),
        ("g1", "17*c1 + 5.9*c12", "17 stands for 17.1675"),
    ],
)
def test_unusual_forms_with_rounded_numbers(entry: str, text: str, said: str) -> None:
    found = kl.diagnose("planar2r", entry, text)
    assert found.agrees == bool(said)
    assert said in " ".join(found.remarks)


def test_answers_that_are_rounded() -> None:
    """Each answer is off by what its last decimal says, in no proportion to anything."""
    arm = kl.load("planar2r")

    def cut(q, step):
        return np.round(kl.gravity_torques(arm, q), step)

    found = kl.diagnose(arm, "gravity_torques", lambda q: cut(q, 4))
    assert found.form == "rounded" and found.remarks == ("its answers are rounded to 4 decimals",)
    assert not kl.diagnose(arm, "gravity_torques", lambda q: cut(q, 4) + 1e-4).agrees


def test_a_rounded_number_that_leaves_no_inertia_is_none() -> None:
    """0.0004 kg m2 to two digits is still something; to two decimals it would be no body."""
    light = kl.DHLink("revolute", mass=1.0, inertia=np.diag([4e-4, 4e-4, 4e-4]))
    heavy = kl.DHLink("revolute", a=0.4, mass=2.0, com=(-0.2, 0, 0), inertia=np.diag([0, 0.1, 0.1]))
    table = kl.DHTable("wrist", "standard", [heavy, light], gravity=(0, -9.81, 0))

    def torques(q, v, a):
        return np.array([0.3404 * a[0] + 4e-4 * a[1] + 7.85 * np.cos(q[0]), 4e-4 * (a[0] + a[1])])

    found = kl.diagnose(table, "inverse_dynamics", torques)
    assert found.agrees and found.form == "rounded"


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("M11", "1.120 + 0.6*c2"),  # 1.115 to two decimals, and written with three
        ("V", "2*9.6*0.5*s1 + 1.5*9.6*(0.5*s1 + 0.4*s12) + 3"),
        ("g2", "1.5*9.6*0.4*c12"),
        ("g1", "18*c1 + 5.9*c12"),
    ],
)
def test_what_is_off_by_more_than_its_last_digit_is_no_rounding(entry: str, text: str) -> None:
    assert not kl.diagnose("planar2r", entry, text).agrees
