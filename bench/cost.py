# SPDX-License-Identifier: GPL-2.0-or-later
"""Error against run time of every law and LIGGGHTS's own models, one impact case and one bulk scene; two minutes."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LAWS = ("thornton", "cavity", "johnson", "hertz")


def main() -> int:
    """Run the command, which prints its tables; its exit code."""
    laws = [word for law in LAWS for word in ("--law", law)]
    words = ["verify", "cost", "cases/steel_wall.toml", *laws, "--repetitions", "3", "--bulk"]
    return subprocess.run([sys.executable, "-m", "epdem", *words], cwd=ROOT, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
