# SPDX-License-Identifier: GPL-2.0-or-later
"""`make bench`: every measurement in turn; each prints its table as it ends. Name scripts to run only those."""

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main() -> int:
    """Run the scripts of this folder, the quick ones first; the exit code counts those that failed."""
    slow = ["million.py"]
    names = sorted(p.name for p in HERE.glob("*.py") if p.name != "all.py")
    order = [n for n in names if n not in slow] + [n for n in slow if n in names]
    wanted = [n for n in order if not sys.argv[1:] or n.removesuffix(".py") in sys.argv[1:]]
    failed = 0
    for name in wanted:
        print(f"\n=== bench/{name}", flush=True)
        failed += subprocess.run([sys.executable, str(HERE / name)], cwd=HERE.parent).returncode != 0
    return failed


if __name__ == "__main__":
    sys.exit(main())
