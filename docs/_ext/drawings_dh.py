"""Drawings of the shipped arms and five-bars as SVG: links, joints, and the DH frames on them.

Colours are the viewer's: x and what lies along it red, z and what lies along it blue. They are
readable on white and on black; text has the page's own colour.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from html import escape

import numpy as np
from numpy.typing import NDArray

import kinlab as kl

Array = NDArray[np.float64]

RED, BLUE, LINK, JOINT, LIT, TOOL = "#d64541", "#3a82d6", "#93a1ad", "#5b7186", "#8ea3b8", "#2e9e5b"
TWO = "#d9822b"
WIDTH = 560.0
"""Of a picture, pixels; it shrinks with the page."""
ABOVE = np.array([0.0, 0.0, 1.0])
ASIDE = np.array([1.0, -1.3, 0.7])
"""Towards the viewer: of arms that stay in a plane, and of all others."""


def axis_word(letter: str, numbers: Iterable[int]) -> str:
    """``z`` with its frame's number below, several joined: as an SVG text's content."""
    parts = []
    for k in numbers:
        low = f'<tspan dy="4" font-size="12">{k}</tspan><tspan dy="-4">&#8203;</tspan>'
        parts.append(f'<tspan font-style="italic">{letter}</tspan>{low}')
    return ", ".join(parts)


@dataclass
class Picture:
    """Pieces of a drawing with their depth, and labels that keep clear of each other.

    Attributes:
        towards: direction to the viewer, (3,).
        scale: pixels a metre.
        middle: what is drawn in the middle, metres, on the screen, (2,).
        height: of the picture, pixels.
    """

    towards: Array
    scale: float = 1.0
    middle: Array = field(default_factory=lambda: np.zeros(2))
    height: float = WIDTH
    pieces: list[tuple[float, str]] = field(default_factory=list)
    boxes: list[tuple[float, float, float, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        d = self.towards / np.linalg.norm(self.towards)
        up = np.array([0.0, 1.0, 0.0]) if abs(d[2]) > 0.99 else np.array([0.0, 0.0, 1.0])
        right = np.cross(up, d)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(d, right), d])

    def frame(self, points: Array, margin: float, most: float, least: float = 150.0) -> None:
        """Chooses the scale so that the points fill the picture, no higher than ``most``."""
        flat = points @ self.axes[:2].T
        low, high = flat.min(axis=0), flat.max(axis=0)
        room = np.maximum(high - low, 1e-9)
        self.scale = float(min((WIDTH - 2 * margin) / room[0], (most - 2 * margin) / room[1]))
        self.middle = 0.5 * (low + high)
        self.height = max(least, float(room[1]) * self.scale + 2 * margin)

    def at(self, point: Array) -> Array:
        """A point of the world in pixels, (2,)."""
        flat = (self.axes[:2] @ point - self.middle) * self.scale
        return np.array([WIDTH / 2 + flat[0], self.height / 2 - flat[1]])

    def depth(self, point: Array) -> float:
        """How near the viewer."""
        return float(self.axes[2] @ point)

    def line(self, start: Array, end: Array, colour: str, width: float, front: float = 0.0) -> None:
        """A straight piece."""
        (x1, y1), (x2, y2) = self.at(start), self.at(end)
        text = (
            f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" '
            f'stroke-width="{width:g}" stroke-linecap="round"/>'
        )
        self.pieces.append((self.depth(0.5 * (start + end)) + front, text))

    def dot(self, point: Array, radius: float, fill: str, stroke: str, front: float = 0.0) -> None:
        """A disc, its radius in pixels."""
        x, y = self.at(point)
        text = (
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:g}" fill="{fill}" stroke="{stroke}" '
            'stroke-width="1.5"/>'
        )
        self.pieces.append((self.depth(point) + front, text))

    def cylinder(self, centre: Array, axis: Array, half: float, radius: float) -> None:
        """A revolute joint; lengths in pixels."""
        x, y = self.at(centre)
        side = self.axes @ axis
        angle = float(np.degrees(np.arctan2(-side[1], side[0])))
        reach = half * float(np.hypot(side[0], side[1]))
        flat = radius * abs(float(side[2]))
        near = reach if side[2] > 0 else -reach
        text = (
            f'<g transform="translate({x:.1f} {y:.1f}) rotate({angle:.1f})" stroke-width="1.2" '
            f'stroke="{JOINT}"><path d="M{-reach:.1f},{-radius:g} L{reach:.1f},{-radius:g} '
            f"A{flat:.1f},{radius:g} 0 0 1 {reach:.1f},{radius:g} L{-reach:.1f},{radius:g} "
            f'A{flat:.1f},{radius:g} 0 0 1 {-reach:.1f},{-radius:g} Z" fill="{JOINT}"/>'
            f'<ellipse cx="{near:.1f}" cy="0" rx="{flat:.1f}" ry="{radius:g}" fill="{LIT}"/></g>'
        )
        self.pieces.append((self.depth(centre) + radius / self.scale, text))

    def box(self, centre: Array, frame: Array, half: Array) -> None:
        """A prismatic joint's housing: a box along the frame's z; lengths in pixels."""
        for axis in range(3):
            for sign in (1.0, -1.0):
                normal = sign * frame[:, axis]
                if self.axes[2] @ normal <= 1e-9:
                    continue
                one, two = ((axis + 1) % 3, (axis + 2) % 3)
                half_m = half / self.scale
                corners = [
                    centre
                    + normal * half_m[axis]
                    + a * half_m[one] * frame[:, one]
                    + b * half_m[two] * frame[:, two]
                    for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))
                ]
                points = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self.at, corners))
                fill = LIT if self.axes[2] @ normal > 0.6 else JOINT
                text = f'<polygon points="{points}" fill="{fill}" stroke="{JOINT}"/>'
                self.pieces.append((self.depth(centre) + half[0] / self.scale, text))

    def arrow(self, origin: Array, tip: Array, colour: str) -> None:
        """An axis; one that points at the viewer is a ring with a dot, away from him a cross."""
        start, end = self.at(origin), self.at(tip)
        way = end - start
        length = float(np.linalg.norm(way))
        if length < 6.0:
            x, y = start
            towards = self.depth(tip) > self.depth(origin)
            inner = (
                f'<circle cx="{x:.1f}" cy="{y:.1f}" r="1.8" fill="{colour}" stroke="none"/>'
                if towards
                else f'<path d="M{x - 3.2:.1f},{y - 3.2:.1f} l6.4,6.4 m0,-6.4 l-6.4,6.4"/>'
            )
            text = (
                f'<g stroke="{colour}" stroke-width="1.6" fill="none">'
                f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="#ffffff"/>{inner}</g>'
            )
            self.pieces.append((self.depth(tip) + 1e3, text))
            return
        u = way / length
        side = np.array([-u[1], u[0]])
        head = [end, end - 9 * u + 3.4 * side, end - 9 * u - 3.4 * side]
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in head)
        stop = end - 7 * u
        text = (
            f'<line x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{stop[0]:.1f}" y2="{stop[1]:.1f}" '
            f'stroke="{colour}" stroke-width="2.2"/><polygon points="{points}" fill="{colour}"/>'
        )
        self.pieces.append((self.depth(0.5 * (origin + tip)) + 1e3, text))

    def label(self, at: Array, way: Array, word: str, letters: int, colour: str) -> None:
        """A text near a place in pixels, in the direction ``way`` where there is room."""
        length = float(np.linalg.norm(way))
        start = np.arctan2(way[1], way[0]) if length > 1e-6 else -0.8
        wide, high = 9.5 * letters + 2, 20.0
        best, least = at, np.inf
        for far in (14.0, 20.0, 28.0, 38.0, 50.0):
            for turn in (0.0, 0.5, -0.5, 1.0, -1.0, 1.6, -1.6, 2.4, -2.4, 3.1):
                away = 2.0 * (far - 14.0) + 6.0 * abs(turn)
                if away >= least:
                    continue
                u = np.array([np.cos(start + turn), np.sin(start + turn)])
                centre = at + (far + 0.4 * wide * abs(u[0])) * u
                cost = self._covered(centre, wide, high) + away
                if cost < least:
                    best, least = centre, cost
        x, y = best
        self.boxes.append((x - wide / 2, y - high / 2, x + wide / 2, y + high / 2))
        text = (
            f'<text x="{x:.1f}" y="{y + 5:.1f}" text-anchor="middle" font-size="18" '
            f'fill="{colour}">{word}</text>'
        )
        self.pieces.append((1e6, text))

    def _covered(self, centre: Array, wide: float, high: float) -> float:
        """Area that a text would share with others, or have outside the picture."""
        x, y = centre
        left, top, right, bottom = x - wide / 2, y - high / 2, x + wide / 2, y + high / 2
        area = 0.0
        for a, b, c, d in self.boxes:
            area += max(0.0, min(right, c) - max(left, a)) * max(0.0, min(bottom, d) - max(top, b))
        inside = max(0.0, min(right, WIDTH) - max(left, 0.0)) * max(
            0.0, min(bottom, self.height) - max(top, 0.0)
        )
        return area + (wide * high - inside)

    def keep_clear(self, start: Array, end: Array, half: float = 4.0) -> None:
        """Labels keep away from the line between two places in pixels."""
        steps = 2 + int(np.linalg.norm(end - start) / (2 * half))
        for share in np.linspace(0.0, 1.0, steps):
            x, y = start + share * (end - start)
            self.boxes.append((x - half, y - half, x + half, y + half))

    def svg(self, said: str) -> str:
        """The picture; ``said`` is what a screen reader says of it."""
        drawn = "\n".join(text for _, text in sorted(self.pieces, key=lambda piece: piece[0]))
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {self.height:.0f}" '
            f'role="img" aria-label="{escape(said, quote=True)}" class="robot-drawing" '
            'font-family="Georgia, Times, serif">\n' + drawn + "\n</svg>"
        )


# -------- Arms


def planar(table: kl.DHTable) -> bool:
    """Whether all joint axes stay along the base's z at every q."""
    return all(link.joint == "revolute" and abs(link.alpha) < 1e-9 for link in table.links)


def dh_steps(table: kl.DHTable, frames: list[Array]) -> list[tuple[Array, Array, str]]:
    """From frame to frame along x and along z, as each row of the table goes.

    Args:
        table: the table.
        frames: frames 0 to n in the world, (4, 4) each.

    Returns:
        Two steps for each row: start and end, (3,), and the colour of the axis it follows.
    """
    steps = []
    for link, start, stop in zip(table.links, frames, frames[1:], strict=False):
        if str(table.convention) == "modified":  # a along x of the frame before, d along z
            corner, colours = start[:3, 3] + link.a * start[:3, 0], (RED, BLUE)
        else:  # d along z of the frame before, a along the frame's own x
            corner, colours = stop[:3, 3] - link.a * stop[:3, 0], (BLUE, RED)
        steps += [(start[:3, 3], corner, colours[0]), (corner, stop[:3, 3], colours[1])]
    return steps


def arm(table: kl.DHTable, q: Array, *, frames: bool = True, most: float = 470.0) -> str:
    """An arm from its DH table: what lies along x of a row, what lies along z, joints and frames.

    Args:
        table: the table.
        q: joint positions, (n,).
        frames: draw the frames' axes and names.
        most: greatest height, pixels.

    Returns:
        An SVG element.
    """
    before = [np.asarray(table.base), *table.frames(q)]
    tool = before[-1] @ np.asarray(table.tool)
    segments = dh_steps(table, before)
    corners = [before[0][:3, 3], *(end for _, end, _ in segments)]
    has_tool = not np.allclose(np.asarray(table.tool), np.eye(4))
    corners.append(tool[:3, 3])
    points = np.array(corners)
    size = float(np.ptp(points, axis=0).max()) or 1.0
    picture = Picture(ABOVE if planar(table) else ASIDE)
    length = (0.17 if not planar(table) else 0.13) * size
    around = [points]
    if frames:
        around += [
            pose[:3, 3] + length * pose[:3, [0, 2]].T
            for pose in ([*before, tool] if has_tool else before)
        ]
    ends = np.concatenate(around)
    picture.frame(ends, 34.0 if frames else 40.0, most, 240.0 if frames else 330.0)
    for start, stop, colour in segments:
        if np.linalg.norm(stop - start) > 1e-9:
            picture.line(start, stop, LINK, 11.0)
            picture.keep_clear(picture.at(start), picture.at(stop), 6.0)
            if frames:
                picture.line(start, stop, colour, 2.6, 0.02 * size)
    if has_tool:
        picture.line(before[-1][:3, 3], tool[:3, 3], LINK, 7.0)
        picture.keep_clear(picture.at(before[-1][:3, 3]), picture.at(tool[:3, 3]), 5.0)
    _joints(picture, table, before)
    _ground(picture, before[0])
    picture.dot(tool[:3, 3], 5.0, TOOL, TOOL, 0.02 * size)
    if frames:
        _axes(picture, before, tool if has_tool else None, length)
    return picture.svg(f"{table.name}: the arm with its DH frames" if frames else table.name)


def _joints(picture: Picture, table: kl.DHTable, before: list[Array]) -> None:
    seen: list[Array] = []
    for i, link in enumerate(table.links):
        pose = before[i + 1] if str(table.convention) == "modified" else before[i]
        centre, axis = pose[:3, 3], pose[:3, 2]
        same = sum(bool(np.allclose(centre, one, atol=1e-6)) for one in seen)
        seen.append(centre)
        reach = 13.0 / picture.scale * axis
        picture.keep_clear(picture.at(centre - reach), picture.at(centre + reach), 10.0)
        if link.joint == "revolute":
            small = 1.0 if not same else 0.75
            picture.cylinder(centre, axis, 13.0 * small, 10.0 * small)
        else:
            picture.box(centre, pose[:3, :3], np.array([10.0, 10.0, 20.0]))


def _ground(picture: Picture, base: Array) -> None:
    """The floor under the base: a disc about its z."""
    u, v = base[:3, 0], base[:3, 1]
    angle = np.linspace(0.0, 2.0 * np.pi, 37)
    ring = base[:3, 3] + 26.0 / picture.scale * (
        np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v
    )
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(picture.at, ring))
    text = f'<polygon points="{points}" fill="{LINK}" fill-opacity=".3" stroke="{LINK}"/>'
    picture.pieces.append((-1e6, text))


def _axes(picture: Picture, frames: list[Array], tool: Array | None, length: float) -> None:
    """x and z of each frame; axes that lie in each other have one name with several numbers."""
    drawn = []
    for letter, column, colour in (("x", 0, RED), ("z", 2, BLUE)):
        groups: list[tuple[Array, Array, list[int]]] = []
        for k, pose in enumerate(frames):
            origin, tip = pose[:3, 3], pose[:3, 3] + length * pose[:3, column]
            for one, other, numbers in groups:
                if np.allclose(one, origin, atol=1e-6) and np.allclose(other, tip, atol=1e-6):
                    numbers.append(k)
                    break
            else:
                groups.append((origin, tip, [k]))
        for origin, tip, _ in groups:
            picture.arrow(origin, tip, colour)
            picture.keep_clear(picture.at(origin), picture.at(tip))
        drawn += [(*group, letter, colour) for group in groups]
    at = np.zeros(2)
    if tool is not None:
        at = picture.at(tool[:3, 3])
        for column, colour in ((0, RED), (2, BLUE)):
            tip = tool[:3, 3] + 0.7 * length * tool[:3, column]
            picture.arrow(tool[:3, 3], tip, colour)
            picture.keep_clear(at, picture.at(tip))
    for origin, tip, numbers, letter, colour in drawn:
        start, end = picture.at(origin), picture.at(tip)
        way = end - start if np.linalg.norm(end - start) >= 6.0 else np.array([-1.0, 1.0])
        picture.label(end, way, axis_word(letter, numbers), 2 * len(numbers), colour)
    if tool is not None:
        picture.label(at, np.array([1.0, 0.4]), "tool", 4, TOOL)


# -------- Five-bars


def five_bar(bar: kl.FiveBar, theta: Array, *, names: bool = True, most: float = 420.0) -> str:
    """A five-bar at crank angles (2,), in its plane: pins, cranks, rods, and what they are called.

    Args:
        bar: the linkage.
        theta: crank angles, rad, (2,); the assembly is +1.
        names: draw the letters and angles.
        most: greatest height, pixels.

    Returns:
        An SVG element.
    """
    tool = np.append(bar.fk(theta, assembly=1), 0.0)
    pins = [np.array([x, 0.0, 0.0]) for x in bar.base_x]
    turn = [np.array([np.cos(t), np.sin(t), 0.0]) for t in theta]
    elbows = [pins[i] + bar.l1[i] * turn[i] for i in range(2)]
    points = np.array([*pins, *elbows, tool])
    picture = Picture(ABOVE)
    picture.frame(points, 52.0 if names else 40.0, most, 240.0 if names else 330.0)
    colours = (BLUE, TWO)
    for i in range(2):
        picture.line(pins[i], elbows[i], colours[i], 9.0)
        picture.line(elbows[i], tool, colours[i], 5.0, -0.001)
    for i in range(2):
        _hatched(picture, pins[i])
        picture.dot(elbows[i], 6.0, "#ffffff", colours[i], 0.01)
    picture.dot(tool, 7.0, TOOL, TOOL, 0.02)
    if names:
        _letters(picture, bar, pins, elbows, tool, theta, colours)
    return picture.svg(f"{bar.name}: the five-bar" if names else bar.name)


def _hatched(picture: Picture, pin: Array) -> None:
    x, y = picture.at(pin)
    hatch = "".join(f"M{x - 13 + 6 * k:.1f},{y - 22:.1f} l5,-6 " for k in range(5))
    text = (
        f'<path d="M{x:.1f},{y:.1f} l-11,-22 h22 Z" fill="{LINK}" fill-opacity=".5" '
        f'stroke="{JOINT}"/><path d="{hatch}" stroke="{JOINT}"/>'
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="#ffffff" stroke="{JOINT}" '
        'stroke-width="2"/>'
    )
    picture.pieces.append((0.01, text))


def _letters(
    picture: Picture,
    bar: kl.FiveBar,
    pins: list[Array],
    elbows: list[Array],
    tool: Array,
    theta: Array,
    colours: tuple[str, str],
) -> None:
    ink = "currentColor"
    together = bar.e == 0.0
    end = picture.at(tool)
    for pin, elbow in zip(map(picture.at, pins), map(picture.at, elbows), strict=True):
        picture.keep_clear(pin, pin + np.array([0.0, -28.0]), 12.0)
        picture.keep_clear(pin, elbow, 5.0)
        picture.keep_clear(elbow, end, 4.0)
    for i in range(2):
        pin, elbow = picture.at(pins[i]), picture.at(elbows[i])
        side = np.array([1.0 if i == 0 else -1.0, 0.0])
        where = side if not together else np.array([0.9, 0.3]) * (1 if i == 0 else -1)
        picture.label(pin, where, axis_word("A", [i + 1]), 2, ink)
        picture.label(elbow, elbow - end, axis_word("B", [i + 1]), 2, ink)
        for start, stop, k in ((pin, elbow, 1), (elbow, end, 2)):
            way = np.array([-(stop - start)[1], (stop - start)[0]])
            way = way if way @ side > 0 else -way
            picture.label(0.5 * (start + stop), way, axis_word("l", [k]), 2, colours[i])
        _angle(picture, pin, float(theta[i]), i, colours[i])
    picture.label(
        picture.at(tool), np.array([0.0, 1.0]), '<tspan font-style="italic">P</tspan>', 1, ink
    )


def _angle(picture: Picture, pin: Array, theta: float, leg: int, colour: str) -> None:
    """The crank's angle from x, counter-clockwise positive, as an arc."""
    radius = 24.0 + 7.0 * leg
    turned = float(np.arctan2(np.sin(theta), np.cos(theta)))
    end = pin + radius * np.array([np.cos(turned), -np.sin(turned)])
    sweep = 0 if turned > 0 else 1
    text = (
        f'<path d="M{pin[0]:.1f},{pin[1]:.1f} h{radius + 12:g}" stroke="{colour}" '
        f'stroke-width="1" stroke-dasharray="3 3"/>'
        f'<path d="M{pin[0] + radius:.1f},{pin[1]:.1f} A{radius:g},{radius:g} 0 0 {sweep} '
        f'{end[0]:.1f},{end[1]:.1f}" fill="none" stroke="{colour}" stroke-width="1.6"/>'
    )
    picture.pieces.append((0.5, text))
    half = np.array([np.cos(turned / 2), -np.sin(turned / 2)])
    at = pin + radius * half
    picture.label(at, half, axis_word("θ", [leg + 1]), 2, colour)
