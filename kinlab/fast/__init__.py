"""The same answers for long stacks: compiled kernels and threads; not for check and doctor.

======================  ==========================================================================
module                  what it holds
======================  ==========================================================================
``arrays``              A robot's chain and inertias as plain arrays for the compiled kernels;
                        without numba itself
``batches``             Many states at once, each quantity by the fastest road there is
``compiled``            Compiled kernels: one decorator, a word when compilation takes time, and
                        threads
``dynamics_kernels``    Kernels of a serial chain's dynamics on plain arrays: M, Christoffel's C
                        and V of many states
``kinematics_kernels``  Kernels of a serial chain on plain arrays: pose, Jacobian, singular
                        values; one or many
``stacks``              The engine's functions with a faster road for long stacks of states
``threads``             How many threads a batch may use
======================  ==========================================================================
"""
