"""``python -m kinlab`` is the ``kinlab`` command."""

from kinlab.cli import main

main()
