# SPDX-License-Identifier: GPL-2.0-or-later
"""What each feature adds to deck, history and step in three hosts: writes docs/lean.md and docs/data/lean.csv.

    .venv/bin/python bench/lean.py      (needs LIGGGHTS, LAMMPS and YADE; minutes)

A cubic lattice of spheres in contact between two walls; the same time step and number of steps for all features. The
time of a step is the processor time of a run less that of a run of the case without features with few steps, over the
difference of the steps. Runs of all features alternate, so that what else the machine does hits all, and the shortest
time counts.
"""

import resource
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

from epdem.api import Scene
from epdem.engines import scene_engine
from epdem.engines.host import Host
from epdem.engines.liggghts.deck import memory
from epdem.scenes.plan.plan import ScenePlan, plan

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))
HOSTS = ("liggghts", "lammps", "yade")
SIDE, RADIUS, OVERLAP, STEP = 8, 1e-3, 2e-3, 1e-6  # spheres, m, over the diameter, s
REPEATS = 3
STEPS, FEW = 10000, 20  # of a run
RUB = {"friction": 0.3}
ADHESIVE = {"name": "thornton_ning", "work_of_adhesion": "1e-3 J/m^2"}
FEATURES: dict[str, dict] = {
    "nothing: `thornton`, no friction": {},
    '`law.name = "cavity"`': {"law": {"name": "cavity"}},
    "`cavity` with `finite_strain`": {"law": {"name": "cavity", "finite_strain": True}},
    "`cavity` with `finite_strain`, `compaction`": {
        "law": {"name": "cavity", "finite_strain": True, "compaction": True}
    },
    '`law.name = "thornton_ning"` (adhesion)': {"law": ADHESIVE},
    "`viscous`": {"viscous": {"restitution": 0.9}},
    "`contact.friction`": {"contact": RUB},
    'friction, `tangential = "partial_slip"`': {"contact": RUB | {"tangential": "partial_slip"}},
    "friction, `tangential_restitution`": {"contact": RUB | {"tangential_restitution": 0.9}},
    "friction, `rolling` `cdt`": {"contact": RUB | {"rolling": {"model": "cdt", "coefficient": 0.1}}},
    "friction, `rolling` `epsd2`": {"contact": RUB | {"rolling": {"model": "epsd2", "coefficient": 0.1}}},
    "friction, `cohesion`": {"contact": RUB | {"cohesion": "1 J/m^3"}},
    "`output.energy`": {"output": {"rows": 20, "particles": 1, "energy": True}},
    "`output.loads`": {"output": {"rows": 20, "particles": 1, "loads": True}},
    "`output.contacts`": {"output": {"rows": 20, "particles": 1, "contacts": 1}},
}
ALL = {"viscous": {"restitution": 0.9}, "output": {"rows": 20, "particles": 1, "energy": True, "loads": True}}
ROLLING = {"rolling": {"model": "epsd2", "coefficient": 0.1}, "cohesion": "1 J/m^3", "tangential_restitution": 0.9}
FEATURES["friction, both dashpots, `epsd2`, cohesion, energy, loads"] = ALL | {"contact": RUB | ROLLING}

TEXT = """# Lean decks

`.venv/bin/python bench/lean.py` writes this page and [lean.csv](data/lean.csv). A deck contains only what the physics
of its case requires. The table shows what a feature adds to the case without features, `thornton` without friction:
lines of the deck, bytes of history per contact (the same in LIGGGHTS and LAMMPS; contacts of YADE have one size for all
features) and time of a step as a ratio. The case is a lattice of {spheres} spheres, all in contact, between two walls;
processor time on one core, the shortest of {repeats} interleaved runs. Three tables on a quiet machine differ by up to
9 %. LAMMPS has the options of a contact in one line.

{table}

`epdem deck CASE --reasons` writes a deck with the reason of each line. `tests/scenes/test_lean.py` removes each line of
the deck of every case in turn and runs the deck again.
"""


def scene(feature: dict, folder: Path, steps: int) -> ScenePlan:
    """The plan of the lattice with a feature."""
    spacing = 2 * RADIUS * (1 - OVERLAP)
    axis = spacing * (np.arange(SIDE) + 0.5)
    place = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    table = pd.DataFrame(place, columns=[*"xyz"]).assign(radius=RADIUS, material="glass")
    table.to_csv(folder / "spheres.csv", index=False)
    edge = spacing * SIDE
    wall = {"kind": "plane", "axis": "z", "material": "glass"}
    parts = {
        "kind": "parts",
        "gravity": 0.0,
        "periodic": True,
        "room": {"x": [0.0, edge], "y": [0.0, edge], "z": [0.0, edge]},
        "wall": [wall | {"name": name, "at": at} for name, at in (("floor", 0.0), ("lid", edge))],
        "fill": [{"name": "lattice", "file": str(folder / "spheres.csv")}],
        "phase": [{"name": "run", "duration": STEP * steps}],
    }
    glass = {"young_modulus": "5 GPa", "poisson_ratio": 0.25, "density": "2500 kg/m^3", "yield_stress": "20 MPa"}
    case = {
        "case": {"name": "lattice", "title": "lattice"},
        "materials": {"glass": glass},
        "law": {"name": "thornton"},
        "scene": parts,
        "output": {"rows": 20, "particles": 1},
        "numerics": {"time_step": STEP, "highest_speed": 1.0},
    }
    return plan(Scene(**(case | feature)).model)


def lines(texts: dict[str, str]) -> int:
    """Lines of the deck that do something; its tables and the modules beside it are not the deck."""
    deck = (text for name, text in texts.items() if name.endswith((".in", ".scene", "scene.py")) or name == "setup.in")
    return sum(1 for text in deck for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#"))


def processor_time(tool: Host, folder: Path) -> float:
    """Processor time [s] of a run of the deck in a folder."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    tool.start(tool.scripts[1], folder)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def measure(repeats: int, scratch: Path) -> pd.DataFrame:
    """One row for each feature and host: lines, bytes, time of a step [us]."""
    rows = {}
    for host in HOSTS:
        start: list[float] = []
        times: dict[str, list[float]] = {name: [] for name in FEATURES}
        tool = scene_engine(host)
        assert isinstance(tool, Host)
        for number, (name, feature) in enumerate(FEATURES.items()):
            for steps in (STEPS, FEW):
                folder = scratch / f"{host}_{number}_{steps}"
                folder.mkdir()
                p = scene(feature, folder, steps)
                texts = tool.files(p)
                tool.put(texts, folder)
            rows[name, host] = {"lines": lines(texts), "bytes": 8 * memory(p.model)}
        for _ in range(repeats):
            start.append(processor_time(tool, scratch / f"{host}_0_{FEW}"))
            for number, name in enumerate(FEATURES):
                times[name].append(processor_time(tool, scratch / f"{host}_{number}_{STEPS}"))
            print(host, start, times, flush=True)
        for name in FEATURES:
            rows[name, host]["us_per_step"] = 1e6 * (min(times[name]) - min(start)) / (STEPS - FEW)
    keys = pd.DataFrame([*rows], columns=["feature", "host"])
    return keys.assign(**pd.DataFrame(rows.values()))


def page(found: pd.DataFrame, repeats: int) -> str:
    """The page of the documentation."""
    from pages import markdown

    base = found[found["feature"] == next(iter(FEATURES))].set_index("host")
    table = []
    for feature, rows in found.groupby("feature", sort=False):
        rows = rows.set_index("host")
        more, ratio = rows["lines"] - base["lines"], rows["us_per_step"] / base["us_per_step"]
        added = f"{rows['bytes'].iloc[0] - base['bytes'].iloc[0]:+d}"
        if not table:
            more, ratio, added = rows["lines"], rows["us_per_step"], str(rows["bytes"].iloc[0])
        shown = [f"{more[h]:+d}" if table else f"{more[h]}" for h in HOSTS]
        shown += [added, *(f"{ratio[h]:.2f}" if table else f"{ratio[h]:.0f} us" for h in HOSTS)]
        titles = [TITLES[h] for h in HOSTS]
        columns = ["feature", *(f"lines, {t}" for t in titles), "history bytes", *(f"step, {t}" for t in titles)]
        table.append(dict(zip(columns, [feature, *shown], strict=True)))
    return TEXT.format(spheres=SIDE**3, repeats=repeats, table=markdown(pd.DataFrame(table)))


TITLES = {"liggghts": "LIGGGHTS", "lammps": "LAMMPS", "yade": "YADE"}


def main() -> None:
    """Measure every feature and write the page."""
    from pages import load, store

    with tempfile.TemporaryDirectory(prefix="epdem_lean_") as scratch:
        store("lean", measure(REPEATS, Path(scratch)))
    (ROOT / "docs/lean.md").write_text(page(load("lean"), REPEATS), encoding="utf-8")


if __name__ == "__main__":
    main()
