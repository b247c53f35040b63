"""Writes robots/urdf/*.urdf from the DH tables in robots/*.toml.

The URDFs are committed so that any other tool can use them; a test regenerates them and finds
no difference. Run it after changing a table: ``python scripts/make_urdfs.py``.
"""

from __future__ import annotations

import kinlab as kl
from kinlab.host.files import write_text
from kinlab.model.library import robots_dir, shipped
from kinlab.model.urdf_write import written


def main() -> None:
    """Writes one file per table and prints its name."""
    folder = robots_dir() / "urdf"
    folder.mkdir(exist_ok=True)
    for entry in shipped().values():
        file = folder / f"{entry.name}.urdf"
        write_text(file, written(kl.DHTable.load(entry.path)))
        print(f"wrote {file.name}")


if __name__ == "__main__":
    main()
