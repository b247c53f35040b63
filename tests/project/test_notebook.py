"""In a real notebook: every result shows itself, and what looks like degrees is asked about."""

from __future__ import annotations

import base64

import nbformat
from nbclient import NotebookClient

CELLS = {
    'import kinlab as kl, numpy as np\nrobot = kl.load("planar2r")\nrobot': "robot planar2r: 2 joints",
    "robot.table": "DH table planar2r",
    'kl.compare(robot, "gravity_torques", lambda q: 0 * q, 20)': "DIFFERS",
    'kl.diagnose(robot, "gravity_torques", lambda q: -kl.gravity_torques(robot, q))': "opposite sign",
    'kl.ik(robot, kl.fk(robot, [0.4, 0.9]), task="xy")': "solved",
    "kl.ik_branches(robot, kl.fk(robot, [0.4, 0.9]))": "2 solutions",
    "kl.find_singularities(robot, points=20)": "families of singular configurations",
    "kl.find_isotropic(robot, seeds=40)": "no isotropic configuration found",
    'kl.sweep(robot, "yoshikawa", 200, workers=1)': "sweep of 200 states",
    "mine = kl.DHTable('mine', 'standard', [kl.DHLink(a=0.3), robot.table.links[1]], gravity=[0, -9.81, 0])\n"
    "kl.diagnose_table(mine, robot)": "mine: differs",
    'five = kl.FiveBar.load("isotropic")\n'
    'five.size_servo((-0.05, 0.05, -0.55, -0.5), 1, 10, motor="SGMAH-08A", gear_ratio=20)': "servo sizing",
}

FIGURE = "kl.plots.ellipses(robot, [0.4, 0.9]).figure"  # pyplot was not imported


def test_every_result_shows_itself():
    book = nbformat.v4.new_notebook(
        cells=[
            nbformat.v4.new_code_cell(code) for code in (*CELLS, "kl.fk(robot, [30, 45])", FIGURE)
        ]
    )
    NotebookClient(book, timeout=120, kernel_name="python3").execute()
    *shown, asked, drawn = book.cells
    for cell, words in zip(shown, CELLS.values(), strict=True):
        (output,) = cell.outputs  # and nothing on stderr
        assert output.output_type == "execute_result", cell.source
        page, text = output.data["text/html"], output.data["text/plain"]
        assert words in page, cell.source
        assert page.startswith('<div style="border-left')
        assert "object at 0x" not in text
        if "robot" not in cell.source.splitlines()[-1] or "(" in cell.source.splitlines()[-1]:
            assert words in text, cell.source
    said = [output for output in asked.outputs if output.output_type == "stream"]
    assert "degrees?" in said[0].text
    assert said[0].name == "stderr"
    assert base64.b64decode(drawn.outputs[0].data["image/png"]).startswith(b"\x89PNG")
