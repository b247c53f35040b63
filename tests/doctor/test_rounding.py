"""The same verdict, the same cause and the same order of causes on every processor.

Processors differ in the last bit. Here the last bit of every value is shaken: the engine's and the
hand formula's for the doctor, the Jacobian and the pose for the analysis, the bars' for the
five-bar. ``python scripts/bench/rounding.py`` does the doctor's whole bench.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from test_doctor_notes import NAMED

import kinlab as kl
from kinlab import arrays
from kinlab.doctor.entries import regression
from kinlab.formulas import tree

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts" / "bench"
SEEDS = range(20)


@pytest.fixture(scope="module")
def rounding():
    sys.path.insert(0, str(SCRIPTS))
    try:
        import rounding as module

        yield module
    finally:
        sys.path.remove(str(SCRIPTS))


PLANAR = sorted({(key, robot) for key, robot, _ in NAMED if robot in ("planar2r", "single_link")})
LARGER = sorted({(key, robot) for key, robot, _ in NAMED} - set(PLANAR))


@pytest.mark.many
@pytest.mark.parametrize(("key", "robot"), PLANAR)
def test_a_misprint_is_told_alike(rounding, key, robot):
    judged = rounding.misprints({(key, robot)})
    assert [label for label, _ in judged] == [f"{key} {robot}"]
    # the one that did change with the processor gets every seed here, the others in the script
    assert rounding.changes(judged, SEEDS if key == "001.ddt1" else SEEDS[:3]) == []


@pytest.mark.many
@pytest.mark.parametrize(("key", "robot"), LARGER)
def test_a_misprint_of_a_spatial_arm_is_told_alike(rounding, key, robot):
    judged = rounding.misprints({(key, robot)}, samples=20)
    assert len(judged) == 1
    assert rounding.changes(judged, SEEDS[:2]) == []


def test_slips_of_the_bench_are_told_alike(rounding):
    judged = rounding.slips(8, 0, ("planar2r", "single_link"))
    assert len(judged) > 15
    assert rounding.changes(judged, SEEDS[:3]) == []


def test_confusions_of_the_bench_are_told_alike(rounding):
    judged = rounding.confusions(1, 0, ("planar2r",))
    assert len(judged) > 10
    assert rounding.changes(judged, SEEDS[:1]) == []


def test_what_is_shaken_is_seen(rounding):
    """A larger shake than rounding does change what is told, so the shaking reaches the doctor."""
    judged = rounding.misprints({("001.tau1", "planar2r")})
    size, rounding.SIZE = rounding.SIZE, 1e-4
    try:
        assert len(rounding.changes(judged, SEEDS[:1])) == 1
    finally:
        rounding.SIZE = size
    assert not rounding.alike(["by 0.36"], ["by 0.3600001"])
    assert rounding.alike(["by 0.36 = m2*l2**2"], ["by 0.3600000001 = m2*l2**2"])
    assert not rounding.alike(["a", "b"], ["b", "a"])


def test_a_product_is_one_word_in_one_order():
    """Every product of every dictionary, as a bag of factors, stands there once."""
    from kinlab.check.quantities.registry import quantity
    from kinlab.doctor.derived import derivation
    from kinlab.doctor.entries.terms import names_for

    table = kl.load("planar2r").table
    for name in ("momentum_rate", "inverse_dynamics", "coriolis_torques", "kinetic_energy"):
        derived = derivation(table, name)
        entries = [derived.tree(poly) for poly in np.ravel(derived.polys)]
        for words in regression.dictionaries(entries, names_for(derived, quantity(name).arguments)):
            bags = Counter(
                tuple(sorted(map(str, w.args if w.op == "mul" else (w,)))) for w in words
            )
            assert max(bags.values()) == 1
            assert all(tree.ordered(w) == w for w in words)


def test_equal_numbers_keep_their_order_whatever_their_last_bit():
    rng = np.random.default_rng(0)
    values = np.array([3.0, 1.0, 3.0, -2.0, 1.0, 3.0, 0.0, -2.0])
    for _ in range(50):
        near = values * (1.0 + 1e-15 * rng.standard_normal(8)) + 1e-16 * rng.standard_normal(8)
        assert arrays.largest_first(near) == [0, 2, 5, 1, 4, 6, 3, 7]
        assert arrays.smallest_first(near) == [3, 7, 6, 1, 4, 0, 2, 5]
        assert (arrays.first_largest(near), arrays.first_smallest(near)) == (0, 3)
    assert arrays.first_largest([1.0, np.inf, np.inf]) == 1
    assert arrays.largest_first([]) == []


def test_pairs_are_found_whatever_the_last_bit():
    """Sixty rows of one effect: which fifty of them are tried must not hang on rounding."""
    from kinlab.doctor.text.pairs import pairs_adding_up

    rng = np.random.default_rng(1)
    one, goal = rng.standard_normal(24), rng.standard_normal(24)
    rows = np.array([one] * 60 + [goal - one])
    plain = pairs_adding_up(rows, goal, 1e-9)
    assert len(plain) >= 50
    for _ in range(20):
        moved = rows * (1.0 + 1e-15 * rng.standard_normal(rows.shape))
        assert pairs_adding_up(moved, goal, 1e-9) == plain


SHAKEN = (0, 1)


@pytest.fixture
def shake(monkeypatch):
    """Shakes what a name gives in the modules named; call it with a seed."""

    def start(seed, names, modules, times):
        rng = np.random.default_rng(seed)
        for module in modules:
            for name in names:
                true = getattr(module, name, None)
                if true is not None:
                    monkeypatch.setattr(
                        module, name, lambda *a, f=true, **k: times(f(*a, **k), rng)
                    )

    return start


def moved(values, rng):
    return values * (1.0 + 1e-15 * rng.standard_normal(np.shape(values)))


def moved_pose(pose, rng):
    from dataclasses import replace

    return replace(pose, **{part: moved(getattr(pose, part), rng) for part in ("u", "w", "sine", "rods")})  # fmt: skip


def five_bar_verdicts(name):

    said = []
    fivebar = kl.FiveBar.load(name)
    grid = np.random.default_rng(3).uniform(-0.6, 0.6, (200, 2))
    for mode in ((-1, 1), (1, -1)):
        said.append(" ".join(fivebar.classify(grid, mode)))
        said += [f"{mode} {p.xy[0]:.9f} {p.xy[1]:.9f}" for p in fivebar.isotropic_poses(mode, 15)]
    return [line.replace("-0.000000000", "0.000000000") for line in said]


@pytest.mark.parametrize("name", ["isotropic", "unequal", "equal_links"])
def test_the_five_bar_says_the_same(shake, name):
    from kinlab.fivebar import metrics, singularity

    plain = five_bar_verdicts(name)
    assert len(plain) > 3
    for seed in SHAKEN:
        shake(seed, ["solve_pose"], [metrics, singularity], moved_pose)
        assert five_bar_verdicts(name) == plain


def analysis_verdicts(name):
    search = kl.find_singularities(kl.load(name))
    return [f"{f.kind} {f.deciding} {np.round(f.pinned, 6) + 0.0} {f.beyond} {f.representative.rank} "
            f"{f.representative.joints}" for f in search.families]  # fmt: skip


@pytest.mark.parametrize("name", ["planar2r", "planar3r", "spatial3r", "stanford", "puma560"])
def test_the_analysis_says_the_same(shake, name):
    from kinlab.analysis.singularities import edge, singular_set
    from kinlab.analysis.structure import axes, task_space

    plain = analysis_verdicts(name)
    assert plain
    for seed in SHAKEN:
        shake(seed, ["jacobian", "fk"], [edge, singular_set, axes, task_space], moved)
        assert analysis_verdicts(name) == plain


def test_an_error_is_not_laid_into_another_number_by_rounding_of_differences():
    """1.0032 for 1 beside 0.250: both multiply qdd1, whatever the seed of the states."""
    terms = (
        "1.000*I1*qdd1 + 1.0032*I2*qdd1 + 1.000*I2*qdd2 + 1.000*l1**2*m2*qdd1 + 0.250*l1**2*m1*qdd1"
        " + 0.250*l2**2*m2*qdd1 + 0.250*l2**2*m2*qdd2 + 1.000*g*l1*m2*cos(q1)"
        " + 0.500*g*l1*m1*cos(q1) + 0.500*g*l2*m2*cos(q1 + q2) + 1.000*l1*l2*m2*qdd1*cos(q2)"
        " + 0.500*l1*l2*m2*qdd2*cos(q2) - 0.500*l1*l2*m2*qd2**2*sin(q2)"
        " - 1.000*l1*l2*m2*qd1*qd2*sin(q2)"
    )
    judged = [kl.diagnose("planar2r_rods", "tau1", terms, 30, seed) for seed in (0, 1, 198)]
    assert [one.agrees for one in judged] == [False] * 3
