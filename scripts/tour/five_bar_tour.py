"""A tour of the five-bar: geometry, singularities, dynamics, closed chain, servo, pictures.

python scripts/tour/five_bar_tour.py --output pictures
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

import kinlab as kl
from kinlab.drives.cycles import pick_and_place
from kinlab.plots.canvas import save
from kinlab.plots.mechanisms import fivebar, fivebar_cycle, fivebar_gains


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path, default=Path("five-bar"), help="folder")
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    robot = kl.FiveBar.load("isotropic")
    xy, v, a = np.array([0.1, -0.5]), np.array([1.0, 0.5]), np.array([10.0, 20.0])

    print("1. Closed form: one point, four working modes")
    for mode in ((-1, 1), (1, -1), (1, 1), (-1, -1)):
        angles = np.degrees(robot.ik(xy, mode))
        kappa = robot.condition_number(xy, mode)
        print(f"   mode {mode}: theta = {angles.round(2)} deg, condition number {kappa:.3f}")

    print("2. Pinocchio's closed chain at the same place")
    chain = robot.closed_chain()
    q = chain.assemble(robot.ik(xy))
    qd = chain.joint_rates(q, v)
    engine = chain.inverse_dynamics(q, qd, chain.joint_accelerations(q, qd, a))
    print(f"   torque, closed form {robot.inverse_dynamics(xy, v, a)} N m")
    print(f"   torque, engine      {engine} N m")
    print(f"   massless rods       {robot.inverse_dynamics(xy, v, a, model='massless')} N m")

    print("3. Singularities and room")
    print(f"   reachable {robot.reachable_area():.4f} m²; {robot.largest_circle()}")
    print(f"   {robot.largest_rectangle()}")
    for pose in robot.isotropic_poses():
        print(f"   isotropic at ({pose.xy[0]:.6f}, {pose.xy[1]:.6f}), kappa - 1 = "
              f"{pose.condition - 1:.1e}")  # fmt: skip

    print("4. Servomotors for a rectangle, 3 m/s and 60 m/s²")
    sizing = robot.size_servo((-0.2, 0.2, -0.65, -0.5), v_max=3.0, a_max=60.0)
    print(f"   torque: note's form {sizing.torque_note.largest:.2f}, full "
          f"{sizing.torque.largest:.2f} N m")  # fmt: skip
    for fit in sizing.short_list[:3]:
        print(f"   {fit.motor.maker} {fit.motor.name}: gear {fit.gear_ratio:.1f}, margin "
              f"{fit.margin:.2f}, limited by {fit.limit}")  # fmt: skip
    best = sizing.short_list[0]
    path = pick_and_place([0.0, -0.65], v_max=10.0, a_max=200.0)
    fastest = robot.fit_to_motor(path, best.motor, best.gear_ratio)
    print(f"   with {best.motor.name} the 25/305/25 mm cycle takes {fastest.duration:.3f} s")

    save(fivebar(robot), folder / "workspace.png")
    save(fivebar_cycle(robot, sizing), folder / "cycle.png")
    save(fivebar_gains(robot, sizing), folder / "gain.png")
    for file in robot.export(folder / "five_bar.xml", xy):
        print(f"wrote {file}")
    print(f"wrote {', '.join(str(folder / n) for n in ('workspace.png', 'cycle.png', 'gain.png'))}")


if __name__ == "__main__":
    main()
