"""A formula agrees only where its text as written does, whatever tidying would make of it."""

from __future__ import annotations

import numpy as np
import pytest

from kinlab.doctor.file import examine_file
from kinlab.errors import ExpressionError
from kinlab.formulas import tree
from kinlab.formulas.text import parse


def agrees(folder, text, table="formulas"):
    file = folder / "f.toml"
    file.write_text(f"robot = 'planar2r'\n[{table}]\ng2 = '{text}'\n", encoding="utf-8")
    return examine_file(file, samples=60)[0].agrees


@pytest.mark.parametrize(
    ("text", "right"),
    [
        ("m2*g*l2*cos(q1+q2)", True),
        ("m2*g*l2*sqrt(cos(q1+q2)**2)", False),
        ("m2*g*l2*(cos(q1+q2)**2)**0.5", False),
        ("m2*g*l2*sqrt(cos(q1+q2))**2", False),
        ("m2*g*l2*cos(q1+q2) + 0*log(q1)", False),
        ("m2*g*l2*cos(q1+q2)*sqrt(q1)**0", False),
        ("m2*g*l2*cos(q1+q2)*(q1-q1)**0", True),
        ("m2*g*l2*cos(q1+q2)*sqrt(q1**2)/abs(q1)", True),
        ("m2*g*l2*cos(sqrt((q1+q2)**2))", True),
    ],
)
def test_the_verdict_is_plain_evaluation_s(tmp_path, text, right):
    assert agrees(tmp_path, text) is right


def test_latex_too(tmp_path):
    assert not agrees(tmp_path, r"m_2 g l_2 \sqrt{\cos(q_1 + q_2)^2}", "latex")


@pytest.mark.parametrize(
    "text",
    [
        "sqrt(x**2)", "sqrt(x)**2", "(x**4)**0.5", "0*log(x)", "0/x", "log(x)**0", "(1/x)**2",
        "(x**2)**3", "x**0", "0*sin(x)", "2*x*0.5", "x - x + 3", "(x**3)**0.5*(x*y)**2",
    ],
)  # fmt: skip
def test_no_tidying_changes_a_value(text):
    rng = np.random.default_rng(0)
    at = {name: rng.uniform(-3.0, 3.0, 400) for name in "xy"}
    with np.errstate(all="ignore"):
        plain = {"sqrt": np.sqrt, "log": np.log, "sin": np.sin, **at}
        wanted = np.broadcast_to(eval(text, {"__builtins__": {}}, plain), (400,))  # noqa: S307
        found = np.broadcast_to(tree.evaluate(parse(text), at), (400,))
    assert np.array_equal(np.isnan(wanted), np.isnan(found))
    assert np.allclose(wanted, found, rtol=1e-12, equal_nan=True)


def test_symbols_that_double_end_at_once(tmp_path):
    rows = 'k0 = "m2"\n' + "".join(f'k{i + 1} = "k{i}*k{i}"\n' for i in range(50))
    file = tmp_path / "f.toml"
    file.write_text(
        f'robot = "planar2r"\n[symbols]\n{rows}[formulas]\ng2 = "k50"\n', encoding="utf-8"
    )
    with pytest.raises(ExpressionError, match="more than 5000 terms"):
        examine_file(file)
    file.write_text(
        'robot = "planar2r"\n[symbols]\na = "b"\nb = "a"\n[formulas]\ng2 = "a"\n', encoding="utf-8"
    )
    with pytest.raises(ExpressionError, match="explained by itself"):
        examine_file(file)
