"""Every named tolerance of kinlab in one frozen object, each with its reason.

Those of compiled kernels stand beside their kernels: a kernel's cache knows its own file only, and
would keep a number that is changed here.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Tolerances:
    """Named tolerances. All are relative or dimensionless unless a unit is given."""

    # -------- Bodies, tables and files

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

    round_trip: float = 1e-10
    """URDF to DH and back: frames, M and g may move by this much (relative for M and g)."""

    urdf_echo: float = 1e-9
    """Relative difference between a number written into the engine and the one read back that is
    still rounding."""

    same_number: float = 1e-9
    """Relative difference below which two numbers that a user wrote down are one."""

    subnormal: float = 1e-300
    """Numbers below this are written into a URDF as 0: a C++ stream cannot read them."""

    # -------- Axes, rows of J and tasks

    parallel_axes: float = 1e-8
    """sin of the angle between two joint axes below which they are parallel. Calling an angle s
    zero moves the tool by s times the arm's length; keeping it puts the common normal 1/s away,
    where rounding weighs 1e-16/s. Both are 1e-8 here, the worst case."""

    intersecting_axes: float = 1e-10
    """Distance between two lines, in metres, below which they intersect."""

    axes_meet: float = 1e-9
    """Metres or sine below which axes meet or are parallel, on tables with ten digits."""

    same_line: float = 1e-8
    """Direction, or distance over the arm's, below which two joint axes are one line: what is
    solved for from poses carries the rounding of a few products."""

    structure_holds: float = 1e-12
    """Of the arm's size or as a sine: axes that miss each other by less meet or are parallel; see
    ``nearly``."""

    structure_nearly: float = 3e-4
    """Of the arm's size or as a sine: axes that miss by more than ``structure_holds`` and less than
    this meet or are parallel only nearly."""

    never_moves: float = 1e-9
    """A singular value of J, relative to the largest, below which a coordinate of the task is
    out of the arm's reach at that state; over several states in general position: everywhere."""

    row_stands_still: float = 1e-9
    """A row of J whose entries stay below this over random poses cannot be moved by the arm."""

    in_plane: float = 1e-9
    """Share of the largest linear entry of J below which the tool does not leave its plane."""

    task_holds: float = 1e-7
    """sigma_min / sigma_max of J at states in general position below which a task cannot be
    held."""

    null_direction: float = 1e-6
    """sigma_min / sigma_max of J below which a direction of joint space may leave the tool in
    place; whether it does is then tried."""

    tool_stays: float = 1e-9
    """Metres and radians within which the tool stays where it is along such a direction."""

    dependent: float = 1e-7
    """Relative volume below which columns are dependent at a singularity solved to 1e-12."""

    # -------- Formulas

    same_branch: float = 1e-6
    """Difference of cosines and sines below which two solutions of one target are one: an acos or
    a root that is 0 keeps half the digits, 1e-8; branches are 1e-3 apart where targets lie."""

    near_singular: float = 1e-3
    """Least over largest singular value of a target's pose that is near a singular one, such as
    the limit of reach, and not in it: joint positions keep 1e-13 there."""

    formula_agrees: float = 1e-9
    """Largest relative error at which a hand formula and the engine are the same formula. Two
    double-precision routes through a seven-joint arm differ by up to 1e-12; a wrong term by
    1e-3 or more."""

    typed_rounding: float = 0.0102
    """Relative difference up to which a typed number may be a constant, rounded to its digits: 0.33
    for 1/3 is 1 % off, 0.7 for sqrt(2)/2 1.005 %; 1.6 for pi/2 is 1.9 % off, and is wrong."""

    may_be_step: float = 1e-2
    """The largest number of a program that may be the step of a difference."""

    is_small: float = 1e-3
    """The largest number of a program that may be where an iteration stops, or a damping."""

    is_step: float = 1e-4
    """The largest number of a program that is rather a step than anything of an arm."""

    left_of_several: float = 1e-11
    """Relative error that several repairs of one program may leave, where one may leave what
    formulas differ by: with so many of them something nearly right is found by accident."""

    left_of_three: float = 1e-8
    """The same of three, in a function that takes derivatives by central differences."""

    finite_differences: float = 1e-5
    """Relative error that derivatives by differences may leave in a function once a slip is
    undone: forward differences with steps of 1e-5, central ones up to 1e-3."""

    slips_leave: float = 1e-6
    """Relative error, of an entry's own largest value, below which no slip is known to be: a
    formula that nothing explains is right to its digits."""

    noise_step: float = 1e-8
    """Step in rad over which a smooth function is straight to 1e-16 of its size."""

    least_step: float = 1e-13
    """Step in rad that a formula hardly feels: it changes by 1e-13 times its slope."""

    erratic: float = 1e-3
    """Share of its size by which the least step changes only what is rounding alone: elsewhere a
    matrix would need a condition number of 1e10."""

    noise_of_differences: float = 1e-13
    """Noise of a function, relative to its size, that its own arithmetic does not make (1e-15)
    and differences do: 1e-12 with steps of 1e-4."""

    coefficient_digits: float = 1e-4
    """Relative error of every coefficient of a function up to which it is right to its digits:
    constants of four digits; and of an answer that has the noise of differences."""

    plain_value: float = 1e-9
    """Size of a value in a program, or its distance from halves and parts of pi, below which it is
    nothing that could be named: rounding leaves 1e-15 of zero, and no arm's states are so small."""

    nearly_agrees: float = 2e-3
    """Relative error up to which a function may be right with rounded constants inside; nobody
    can tell."""

    bare_number: float = 5e-3
    """Relative error up to which an answer that is one bare number may be rounded. Any number of
    three digits is as near as that; with two, 9.8 is 9.81 and 23 is 23.05, but 1.6 is not pi/2."""

    nearly_throughout: float = 0.02
    """The same of every entry by its own largest value, at every state: no slip but an exact one is
    looked for in what is nearer than rounded numbers, coarse steps and tables may be."""

    may_be_rounded: float = 0.06
    """Relative error of a program up to which it is asked whether its numbers are rounded: half a
    unit of a number with two digits is up to 5 %."""

    left_of_slip: float = 1e-4
    """Share of what was off that may be left once a slip is undone, in a function that takes
    derivatives by differences."""

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

    pole_of_tan: float = 1e-12
    """|cos x| below which x is an odd multiple of 90°, where tan x has no value."""

    vanishes: float = 1e-12
    """SI units. What an engine returns for zero is rounding residue of this size or less."""

    # -------- The doctor

    same_relation: float = 1e-7
    """Relative difference below which a solved number is the one that a relation gives."""

    rounding_leaves: float = 1e-13
    """Size in SI units of what rounding leaves of a zero: sums of products with cos(pi/2)."""

    of_a_state_beside: float = 1e-4
    """Relative difference of vectors and matrices at states that are a difference's step apart."""

    typed_endless: float = 1e-6
    """Relative difference up to which a typed number of many digits is pi, a third, a root of 2."""

    solved_angle: float = 1e-7
    """rad. Slack of an angle that is solved for from exact poses."""

    still: float = 1e-4
    """How far a joint moves at most over poses in which it does not move, rad or m: an encoder's
    last digits are no motion."""

    last_digit: float = 1e-6
    """Share of a size below which two numbers of a body differ in their last digits alone."""

    same_body: float = 1e-8
    """Relative difference of masses, centres and tensors that is still rounding of their moving
    from one frame to another."""

    exact_poses: float = 1e-7
    """Noise below which poses are exact, and more than one slip can be looked for."""

    carried_on: float = 1e-3
    """Share of the largest value by which two sides of a chain of equalities may differ and carry
    the same slip on: numbers in it are rounded to three digits."""

    effect_matches: float = 1e-9
    """Share of the values within which the effect of an edit is the one that was looked for."""

    effects_add_up: float = 1e-8
    """Share of a program's answer within which the effects of edits add up to what is missing."""
    tried_further: float = 1e-7
    """Share of a program's answer that an edit may miss at the first states, to be tried at all."""
    no_effect: float = 1e-12
    """An effect below this share of the values is rounding: the edit changes nothing."""

    no_share: float = 1e-8
    """A term of a sum with less than this share of the largest is not in it."""

    force_felt: float = 1e-9
    """Torque in parts of a wrench's largest component, below which a joint does not feel a
    component of it."""

    same_function: float = 1e-9
    """Two columns of unit length closer than this, up to their sign, are one function."""

    # -------- Singular configurations

    singular: float = 1e-10
    """sigma_min / sigma_max at and below which a configuration counts as singular."""

    internal_motion: float = 1e-8
    """Share of the greatest singular value below which a joint motion leaves the tool where it
    is, at a singularity solved to 1e-12."""

    on_singular_set: float = 1e-12
    """Norm of the residual, in the arm's own length unit, below which a solution lies on the
    singular set; far above rounding (1e-15), far below the 1e-10 that is promised for sigma_min /
    sigma_max."""

    limit_rounding: float = 1e-12
    """rad or m by which a solution may miss a limit through rounding alone."""

    limit_digits: float = 1e-9
    """rad or m beyond a joint limit that still count as within: a limit of ten digits (6.283185307
    for a whole turn) does not hide what stands on it. Answers themselves are within the limits."""

    root_crowd: float = 1e-3
    """Roots on the unit circle nearer to each other than this may be one multiple root, which comes
    as a crowd of simple ones about it."""

    zeros_together: float = 1e-9
    """Of the cosine of half the angle between two zeros: as near to 1 they may be one double zero,
    which a formula finds to half the digits only."""

    stays_singular: float = 1e-9
    """sigma_min / sigma_max up to which the arm stayed singular; the held joints are known to
    1e-12."""

    same_pinned_value: float = 1e-6
    """rad or m: two values of a pinned joint closer than this are one. Solutions agree to 1e-9."""

    takes_part: float = 1e-6
    """Share of a unit vector below which a joint takes no part."""

    factor_vanishes: float = 1e-12
    """Value of a factor of det J, over its size in general position, at which it counts as zero."""

    form_has_sign: float = 1e-6
    """Eigenvalue of the quadratic form at an edge of the workspace, over its own size in the arm's
    length unit, that has a sign."""

    coefficient_rounding: float = 1e-11
    """Coefficients of a minor of J below this share of the largest are rounding."""

    distance_gap: float = 1e-6
    """rad or m between the distance to a zero and its proved bound at which they count as one."""

    singular_value_rounding: float = 1e-12
    """Share of sigma_max that rounding may do to a computed singular value."""

    shortest_step: float = 1e-4
    """rad or m. Shortest step along a curve of singularities: a whole turn then has 60,000 points;
    shorter ones take for ever and show nothing more."""

    # -------- Isotropy and workspace

    isotropic: float = 1e-8
    """Condition number - 1 at and below which a configuration is isotropic."""

    same_configuration: float = 1e-5
    """rad or m between two listings of one isotropic configuration. Double roots are solved to half
    the digits, so that 1e-8 would list them twice."""

    family_radius: float = 0.005
    """rad or m around an isotropic configuration in which its family's dimension is measured: a
    curve bends by a fraction of that, and a double root, which linearises like a curve, draws its
    neighbours back."""

    same_minimum: float = 1e-3
    """Relative difference of two condition numbers at p = 512 below which they may be one
    minimum."""

    same_design: float = 1e-5
    """Relative difference of open numbers below which two designs are one."""

    vanished_length: float = 1e-6
    """Lengths below this share of the arm's own length unit are links that vanished."""

    beside_boundary: float = 1e-3
    """Share of the arm's reach: how far beside a piece of the boundary its sides are tried. Islands
    and gaps thinner than this are not told from the boundary itself."""

    beside_section: float = 2e-3
    """Share of a section's size: how far beside a curve its sides are tried."""

    # -------- Inverse kinematics

    search_step: float = 1e-13
    """||q_{k+1} - q_k|| below which the readable search stops, where the caller gives none."""

    damping_floor: float = 1e-9
    """Keeps J^T J + mu 1 of the inverse kinematics invertible at a singular solution; larger ones
    slow the last steps there."""

    rests_singular: float = 1e-3
    """sigma_min / sigma_max of J, metres over the arm's length, below which a rest is at a
    singularity."""

    two_solutions: float = 1e-3
    """Radians or metres, whole turns left out, by which two solutions must differ to be two."""

    path_singular: float = 1e-6
    """sigma_min over the arm's length unit at which a path counts as meeting a singularity."""

    same_pose: float = 1e-5
    """Metres, and entries of the rotation, within which two poses are one."""

    same_zero: float = 1e-4
    """rad within which two zeros are one; a double one is found to half the digits only."""

    crossing_sine: float = 1e-3
    """Sine of the angle at which two images must cross to make a node."""

    # -------- Motion, simulation and drives

    integrator_relative: float = 1e-10
    """Relative error of a step of the integrator."""

    integrator_absolute: float = 1e-12
    """Absolute error of a step of the integrator, in the state's own units."""

    follows: float = 1e-10
    """m and rad of the inverse kinematics at the samples of a motion."""

    way_lost: float = 1e-4
    """sigma_min / sigma_max of J, metres over the arm's length, at which a way is refused: joint
    rates are then 10⁴ times the tool's."""

    at_limit: float = 1e-9
    """Relative: a motion planned to its limit may lie above it by rounding."""

    at_rest: float = 1e-10
    """rad/s or m/s below which a joint with friction counts as at rest where it turns round."""

    narrowest_piece: float = 1e-7
    """Part of a motion's duration at which a piece is not cut any more."""

    same_finding: float = 1e-4
    """Part of a motion's duration within which two findings of one kind are one."""

    beside_singularity: float = 1e-3
    """How far beside a singularity the branch is named, in parts of the motion's duration."""

    no_motion: float = 1e-9
    """A speed, acceleration, ratio or efficiency of no more than this is none."""

    stands_still: float = 1e-9
    """Part of its largest rate below which a joint stands still."""

    inside_piece: float = 1e-9
    """Part of a piece of a motion by which its first and last instant lie inside it: there an
    acceleration that jumps has the value of the piece."""

    rms_settles: float = 2e-7
    """Relative change of the RMS torques between two grids, of half the steps, that ends the
    search."""

    least_ratio: float = 1e-3
    """Gear ratios are tried from this part of the bound up to the bound."""

    equal_margins: float = 1e-3
    """Margins that differ by less than this part are equal: the ratio is searched for to 1e-4."""

    drawn_error: float = 1e-17
    """Least error that a logarithmic axis shows."""

    # -------- The five-bar

    singular_sine: float = 1e-7
    """Sine of the angle between two bars of a five-bar below which they are in line. At the
    edge of the workspace it is 1e-14 of the bars' length, a few ulps of the point itself."""

    closure: float = 1e-12
    """Gap of a closed loop, relative to the size of the mechanism, that Newton must reach; it
    ends near 1e-16 when it converges at all."""

    loop_acceleration: float = 1e-7
    """Largest |Jc a + Jc_dot v| over |Jc_dot v| + |a| size that still counts as a closed loop."""

    same_pose_of_fivebar: float = 0.003
    """Two fully isotropic poses closer than this part of the linkage's size are one: one factor's
    curve crosses that of the right angles, which gives the place to rounding; the other's
    touches it, and descent along that one ends anywhere within a few 1e-4."""

    equal_cranks: float = 1e-12
    """Relative difference of the cranks of a five-bar below which they are equal."""

    pressure_angle: float = 1e-5
    """rad. Pressure angle of a five-bar up to which a pose is called fully isotropic."""

    rods_miss: float = 1e-6
    """Share of a five-bar's size by which rods must miss each other to be given up without a
    try."""

    shortest_stride: float = 1e-6
    """Part of a way below which Newton's method along one branch of a closed chain gives up."""

    worst_case_gap: float = 1e-7
    """Part of the largest value over a rectangle to which value and bound are brought together."""

    bound_rounding: float = 1e-11
    """Part of a proved bound by which it is widened: the rounding of a few hundred operations."""

    design_sine: float = 1e-3
    """Sine of the angle between two bars at which a pose of the wanted workspace counts as in
    line."""

    design_slack: float = 1e-8
    """Parts of a limit of a design by which it may be exceeded: rounding of the polish that ends on
    it."""

    weighed_gap: float = 1e-6
    """Gap of the proof of what a design weighs or limits."""

    reported_gap: float = 1e-4
    """Gap of the proof of the other quantities of a design, which are only reported."""

    worst_places: float = 1e-5
    """Part of a design's cost below which its worst places need not join the points of the
    search."""

    goal_proved: float = 1e-3
    """Gap between bound and value, in parts of the value, up to which a goal counts as proved."""

    at_end_of_range: float = 1e-4
    """Part of a range within which a length counts as lying at its end."""

    eased_bound: float = 1e-6
    """Part by which a bound is eased, so that the end it comes from still meets it."""


TOLERANCES = Tolerances()
