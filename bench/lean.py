# SPDX-License-Identifier: GPL-2.0-or-later
"""Each scene as its case asks for it against the same with every sub-model on: writes docs/lean.md.

    .venv/bin/python bench/lean.py [--out docs/lean.md] [--repeats 5]

The full deck has friction, tangential dashpot, rolling friction, cohesion and the energy balance, with coefficients so
small that the spheres do the same in the same time steps. Both run to 95 % of the scene once; the rest is then repeated
in turns from the restart files, so that what else the machine does hits both, and the shortest time counts.
"""

import argparse
import tempfile
from pathlib import Path

from epdem.base.files import write_texts
from epdem.case import scene as scenes
from epdem.case.toml import read_toml
from epdem.engines import log
from epdem.engines.liggghts import launcher, resume
from epdem.engines.liggghts.deck import files, memory
from epdem.engines.restarts import whole_restarts
from epdem.scenes.plan.plan import plan
from epdem.theory.backbones import ADHESIVE

ROOT = Path(__file__).parents[1]
NOTHING = 1e-9


def lean(data: dict) -> dict:
    """The case without asked-for extras: the least that its physics needs."""
    return data | {"output": {"rows": 20, "particles": 1, "restarts": 20}}


def full(data: dict) -> dict:
    """The case with every sub-model and the energy balance."""
    nothing: dict = {"friction": NOTHING}
    if "viscous" not in data:  # LIGGGHTS has one restitution for both dashpots
        nothing["tangential_restitution"] = 0.999
    if data["law"]["name"] not in ADHESIVE and not data["law"].get("compaction"):  # which have none beside their own
        nothing["cohesion"] = f"{NOTHING} J/m^3"
    rolling = {"rolling": {"model": "epsd2", "coefficient": NOTHING}}
    output = {"rows": 20, "particles": 1, "restarts": 20, "energy": True, "loads": True}
    return data | {"contact": nothing | rolling | data.get("contact", {}), "output": output, "numerics": {"error": 0.1}}


def loop_seconds(folder: Path, name: str) -> float:
    """Seconds per step in LIGGGHTS's loops; a scene's output stays in its folder, for the deck that continues it."""
    out = launcher.OUT if name == "in.scene" else "out.resume"
    launcher.run(name, folder, out=out)
    loops = log.loops(folder / out)
    return sum(t for t, _ in loops) / max(1, sum(n for _, n in loops))


def lines(folder: Path) -> int:
    """Lines of the deck that do something."""
    text = (folder / "in.scene").read_text() + (folder / "setup.in").read_text()
    return sum(1 for line in text.splitlines() if line.strip() and not line.startswith("#"))


def measure(path: Path, repeats: int, scratch: Path) -> dict:
    """The numbers of one scene."""
    found: dict = {"name": path.stem}
    folders = {}
    data = read_toml(path)
    step = plan(scenes.parse(full(data), path)).time_step  # sticking contacts need the smaller one
    for name, make in (("lean", lean), ("full", full)):
        p = plan(scenes.parse(make(data) | {"numerics": {"time_step": f"{step} s"}}, path))
        folders[name] = folder = scratch / f"{path.stem}_{name}"
        write_texts(folder, files(p))
        found[f"{name}_lines"], found[f"{name}_bytes"] = lines(folder), 8 * memory(p.model)
        loop_seconds(folder, "in.scene")
        resume.write_resume(p, folder, whole_restarts(folder, folder / launcher.OUT)[-1])
    times: dict[str, list[float]] = {name: [] for name in folders}
    for _ in range(repeats):
        for name, folder in folders.items():
            times[name].append(loop_seconds(folder, "in.resume"))
    return found | {f"{name}_seconds": min(values) for name, values in times.items()}


HEAD = """# Lean and full decks

`.venv/bin/python bench/lean.py` writes this page. The *lean* deck contains only what the physics of the case requires.
The *full* deck is the same scene with every sub-model on (friction, dashpot, rolling friction, cohesion, plastic work,
wall loads), the same time step, and coefficients of 1e-9 for models that the case does not have. Times are for the last
5 % of each scene on one rank, the shortest of several interleaved runs.

| scene | deck lines full | lean | history bytes per contact full | lean | us per step full | lean | ratio |
|---|---|---|---|---|---|---|---|
"""
TAIL = """
`epdem deck CASE --reasons` writes a deck with the reason of each line. `tests/scenes/test_lean.py` removes each line of
the deck of every case in turn and runs the deck again.
"""


def page(rows: list[dict]) -> str:
    """The page of the documentation."""
    body = []
    for r in rows:
        a, b = r["full_seconds"] * 1e6, r["lean_seconds"] * 1e6
        cells = (r["name"], r["full_lines"], r["lean_lines"], r["full_bytes"], r["lean_bytes"], f"{a:.4g}", f"{b:.4g}")
        body.append("| " + " | ".join(map(str, cells)) + f" | {a / b:.2f} |\n")
    return HEAD + "".join(body) + TAIL


def main() -> None:
    """Measure every scene in cases/ and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs/lean.md")
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="epdem_lean_") as scratch:
        rows = [
            measure(p, options.repeats, Path(scratch))
            for p in sorted((ROOT / "cases").glob("*.toml"))
            if scenes.is_scene(read_toml(p))
        ]
    options.out.write_text(page(rows))
    print(options.out.read_text())


if __name__ == "__main__":
    main()
