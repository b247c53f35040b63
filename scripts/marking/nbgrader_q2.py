"""An autograder cell for nbgrader (a read-only test cell worth 4 points, partial credit).

The cell above it is the student's: ``tau2 = "m2*l2^2*(qdd1 + qdd2) + ..."``. nbgrader takes the
value of a test cell's last line as its points.
"""

import kinlab as kl

found = kl.mark("sheet.toml", {"me": {"q2": tau2}}, feedback="cause")["me"]["q2"]  # noqa: F821
print(found.verdict, found.place, found.cause, sep="\n")
found.points  # noqa: B018
