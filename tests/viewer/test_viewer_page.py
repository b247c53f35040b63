"""The saved page in a real browser: its kinematics, sliders, animation and five-bar."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from browser import chromium, open_file, ready, slide, tab, wait_until, world  # noqa: F401
from random_tables import random_table

import kinlab as kl
from kinlab.viewer.drawing.arm import joint_paths
from kinlab.viewer.scene import FiveBarScene, Scene

AGREE = 1e-9

SKEWED = """<robot name="skewed"><link name="a"/><link name="b"/><link name="c"/>
<joint name="turn" type="revolute"><parent link="a"/><child link="b"/>
<origin xyz=".1 .2 .3" rpy=".4 .5 .6"/><axis xyz="1 2 -2"/>
<limit lower="-3" upper="3" velocity="1" effort="1"/></joint>
<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/>
<origin xyz="-.3 .1 .2" rpy="1 -.5 2"/><axis xyz="-1 1 3"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"""


def robots():
    named = ["puma560", "stanford", "scara", "panda", "planar3r", "spatial3r", "single_link"]
    yield from map(kl.load, [*named, "erd:ur5", "erd:xarm7"])
    yield kl.Robot.from_urdf(SKEWED)
    for seed, convention in ((3, "standard"), (4, "modified"), (5, "standard")):
        yield kl.Robot.from_dh(random_table(seed, 5 + seed % 3, convention))


@pytest.fixture(scope="module")
def bare(chromium, tmp_path_factory):  # noqa: F811
    """A page of a small arm, for what needs the page's functions and no picture."""
    page = chromium.new_page(viewport={"width": 200, "height": 200})
    yield open_file(page, Scene(kl.load("planar2r")), tmp_path_factory.mktemp("bare"))
    page.close()


def test_kinematics_of_the_page_are_pinocchios(bare):
    """FK of every joint and of the tool, J and the singular values, on random poses."""
    rng = np.random.default_rng(0)
    for robot in robots():
        spec = Scene(robot, meshes=False)._spec
        poses = rng.uniform(np.maximum(robot.lower, -3), np.minimum(robot.upper, 3), (5, robot.n))
        answers = bare.evaluate(
            """([spec, poses]) => {
              const arm = kinlab.serialArm(spec);
              return poses.map(q => [arm.frames(q), arm.jacobian(q), kinlab.metrics(arm.task(q))]);
            }""",
            [spec, poses.tolist()],
        )
        data = robot.model.createData()
        for q, (frames, J, metrics) in zip(poses, answers, strict=True):
            pin.forwardKinematics(robot.model, data, q)
            joints = [m.homogeneous for m in list(data.oMi)[1:]]
            expected = np.array([*joints, kl.fk(robot, q)])
            assert np.abs(np.reshape(frames, (-1, 4, 4)) - expected).max() < AGREE, robot.name
            assert np.abs(np.array(J) - kl.jacobian(robot, q)).max() < AGREE, robot.name
            task = kl.jacobian(robot, q)[spec["rows"]]
            sigma = np.linalg.svd(task, compute_uv=False)
            assert np.abs(np.array(metrics["sigma"]) - sigma).max() < AGREE, robot.name
            assert metrics["sigmaMin"] == pytest.approx(sigma[-1], abs=AGREE)
            if sigma[-1] > 1e-12 * sigma[0]:
                assert metrics["kappa"] == pytest.approx(sigma[0] / sigma[-1], rel=1e-6)
            else:
                assert metrics["kappa"] == np.inf
            if task.shape[0] == task.shape[1]:
                assert metrics["det"] == pytest.approx(np.linalg.det(task), abs=AGREE)
            else:
                assert metrics["det"] is None


@pytest.mark.parametrize("shape", [(6, 6), (3, 7), (6, 2), (2, 2), (3, 1)])
def test_svd_of_the_page(bare, shape):
    """Against LAPACK, down to exactly singular matrices, where A A^T would lose half the digits."""
    rng = np.random.default_rng(1)
    for least in (1.0, 1e-6, 1e-10, 0.0):
        U, _, Vt = np.linalg.svd(rng.normal(size=shape), full_matrices=False)
        sigma = np.geomspace(1.0, least, len(Vt)) if least else np.append(np.ones(len(Vt) - 1), 0)
        A = U * sigma @ Vt
        found = bare.evaluate("A => kinlab.svd(A)", A.tolist())
        values = np.array([entry["sigma"] for entry in found])
        vectors = np.array([entry["vector"] for entry in found])
        assert np.abs(values[: len(sigma)] - np.sort(sigma)[::-1]).max() < 1e-14
        assert np.abs(vectors @ vectors.T - np.eye(shape[0])).max() < 1e-13
        # A A^T from the left singular vectors
        assert np.abs(vectors.T * values**2 @ vectors - A @ A.T).max() < 1e-13


def test_singular_pose_reads_infinite(tab, tmp_path):  # noqa: F811
    page = open_file(tab, Scene(kl.load("planar2r"), [0.3, 0.0]), tmp_path)
    text = page.inner_text("#panel")
    assert "∞" in text
    slide(page, 1, 0.5 * np.pi)
    assert "∞" not in page.inner_text("#panel")


@pytest.mark.parametrize("name", ["puma560", "stanford", "erd:finger_edu"])
def test_every_slider_moves_what_pinocchio_moves(tab, tmp_path, name):  # noqa: F811
    robot = kl.load(name)
    rng = np.random.default_rng(2)
    q = rng.uniform(robot.lower, robot.upper)
    page = open_file(tab, Scene(robot, q), tmp_path)
    data = robot.model.createData()
    for joint in range(robot.n):
        before = page.screenshot()
        q[joint] = 0.5 * (q[joint] + (robot.lower if joint % 2 else robot.upper)[joint])
        slide(page, joint, q[joint])
        pin.forwardKinematics(robot.model, data, q)
        for i, path in enumerate(joint_paths(robot.model)):
            assert np.abs(world(page, path) - data.oMi[i].homogeneous).max() < AGREE
        ready(page)
        # turning a cylinder about its own axis shows in its frame's arrows
        assert page.screenshot() != before, f"{name}: joint {joint} changed nothing on the screen"
    assert np.abs(np.array(page.evaluate("page.q")) - q).max() < 1e-13  # sliders keep 15 digits
    assert [url for url in page.asked if not url.startswith(("file:", "data:"))] == []


def test_number_box_takes_degrees_and_keeps_limits(tab, tmp_path):  # noqa: F811
    page = open_file(tab, Scene(kl.load("planar2r")), tmp_path)
    box = page.locator("input[type=number]").first
    box.fill("30")
    box.press("Enter")
    assert page.evaluate("page.q[0]") == pytest.approx(np.pi / 6)
    box.fill("9999")
    box.press("Enter")
    assert page.evaluate("page.q[0]") == kl.load("planar2r").upper[0]
    box.fill("")
    box.press("Enter")
    assert np.isfinite(page.evaluate("page.q[0]"))


def test_ellipsoid_has_the_singular_values_for_axes(tab, tmp_path):  # noqa: F811
    robot = kl.load("puma560")
    q = np.array([0.3, 0.5, -0.4, 0.2, 0.9, 0.1])
    page = open_file(tab, Scene(robot, q), tmp_path)
    U, sigma, _ = np.linalg.svd(kl.jacobian(robot, q)[:3])
    for kind, axes in (("velocity", sigma), ("force", 1.0 / sigma)):
        shape = world(page, f"/meshcat/ellipsoids/{kind}")
        ratio = shape[:3, :3] @ shape[:3, :3].T / np.max(shape[:3, :3] @ shape[:3, :3].T)
        expected = U @ np.diag(axes**2) @ U.T
        assert np.abs(ratio - expected / expected.max()).max() < 1e-6
        assert np.abs(shape[:3, 3] - kl.fk(robot, q)[:3, 3]).max() < AGREE


def flipped(convention):
    """Joints that turn and slide against z, with every column of the table in use."""
    links = [
        kl.DHLink(a=0.3, alpha=0.7, d=0.2, theta=0.4, flip=True),
        kl.DHLink("prismatic", a=-0.2, alpha=-1.1, d=0.3, theta=-0.9, flip=True),
        kl.DHLink(a=0.1, alpha=2.0, d=-0.25, theta=2.5),
    ]
    return kl.Robot.from_dh(kl.DHTable("flipped", convention, links))


@pytest.mark.parametrize(
    "name", ["puma560", "puma560_modified", "stanford", "erd:ur5", "standard", "modified"]
)
def test_dh_picture_stands_on_the_dh_frames(tab, tmp_path, name):  # noqa: F811
    """Frames where the hand product puts them; d and theta lead from one to the next."""
    robot = flipped(name) if name in ("standard", "modified") else kl.load(name)
    table = robot.table or kl.to_dh(robot)
    rng = np.random.default_rng(3)
    q = rng.uniform(np.maximum(robot.lower, -3), np.minimum(robot.upper, 3))
    page = open_file(tab, Scene(robot, q, meshes=False), tmp_path)
    paths = joint_paths(robot.model)
    frames = [np.asarray(table.base), *table.frames(q)]
    for i, frame in enumerate(frames):
        assert np.abs(world(page, f"{paths[i]}/dh/frame_{i}") - frame).max() < AGREE
    for i, link in enumerate(table.links, 1):
        foot = world(page, f"{paths[i - 1]}/dh/dh_row_{i}")
        rod = world(page, f"{paths[i - 1]}/dh/dh_row_{i}/d")
        sign = -1.0 if link.flip else 1.0
        d = link.d + (sign * q[i - 1] if link.joint == "prismatic" else 0.0)
        assert np.abs(foot[:3, :3] @ [0, 0, d] - rod[:3, 2]).max() < 1e-8
        # theta, as the page's table shows it, turns the foot's x into that of the link
        shown = page.locator("table tr").nth(i).locator("td").nth(4).inner_text()
        theta = np.radians(float(shown.rstrip("°")))
        x = world(page, paths[i - 1] + f"/dh/dh_row_{i}")[:3, :3] @ [
            np.cos(theta),
            np.sin(theta),
            0,
        ]
        behind = frames[i] if str(table.convention) == "modified" else world(
            page, f"{paths[i]}/dh/dh_x_{i}")  # fmt: skip
        assert np.abs(x - behind[:3, 0]).max() < 1e-3
        # the a rod and alpha arc: one step along and about x from the z axis before to the next
        modified = str(table.convention) == "modified"
        start = world(page, f"{paths[i - 1 if modified else i]}/dh/dh_x_{i}")
        c, s = np.cos(link.alpha), np.sin(link.alpha)
        step = np.array([[1, 0, 0, link.a], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
        end = foot if modified else frames[i]
        assert np.abs(start @ step - end).max() < AGREE


def test_dh_rows_are_drawn_on_demand(tab, tmp_path):  # noqa: F811
    page = open_file(tab, Scene(kl.load("puma560"), [0.3] * 6), tmp_path)
    plain = page.screenshot()
    assert page.locator(".label:visible", has_text="a2").count() == 0
    page.locator("table tr").nth(2).click()
    page.wait_for_timeout(100)
    assert "0.4318" in page.locator(".label:visible", has_text="a2").inner_text()
    assert page.screenshot() != plain
    page.locator("#dh-all").click()
    page.wait_for_timeout(100)
    assert page.locator(".label:visible", has_text="θ6 =").count() == 1


def test_animation_plays_pauses_and_scrubs(tab, tmp_path):  # noqa: F811
    robot = kl.load("planar2r")
    scene = Scene(robot)
    rows = np.array([[0.0, 0.0], [1.0, -0.5], [0.5, 2.0]])
    scene.animate(rows, [0.0, 1.0, 3.0], "Try")
    page = open_file(tab, scene, tmp_path)
    page.evaluate("page.seek(2)")
    assert page.evaluate("page.q") == pytest.approx([0.75, 0.75])
    page.locator("#scrub").evaluate("r => { r.value = 0.5; r.dispatchEvent(new Event('input')); }")
    assert page.evaluate("page.q") == pytest.approx([0.5, -0.25])
    page.locator("#play").click()
    wait_until(page, "page.state.time > 0.7")
    page.locator("#play").click()
    held = page.evaluate("page.q")
    page.wait_for_timeout(150)
    assert page.evaluate("page.q") == held
    page.locator("#play").click()  # runs on over the end and starts again
    page.evaluate("page.seek(2.95)")
    wait_until(page, "page.state.time < 2")


def five_bars():
    yield kl.FiveBar.load("isotropic")
    yield kl.FiveBar(l1=[0.3, 0.25], l2=[0.5, 0.55], e=0.12)


def test_five_bar_closes_in_the_page(tab, tmp_path):  # noqa: F811
    """Closed form against the Python one, and the rods' ends against each other in the scene."""
    rng = np.random.default_rng(4)
    for linkage in five_bars():
        scene = FiveBarScene(linkage)
        page = open_file(tab, scene, tmp_path)
        for theta in scene.q + rng.uniform(-0.3, 0.3, (4, 2)):
            reached = np.array(page.evaluate("q => page.setJoints(q)", theta.tolist()))
            assert np.abs(reached - theta).max() == 0.0
            tool = linkage.fk(theta)
            J = linkage.jacobian(tool, scene.mode)
            home = world(page, "/meshcat/fivebar")
            ends = [
                world(page, f"/meshcat/fivebar/rod{i + 1}") @ [np.asarray(linkage.l2)[i], 0, 0, 1]
                for i in range(2)
            ]
            for end in ends:
                assert np.abs(end - home @ [*tool, 0, 1]).max() < AGREE
            elbow = world(page, "/meshcat/fivebar/crank1") @ [np.asarray(linkage.l1)[0], 0, 0, 1]
            assert np.abs(elbow - world(page, "/meshcat/fivebar/rod1")[:, 3]).max() < AGREE
            rates = np.array(page.evaluate("page.model.task(page.q)"))
            assert np.abs(rates - J).max() < AGREE * np.abs(J).max()


def rods_sine(linkage, q):
    """w_1 x w_2 of a pose given by its cranks."""
    u = np.column_stack([np.cos(q), np.sin(q)])
    elbows = np.column_stack([linkage.base_x, [0, 0]]) + np.asarray(linkage.l1)[:, None] * u
    w = (linkage.fk(q) - elbows) / np.asarray(linkage.l2)[:, None]
    return w[0, 0] * w[1, 1] - w[0, 1] * w[1, 0]


def test_five_bar_stops_at_type_two(tab, tmp_path):  # noqa: F811
    """Cranks drawn apart until the rods are stretched: the drag ends there, and says so."""
    linkage = kl.FiveBar(l1=0.3, l2=0.35, e=0.1)
    scene = FiveBarScene(linkage)
    page = open_file(tab, scene, tmp_path)
    assert page.locator("#stopped").is_hidden()
    slide(page, 0, -0.6)
    assert page.locator("#stopped").is_hidden()
    slide(page, 1, -np.pi)
    assert "type II" in page.inner_text("#stopped")
    q = np.array(page.evaluate("page.q"))
    assert -np.pi < q[1] < scene.q[1]
    assert rods_sine(linkage, q) == pytest.approx(0.01, rel=1e-3)
    slide(page, 1, scene.q[1])  # and back out of it, on the side it came from
    assert page.locator("#stopped").is_hidden()
    q = np.array(page.evaluate("page.q"))
    assert q == pytest.approx([-0.6, scene.q[1]], abs=1e-13)
    assert rods_sine(linkage, q) > 0.01


@pytest.mark.parametrize("name", ["ur5", "talos_arm", "kinova"])
def test_meshes_are_shown(tab, tmp_path, name):  # noqa: F811
    """Collada and STL: the meshes are in the scene, and every part has a material to show it."""
    page = open_file(tab, Scene(kl.load(f"erd:{name}")), tmp_path)
    count = page.evaluate(
        """() => {
          let triangles = 0;
          kinlab.node(page.spec.body).traverse(o => {
            if (!o.geometry) return;
            for (const material of [o.material].flat()) {
              if (!material || !material.isMaterial) throw new Error("a part is invisible");
            }
            if ([o.material].flat(9).length !== [o.material].flat().length) throw new Error("nested");
            const g = o.geometry;
            triangles += (g.index ? g.index.count : g.attributes.position.count) / 3;
          });
          return triangles;
        }"""
    )
    assert count > 5000


def test_notebook_cell_works_inside_its_frame(tab):  # noqa: F811
    tab.set_content(f"<h1>cell</h1>{Scene(kl.load('planar2r'))._repr_html_()}")
    cell = tab.frames[1]
    ready(cell)
    slide(cell, 0, 0.5)
    assert cell.evaluate("page.q") == [0.5, 0.0]


def test_tool_trace_follows_the_tool(tab, tmp_path):  # noqa: F811
    robot = kl.load("planar2r")
    page = open_file(tab, Scene(robot, [0.1, 0.4]), tmp_path)
    page.get_by_label("tool trace").check()
    poses = [[0.1, 0.4], [0.2, 0.4], [0.2, 0.6]]
    for q in poses[1:]:
        page.evaluate("q => page.setJoints(q)", q)
    drawn = page.evaluate(
        "() => [...kinlab.node(page.spec.trace).children[0].geometry.attributes.position.array]"
    )
    assert np.abs(np.reshape(drawn, (-1, 3)) - kl.fk(robot, poses)[:, :3, 3]).max() < 1e-6
    page.get_by_label("tool trace").uncheck()
    assert page.evaluate("kinlab.node(page.spec.trace).visible") is False
