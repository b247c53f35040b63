"""The hand formulas of the notes, one file per note or part of a note.

======================  ==========================================================================
module                  what it holds
======================  ==========================================================================
``arm``                 What the general formulas stand on: the arm's numbers, its link frames,
                        its mass matrix
``loop``                The numbers of a five-bar as the hand formulas of note 003 read them, and
                        small helpers
``note000_dynamics``    Note 000, statics and dynamics: forces along the chain, Newton-Euler, MVG,
                        Lagrange
``note000_inverse``     Note 000, sections 5, 6 and IK: singular and isotropic poses, Newton,
                        gradient
``note000_kinematics``  Note 000, sections 3 and 4: link transforms, forward kinematics, the
                        Jacobian
``note001_energies``    Note 001: the planar 2R arm with point masses, from the energies to the
                        Lagrangian
``note001_torques``     Note 001: Lagrange's equation of the planar 2R arm, term by term, and its
                        coefficients D
``note002_coriolis``    Note 002, section 4.6: the Coriolis matrix, what is skew about it, the
                        equation of motion
``note002_dynamics``    Note 002: Lagrange's equation term by term, the single joint, the least
                        action
``note002_frames``      Note 002, section 1: standard DH frames, centres of mass, the two-link
                        example
``note002_mass``        Note 002, sections 2 and 3: kinetic energy, the inertia tensor, M, the
                        gravity vector
``note003_dynamics``    Note 003: inverse dynamics of the five-bar, and what follows for the
                        servomotors
``note003_kinematics``  Note 003: inverse kinematics, Jacobian and accelerations of the five-bar
======================  ==========================================================================

They use numpy and :mod:`kinlab.formulas.record` and nothing else, so that each is an oracle for the
engine: the two meet in :mod:`kinlab.check` only. The ids are ``<note>.<name>``.
"""
