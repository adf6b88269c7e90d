# SPDX-License-Identifier: GPL-2.0-or-later
"""`make docs`: every generated page and figure of docs/, each by the command that a reader can run."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
BIN = Path(sys.executable).parent
COMMANDS = {
    "figures/steel_wall.png": [
        BIN / "epdem",
        "run",
        "cases/steel_wall.toml",
        "-e",
        "liggghts",
        "-e",
        "liggghts-thornton_ning",
        "--out",
        "runs/docs",
    ],
    "figures/laws.png": [sys.executable, "docs/laws.py"],
    "figures/figure_8_16.png": [BIN / "epdem", "figures", "--out", "runs/docs/figures"],
    "equations.md": [sys.executable, "docs/equations.py"],
    "cost.md": [sys.executable, "docs/cost.py"],
    "benchmarks.md": [sys.executable, "docs/benchmarks.py"],
    "stability.md": [sys.executable, "docs/stability.py"],
}


def main() -> None:
    """Run the commands whose page is named on the command line, or all."""
    (ROOT / "docs/figures").mkdir(exist_ok=True)
    for page, command in COMMANDS.items():
        if len(sys.argv) > 1 and page not in sys.argv[1:]:
            continue
        print(f"docs/{page}: {' '.join(str(c) for c in command).replace(str(BIN) + '/', '')}", flush=True)
        subprocess.run(list(map(str, command)), cwd=ROOT, stdout=subprocess.DEVNULL)  # thornton_ning fails its checks
        if page == "figures/steel_wall.png":
            (ROOT / "docs" / page).write_bytes((ROOT / "runs/docs/e_n.png").read_bytes())
        if page == "figures/figure_8_16.png":
            for picture in (ROOT / "runs/docs/figures").glob("*.png"):
                (ROOT / "docs/figures" / picture.name).write_bytes(picture.read_bytes())


if __name__ == "__main__":
    main()
