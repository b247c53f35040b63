"""Formulas rewritten by identities and by what only looks like one: the verdict is plain evaluation's."""

from __future__ import annotations

import formula_cases
import fuzz_pool
from hypothesis import given, settings
from hypothesis import strategies as st

KNOWN = {
    "g2": [
        ("m2*g*l2*sqrt(cos(q1+q2)**2)", "differs"),
        ("m2*g*l2*(cos(q1+q2)**2)**0.5", "differs"),
        ("m2*g*l2*(cos(q1+q2)**2)**(1/2)", "differs"),
        ("m2*g*l2*cos(q1+q2)+0*log(q1)", "differs"),
        ("m2*g*l2*cos(q1+q2)+0*asin(2)", "differs"),
        ("m2*g*l2*cos(sqrt(q1)**2+q2)", "differs"),
        ("m2*g*l2*cos(q1+q2)*sqrt(q1)/sqrt(q1)", "differs"),
        ("m2*g*l2*cos(abs(q1)+q2)", "differs"),
        ("m2*g*l2*cos(abs(q1+q2))", "agrees"),
        ("m2*g*l2*cos(sqrt((q1+q2)**2))", "agrees"),
        ("m2*g*l2*cos(q1+q2)*sqrt(q1**2)/abs(q1)", "agrees"),
        ("m2*g*l2*sin(q1+q2+pi/2)", "agrees"),
        ("m2*g*l2*cos(q1+q2)*(q1-q1)**0", "agrees"),
        ("m2*g*l2*cos(q1+q2)*exp(log(q1)-log(q1))", "differs"),
        ("m2*g*l2*exp(log(cos(q1+q2)))", "differs"),
        ("m2*g*l2*cos(atan(tan(q1))+q2)", "differs"),
        ("m2*g*l2*cos(asin(sin(q1))+q2)", "differs"),
    ],
    "tau2": [
        ("(m2*l2**2+m2*l1*l2*cos(q2))*qdd1+m2*l2**2*qdd2+m2*l1*l2*sin(q2)*sqrt(qd1**4)+m2*g*l2*cos(q1+q2)", "agrees"),
        ("(m2*l2**2+m2*l1*l2*cos(q2))*sqrt(qdd1**2)+m2*l2**2*qdd2+m2*l1*l2*sin(q2)*qd1**2+m2*g*l2*cos(q1+q2)", "differs"),
        ("(m2*l2**2+m2*l1*l2*cos(q2))*qdd1+m2*l2**2*qdd2+m2*l1*l2*sin(q2)*sqrt(qd1)**4+m2*g*l2*cos(q1+q2)", "differs"),
    ],
}  # fmt: skip


def test_known():
    cases = [
        (f"{entry} = {text}", (entry, text, False, verdict))
        for entry, list_ in KNOWN.items()
        for text, verdict in list_
    ]
    fuzz_pool.demand("formula_cases:judge", cases)


def test_text():
    cases = formula_cases.cases(fuzz_pool.SEED + 20, fuzz_pool.count(10), typeset=False)
    found = fuzz_pool.demand("formula_cases:judge", cases)
    assert found["right"] > len(cases) / 2


def test_latex():
    cases = formula_cases.cases(fuzz_pool.SEED + 21, fuzz_pool.count(5), typeset=True)
    found = fuzz_pool.demand("formula_cases:judge", cases)
    assert found["right"] > len(cases) / 2


@settings(max_examples=fuzz_pool.count(10))
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_any_formula(seed, typeset):
    [(label, case)] = formula_cases.cases(fuzz_pool.seeded(seed), 1, typeset=typeset)
    fuzz_pool.demand_one("formula_cases:judge", label, case)
