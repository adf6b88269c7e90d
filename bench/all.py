# SPDX-License-Identifier: GPL-2.0-or-later
"""`make bench`: every measurement in turn; each prints its table as it ends. Name scripts to run only those.

At the end one table holds all ratios with their limits. A missed limit is a word in it; the command fails if a script
fails, and a script fails if a model of ours is slower than LIGGGHTS's own or than it was with LIGGGHTS's loop.
"""

import subprocess
import sys
from pathlib import Path

import store

HERE = Path(__file__).resolve().parent


def main() -> int:
    """Run the scripts of this folder, the quick ones first; the exit code counts those that failed."""
    slow = ["million.py", "scenes_speed.py"]
    parts = ["all.py", "store.py", "dense_packings.py", "lammps_packings.py"]
    names = sorted(p.name for p in HERE.glob("*.py") if p.name not in parts and not p.name.startswith("community"))
    order = [n for n in names if n not in slow] + [n for n in slow if n in names]
    wanted = [n for n in order if not sys.argv[1:] or n.removesuffix(".py") in sys.argv[1:]]
    failed = 0
    for name in wanted:
        print(f"\n=== bench/{name}", flush=True)
        failed += subprocess.run([sys.executable, str(HERE / name)], cwd=HERE.parent).returncode != 0
    print(f"\n=== all ratios\n{store.table()}")
    return failed


if __name__ == "__main__":
    sys.exit(main())
