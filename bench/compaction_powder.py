# SPDX-License-Identifier: GPL-2.0-or-later
"""The powder of cases/compaction_powder.toml with four laws: force of the plate, work, contacts.

Run: .venv/bin/python bench/compaction_powder.py

Prints the table of docs/compaction.md and draws docs/figures/compaction_powder.png.
"""

import tempfile
from pathlib import Path

import numpy as np

from epdem import Scene, run
from epdem.report.chart import Axis, Chart, Panel, Series, save

HERE = Path(__file__).resolve().parent.parent
LAWS = {
    "thornton": {"name": "thornton"},
    "cavity": {"name": "cavity"},
    "cavity, finite_strain": {"name": "cavity", "finite_strain": True},
    "cavity, finite_strain, compaction": {"name": "cavity", "finite_strain": True, "compaction": True},
}
OUTPUT = {"rows": 500, "particles": 250, "energy": True}
ALT = "Force of the plate against its height while it presses and releases a powder, with four laws"


def main() -> None:
    """Run the case with each law."""
    curves = []
    print("| law | largest force [N] | contacts per sphere there | without overlap | plastic work [mJ] | recovered |")
    for colour, (name, law) in enumerate(LAWS.items()):
        case = Scene.from_toml(HERE / "cases" / "compaction_powder.toml").replace(law=law, output=OUTPUT)
        with tempfile.TemporaryDirectory() as folder:
            tables = run(case, out=Path(folder) / "run").tables
        rows, contacts, checks = tables["rows"], tables["contacts"], tables["checks"].set_index("key")
        force = rows["plate_force"].to_numpy()
        top = rows["step"].iloc[int(np.argmax(force))]
        steps = contacts["step"].unique()
        there = contacts[(contacts["step"] == steps[np.argmin(abs(steps - top))]) & (contacts["force"] > 0)]
        number = (len(there) + (there["j"] != 0).sum()) / rows["particles"].iloc[-1]
        by_growth = 100 * (there["overlap"] < 0).mean()
        plastic = 1e3 * tables["energy_balance"]["plastic"].iloc[-1]
        back = 100 * checks.loc["recovered_work", "value"] / checks.loc["recovered_work", "expected"]
        cells = (f"{force.max():.1f}", f"{number:.2f}", f"{by_growth:.1f} %", f"{plastic:.2f}", f"{back:.1f} %")
        print(f"| `{name}` |", " | ".join(cells), "|", flush=True)
        curves.append(Series(name, 1e3 * rows["plate_z"].to_numpy(), force, colour))
    panel = Panel(Axis("height of the plate", "mm", high=1.6), Axis("force of the plate", "N"), curves)
    save(Chart("compaction_powder", "A powder under a plate", ALT, [panel]), HERE / "docs/figures", data=False)


if __name__ == "__main__":
    main()
