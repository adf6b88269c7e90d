# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes with STL walls in LIGGGHTS and LAMMPS, side by side: writes docs/data/stl_scenes.csv.

    .venv/bin/python bench/stl_scenes.py

hopper and screw are cases/hopper_stl.toml and cases/screw.toml; drum has the beads of cases/drum_beads.toml in a closed
drum of triangles that turns. Each seed is another packing. `sigmas` is the difference of the means of both hosts over
its standard error, by the scatter of the seeds.
"""

import itertools
import math
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

from epdem.api import Scene, run
from epdem.case.toml import read_toml

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "docs/data/stl_scenes.csv"
HOSTS = ("liggghts", "lammps")


def drum(folder: Path) -> Scene:
    """A drum about y, 60 mm wide and 16 mm long, filled to a third."""
    sys.path.insert(0, str(ROOT / "cases/parts"))
    import meshes

    ends = [*meshes.line((0, -8), (30, -8), 8), *meshes.line((30, -8), (30, 8), 3)[1:]]
    meshes.write(folder, "drum", meshes.revolve([*ends, *meshes.line((30, 8), (0, 8), 8)[1:]], 50))
    data = read_toml(ROOT / "cases/drum_beads.toml")
    wall = {"name": "drum", "kind": "stl", "file": str(folder / "drum.stl"), "scale": 1e-3, "material": "beads"}
    block = {"x": ["-19 mm", "19 mm"], "y": ["-7 mm", "7 mm"], "z": ["-19 mm", "19 mm"]}
    turn = {"wall": "drum", "kind": "rotate", "axis": "+y", "rate": data["scene"]["angular_velocity"]}
    data["scene"] = {
        "kind": "parts",
        "room": {"x": ["-31 mm", "31 mm"], "y": ["-9 mm", "9 mm"], "z": ["-31 mm", "31 mm"]},
        "wall": [wall | {"rotate": {"axis": "+x", "angle": "90 deg"}}],
        "fill": [{"name": "bed", "region": block, "particles": data["scene"]["particles"], "count": 1200}],
        "phase": [{"name": "turn", "duration": "1.5 s", "move": [turn]}],
        "measure": [{"name": "angle", "kind": "repose", "over": "x"}],
    }
    return Scene(**data | {"output": {"rows": 150, "particles": 75, "loads": True}})


SCENES = {"screw": "screw.toml", "hopper": "hopper_stl.toml", "drum": ""}
PACKINGS = {"screw": 4, "hopper": 4, "drum": 8}
UNITS = {"torque": "uN m", "force": "mN", "discharge": "g/s", "angle": "deg"}


def measure(name: str, seed: int, host: str, folder: Path) -> dict[str, float]:
    """Run a scene; its quantities in UNITS, means over the steady part."""
    case = Scene.from_toml(ROOT / "cases" / SCENES[name]) if SCENES[name] else drum(folder)
    tables = run(case.replace({"numerics.seed": seed}), engines=host, out=folder / host).tables
    rows, measures = tables["rows"], tables.get("measures")
    if name == "hopper":
        late = measures["time"].between(0.25, 0.6)
        return {"discharge": 1e3 * np.polyfit(measures["time"][late], measures["poured"][late], 1)[0]}
    if name == "drum":
        torque = -1e6 * rows["drum_torque_y"][rows["time"] > 0.7].mean()
        return {"angle": math.degrees(measures["angle"][measures["time"] > 0.7].mean()), "torque": torque}
    late = rows["time"] > 0.3
    return {"torque": 1e6 * rows["screw_torque_z"][late].mean(), "force": 1e3 * rows["screw_force_z"][late].mean()}


def compare(found: pd.DataFrame) -> pd.DataFrame:
    """The means of the hosts, from rows of scene, quantity, host and value."""
    table = []
    for (scene, quantity), values in found.groupby(["scene", "quantity"], sort=False):
        liggghts, lammps = (values["value"][values["host"] == host] for host in HOSTS)
        error = math.sqrt(lammps.sem() ** 2 + liggghts.sem() ** 2)
        row = {"scene": scene, "quantity": quantity, "unit": UNITS[quantity], "packings": len(lammps)}
        for host, x in zip(HOSTS, (liggghts, lammps), strict=True):
            row |= {host: f"{x.mean():.4g}", f"{host}_scatter": f"{x.std():.2g}"}
        row |= {
            "ratio": f"{lammps.mean() / liggghts.mean():.3f}",
            "sigmas": f"{(lammps.mean() - liggghts.mean()) / error:+.1f}",
        }
        table.append(row)
    return pd.DataFrame(table)


def main() -> None:
    """Run the packings of all scenes and write the table."""
    found = []
    runs = [(name, seed) for name in SCENES for seed in range(1, PACKINGS[name] + 1)]
    for (name, seed), host in itertools.product(runs, HOSTS):
        with tempfile.TemporaryDirectory(prefix="epdem_stl_") as folder:
            for quantity, value in measure(name, seed, host, Path(folder)).items():
                found.append({"scene": name, "quantity": quantity, "host": host, "value": value})
                print(f"{name} {quantity} {host} seed {seed}: {value:.5g} {UNITS[quantity]}", flush=True)
    compare(pd.DataFrame(found)).to_csv(TABLE, index=False)


if __name__ == "__main__":
    main()
