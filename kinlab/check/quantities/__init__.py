"""The engine's quantities by name: what a hand formula can be compared with.

============  ====================================================================================
module        what it holds
============  ====================================================================================
``action``    Engine quantities about the action S = ∫ L dt and its first variation (note 002)
``fivebar``   Five-bars as a domain, and the engine's quantities of their closed chain
``identity``  Identities of vectors and rotations: quantities that need no mechanism
``inverse``   Inverse kinematics as a quantity: joint positions are right where their pose is
              the target
``links``     Engine quantities of single links, of dM/dq, and of Lagrange's equation
``quantity``  What a hand formula can be compared with: a quantity of a kind of mechanism
``registry``  The engine's quantities by name, with an index where only some entries are meant
``serial``    Serial arms as a domain, and the engine's quantities of their kinematics and
              dynamics
``special``   Engine quantities of note 000 beyond the usual ones: frames, singular and isotropic
              poses, IK
``table``     Engine quantities that an arm's own checks need: yourdfpy's pose, and what holds M,
              C and g together
============  ====================================================================================
"""
