"""Runs the campaigns for a given time, with a new seed each round.

    python tests/fuzz/long.py --minutes 30
    python tests/fuzz/long.py --minutes 5 --only urdf --seed 7

Every round prints its seed; `KINLAB_FUZZ=long KINLAB_FUZZ_SEED=<seed> pytest tests/fuzz` repeats it.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main() -> int:
    """Exit code 1 if a round failed."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=30.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--scale", type=float, default=10.0, help="cases of a round, times the short run"
    )
    parser.add_argument(
        "--only", default="", help="part of a file's name: urdf, table, formula, api, cli, mesh"
    )
    parser.add_argument(
        "--report", default="", help="append every bad case to this file, a JSON object a line"
    )
    options = parser.parse_args()
    files = sorted(str(f) for f in HERE.glob("test_*.py") if options.only in f.name)
    end, seed, failed = time.monotonic() + 60 * options.minutes, options.seed, 0
    while time.monotonic() < end:
        seed += 1000
        print(f"seed {seed}", flush=True)
        environment = os.environ | {
            "KINLAB_FUZZ": "long", "KINLAB_FUZZ_SEED": str(seed), "KINLAB_FUZZ_SCALE": str(options.scale),
        }  # fmt: skip
        if options.report:
            environment["KINLAB_FUZZ_REPORT"] = str(Path(options.report).resolve())
        code = subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-n", "0", "--tb=short", *files],
            env=environment,
            check=False,
        ).returncode
        failed += code != 0
    print(f"{failed} rounds failed")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
