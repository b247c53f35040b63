"""Arms of the literature for the tests of the branches, with where their numbers come from."""

import math

import numpy as np

import kinlab as kl

HALF = math.pi / 2


def table(name, convention, rows, source="", tool=None):
    """A robot from rows (a, alpha, d, theta) of six revolute joints without limits that matter."""
    links = [
        kl.DHLink(a=a, alpha=alpha, d=d, theta=theta, lower=-math.pi, upper=math.pi)
        for a, alpha, d, theta in rows
    ]
    return kl.Robot.from_dh(kl.DHTable(name, convention, links, source=source))


def xarm6():
    """UFACTORY xArm 6 user manual, appendix "Kinematics", modified DH (mm there)."""
    tilt = 1.3849179
    return table("xarm6", "modified", [
        (0, 0, 0.267, 0), (0, -HALF, 0, -tilt), (0.28948866, 0, 0, tilt),
        (0.0775, -HALF, 0.3425, 0), (0, HALF, 0, 0), (0.076, -HALF, 0.097, 0),
    ])  # fmt: skip


def crx10ia():
    """Fanuc CRX-10iA, modified DH: Abbes and Poisson, "Geometric approach for inverse kinematics
    of the FANUC CRX collaborative robot", Robotics 13(6), 2024."""
    return table("crx10ia", "modified", [
        (0, 0, 0, 0), (0, -HALF, 0, 0), (0.54, math.pi, 0, 0),
        (0, -HALF, -0.54, 0), (0, HALF, 0.15, 0), (0, -HALF, -0.16, 0),
    ])  # fmt: skip


def jaco2():
    """Kinova JACO2 j2n6s300, wrist with 60 degrees: Kinova "User guide", DH parameters (classic)."""
    d1, d2, d3, d4, d5, d6, e2 = 0.2755, 0.41, 0.2073, 0.0741, 0.0741, 0.16, 0.0098
    aa = math.pi / 6
    ratio = math.sin(aa) / math.sin(2 * aa)
    return table("jaco2", "standard", [
        (0, HALF, d1, 0), (d2, math.pi, 0, 0), (0, HALF, -e2, 0),
        (0, 2 * aa, -(d3 + ratio * d4), 0), (0, 2 * aa, -ratio * (d4 + d5), 0),
        (0, math.pi, -(ratio * d5 + d6), 0),
    ])  # fmt: skip


def random_arm(seed, n=6, slides=(), convention="standard", flips=True):
    """An arm in general position, with offsets of theta and flipped joints."""
    rng = np.random.default_rng(seed)
    links = [
        kl.DHLink(
            joint="prismatic" if i in slides else "revolute", a=rng.uniform(0.1, 0.6),
            alpha=rng.uniform(-1.5, 1.5), d=rng.uniform(-0.4, 0.4), theta=rng.uniform(-2, 2),
            lower=-math.pi, upper=math.pi, flip=bool(flips and rng.random() < 0.3),
        ) for i in range(n)
    ]  # fmt: skip
    return kl.Robot.from_dh(kl.DHTable(f"random{seed}", convention, links))


def manseur_doty():
    """Manseur and Doty, "A robot manipulator with 16 real inverse kinematic solution sets",
    IJRR 8(5), 1989: the arm, and a pose that it meets in 16 ways."""
    one = math.radians(1.0)
    robot = table("manseur_doty", "standard", [
        (0.3, HALF, 0, 0), (1, one, 0, 0), (0, HALF, 0.2, 0),
        (1.5, one, 0, 0), (0, HALF, 0, 0), (0, one, 0, 0),
    ])  # fmt: skip
    printed = np.array(
        [[-0.760117, -0.641689, 0.102262], [0.133333, 0, 0.991071], [-0.635959, 0.766965, 0.085558]]
    )
    left, _, right = np.linalg.svd(printed)  # six digits are printed
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = left @ right, [-1.140175, 0, 0]
    return robot, pose


def built_by_ssik(name):
    """An arm that ssik ships a solver for, as a kinlab robot from the same numbers, and a function
    from a pose to all solutions by ssik, (m, 6)."""
    import ssik

    module = __import__(
        next(a.import_path for a in ssik.list_arms() if a.name == name), fromlist=["_KB"]
    )
    arm = ssik.Manipulator.from_prebuilt(name)
    links, joints, before = ['<link name="l0"/>'], [], np.eye(4)
    count = len(module._JOINT_AXES)
    for i in range(count + 1):
        place = before if i == count else before @ np.asarray(module._JOINT_T_LEFTS[i])
        axis = [0, 0, 1] if i == count else module._JOINT_AXES[i]
        kind = "fixed" if i == count else "revolute"
        pitch = math.atan2(-place[2, 0], math.hypot(place[0, 0], place[1, 0]))
        rpy = (math.atan2(place[2, 1], place[2, 2]), pitch, math.atan2(place[1, 0], place[0, 0]))
        links.append(f'<link name="l{i + 1}"/>')
        joints.append(
            f'<joint name="j{i + 1}" type="{kind}"><parent link="l{i}"/><child link="l{i + 1}"/>'
            f'<origin xyz="{" ".join(repr(float(v)) for v in place[:3, 3])}" '
            f'rpy="{" ".join(repr(float(v)) for v in rpy)}"/>'
            f'<axis xyz="{" ".join(repr(float(v)) for v in axis)}"/>'
            f'<limit lower="-3.2" upper="3.2" effort="1" velocity="1"/></joint>'
        )
        if i < count:
            before = np.asarray(module._JOINT_T_RIGHTS[i])
    robot = kl.Robot.from_urdf(f'<robot name="{name}">{"".join(links + joints)}</robot>')

    def solve(pose):
        found = arm.solve(pose, respect_limits=False, enumerate_windings=False)
        return np.array([s.q for s in found]).reshape(-1, count)

    return robot, arm, solve
