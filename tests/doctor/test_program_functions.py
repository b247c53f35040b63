"""A program's functions, each by itself: right or wrong whatever is done with what they answer."""

from __future__ import annotations

import ast

import pytest
from hand_programs import searched, told_in_its_line, with_slips, written

import kinlab as kl
from kinlab.doctor.program.search.units import Units
from kinlab.doctor.program.several import repairs
from kinlab.doctor.program.trial import quietly

CHRISTOFFEL = """
import numpy as np

L = np.array([0.5, 0.4])
M = np.array([2.0, 1.5])

def mass(q):
    total = np.zeros((2, 2))
    for i in range(2):
        J = np.zeros((2, 2))
        for j in range(i + 1):
            for k in range(j, i + 1):
                phi = q[:k + 1].sum()
                J[:, j] += L[k]*np.array([-np.sin(phi), np.cos(phi)])
        total += M[i]*J.T @ J
    return total

def f(q, v):
    h = 1e-5
    D = []
    for k in range(2):
        step = np.zeros(2)
        step[k] = h
        D.append((mass(q + step) - mass(q - step))/(2*h))
    rate = sum(D[k]*v[k] for k in range(2))
    grad = np.array([0.5*v @ D[k] @ v for k in range(2)])
    return rate @ v - grad
"""
TURN = """
import numpy as np

L1, L2, E = 0.3, 0.5, 0.2/np.sqrt(2)

def f(xy, v, a, mode):
    out = np.zeros(2)
    for k, side in enumerate((1, -1)):
        r = xy - np.array([side*E, 0.0])
        d = np.hypot(*r)
        th = np.arctan2(r[1], r[0]) - mode[k]*np.arccos((d**2 + L1**2 - L2**2)/(2*L1*d))
        u = np.array([np.cos(th), np.sin(th)])
        n = np.array([-u[1], u[0]])
        w = (r - L1*u)/L2
        t = np.array([-w[1], w[0]])
        thd = w @ v/(L1*(n @ w))
        phd = t @ (v - L1*thd*n)/L2
        out[k] = (w @ a + L1*thd**2*(u @ w) + L2*phd**2)/(L1*(n @ w))
    return out
"""
TYPED = '''
import math

import numpy as np

ROWS = """
   0        0.333    0
   0        0       -90
   0        0.316    90
   0.0825   0        90
  -0.0825   0.384   -90
   0        0        90
   0.088    0        90
"""

def parsed(text):
    rows = []
    for line in text.strip().splitlines():
        a, d, alpha = map(float, line.split())
        rows.append((a, d, math.radians(alpha)))
    return rows

def modified(a, d, al, th):
    ct, st, ca, sa = math.cos(th), math.sin(th), math.cos(al), math.sin(al)
    return np.array([
        [ct, -st, 0, a],
        [st*ca, ct*ca, -sa, -sa*d],
        [st*sa, ct*sa, ca, ca*d],
        [0, 0, 0, 1],
    ])

def f(q):
    pose = np.eye(4)
    for (a, d, al), th in zip(parsed(ROWS), q):
        pose = pose @ modified(a, d, al, th)
    flange = np.eye(4)
    flange[2, 3] = 0.107
    return pose @ flange
'''
RODS = """
import numpy as np

l1 = 0.5
l2 = 0.4
lc1 = l1/2
lc2 = l2/2
m1 = 2.0
m2 = 1.5
I1 = m1*l1**2/12
I2 = m2*l2**2/12
g = 9.81

def f(q, qd, qdd):
    th1, th2 = q
    c1 = np.cos(th1)
    c12 = np.cos(th1 + th2)
    h = m2*l1*lc2*np.sin(th2)
    d11 = m1*lc1**2 + I1 + m2*(l1**2 + lc2**2 + 2*l1*lc2*np.cos(th2)) + I2
    d12 = m2*(lc2**2 + l1*lc2*np.cos(th2)) + I2
    d22 = m2*lc2**2 + I2
    g2 = m2*g*lc2*c12
    g1 = m1*g*lc1*c1 + m2*g*l1*c1 + g2
    tau1 = d11*qdd[0] + d12*qdd[1] - 2*h*qd[0]*qd[1] - h*qd[1]**2 + g1
    tau2 = d12*qdd[0] + d22*qdd[1] + h*qd[0]**2 + g2
    return np.array([tau1, tau2])
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "coriolis_torques", CHRISTOFFEL),
        ("isotropic", "fivebar_turn", TURN),
        ("planar2r_rods", "inverse_dynamics", RODS),
        ("panda", "fk", TYPED),
    ],
)
def test_every_program_is_right(robot, quantity, text):
    assert kl.diagnose(robot, quantity, written(text)).agrees


def test_a_function_that_is_asked_often_is_right_with_an_edit_whatever_else_is_wrong():
    """The mass matrix becomes right although the torques made of it do not."""
    slips = [("range(j, i + 1)", "range(i, i + 1)"), ("0.5*v @", "v @")]
    search = searched("planar2r", "coriolis_torques", with_slips(CHRISTOFFEL, slips), beside=0.0)
    search.singles()
    units = Units(search.asked, search.observed, search.evidence, search.work)
    names = [part.name for part in search.trial.program.parts]
    assert [names[k] for k in units.wrong] == ["mass"]
    with quietly():
        found = units.repairs([edit for edit, _values in search.tried], 10**9)
    assert found and all(names[edit.part] == "mass" for edit in found)
    assert "j" in {
        ast.unparse(edit.changes[0].new)
        for edit in found
        if isinstance(edit.changes[0].new, ast.AST)
    }


def test_a_right_function_is_not_looked_at():
    text = with_slips(CHRISTOFFEL, [("0.5*v @", "v @")])
    search = searched("planar2r", "coriolis_torques", text, beside=0.0)
    assert not Units(search.asked, search.observed, search.evidence, search.work).wrong


def test_two_plain_signs_are_tried_together_whatever_speaks_against_each():
    slips = [("- 2*h*qd", "+ 2*h*qd"), ("+ h*qd[0]**2", "- h*qd[0]**2")]
    search = searched("planar2r_rods", "inverse_dynamics", with_slips(RODS, slips), beside=0.0)
    assert not search.singles()
    found = repairs._Several._plain(search, repairs._Tried(search))
    assert {edit.kind for edit in found[0].edits} == {"sign"} and len(found[0].edits) == 2


def test_the_numbers_of_a_five_bar_have_dimensions():
    known = searched("isotropic", "fivebar_turn", TURN).dimensions
    length = known.of_text("L1")
    assert length and known.of_text("d") == pytest.approx(length)
    assert known.of_text("th") == pytest.approx(0.0)
    assert known.of_text("w") is None or known.of_text("w") == pytest.approx(0.0)
    assert known.of_text("thd") == pytest.approx(known.of_text("phd"))
    assert abs(known.of_text("thd")) > 0.1 and known.consistent


def test_a_term_lost_above_a_fraction_is_told():
    right, slip = "(u @ w) + L2*phd**2)/(L1", "(u @ w))/(L1"
    told_in_its_line("isotropic", "fivebar_turn", TURN, right, slip)


def test_a_function_that_is_right_is_not_spoilt():
    """A slip in a table that is text: no factor in the transform of a row makes up for it."""
    found = kl.diagnose("panda", "fk", written(TYPED.replace("-0.0825", "0.0825")))
    assert not found.agrees
    assert "modified" not in str(found)


def test_of_two_names_for_one_slip_that_with_company_in_the_program_comes_first(tmp_path):
    """``l1*lc2`` stands in other lines; ``lc1*l2`` is the same number and stands nowhere."""
    slips = [("h = m2*l1*lc2", "h = m2*lc1*lc2"), ("+ h*qd[0]**2", "- h*qd[0]**2")]
    file, text = tmp_path / "rods.py", with_slips(RODS, slips)
    file.write_text(text)
    found = kl.diagnose("planar2r_rods", "inverse_dynamics", written(text, file))
    assert "h = m2*l1*lc2*" in found.sentence.partition("or else")[0]
