"""Three controllers on a simulated UR5: computed torque, PD with gravity, and impedance.

python scripts/tour/drive_an_arm.py --output controllers.png
"""

from __future__ import annotations

import argparse

import numpy as np

import kinlab as kl


def computed_torque(robot, motion, stiffness=100.0):
    """tau = M(q) (a_d + Kd (v_d - v) + Kp (q_d - q)) + C v + g: errors die like e^-10t."""
    damping = 2.0 * np.sqrt(stiffness)

    def torque(t, q, v):
        wanted, rate, gain = motion.at(min(t, motion.duration))
        a = gain + damping * (rate - v) + stiffness * (wanted - q)
        return kl.inverse_dynamics(robot, q, v, a)

    return torque


def pd_with_gravity(robot, goal, stiffness, damping):
    """tau = g(q) + Kp (q_d - q) - Kd v: the energy of spring and arm can only fall."""
    return lambda t, q, v: kl.gravity_torques(robot, q) + stiffness * (goal - q) - damping * v


def impedance(robot, place, stiffness, damping, joint_damping):
    """tau = g(q) + J^T (K (x_d - x) - D xdot) - d v: the tool yields like a spring."""

    def torque(t, q, v):
        jac = kl.jacobian(robot, q)[:3]
        pull = stiffness * (place - kl.fk(robot, q)[:3, 3]) - damping * (jac @ v)
        return kl.gravity_torques(robot, q) + jac.T @ pull - joint_damping * v

    return torque


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--output", default="controllers.png")
    chosen = options.parse_args()
    robot = kl.load("ur5")
    start = np.array([0.3, -1.0, 1.2, 0.3, 0.8, 0.2])
    goal = start + [0.5, -0.3, 0.2, 0.2, -0.3, 0.4]
    motion = kl.motion.joint(robot, [start, goal], acceleration=3)

    away = start + 0.05
    law = computed_torque(robot, motion)
    followed = kl.simulate(robot, away, None, law, duration=motion.duration + 0.5)
    times = np.minimum(followed.t, motion.duration)
    error = np.abs(followed.q - motion.at(times)[0])
    critical = 0.05 * (1.0 + 10.0 * followed.t) * np.exp(-10.0 * followed.t)
    off = np.abs(error.max(axis=1) - critical).max()
    print(
        f"computed torque: error {error[0].max():.3g} at the start, {error[-1].max():.2g} rad at "
        f"the end; off the critically damped law by {off:.1e}"
    )
    print(followed)

    held = kl.simulate(robot, start, None, pd_with_gravity(robot, goal, 300.0, 60.0), duration=3.0)
    print(f"PD with gravity: {np.abs(held.q[-1] - goal).max():.2g} rad from its goal after 3 s")

    place = kl.fk(robot, start)[:3, 3]
    push = np.array([0.0, 20.0, 0.0])
    law = impedance(robot, place, 500.0, 60.0, 2.0)
    pressed = kl.simulate(robot, start, None, law, wrench=[*-push, 0, 0, 0], duration=4.0)
    gives = kl.fk(robot, pressed.q[-1])[:3, 3] - place
    print(f"impedance: pushed by 20 N, 500 N/m give {np.round(1e3 * gives, 2)} mm")

    from kinlab.plots import canvas

    axes = canvas.new_axes("ur5: three controllers", size=(7.2, 4.4))
    tool = kl.fk(robot, pressed.q)[:, :3, 3] - place
    axes.plot(followed.t, error.max(axis=1), label="computed torque: largest joint error, rad")
    axes.plot(held.t, np.abs(held.q - goal).max(axis=1), label="PD with gravity: the same, rad")
    axes.plot(pressed.t, tool[:, 1], label="impedance: the tool gives way, m")
    axes.axhline(20.0 / 500.0, color="0.6", ls=":", lw=1.0)
    axes.set(xlabel="t, s", ylim=(0.0, 0.55))
    axes.grid(alpha=0.25)
    axes.legend(fontsize=9)
    print(f"wrote {canvas.save(axes, chosen.output)}")


if __name__ == "__main__":
    main()
