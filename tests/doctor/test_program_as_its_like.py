"""What a program lacks is told by what is like it: the arm's own table, a name's counterpart, the
other half of a twist, the other kind of joint.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line, with_slips, written

import kinlab as kl

DEGREES = """
import numpy as np
deg = np.pi/180
ROWS = [("R", 0.0, -90*deg, 0.412, 0.0), ("R", 0.0, 90*deg, 0.154, 0.0),
        ("P", 0.0203, 0.0, 0.0, -90*deg), ("R", 0.0, -90*deg, 0.0, 0.0),
        ("R", 0.0, 90*deg, 0.0, 0.0), ("R", 0.0, 0.0, 0.263, 0.0)]

def f(q):
    T = np.eye(4)
    for (kind, a, al, d, th), x in zip(ROWS, q):
        th, d = (th + x, d) if kind == "R" else (th, d + x)
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
        T = T @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])
    return T
"""
KINDS = """
import numpy as np
quarter = np.pi/2
ROWS = [("R", 0.0, -quarter, 0.412, 0.0), ("R", 0.0, quarter, 0.154, 0.0),
        ("P", 0.0203, 0.0, 0.0, -quarter), ("R", 0.0, -quarter, 0.0, 0.0),
        ("R", 0.0, quarter, 0.0, 0.0), ("R", 0.0, 0.0, 0.263, 0.0)]

def f(q):
    T = [np.eye(4)]
    for k, (_kind, a, al, d, th) in enumerate(ROWS):
        th, d = (th, d + q[k]) if k == 2 else (th + q[k], d)
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
        T.append(T[-1] @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]]))
    J = np.zeros((6, 6))
    for k, row in enumerate(ROWS):
        z, p = T[k][:3, 2], T[k][:3, 3]
        if row[0] == "P":
            J[:3, k] = z
        else:
            J[:3, k], J[3:, k] = np.cross(z, T[6][:3, 3] - p), z
    return J
"""
TENSORS = """
import numpy as np
ROWS = [(0.0, 0.0), (0.45, 0.0), (0.35, np.pi/2)]
MASSES = [3.0, 2.0, 1.2]
CENTRES = np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])

def tensor(xx, yy, zz, xy=0.0, yz=0.0):
    return np.array([[xx, xy, 0.0], [xy, yy, yz], [0.0, yz, zz]])

INERTIAS = [tensor(0.02, 0.08, 0.07), tensor(0.01, 0.04, 0.045),
            tensor(0.004, 0.012, 0.014, xy=0.001, yz=0.0005)]

def f(q):
    T, frames, M = np.eye(4), [], np.zeros((3, 3))
    for (a, al), t in zip(ROWS, q):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        T = T @ np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, 0], [s*sa, c*sa, ca, 0], [0, 0, 0, 1]])
        frames.append(T)
    for k, T in enumerate(frames):
        R, middle = T[:3, :3], T[:3, :3] @ CENTRES[k] + T[:3, 3]
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        for j in range(k + 1):
            z, p = frames[j][:3, 2], frames[j][:3, 3]
            Jv[:, j], Jw[:, j] = np.cross(z, middle - p), z
        M += MASSES[k]*Jv.T @ Jv + Jw.T @ R @ INERTIAS[k] @ R.T @ Jw
    return M
"""
GRADIENT = """
import numpy as np
L = np.array([0.5, 0.4, 0.25])

def f(q, target):
    t = np.cumsum(q)
    there = np.array([L @ np.cos(t), L @ np.sin(t), t[-1]])
    J = np.array([[-L[k:] @ np.sin(t[k:]) for k in range(3)],
                  [L[k:] @ np.cos(t[k:]) for k in range(3)], [1.0, 1.0, 1.0]])
    grad = -J.T @ (target - there)
    return q - 0.1*grad
"""
COUNTERPARTS = """
import numpy as np
LEGS = [(0.12, 0.3, 0.5), (-0.12, 0.26, 0.54)]

def f(xy, v, a, mode):
    turns = []
    for (base, crank, rod), side in zip(LEGS, mode):
        x, y = xy[0] - base, xy[1]
        far = np.hypot(x, y)
        one = np.arctan2(y, x) - side*np.arccos((crank**2 + far**2 - rod**2)/(2*crank*far))
        two = np.arctan2(y - crank*np.sin(one), x - crank*np.cos(one))
        B = np.array([[-crank*np.sin(one), -rod*np.sin(two)], [crank*np.cos(one), rod*np.cos(two)]])
        done, dtwo = np.linalg.solve(B, v)
        inward = -crank*done**2*np.array([np.cos(one), np.sin(one)]) - rod*dtwo**2*np.array([np.cos(two), np.sin(two)])
        turns.append(np.linalg.solve(B, a - inward)[0])
    return np.array(turns)
"""
MIXED = """
import numpy as np
def f(q, v):
    c = np.cos(q[1])
    M = np.array([[2.0*0.25**2 + 2.0*0.25/12 + 1.5*(0.25 + 0.04 + 0.2*c) + 0.02, 1.5*(0.04 + 0.1*c) + 0.02],
                  [1.5*(0.04 + 0.1*c) + 0.02, 1.5*0.04 + 0.02]])
    return 0.5*v @ M @ v
"""
HALVES = """
import numpy as np
A, D = [0.0, -0.425, -0.39225, 0.0, 0.0, 0.0], [0.089159, 0.0, 0.0, 0.10915, 0.09465, 0.0823]
AL = [np.pi/2, 0.0, 0.0, np.pi/2, -np.pi/2, 0.0]

def f(q):
    T = [np.eye(4)]
    for a, d, al, t in zip(A, D, AL, q):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        T.append(T[-1] @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]]))
    R, tip = T[6][:3, :3], T[6][:3, 3]
    Jv = np.array([np.cross(one[:3, 2], tip - one[:3, 3]) for one in T[:6]]).T
    Jw = np.array([one[:3, 2] for one in T[:6]]).T
    upper = R.T @ Jv
    lower = R.T @ Jw
    return np.vstack([upper, lower])
"""
ONE_KIND = """
import numpy as np
ROWS = [(0.0, -np.pi/2, 0.412, 0.0), (0.0, np.pi/2, 0.154, 0.0), (0.0203, 0.0, 0.0, -np.pi/2),
        (0.0, -np.pi/2, 0.0, 0.0), (0.0, np.pi/2, 0.0, 0.0), (0.0, 0.0, 0.263, 0.0)]

def f(q, qd):
    T, w, v, out = np.eye(4), np.zeros(3), np.zeros(3), []
    for k, (a, al, d, th) in enumerate(ROWS):
        slide = k == 2
        th = th + (0 if slide else q[k])
        d = d + (q[k] if slide else 0)
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
        z, last = T[:3, 2], T[:3, 3]
        T = T @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])
        w = w + (0 if slide else qd[k])*z
        v = v + np.cross(w, T[:3, 3] - last) + (qd[k]*z if slide else 0)
    return np.array([v @ v])[0]
"""

FLANGE = """
import numpy as np
A = [0, 0, 0, 0.0825, -0.0825, 0, 0.088]
AL = [0, -np.pi/2, np.pi/2, np.pi/2, -np.pi/2, np.pi/2, np.pi/2]
D = [0.333, 0, 0.316, 0, 0.384, 0, 0]

def f(q):
    T, frames = np.eye(4), []
    for a, al, d, t in zip(A, AL, D, q):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        T = T @ np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, -d*sa], [s*sa, c*sa, ca, d*ca], [0, 0, 0, 1]])
        frames.append(T)
    axes, points = np.array(frames)[:, :3, 2], np.array(frames)[:, :3, 3]
    tip = points[-1] + 0.107*axes[-1]
    return np.hstack([np.cross(axes, tip - points), axes]).T
"""
SYMBOLS = """
import numpy as np
def slopes(q):
    h = 1.5*0.5*0.2*np.sin(q[1])
    dM = np.zeros((2, 2, 2))
    dM[0, 0, 1] = -2*h
    dM[0, 1, 1] = dM[1, 0, 1] = -h
    return dM

def f(q):
    dM = slopes(q)
    return 0.5*(dM + dM.transpose(0, 2, 1) - dM.transpose(2, 0, 1))
"""
AT_REST = """
import numpy as np
L, M, IC = np.array([0.5, 0.4]), np.array([2.0, 1.5]), np.array([2.0*0.25/12, 1.5*0.16/12])

def f(q, v, a):
    t, w, al, acc, forces, levers = 0.0, 0.0, 0.0, np.array([0.0, 0.0]), [], []
    for k in range(2):
        t, w, al = t + q[k], w + v[k], al + a[k]
        e, n = np.array([np.cos(t), np.sin(t)]), np.array([-np.sin(t), np.cos(t)])
        forces.append(M[k]*(acc + L[k]/2*(al*n - w**2*e)))
        levers.append((L[k]*e, IC[k]*al))
        acc = acc + L[k]*(al*n - w**2*e)
    force, moment, out = np.zeros(2), 0.0, np.zeros(2)
    for k in (1, 0):
        arm, own = levers[k]
        moment += own + arm[0]*(force + forces[k]/2)[1] - arm[1]*(force + forces[k]/2)[0]
        force = force + forces[k]
        out[k] = moment
    return out
"""
APPENDED = """
import numpy as np
L = [0.5, 0.4, 0.25]

def f(q, wrench):
    angle, point, joints = 0.0, np.zeros(3), []
    for length, turn in zip(L, q):
        angle += turn
        joints.append((angle, point))
        point = point + length*np.array([np.cos(angle), np.sin(angle), 0.0])
    force, moment = wrench[:3], wrench[3:]
    return np.array([(moment + np.cross(point - own, force))[2] for _turn, own in joints])
"""
SUMS = """
from math import atan2, cos, sin, sqrt
import numpy as np
CRANK, ROD, HALF = 0.09, 0.09, 0.059

def leg(x, y, base, side):
    u, v = x - base, y
    k = (CRANK**2 + u**2 + v**2 - ROD**2)/(2*CRANK)
    turn = atan2(v, u) - atan2(sqrt(u**2 + v**2 - k**2), k)
    ex, ey = base + CRANK*cos(turn), CRANK*sin(turn)
    bend = cos(turn)*(y - ey) - sin(turn)*(x - ex)
    if bend*side < 0:
        turn = atan2(v, u) + atan2(sqrt(u**2 + v**2 - k**2), k)
    return turn

def f(xy, mode):
    return np.array([atan2(sin(t), cos(t)) for t in (leg(*xy, HALF, mode[0]), leg(*xy, -HALF, mode[1]))])
"""
STEINER = """
import numpy as np
L, M = [0.5, 0.4, 0.25], [3.0, 2.0, 1.0]

def f(q):
    t = np.cumsum(q)
    ends = [np.zeros(2)]
    for length, angle in zip(L, t):
        ends.append(ends[-1] + length*np.array([np.cos(angle), np.sin(angle)]))
    mass, centre, inertia = 0.0, np.zeros(2), 0.0
    out = np.zeros((3, 3))
    for k in (2, 1, 0):
        middle, total = (ends[k] + ends[k + 1])/2, mass + M[k]
        joint = (mass*centre + M[k]*middle)/total
        inertia = inertia + M[k]*L[k]**2/12 + M[k]*np.sum((middle - joint)**2) + mass*np.sum((centre - joint)**2)
        mass, centre = total, joint
        for i in range(k + 1):
            out[i, k] = out[k, i] = inertia + mass*(centre - ends[k]) @ (centre - ends[i])
    return out
"""
LONG_ROWS = """
import numpy as np

def f(q):
    a = [0, 0, 0, 0.0825, -0.0825, 0, 0.088, 0]
    d = [0.333, 0, 0.316, 0, 0.384, 0, 0, 0.107]
    turn = [0, -1, 1, 1, -1, 1, 1, 0]
    T = np.eye(4)
    for k, th in enumerate([*q, 0.0]):
        c, s, ca, sa = np.cos(th), np.sin(th), float(turn[k] == 0), turn[k]
        T = T @ np.array([[c, -s, 0, a[k]], [s*ca, c*ca, -sa, -d[k]*sa], [s*sa, c*sa, ca, d[k]*ca], [0, 0, 0, 1]])
    return T
"""
SQUARES = """
import numpy as np
CRANK, ROD, HALF = 0.09, 0.09, 0.059

def f(xy):
    rows = []
    for base in (HALF, -HALF):
        dx = base - xy[0]
        rows.append([2*dx*CRANK, -2*xy[1]*CRANK, ROD**2 - dx**2 - xy[1]**2 - CRANK**2])
    return np.array(rows)
"""
COPIED = """
import numpy as np
L = [0.5, 0.4, 0.25]

def f(q, wrench):
    angle, tip, places = 0.0, np.zeros(3), []
    for length, turn in zip(L, q):
        angle, start = angle + turn, tip
        tip = tip + length*np.array([np.cos(angle), np.sin(angle), 0.0])
        places.append(start)
    force, moment, at = wrench[:3], wrench[3:], tip
    out = np.zeros(3)
    for k in (2, 1, 0):
        own = places[k]
        moment = moment + np.cross(at - own, force)
        at = own
        out[k] = moment[2]
    return out
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("equal_links", "fivebar_equation", SQUARES, "- xy[1]**2 - CRANK**2", "- xy[1]**2"),
        ("planar3r", "statics", COPIED, "at = own", "at = tip"),
        ("planar3r", "statics", APPENDED, "point - own, force", "point - joints[0][1], force"),
        ("equal_links", "fivebar_angles", SUMS, "cos(turn)*(y - ey) - sin(turn)*(x - ex)", "cos(turn)*(x - ex) - sin(turn)*(y - ey)"),
        ("planar3r", "mass_matrix", STEINER, " + mass*np.sum((centre - joint)**2)", ""),
        ("panda", "fk", LONG_ROWS, "0, 0.384, 0, 0, 0.107", "0.384, 0, 0, 0, 0.107"),
        ("stanford", "fk", DEGREES, "0.0203, 0.0, 0.0, -90*deg", "0.0203, 0.0, 0.0, 90*deg"),
        ("stanford", "jacobian", KINDS, '("P", 0.0203', '("R", 0.0203'),
        ("spatial3r", "mass_matrix", TENSORS, "xy=0.001, yz=0.0005", "xy=-0.001, yz=-0.0005"),
        ("planar3r", "gradient_step", GRADIENT, "grad = -J.T", "grad = J.T"),
        ("planar3r", "gradient_step", GRADIENT, "q - 0.1*grad", "q + 0.1*grad"),
        ("unequal", "fivebar_turn", COUNTERPARTS, " - rod*dtwo**2*np.array([np.cos(two), np.sin(two)])", ""),
        ("planar2r_rods", "kinetic_energy", MIXED, "0.5*v @ M @ v", "0.5*np.diag(M) @ v**2"),
        ("ur5", "jacobian_tool", HALVES, "lower = R.T @ Jw", "lower = Jw"),
        ("panda", "jacobian", FLANGE, "points[-1] + 0.107*axes[-1]", "points[-1]"),
        ("planar2r_rods", "christoffel", SYMBOLS, "0.5*(dM", "1.0*(dM"),
        ("planar2r_rods", "inverse_without_gravity", AT_REST, "np.array([0.0, 0.0])", "np.array([0.0, 9.81])"),
        ("stanford", "tip_speed_squared", ONE_KIND, "(0 if slide else qd[k])*z", "qd[k]*z"),
    ],
    ids=["a square", "a copy", "a name of a loop", "sums", "Steiner", "a long row", "degrees", "kinds", "signs", "a gradient", "uphill", "counterparts", "mixed terms", "halves", "flange", "symbols", "at rest", "one kind"],
)  # fmt: skip
def test_what_is_lacking_is_told_by_its_like(robot, quantity, text, right, slip, tmp_path) -> None:
    if slip:
        told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")
    else:
        found = kl.diagnose(robot, quantity, written(with_slips(text, [(right, slip)])))
        assert len(found.causes) == 1 and right.strip(" -") in found.causes[0].sentence, found
