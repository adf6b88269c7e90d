# SPDX-License-Identifier: GPL-2.0-or-later
"""The powder of cases/compaction_powder.toml with three laws: force of the plate, energy, contacts.

Run: .venv/bin/python bench/compaction_powder.py

Prints the table of docs/scenes.md and draws docs/figures/compaction_powder.png.
"""

import tempfile
from pathlib import Path

import numpy as np

from epdem import Scene, run
from epdem.report.chart import Axis, Chart, Panel, Series
from epdem.report.drawing import save
from epdem.scenes.energy_balance import closure

HERE = Path(__file__).resolve().parent.parent
LAWS = {
    "thornton": {"name": "thornton"},
    "cavity": {"name": "cavity"},
    "cavity with finite_strain": {"name": "cavity", "finite_strain": True},
    "cavity with finite_strain and compaction": {"name": "cavity", "finite_strain": True, "compaction": True},
}
ALT = "Force of the plate against its height while it presses and releases a powder, with four laws"


def main() -> None:
    """Run the case with each law."""
    curves = []
    print("| law | largest force [N] | contacts with a force per sphere there | plastic work [mJ] | energy balance |")
    for colour, (name, law) in enumerate(LAWS.items()):
        case = Scene.from_toml(HERE / "cases" / "compaction_powder.toml").replace(law=law)
        with tempfile.TemporaryDirectory() as folder:
            tables = run(case, out=Path(folder) / "run").tables
        rows, contacts, balance = tables["rows"], tables["contacts"], tables["energy_balance"]
        force = rows["plate_force"].to_numpy()
        top = rows["step"].iloc[int(np.argmax(force))]
        steps = contacts["step"].unique()
        there = contacts[(contacts["step"] == steps[np.argmin(abs(steps - top))]) & (contacts["force"] > 0)]
        number = (len(there) + (there["j"] != 0).sum()) / rows["particles"].iloc[-1]
        plastic = 1e3 * balance["plastic"].iloc[-1]
        print(f"| `{name}` | {force.max():.1f} | {number:.2f} | {plastic:.2f} | {closure(balance):.1e} |", flush=True)
        curves.append(Series(name, rows["plate_z"].to_numpy(), force, colour))
    panel = Panel(Axis("height of the plate", "m", high=1.6e-3), Axis("force of the plate", "N"), curves)
    save(Chart("compaction_powder", "A powder under a plate", ALT, [panel]), HERE / "docs/figures", data=False)


if __name__ == "__main__":
    main()
