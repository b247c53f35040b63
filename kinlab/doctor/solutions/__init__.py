"""Inverse kinematics by hand: which branches are right, and which step of the closed form is not.

================  ================================================================================
module            what it holds
================  ================================================================================
``closed_forms``  The closed forms of inverse kinematics as the textbooks derive them, walked branch
                  by branch
``lines``         Joint positions as text, line by line: each judged with right values for the
                  joints it stands on
``verdict``       Inverse kinematics judged: right where Pinocchio finds the tool at the target, on
                  any branch
================  ================================================================================
"""
