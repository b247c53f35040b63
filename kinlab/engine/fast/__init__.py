"""The same answers for long stacks: compiled kernels and threads; not for check and doctor.

======================  ==========================================================================
module                  what it holds
======================  ==========================================================================
``arrays``              A robot's chain as plain arrays for the compiled kernels; without numba
                        itself
``compiled``            Compiled kernels: one decorator, and a word when compilation takes time
``kinematics_kernels``  Kernels of a serial chain on plain arrays: pose, Jacobian, singular
                        values; one or many
``stacks``              The engine's functions with a faster road for long stacks of states: the
                        one door to this room
``threads``             How many threads a batch may use, and handing its rows to them; without
                        numba
======================  ==========================================================================
"""
