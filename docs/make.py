# SPDX-License-Identifier: GPL-2.0-or-later
"""`make docs`: every generated page and figure of docs/, each by the command that a reader can run.

Run: .venv/bin/python docs/make.py [figures/NAME.png] [PAGE.md]      (without names: all)

Figures of `epdem` are copied from its folder of results.
"""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
FIGURES = {  # the command, and where the figure is then
    "steel_wall.png": (
        "epdem verify crosscheck cases/steel_wall.toml -e liggghts -e liggghts-thornton_ning -o runs/docs/steel",
        "runs/docs/steel/e_n.png",
    ),
    "oblique_steel.png": (
        "epdem run cases/oblique_steel.toml -e embedded -e liggghts -o runs/docs/oblique",
        "runs/docs/oblique/psi.png",
    ),
    "conductance.png": (
        "epdem run cases/press_layer.toml -e lammps -o runs/docs/layer",
        "runs/docs/layer/conductance.png",
    ),
    "tablet.png": ("epdem run cases/press_tablet.toml -o runs/docs/press", "runs/docs/press/bed.png"),
    "figure_8_16.png": ("epdem verify figures -o runs/figures", "runs/figures/figure_8_16.png"),
    "figure_8_17.png": ("epdem verify figures -o runs/figures", "runs/figures/figure_8_17.png"),
    "figure_8_18.png": ("epdem verify figures -o runs/figures", "runs/figures/figure_8_18.png"),
    "figure_8_19.png": ("epdem verify figures -o runs/figures", "runs/figures/figure_8_19.png"),
    "thornton_ning_1998.png": ("epdem verify figures -o runs/figures", "runs/figures/thornton_ning_1998.png"),
    "laws.png": (".venv/bin/python docs/laws.py", "docs/figures/laws.png"),
    "crosscheck.png": (".venv/bin/python docs/crosscheck.py", "docs/figures/crosscheck.png"),
    "cost.png": (".venv/bin/python docs/cost.py", "docs/figures/cost.png"),
    "stability_map.png": (".venv/bin/python docs/stability.py", "docs/figures/stability_map.png"),
    "validate.png": (".venv/bin/python docs/benchmarks.py", "docs/figures/validate.png"),
    "impact_25k.png": (".venv/bin/python docs/benchmarks.py", "docs/figures/impact_25k.png"),
    "impact_25k_lowest.png": (".venv/bin/python docs/benchmarks.py", "docs/figures/impact_25k_lowest.png"),
    "contact_cost.png": (".venv/bin/python bench/liggghts_speed.py", "docs/figures/contact_cost.png"),
}
PAGES = {
    "equations.md": ".venv/bin/python docs/equations.py",
    "cost.md": ".venv/bin/python docs/cost.py",
    "crosscheck.md": ".venv/bin/python docs/crosscheck.py",
    "benchmarks.md": ".venv/bin/python docs/benchmarks.py",
    "stability.md": ".venv/bin/python docs/stability.py",
    "decks.md": ".venv/bin/python docs/decks.py",
    "validation.md": ".venv/bin/python docs/validation.py",
}


def main() -> None:
    """Run the commands whose page or figure is named on the command line, or all, each once."""
    (ROOT / "docs/figures").mkdir(exist_ok=True)
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    commands = {f"figures/{name}": command for name, (command, _) in FIGURES.items()} | PAGES
    wanted = {name: command for name, command in commands.items() if name in sys.argv[1:] or len(sys.argv) == 1}
    for command in dict.fromkeys(wanted.values()):
        print(f"{', '.join(name for name in wanted if wanted[name] == command)}: {command}", flush=True)
        words = command.replace(".venv/bin/python", sys.executable).split()
        subprocess.run(words, cwd=ROOT, env=os.environ | {"PATH": path}, stdout=subprocess.DEVNULL)
    for name, (_, place) in FIGURES.items():
        if f"figures/{name}" in wanted:
            (ROOT / "docs/figures" / name).write_bytes((ROOT / place).read_bytes())


if __name__ == "__main__":
    main()
