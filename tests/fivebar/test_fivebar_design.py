"""Designed five-bars against a brute-force grid, plain geometry, Huang's condition and themselves."""

from __future__ import annotations

import itertools
import sys

import numpy as np
import pytest

import kinlab as kl
from kinlab.cli import main
from kinlab.errors import FileError, MechanismError, NameUnknownError, OptionError, UnreachableError

BOX = (-0.2, 0.15, -0.65, -0.5)


def dense(box, count=41):
    x, y = np.meshgrid(np.linspace(*box[:2], count), np.linspace(*box[2:], count))
    return np.stack([x.ravel(), y.ravel()], axis=1)


def worst_condition(five, points, mode=(-1, 1)):
    """Largest kappa from singular values of J by numpy; infinite where it cannot go everywhere."""
    if not five.reachable(points).all():
        return np.inf
    try:
        jac = five.jacobian(points, mode)
    except kl.KinlabError:
        return np.inf
    det = np.linalg.det(jac)
    if np.abs(np.sum(np.sign(det))) < len(points):
        return np.inf  # the rods get in line on the way
    return float(np.max(np.linalg.cond(jac)))


def five_bars(l1, l2, e):
    for lengths in itertools.product(l1, l2, e):
        try:
            yield kl.FiveBar(*lengths)
        except MechanismError:
            continue


def test_no_linkage_of_a_grid_is_better():
    """Brute force: 9 x 9 x 5 linkages, each at 13 x 13 places; one is nearly as good."""
    found = kl.design_fivebar(BOX, l1=(0.2, 0.5), l2=(0.3, 0.6), e=(0.05, 0.25))
    points = dense(BOX, 13)
    grid = five_bars(np.linspace(0.2, 0.5, 9), np.linspace(0.3, 0.6, 9), np.linspace(0.05, 0.25, 5))
    best = min(worst_condition(five, points) for five in grid)
    mine = found.goals["condition"]
    assert mine.value <= best * (1 + 1e-9)
    assert best < 1.1 * mine.value


def test_the_proof_holds_at_every_place():
    found = kl.design_fivebar(BOX, "torque", payload=2.0, limits={"condition": 2.0, "size": 1.2})
    five, points = found.fivebar, dense(BOX, 81)
    goals = found.goals
    reached = worst_condition(five, points)
    assert reached <= goals["condition"].bound and goals["condition"].bound <= 2.0 * (1 + 1e-5)
    assert reached == pytest.approx(goals["condition"].value, rel=1e-3)
    angle = np.degrees(five.transmission_angle(points))
    least = np.minimum(angle, 180.0 - angle).min()
    assert least >= goals["transmission"].bound
    assert least == pytest.approx(goals["transmission"].value, rel=1e-3)
    columns = np.linalg.inv(five.jacobian(points))  # v = J^-1 rate, so tau = J^-T F
    torque = 2.0 * 9.81 * np.linalg.norm(columns, axis=1).max()
    assert torque <= goals["torque"].bound
    assert torque == pytest.approx(goals["torque"].value, rel=1e-3)
    assert sum(found.lengths) == pytest.approx(goals["size"].value) and found.gap < 1e-3


def test_clearance_is_the_least_of_the_lengths():
    """Lever arms as distances of pins from lines of bars, and distances of pins."""
    found = kl.design_fivebar(BOX, "size", limits={"clearance": 0.1, "transmission": 40})
    five, points = found.fivebar, dense(BOX, 41)
    theta = five.ik(points)
    base = np.array([[five.e, 0.0], [-five.e, 0.0]])
    elbow = base + five.l1[:, None] * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    least = np.inf

    def from_line(pin, a, b):
        way = b - a
        side = pin - a
        return np.abs(way[..., 0] * side[..., 1] - way[..., 1] * side[..., 0]) / np.hypot(
            way[..., 0], way[..., 1]
        )

    for leg in (0, 1):
        own, other = elbow[:, leg], elbow[:, 1 - leg]
        gaps = [
            from_line(base[leg], own, points), from_line(own, other, points),
            np.linalg.norm(points - base[leg], axis=1), np.linalg.norm(own - other, axis=1),
            np.linalg.norm(own - base[1 - leg], axis=1),
        ]  # fmt: skip
        least = min(least, *(gap.min() for gap in gaps))
    assert least >= found.goals["clearance"].bound - 1e-12
    assert least == pytest.approx(found.goals["clearance"].value, rel=1e-3)
    assert found.goals["clearance"].value >= 0.1 * (1 - 1e-6)
    assert found.goals["transmission"].value >= 40 * (1 - 1e-6)
    assert any("≥" in text for text in found.at_limit)


def test_never_worse_than_huangs_fully_isotropic_linkage():
    """e = (l2 - l1)/sqrt(2) at (0, -(l1 + l2)/sqrt(2)); a machine of the same size, two rectangles."""
    l1, l2 = 0.3, 0.5
    huang = kl.FiveBar(l1, l2, (l2 - l1) / np.sqrt(2))
    y = -(l1 + l2) / np.sqrt(2)
    for half in (0.01, 0.06):
        box = (-2 * half, 2 * half, y - half, y + half)
        found = kl.design_fivebar(box, limits={"size": l1 + l2 + huang.e})
        theirs = worst_condition(huang, dense(box))
        assert found.goals["condition"].value <= theirs
        assert found.goals["size"].value <= (l1 + l2 + huang.e) * (1 + 1e-6)


def test_a_free_height_is_used():
    """The design with a free height is no worse than at any fixed one, above or below."""
    lengths = {"l1": (0.2, 0.5), "l2": (0.3, 0.6), "e": (0.05, 0.25)}
    free = kl.design_fivebar(BOX, height=(-0.8, -0.2), **lengths)
    assert free.workspace.y_max - free.workspace.y_min == pytest.approx(0.15)
    for low in (free.workspace.y_min + 0.02, -0.3):
        fixed = kl.design_fivebar((*BOX[:2], low, low + 0.15), **lengths)
        assert free.goals["condition"].value <= fixed.goals["condition"].value * (1 + 1e-6)
    below = kl.design_fivebar(BOX, **lengths)
    above = kl.design_fivebar((*BOX[:2], 0.5, 0.65), **lengths)
    assert above.mode == (1, -1)
    assert above.goals["condition"].value == pytest.approx(below.goals["condition"].value, rel=1e-5)


def test_the_same_seed_and_a_stopped_search_give_the_same_answer(tmp_path):
    class Stopped(Exception):
        pass

    def stop(done, total, best):
        if done == 31:
            raise Stopped

    whole = kl.design_fivebar(BOX, seed=3)
    file = tmp_path / "search.json"
    with pytest.raises(Stopped):
        kl.design_fivebar(BOX, seed=3, resume=file, progress=stop)
    seen = []
    again = kl.design_fivebar(BOX, seed=3, resume=file, progress=lambda done, *_: seen.append(done))
    assert seen[0] == 32 and again.lengths == whole.lengths
    assert kl.design_fivebar(BOX, seed=3).lengths == whole.lengths
    other = kl.design_fivebar(BOX, seed=4)
    assert other.goals["condition"].value == pytest.approx(whole.goals["condition"].value, rel=1e-5)
    with pytest.raises(FileError, match="the state of another design search"):
        kl.design_fivebar(BOX, seed=4, resume=file)
    file.write_text("{}", encoding="utf-8")
    with pytest.raises(FileError, match="no state of a design search"):
        kl.design_fivebar(BOX, seed=3, resume=file)


def test_a_front_has_no_design_that_another_beats(tmp_path):
    file = tmp_path / "front.json"
    front = kl.fivebar_front(BOX, ("condition", "size"), 4, resume=file)
    condition, size = front.values("condition"), front.values("size")
    assert len(front.designs) >= 3
    assert condition == sorted(condition) and size == sorted(size, reverse=True)
    again = kl.fivebar_front(BOX, ("condition", "size"), 4, resume=file)
    assert [d.lengths for d in again.designs] == [d.lengths for d in front.designs]
    points = dense(BOX, 9)
    rng = np.random.default_rng(0)
    for lengths in rng.uniform([0.2, 0.2, 0.0], [0.8, 0.9, 0.4], (60, 3)):
        kappa, whole = worst_condition(kl.FiveBar(*lengths), points), sum(lengths)
        for design in front.designs:
            goals = design.goals
            assert kappa >= goals["condition"].value * (1 - 1e-3) or whole >= goals["size"].value
    with pytest.raises(FileError, match="the state of another front"):
        kl.fivebar_front(BOX, ("condition", "size"), 6, resume=file)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: kl.design_fivebar((0, 1, 0)), OptionError, "expected .x_min"),
        (lambda: kl.design_fivebar((0, 0, -1, 1)), OptionError, "has no area"),
        (lambda: kl.design_fivebar((0, 1e90, -1, 1)), OptionError, "is no machine's"),
        (lambda: kl.design_fivebar((-0.1, 0.1, -0.1, 0.1), e=0), UnreachableError,
         "move the rectangle from the pins"),
        (lambda: kl.design_fivebar(BOX, "kondition"), NameUnknownError, "did you mean 'condition'"),
        (lambda: kl.design_fivebar(BOX, {"size": -1}), OptionError, "weight of size is -1"),
        (lambda: kl.design_fivebar(BOX, {}), OptionError, "goal is {}"),
        (lambda: kl.design_fivebar(BOX, "torque"), OptionError, "needs the payload"),
        (lambda: kl.design_fivebar(BOX, l1=(0.3, 0.2)), OptionError, "give the least first"),
        (lambda: kl.design_fivebar(BOX, l2=0), OptionError, "l2 starts at 0 m"),
        (lambda: kl.design_fivebar(BOX, limits={"transmission": 95}), OptionError, "below 90"),
        (lambda: kl.design_fivebar(BOX, limits={"condition": 0.5}), OptionError, "above 1"),
        (lambda: kl.design_fivebar(BOX, mode=(1, 2)), OptionError, "mode"),
        (lambda: kl.design_fivebar(BOX, seed=-1), OptionError, "seed is -1"),
        (lambda: kl.design_fivebar(BOX, l1=0.1, l2=(0.1, 0.2)), UnreachableError,
         r"l1 \+ l2 above 0.6801 m would reach it"),
        (lambda: kl.design_fivebar(BOX, limits={"transmission": 85, "size": 0.8}),
         UnreachableError, "the nearest, l1 .* has .*(transmission|size)"),
        (lambda: kl.fivebar_front(BOX, ("size", "size")), OptionError, "two different"),
        (lambda: kl.fivebar_front(BOX, ("size", "torque")), OptionError, "payload"),
    ],
)  # fmt: skip
def test_bad_input_is_refused_with_what_would_work(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_the_command(monkeypatch, capsys, tmp_path):
    def kinlab(*arguments):
        monkeypatch.setenv("COLUMNS", "120")
        monkeypatch.setattr(sys, "argv", ["kinlab", "fivebar", "design", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            main()
        said = capsys.readouterr()
        return left.value.code, said.out, said.err

    box = ("--workspace", -0.2, 0.15, -0.65, -0.5)
    file = tmp_path / "mine.toml"
    code, out, _ = kinlab(*box, "--goal", "condition", "--goal", "size=0.5", "--limit",
                          "clearance=0.1", "-o", file, "--picture", tmp_path / "d.svg")  # fmt: skip
    assert code == 0 and "condition number" in out and "≥ 0.1" in out
    five = kl.FiveBar.load(file)
    assert worst_condition(five, dense(BOX)) < 2 and (tmp_path / "d.svg").stat().st_size > 10_000
    code, out, _ = kinlab(*box, "--pareto", "condition", "size", "--count", 3, "--picture",
                          tmp_path / "f.svg")  # fmt: skip
    assert code == 0 and "from the best condition to the best size" in out
    assert (tmp_path / "f.svg").stat().st_size > 10_000
    for arguments, message in [
        ((*box, "--limit", "size"), "write it as name=number"),
        ((*box, "--goal", "size=1", "--goal", "size=2"), "is given twice"),
        ((*box, "--l1", 0.1, 0.2, "--l2", 0.1, 0.2), "out of reach of every linkage"),
        ((*box, "--pareto", "condition", "size", "-o", file), "leave out --goal and --output"),
    ]:
        code, _, err = kinlab(*arguments)
        assert code == 2 and message in err and len(err.strip().splitlines()) == 1


def test_what_is_not_proved_is_said():
    """The crank torque alone drives the design into a singularity, where its bound is lost."""
    found = kl.design_fivebar((-0.1, 0.1, -0.4, -0.3), "torque", payload=2.0)
    goal = found.goals["torque"]
    assert goal.bound > 1.001 * goal.value
    assert "NOT proved" in str(found) and "near a singularity" in found.remarks[0]
    assert kl.design_fivebar((-0.1, 0.1, -0.4, -0.3), "condition").remarks == ()
