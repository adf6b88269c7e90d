# SPDX-License-Identifier: GPL-2.0-or-later
"""Small runs of every kind of scene that are kept in tests/scenes/stored, so that reading them takes no engine.

cd tests/scenes && ../../.venv/bin/python stored_runs.py    # makes them anew; look at what changes
"""

import shutil
import tempfile
from collections.abc import Collection
from pathlib import Path

from scene_runs import write_case

from epdem.case.scene import load, parse
from epdem.case.toml import read_toml
from epdem.engines import scene_engine
from epdem.scenes.plan.plan import ScenePlan, plan
from epdem.scenes.run import run_plan

STORED = Path(__file__).with_name("stored")
CASES = Path(__file__).parents[2] / "cases"
OUTPUT = {"rows": 8, "particles": 4, "energy": True, "loads": True}
BED = {"box": ["8 mm", "8 mm", "12 mm"], "count": 8, "duration": "0.05 s"}
PRESS = {
    "box": ["0.4 mm", "0.4 mm", "0.6 mm"],
    "count": 16,
    "height": "0.13 mm",
    "unload_stroke": "0.05 mm",
    "speed": "4 m/s",
    "unload_speed": "2 m/s",
}
BIN = {
    "count": 12,
    "bin_height": "20 mm",
    "bin_diameter": "20 mm",
    "outlet": "12 mm",
    "fill_time": "0.05 s",
    "outlet_height": "5 mm",
    "duration": "0.06 s",
}
# kind: (engine, case file, changes of [scene], step)
RUNS: dict[str, tuple[str, str, dict[str, object], str]] = {
    "settle": ("liggghts", "settle_glass", BED, "1e-5 s"),
    "hopper": ("liggghts", "hopper_beads", BIN, "1e-5 s"),
    "drum": (
        "liggghts",
        "drum_beads",
        {"count": 8, "diameter": "16 mm", "length": "6 mm", "duration": "0.08 s", "fixed_ends": True},
        "1e-5 s",
    ),
    "compaction": ("liggghts", "compaction_powder", PRESS, "5e-8 s"),
    "peening": ("liggghts", "peening_steel", {"count": 8, "width": "3 mm", "duration": "0.15 ms"}, "4e-8 s"),
    "yade_settle": ("yade", "settle_glass", BED, "1e-5 s"),
    "yade_compaction": ("yade", "compaction_powder", PRESS, "5e-8 s"),
}


def planned(name: str) -> ScenePlan:
    """The plan of a stored run."""
    return plan(load(STORED / name / "case.toml"))


def data_of(name: str) -> dict:
    """TOML data of a stored run: without friction, so that its energy balance closes."""
    _, case, scene, step = RUNS[name]
    data = read_toml(CASES / f"{case}.toml")
    without = {key: value for key, value in data.items() if key != "contact"}
    law = {"name": "thornton"} if case == "compaction_powder" else data["law"]
    return without | {"law": law, "scene": data["scene"] | scene, "output": {**OUTPUT}, "numerics": {"time_step": step}}


def is_of_run(path: Path, deck: Collection[str]) -> bool:
    """Whether a file is of the run, not of the deck."""
    return path.is_file() and path.name not in deck and path.suffix != ".so"


def store(name: str) -> None:
    """Run and keep what the engine wrote, without its deck."""
    engine = scene_engine(RUNS[name][0])
    folder = STORED / name
    shutil.rmtree(folder, ignore_errors=True)
    p = plan(parse(data_of(name)))
    deck = engine.files(p)
    with tempfile.TemporaryDirectory() as scratch:
        run_plan(p, engine, Path(scratch))
        written = [path for path in Path(scratch).iterdir() if is_of_run(path, deck)]
        write_case(data_of(name), folder)
        for path in written:
            shutil.copy(path, folder)


if __name__ == "__main__":
    for name in RUNS:
        store(name)
