"""Isotropy: configurations of an arm that have it, and lengths that make an arm isotropic.

==================  ==============================================================================
module              what it holds
==================  ==============================================================================
``best_condition``  The least condition number an arm can reach, by smooth minimisation from many
                    starts
``configurations``  Isotropic configurations: J J^T = a 1, where the tool moves equally well in
                    every direction
``design``          Link lengths and twists that make an arm isotropic, solved together with the
                    configuration
``design_model``    A DH table with some of its numbers open: its Jacobian and how it changes with
                    them
``system``          Isotropy as a system of smooth equations, and the length that may be one of its
                    unknowns
==================  ==============================================================================
"""
