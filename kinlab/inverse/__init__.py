"""Inverse kinematics: one pose, many poses, all branches, along a path."""
