"""Small things of the page that a user trips over: numbers, names, narrow windows, meshes."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from browser import chromium, open_file, tab, wait_until  # noqa: F401

import kinlab as kl
from kinlab.analysis.structure.axes import frame_origins
from kinlab.viewer import motions
from kinlab.viewer.drawing.bodies import DrawnBodies
from kinlab.viewer.scene import Scene

BODY = '<inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>'
VISUAL = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
LIMIT = '<limit lower="-2" upper="2" velocity="1" effort="1"/>'


def stl(path, normal):
    """A tetrahedron whose facets all claim one normal."""
    points = np.array([[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.3]], dtype=np.float32)
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    facets = b"".join(
        struct.pack("<12fH", *normal, *points[list(face)].ravel(), 0) for face in faces
    )
    path.write_bytes(bytes(80) + struct.pack("<I", len(faces)) + facets)


def arm(folder, *meshes, name="an_arm_with_a_joint_of_a_long_name"):
    stl(folder / "bare.stl", (0, 0, 0))
    stl(folder / "good.stl", (0, 0, 1))
    visuals = "".join(map(VISUAL.format, meshes))
    (folder / "arm.urdf").write_text(
        f'<robot name="arm"><link name="base"/><link name="l1">{BODY}{visuals}</link>'
        f'<link name="l2">{BODY}</link>'
        f'<joint name="{name}" type="revolute"><parent link="base"/><child link="l1"/>'
        f'<axis xyz="0 0 1"/>{LIMIT}</joint>'
        f'<joint name="b" type="revolute"><parent link="l1"/><child link="l2"/>'
        f'<origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>{LIMIT}</joint></robot>'
    )
    return kl.load(folder / "arm.urdf")


def test_a_missing_mesh_leaves_its_good_neighbour_alone(tmp_path):
    bodies = DrawnBodies(arm(tmp_path, "gone.stl", "good.stl"), [tmp_path], True)
    assert len(bodies.visuals.geometryObjects) == 1 and not bodies.bare
    assert bodies.notes == ["link 'l1': mesh 'gone.stl' is missing; it is left out"]
    alone = DrawnBodies(arm(tmp_path, "gone.stl"), [tmp_path], True)
    assert 1 in alone.bare
    assert alone.notes == ["link 'l1': mesh 'gone.stl' is missing; a rod stands for it"]


def test_facets_without_normals_are_lit(tab, tmp_path):  # noqa: F811
    page = open_file(tab, Scene(arm(tmp_path, "bare.stl")), tmp_path)
    lengths = page.evaluate(
        """() => {
          const found = [];
          kinlab.node(page.spec.joints[0].path).traverse(({ geometry, name }) => {
            const normal = geometry && geometry.type === "BufferGeometry" &&
              geometry.attributes.normal;
            if (!normal || geometry.attributes.position.count !== 12) return;
            for (let i = 0; i < normal.count; i++)
              found.push(Math.hypot(normal.getX(i), normal.getY(i), normal.getZ(i)));
          });
          return found;
        }"""
    )
    assert len(lengths) == 12
    assert np.allclose(lengths, 1.0, atol=1e-6)


def test_tiny_angles_read_zero_without_a_sign(tab, tmp_path):  # noqa: F811
    q = [2.08e-13, -1e-7, 1e-9, -3e-8, -1e-12, 0.25]
    page = open_file(tab, Scene(kl.load("puma560"), q), tmp_path)
    page.evaluate("() => page.showRow('all')")
    wait_until(page, "!viewer.needs_render")
    boxes = page.evaluate(
        "() => [...document.querySelectorAll('.joint input[type=number]')].map(x => x.value)"
    )
    assert boxes == ["0.0"] * 5 + ["14.3"]
    text = page.evaluate("() => document.body.innerText")
    assert "-0.0" not in text and "e-" not in text
    cells = page.evaluate(
        "() => [...document.querySelectorAll('table tr')].slice(1).map(r => r.lastChild.innerText)"
    )
    assert cells[:5] == ["0°"] * 5 and cells[5] == "14.324°"


def test_names_are_whole_and_meshcats_own_bar_is_gone(tab, tmp_path):  # noqa: F811
    page = open_file(tab, Scene(arm(tmp_path, "good.stl")), tmp_path)
    cut = page.evaluate(
        "() => [...document.querySelectorAll('.joint .name')].filter(x => x.scrollWidth > x.clientWidth + 1).length"
    )
    assert cut == 0
    assert page.evaluate("() => getComputedStyle(document.querySelector('.dg')).display") == "none"


def test_a_narrow_window_keeps_its_picture(tab, tmp_path):  # noqa: F811
    tab.set_viewport_size({"width": 420, "height": 800})
    page = open_file(tab, Scene(kl.load("planar2r")), tmp_path)
    boxes = page.evaluate(
        """() => ["stage", "panel"].map(id => {
          const { x, y, width, height } = document.getElementById(id).getBoundingClientRect();
          return [x, y, width, height];
        }).concat([[0, 0, viewer.renderer.domElement.clientWidth,
                    viewer.renderer.domElement.clientHeight]])"""
    )
    stage, panel, canvas = boxes
    assert stage[2] == panel[2] == canvas[2] == 420
    assert canvas[3] == pytest.approx(stage[3], abs=1) and stage[3] > 300
    assert panel[1] >= stage[1] + stage[3] - 1, "the panel covers the picture"
    assert_all_in_the_picture(page, kl.load("planar2r"), [page.evaluate("() => page.q")])


def assert_all_in_the_picture(page, robot, poses):
    points = np.concatenate([frame_origins(robot, np.array(q)) for q in poses])
    places = page.evaluate(
        """points => points.map(([x, y, z]) => {
          viewer.camera.updateMatrixWorld();
          const p = new MeshCat.THREE.Vector3(x, z, -y).project(viewer.camera);
          return [p.x, p.y];
        })""",
        points.tolist(),
    )
    assert np.abs(places).max() < 1.0


def test_the_whole_of_a_motion_is_in_the_picture(tab, tmp_path):  # noqa: F811
    robot = kl.load("stanford")
    scene = Scene(robot)
    shown = motions.motion(robot, "pick", scene.q)
    scene.animate(shown.q, shown.duration, shown.name)
    page = open_file(tab, scene, tmp_path)
    assert_all_in_the_picture(page, robot, shown.q)


def test_frames_are_seen_through_the_bodies(tab, tmp_path):  # noqa: F811
    page = open_file(tab, Scene(kl.load("planar2r")), tmp_path)
    hidden = page.evaluate(
        """() => {
          let hidden = 0, seen = 0;
          for (const path of page.spec.groups.frames) kinlab.node(path).traverse(o => {
            if (o.material) o.material.depthTest ? hidden++ : seen++;
          });
          return [hidden, seen];
        }"""
    )
    assert hidden[0] == 0 and hidden[1] > 0
