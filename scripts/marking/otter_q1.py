"""A test for otter-grader, tests/q1.py of an assignment: the notebook defines ``x`` as text."""

OK_FORMAT = True

test = {
    "name": "q1",
    "points": 2,
    "suites": [
        {
            "cases": [
                {
                    "code": r"""
>>> import kinlab as kl
>>> found = kl.mark("sheet.toml", {"me": {"q1": x}}, feedback="place")["me"]["q1"]
>>> print(found.verdict if found.right else found.place)
right
""",
                    "hidden": False,
                    "locked": False,
                    "points": 2,
                }
            ],
            "scored": True,
            "setup": "",
            "teardown": "",
            "type": "doctest",
        }
    ],
}
