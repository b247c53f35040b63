"""Every named tolerance of kinlab in one frozen object, each with its reason.

Those of compiled kernels stand beside their kernels: a kernel's cache knows its own file only, and
would keep a number that is changed here.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tolerances:
    """Named tolerances. All are relative or dimensionless unless a unit is given."""

    orthonormal: float = 1e-9
    """A rotation may miss R^T R = 1 by this much: rotations typed with ten digits pass, ones
    typed with five are told how far they are off."""

    inertia_symmetry: float = 1e-9
    """Relative asymmetry of an inertia tensor that is still read as rounding."""

    inertia_triangle: float = 1e-6
    """Relative violation of I1 + I2 >= I3 that CAD exports with six digits show on thin plates
    (equality is exact for a lamina, so rounding falls on either side)."""

    inertia_rounding: float = 0.05
    """Share of the largest moment up to which a tensor that no body can have may be called rounded,
    however few digits it is printed with: half a unit of a number with two is up to 5 %."""

    inertia_floor: float = 1e-9
    """kg m². Moments below this are judged as if they were this large: exported files hold
    rounding residue such as -2e-35 in links that stand for a frame only."""

    massless: float = 1e-12
    """A joint moves no inertia when what it feels with the joints behind it free is below this
    share of what it feels with them locked: rounding leaves 1e-16, a 50-joint chain 1e-4."""

    parallel_axes: float = 1e-8
    """sin of the angle between two joint axes below which they are parallel. Calling an angle s
    zero moves the tool by s times the arm's length; keeping it puts the common normal 1/s away,
    where rounding weighs 1e-16/s. Both are 1e-8 here, the worst case."""

    never_moves: float = 1e-9
    """A singular value of J, relative to the largest, below which a coordinate of the task is
    out of the arm's reach at that state; over several states in general position: everywhere."""

    intersecting_axes: float = 1e-10
    """Distance between two lines, in metres, below which they intersect."""

    singular_sine: float = 1e-7
    """Sine of the angle between two bars of a five-bar below which they are in line. At the
    edge of the workspace it is 1e-14 of the bars' length, a few ulps of the point itself."""

    closure: float = 1e-12
    """Gap of a closed loop, relative to the size of the mechanism, that Newton must reach; it
    ends near 1e-16 when it converges at all."""

    formula_agrees: float = 1e-9
    """Largest relative error at which a hand formula and the engine are the same formula. Two
    double-precision routes through a seven-joint arm differ by up to 1e-12; a wrong term by
    1e-3 or more."""

    formula_differs: float = 1e-3
    """A misprint must show at least this relative disagreement to be called shown."""

    residue: float = 1e-13
    """Entries this close to zero, or angles this close to a multiple of 90°, are rounding residue
    of a product of rotations (a few 1e-16) and are printed as the number meant."""

    tie: float = 1e-9
    """Numbers that differ by less than this share of the largest of the list are a tie: rounding,
    which differs from processor to processor, must not decide which of them comes first."""

    same_length: float = 1e-12
    """Relative difference at which a centre of mass counts as a simple fraction of its link's
    length (or as zero) in a derived formula: a decimal typed in full differs by 1e-16, a centre
    that is something else in the third digit."""

    right_angle: float = 1e-15
    """How far a cosine or sine may miss 0 or ±1 and count as a right angle's in a derived formula:
    the rounding of pi/2 leaves 6e-17, and more would make it another arm's formula."""

    in_plane: float = 1e-9
    """Share of the largest linear entry of J below which the tool does not leave its plane."""

    round_trip: float = 1e-10
    """URDF to DH and back: frames, M and g may move by this much (relative for M and g)."""

    urdf_echo: float = 1e-9
    """Relative difference between a number written into the engine and the one read back that is
    still rounding."""

    null_direction: float = 1e-6
    """sigma_min / sigma_max of J below which a direction of joint space may leave the tool in
    place; whether it does is then tried."""

    tool_stays: float = 1e-9
    """Metres and radians within which the tool stays where it is along such a direction."""

    task_holds: float = 1e-7
    """sigma_min / sigma_max of J at states in general position below which a task cannot be
    held."""

    axes_meet: float = 1e-9
    """Metres or sine below which axes meet or are parallel, on tables with ten digits."""

    dependent: float = 1e-7
    """Relative volume below which columns are dependent at a singularity solved to 1e-12."""

    same_number: float = 1e-9
    """Relative difference below which two numbers that a user wrote down are one."""

    same_line: float = 1e-8
    """Direction, or distance over the arm's, below which two joint axes are one line: what is
    solved for from poses carries the rounding of a few products."""

    same_relation: float = 1e-7
    """Relative difference below which a solved number is the one that a relation gives."""

    solved_angle: float = 1e-7
    """rad. Slack of an angle that is solved for from exact poses."""

    same_body: float = 1e-8
    """Relative difference of masses, centres and tensors that is still rounding of their moving
    from one frame to another."""

    exact_poses: float = 1e-7
    """Noise below which poses are exact, and more than one slip can be looked for."""

    effect_matches: float = 1e-9
    """Share of the values within which the effect of an edit is the one that was looked for."""

    no_effect: float = 1e-12
    """An effect below this share of the values is rounding: the edit changes nothing."""

    no_share: float = 1e-8
    """A term of a sum with less than this share of the largest is not in it."""

    same_function: float = 1e-9
    """Two columns of unit length closer than this, up to their sign, are one function."""

    row_stands_still: float = 1e-9
    """A row of J whose entries stay below this over random poses cannot be moved by the arm."""

    loop_acceleration: float = 1e-7
    """Largest |Jc a + Jc_dot v| over |Jc_dot v| + |a| size that still counts as a closed loop."""

    same_pose_of_fivebar: float = 0.003
    """Two fully isotropic poses closer than this part of the linkage's size are one: one factor's
    curve crosses that of the right angles, which gives the place to rounding; the other's
    touches it, and descent along that one ends anywhere within a few 1e-4."""

    equal_cranks: float = 1e-12
    """Relative difference of the cranks of a five-bar below which they are equal."""

    no_motion: float = 1e-9
    """A speed, acceleration, ratio or efficiency of no more than this is none."""

    pressure_angle: float = 1e-5
    """rad. Pressure angle of a five-bar up to which a pose is called fully isotropic."""

    pole_of_tan: float = 1e-12
    """|cos x| below which x is an odd multiple of 90°, where tan x has no value."""

    vanishes: float = 1e-12
    """SI units. What an engine returns for zero is rounding residue of this size or less."""


TOLERANCES = Tolerances()
