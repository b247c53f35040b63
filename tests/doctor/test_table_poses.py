"""Poses: exact and with noise, from arrays and from CSV files."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.tables.reference.poses import is_poses_file, read_poses
from kinlab.model.rotations import matrices_rpy, rpy_matrix

PUMA = kl.load("puma560").table


def measured(table, count=40, seed=0, mm=0.0, deg=0.0):
    rng = np.random.default_rng(seed)
    q = rng.uniform(-2.0, 2.0, (count, table.n))
    T = kl.fk(kl.Robot.from_dh(table), q)
    for pose in T:
        pose[:3, 3] += rng.normal(0, mm * 1e-3, 3)
        pose[:3, :3] = rpy_matrix(*rng.normal(0, np.radians(deg), 3)) @ pose[:3, :3]
    return q, T


def row(table, i, **cells):
    links = list(table.links)
    links[i - 1] = replace(links[i - 1], **cells)
    return replace(table, links=links)


SLIPS = [
    (row(PUMA, 3, alpha=np.pi / 2), (3, "alpha", "sign")),
    (row(PUMA, 2, theta=np.pi / 2), (2, "theta", "quarter-turn")),
    (row(PUMA, 3, d=-PUMA.links[2].d), (3, "d", "sign")),
    (row(PUMA, 4, d=0.4), (4, "d", "value")),
    (row(PUMA, 3, flip=True), (3, "flip", "sense")),
    (replace(PUMA, convention="modified"), (None, "convention", "convention")),
    (row(PUMA, 2, a=PUMA.links[1].d, d=PUMA.links[1].a), (2, "a, d", "exchanged")),
]


@pytest.mark.parametrize(("mine", "cause"), SLIPS)
def test_exact_poses_give_the_verdicts_of_a_table(mine, cause):
    found = kl.diagnose_table(mine, poses=measured(PUMA))
    assert [(c.row, c.column, c.kind) for c in found.causes] == [cause]
    q, T = measured(PUMA, seed=9)
    np.testing.assert_allclose(kl.fk(kl.Robot.from_dh(found.repaired), q), T, atol=1e-8)


@pytest.mark.parametrize(("mine", "cause"), SLIPS)
def test_with_noise_the_cell_is_named_and_how_clear_it_is(mine, cause):
    found = kl.diagnose_table(mine, poses=measured(PUMA, mm=0.1, deg=0.01))
    assert [(c.row, c.column, c.kind) for c in found.causes] == [cause], found
    assert found.clear["sigma_position"] == pytest.approx(1e-4, rel=0.3)
    assert found.clear["sigma_angle_deg"] == pytest.approx(0.01, rel=0.3)
    assert found.clear["effect"] > 10 and found.clear["runner_up"] > 3
    assert "times the noise" in str(found)


def test_a_slip_below_the_noise_is_not_named():
    q, T = measured(PUMA, mm=0.1, deg=0.01)
    found = kl.diagnose_table(row(PUMA, 3, a=PUMA.links[2].a + 2e-6), poses=(q, T))
    assert found.agrees and not found.causes and "within their noise" in found.sentence


def test_right_tables_agree_with_noisy_poses():
    for seed in range(10):
        table = kl.load(("puma560", "scara", "stanford", "ur5", "panda")[seed % 5]).table
        found = kl.diagnose_table(table, poses=measured(table, 30, seed, 0.1, 0.01))
        assert found.agrees, found


def test_two_slips_in_noise_are_left_unknown_not_guessed():
    mine = row(row(PUMA, 2, theta=np.pi / 2), 3, alpha=0.3)
    found = kl.diagnose_table(mine, poses=measured(PUMA, mm=0.1, deg=0.01))
    if found.causes:  # then it must be right
        q, T = measured(PUMA, seed=4)
        error = kl.fk(kl.Robot.from_dh(found.repaired), q) - T
        assert np.max(np.abs(error)) < 2e-3
    assert not found.agrees


def _csv(path, header, lines):
    text = [header, *(",".join(repr(float(x)) for x in line) for line in lines)]
    path.write_text("\n".join(text) + "\n", encoding="utf-8")
    return path


def test_every_form_of_a_poses_file_reads_the_same(tmp_path):
    q, T = measured(PUMA, 5)
    names = ",".join(f"q{i}" for i in range(1, 7))
    entries = ",".join(f"T{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3, 4))
    rpy = [matrices_rpy([pose[:3, :3]])[0] for pose in T]
    from scipy.spatial.transform import Rotation

    quaternions = Rotation.from_matrix(T[:, :3, :3]).as_quat()  # x, y, z, w
    files = [
        _csv(tmp_path / "a.csv", f"{names},{entries}", np.c_[q, T[:, :3].reshape(5, 12)]),
        _csv(tmp_path / "b.csv", f"x [mm],y [mm],z [mm],roll [deg],pitch [deg],yaw [deg],{names}",
             np.c_[1000 * T[:, :3, 3], np.degrees(rpy), q]),
        _csv(tmp_path / "c.csv", f"{names},x,y,z,qx,qy,qz,qw", np.c_[q, T[:, :3, 3], quaternions]),
        _csv(tmp_path / "d.csv", ",".join(f"q{i} [deg]" for i in range(1, 7)) +
             "," + ",".join(f"T{i}{j}" for i in (1, 2, 3, 4) for j in (1, 2, 3, 4)),
             np.c_[np.degrees(q), T.reshape(5, 16)]),
    ]  # fmt: skip
    for file in files:
        assert is_poses_file(file)
        read_q, read_T = read_poses(file, 6)
        np.testing.assert_allclose(read_q, q, atol=1e-12)
        np.testing.assert_allclose(read_T, T, atol=1e-12)
        assert kl.diagnose_table(PUMA, file).agrees


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("q1,q2\n", "no poses"),
        ("q1,x,y,z\n0,1,2,3\n", "columns q1, x, y, z are no poses; expected q1 ... qn"),
        ("q1,q3,x,y,z,roll,pitch,yaw\n0,0,1,2,3,0,0,0\n", "q1 to q2 without a gap"),
        ("q1,x,y,z,roll,pitch,yaw\n0,1,2,3,0,0\n", "line 2 has 6 cells; expected 7"),
        ("q1,x,y,z,roll,pitch,yaw\n0,1,2,3,0,0,up\n", "line 2: 'up' is not a number"),
        ("q1,x,y,z,roll,pitch,yaw\n0,1,2,3,0,0,nan\n", "line 2: 'nan' is not finite"),
        ("q1 [grad],x,y,z,roll,pitch,yaw\n0,1,2,3,0,0,0\n", "unit 'grad'"),
        ("q1,q1,x,y,z,roll,pitch,yaw\n0,0,1,2,3,0,0,0\n", "'q1' stands twice"),
        ("q1,x,y,z,qx,qy,qz,qw\n0,1,2,3,1,1,0,0\n", "line 2: the quaternion has length 1.41"),
        ("q1,x,y,z,roll,pitch,yaw\n0,1,2,3,0,0,0\n", "1 of them; give three or more"),
    ],
)
def test_a_bad_poses_file_is_refused_with_its_place(tmp_path, text, said):
    file = tmp_path / "poses.csv"
    file.write_text(text, encoding="utf-8")
    table = kl.load("single_link").table
    with pytest.raises(kl.KinlabError) as caught:
        kl.diagnose_table(table, file)
    assert said in str(caught.value)


def test_bad_arrays_are_refused():
    q, T = measured(PUMA, 5)
    for bad, said in (
        ((q[:4], T), "expected (N, n) and (N, 4, 4)"),
        ((q[:, :4], T), "has 6 joints, 'the poses' has 4"),
        ((q, 2 * T), "state 1 is no rigid transform"),
        ((q, T * np.nan), "every entry must be finite"),
    ):
        with pytest.raises(kl.KinlabError) as caught:
            kl.diagnose_table(PUMA, poses=bad)
        assert said in str(caught.value)


def test_poses_at_one_q_are_refused():
    q, T = measured(PUMA, 5)
    with pytest.raises(kl.KinlabError, match="all are at one q"):
        kl.diagnose_table(PUMA, poses=(np.tile(q[:1], (5, 1)), np.tile(T[:1], (5, 1, 1))))


def test_of_joints_at_rest_nothing_is_said_for_sure():
    """Two lengths that make up for each other while nothing between them turns."""
    q, _ = measured(PUMA, 8)
    q[:, 1:] = 0.0
    rows = list(PUMA.links)
    rows[1], rows[2] = replace(rows[1], a=rows[1].a + 0.2), replace(rows[2], a=rows[2].a - 0.2)
    other = replace(PUMA, links=tuple(rows))
    found = kl.diagnose_table(other, poses=(q, PUMA.fk(q)[:, -1]))
    assert "other tables would as well" in found.sentence and not found.certain_rows
    assert any("joints 2, 3, 4, 5 and 6 do not move" in note for note in found.notes)


def test_rows_away_from_the_joint_at_rest_are_sure():
    q, _ = measured(PUMA, 8)
    q[:, 5] = 0.3
    found = kl.diagnose_table(PUMA, poses=(q, PUMA.fk(q)[:, -1]))
    assert found.agrees and found.certain_rows == (1, 2, 3, 4)


def test_poses_in_millimetres_may_be_what_is_wrong():
    q, T = measured(PUMA, 6)
    T = T.copy()
    T[:, :3, 3] *= 1000.0
    found = kl.diagnose_table(PUMA, poses=(q, T))
    assert not found.agrees and any("another unit" in note for note in found.notes)


def test_noise_does_not_hide_that_joints_rest():
    q, _ = measured(PUMA, 40)
    q[:, 1:] = 0.3
    T = PUMA.fk(q)[:, -1].copy()
    T[:, :3, 3] += 1e-4 * np.random.default_rng(1).standard_normal((len(T), 3))
    found = kl.diagnose_table(PUMA, poses=(q, T))
    assert any("joints 2, 3, 4, 5 and 6 do not move" in note for note in found.notes)


@pytest.mark.parametrize("mm", [0.0, 0.1])
@pytest.mark.parametrize("mine", [PUMA, row(PUMA, 4, d=0.4)], ids=["right", "a slip"])
def test_a_pose_that_is_far_off_is_left_out_and_named(mm, mine):
    q, T = measured(PUMA, mm=mm, deg=0.1 * mm)
    T[16, :3, 3] += (0.03, 0.0, 0.0)
    found = kl.diagnose_table(mine, poses=(q, T))
    assert found.states == 39
    assert "pose 17 is left out" in str(found)
    assert found.agrees == (mine is PUMA)
    assert mine is PUMA or [(c.row, c.column) for c in found.causes] == [(4, "d")]


def test_what_noise_hides_is_said():
    poses = measured(PUMA, mm=1.0, deg=0.05)
    right = kl.diagnose_table(PUMA, poses=poses)
    hidden = right.clear["hidden_length"]
    assert right.agrees and "may not show" in str(right)
    assert 0.0005 < hidden < 0.005
    beyond = row(PUMA, 3, a=PUMA.links[2].a + 2 * hidden)
    assert not kl.diagnose_table(beyond, poses=poses).agrees


def test_an_encoders_last_digits_are_no_motion():
    rng = np.random.default_rng(4)
    q = rng.uniform(-2.0, 2.0, (40, 6))
    q[:, 3] = 0.3 + rng.normal(0.0, 1e-5, 40)
    T = kl.fk(kl.Robot.from_dh(PUMA), q)
    right = kl.diagnose_table(PUMA, poses=(q, T))
    assert right.agrees and right.verdict == "agrees at these poses"
    assert right.unseen_rows == (3, 4) and not {3, 4} & {*right.certain_rows}
    wrong = kl.diagnose_table(row(PUMA, 4, d=0.4), poses=(q, T))
    assert wrong.sentence.startswith("the poses allow, and do not prove: ")
