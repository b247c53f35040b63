"""What the engine says: a thin layer over Pinocchio, for one state or a stack of them.

==============  ==================================================================================
module          what it holds
==============  ==================================================================================
``dynamics``    Dynamics by Pinocchio: M, C, g, inverse and forward dynamics, energies, of any
                number of states
``integrator``  Ordinary differential equations in time, by scipy's DOP853, with stops and
                projections
``kinematics``  Forward kinematics, Jacobians and statics, by Pinocchio, for any number of states
``lagrange``    What Lagrange's equation is made of: exact derivatives of M, the energies and the
                action
``links``       The single links, by Pinocchio: their motion, the wrenches on them, their energies
``states``      Joint vectors at the door: cheap on the good path, exact about what is wrong on
                the other
``fast/``       The engine's functions with a faster road for long stacks: compiled kernels and
                threads; check and doctor never take it
==============  ==================================================================================
"""
