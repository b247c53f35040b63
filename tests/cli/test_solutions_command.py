"""kinlab workspace --measure solutions, and the motion of a change of posture."""

import numpy as np
import pytest
from typer.testing import CliRunner

import kinlab as kl
from kinlab.cli import app
from kinlab.errors import StructureError
from kinlab.viewer.motions import motion

TABLE = "\n".join(
    [
        'name = "wenger"\nconvention = "standard"',
        *(
            f'[[links]]\njoint = "revolute"\na = {a}\nalpha = "{alpha}"\nd = {d}\ntheta = 0\n'
            'lower = "-pi"\nupper = "pi"'
            for a, alpha, d in ((1, "-pi/2", 0), (2, "pi/2", 1), (1.5, "0", 0))
        ),
    ]
)


@pytest.fixture
def table(tmp_path):
    path = tmp_path / "wenger.toml"
    path.write_text(TABLE)
    return path


def test_map_of_solutions(table, tmp_path):
    picture = tmp_path / "map.png"
    call = ["workspace", str(table), "--measure", "solutions", "-o", str(picture)]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 0, result.output
    assert "quaternary, generic, 4 cusps and 0 nodes" in " ".join(result.output.split())
    assert result.output.count("cusp at") == 4
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_motion_of_a_change_of_posture(table):
    robot = kl.load(str(table))
    shown = motion(robot, "posture", np.zeros(3))
    middle = len(shown.q) // 2
    here = kl.fk(robot, shown.q[[0, middle]])[:, :3, 3]
    np.testing.assert_allclose(here[0], here[1], atol=1e-8)
    assert np.abs(shown.q[0] - shown.q[middle]).max() > 0.1
    det = np.linalg.det(kl.jacobian(robot, shown.q)[:, :3])
    assert (np.sign(det) == np.sign(det[0])).all()


def test_an_arm_without_one_says_so():
    with pytest.raises(StructureError, match="without a singularity"):
        motion(kl.load("planar2r"), "posture", np.zeros(2))


def test_branches_are_drawn_as_ghosts(table, tmp_path):
    page, plain = tmp_path / "all.html", tmp_path / "one.html"
    start = ["view", str(table), "-q", "0.5, 0.3, 1.0", "--save"]
    for call in ([*start, str(page), "--branches"], [*start, str(plain)]):
        result = CliRunner().invoke(app, call)
        assert result.exit_code == 0, result.output
    assert page.stat().st_size > plain.stat().st_size
