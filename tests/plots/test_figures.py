"""The figures as an API: named, documented, drawn into the axes that are given."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import kinlab as kl
from kinlab.plots.canvas import new_axes

NAMES = {
    "ellipses", "fivebar", "fivebar_cycle", "fivebar_design", "fivebar_front", "fivebar_gains", "ik_history", "save",
    "singular_loci", "singular_values", "solutions", "torque_speed", "workspace", "workspace_cloud", "workspace_map",
}  # fmt: skip


@pytest.fixture(scope="module")
def planar():
    return kl.load("planar2r")


@pytest.fixture(scope="module")
def chart():
    return kl.sample_workspace("spatial3r", samples=3000, workers=1)


def test_every_figure_is_listed_and_documented():
    assert set(dir(kl.plots)) == NAMES
    for name in NAMES - {"save"}:
        figure = getattr(kl.plots, name)
        about = inspect.getdoc(figure)
        assert "ax" in inspect.signature(figure).parameters, name
        assert "ax:" in about and "Returns:" in about, name


def test_a_room_that_was_imported_hides_no_figure():
    import kinlab.plots.counts
    import kinlab.plots.mechanisms  # noqa: F401

    assert all(callable(getattr(kl.plots, name)) for name in NAMES)


def drawn(planar, chart, name, ax):
    bar = kl.FiveBar.load("isotropic")
    target = kl.fk(planar, [0.4, 0.9])
    return {
        "ellipses": lambda: kl.plots.ellipses(planar, [0.3, 1.2], ax=ax),
        "fivebar": lambda: kl.plots.fivebar(bar, resolution=41, ax=ax),
        "ik_history": lambda: kl.plots.ik_history(kl.ik(planar, target, history=True), ax=ax),
        "singular_loci": lambda: kl.plots.singular_loci("spatial3r", ax=ax),
        "singular_values": lambda: kl.plots.singular_values(planar, [[0, -1], [0, 1]], ax=ax),
        "workspace": lambda: kl.plots.workspace(planar, samples=2000, ax=ax),
        "workspace_map": lambda: kl.plots.workspace_map(chart, ax=ax),
    }[name]()


@pytest.mark.parametrize(
    "name",
    ["ellipses", "fivebar", "ik_history", "singular_loci", "singular_values", "workspace", "workspace_map"],
)  # fmt: skip
def test_figures_draw_into_the_axes_given(planar, chart, name):
    mine = new_axes()
    assert drawn(planar, chart, name, mine) is mine
    assert mine.lines or mine.collections
    assert mine.get_xlabel() and mine.get_ylabel()


def test_iterations_are_whole_numbers(planar):
    ax = kl.plots.ik_history(kl.ik(planar, kl.fk(planar, [0.4, 0.9]), history=True))
    ax.figure.canvas.draw()
    ticks = ax.get_xticks()
    assert np.array_equal(ticks, np.round(ticks))
    with pytest.raises(kl.KinlabError, match="no history"):
        kl.plots.ik_history(kl.ik(planar, kl.fk(planar, [0.4, 0.9])))


def test_singular_curves_are_labelled():
    square = kl.plots.singular_loci("spatial3r")
    assert [t.get_text() for t in square.get_legend().get_texts()] == ["singular: det J = 0"]
    ticks = square.get_xticks()
    assert np.allclose(ticks % 15, 0.0)


def test_ticks_in_space_do_not_collide(chart):
    ax = kl.plots.workspace_cloud(chart)
    ax.figure.canvas.draw()
    renderer = ax.figure.canvas.get_renderer()
    boxes = [
        label.get_window_extent(renderer)
        for axis in (ax.xaxis, ax.yaxis, ax.zaxis)
        for label in axis.get_ticklabels()
        if label.get_text() and label.get_visible()
    ]
    assert len(boxes) >= 6
    for k, one in enumerate(boxes):
        assert not any(one.overlaps(two) for two in boxes[k + 1 :])


def test_a_map_ends_where_its_cells_end(chart):
    """The surface is clipped to the filled cells: a filled centre is in, one beyond a gap is not."""
    from kinlab.sweeps.workspace import binned

    ax = kl.plots.workspace_map(chart)
    flat = binned(chart)
    (surface,) = [c for c in ax.collections if c.get_array() is not None]
    u, v = 0.5 * (flat.u[1:] + flat.u[:-1]), 0.5 * (flat.v[1:] + flat.v[:-1])
    full = np.argwhere(flat.count > 0)
    path = surface.get_clip_path().get_fully_transformed_path()
    places = ax.transData.transform(np.column_stack([u[full[:, 0]], v[full[:, 1]]]))
    assert path.contains_points(places).all()
    corners = [[flat.u[0], flat.v[0]], [flat.u[-1], flat.v[-1]]]  # the tool never gets there
    assert not path.contains_points(ax.transData.transform(corners)).any()


def test_ellipses_of_several_axes_have_a_legend_each(planar):
    both = new_axes().figure.subplots(1, 2)
    for axes in both:
        kl.plots.ellipses(planar, [0.3, 1.2], ax=axes)
    assert not both[0].figure.legends
    for axes in both:
        kinds = [text.get_text().split(":")[0] for text in axes.get_legend().get_texts()]
        assert kinds == ["velocity", "force"]


@pytest.mark.parametrize(
    ("limit", "names"), [(np.pi, {"edge"}), (2.0, {"edge", "with a joint at a limit"})]
)
def test_a_section_names_the_lines_that_it_draws(limit, names):
    turn = {"lower": -limit, "upper": limit}
    first = kl.DHLink(d=0.4, alpha=np.pi / 2, lower=-np.pi, upper=np.pi)
    links = [first, kl.DHLink(a=0.35, **turn), kl.DHLink(a=0.3, **turn)]
    robot = kl.Robot.from_dh(kl.DHTable("elbow", "standard", links))
    axes = kl.plots.workspace(robot, kl.sample_workspace(robot, samples=500, workers=1))
    (legend,) = axes.figure.legends
    assert {text.get_text() for text in legend.get_texts()} >= names
    drawn = {
        (line.get_color(), line.get_linestyle()) for line in axes.lines if len(line.get_xdata())
    }
    assert ("with a joint at a limit" in names) == any(style == "--" for _, style in drawn)


def test_a_figure_shows_itself_in_a_notebook_without_pyplot(planar):
    figure = kl.plots.ellipses(planar, [0.3, 1.2]).figure
    assert figure._repr_png_().startswith(b"\x89PNG")
