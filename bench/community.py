# SPDX-License-Identifier: GPL-2.0-or-later
"""The benchmarks of Dosta et al. 2024 (Comput. Phys. Commun. 296, 109066): `make bench-community`.

    .venv/bin/python bench/community.py [CASE ...] [--models hertz,ep/hertz,...] [--seeds 1,2,3] [--until 0.1]

Each case of cases/benchmarks is run in two parts: the rain, whose last frame is stored as spheres.csv in
runs/community/CASE/seedN, and what follows, which every model and engine begins with these spheres. A run that was
stopped goes on from its last restart file.
"""

import argparse
import sys
import time
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from community_models import MODELS, curve, engine

from epdem.case.scene import SceneCase, parse
from epdem.errors import CaseError
from epdem.liggghts import resume
from epdem.liggghts.scenes import LiggghtsScenes
from epdem.scenes.run import SceneOutcome, run_case

ROOT = Path(__file__).resolve().parents[1]
CASES, RUNS = ROOT / "cases/benchmarks", ROOT / "runs/community"
SHORT = 10_000  # steps of a case that is for larger machines


class Enough(Exception):
    """The run has the time that was asked for; its restart file is whole."""


def say(what: str) -> Callable[[int, int], None]:
    """Progress in one line every ten seconds."""
    start, last = time.monotonic(), [0.0]

    def report(step: int, steps: int) -> None:
        now = time.monotonic()
        if now - last[0] > 10.0:
            last[0] = now
            print(f"{what}: step {step} of {steps}, {now - start:.0f} s", file=sys.stderr, flush=True)

    return report


def run(
    case: SceneCase, text: str, what: LiggghtsScenes, folder: Path, until: float | None = None
) -> SceneOutcome | None:
    """A run that goes on where an earlier one was stopped; None if it was stopped at `until` [s]."""
    show = say(str(folder.relative_to(RUNS)))

    def report(step: int, steps: int) -> None:
        show(step, steps)
        if until is not None and step * (case.numerics.time_step or 0.0) > until:
            raise Enough

    goes_on = not (folder / "results.h5").exists() and bool(resume.whole_restarts(folder))
    try:
        try:
            return run_case(case, text, what, place=folder, out=folder, resume=goes_on, report=report)
        except CaseError:
            if not goes_on:
                raise
            return run_case(case, text, what, place=folder, out=folder, report=report)  # of another version
    except Enough:
        return None


def rain(name: str, seed: int) -> Path:
    """spheres.csv of a bed: the last frame of the case's first phase."""
    text, data = read(name)
    data["numerics"]["seed"] = seed
    scene = data["scene"]
    scene["phase"] = scene["phase"][:1]
    scene["body"] = [b for b in scene.get("body", []) if b.get("phase") == scene["phase"][0]["name"]]
    scene.pop("measure", None)
    data["output"] |= {"restarts": 20, "particles": 2}
    folder = RUNS / name / f"seed{seed}"
    case = parse(data, CASES / f"{name}.toml")
    done = run(case, text, engine("ep/hertz"), folder / "bed")
    assert done is not None
    frames = done.results.tables["particles"]
    bed = frames[frames["step"] == frames["step"].max()].sort_values("id")
    materials = [done.plan.model.types[int(t) - 1].material for t in bed["type"]]
    table = bed[["x", "y", "z", "radius", "vx", "vy", "vz"]].assign(material=materials)
    table.to_csv(folder / "spheres.csv", index=False, float_format="%.17g")
    return folder / "spheres.csv"


def read(name: str) -> tuple[str, dict[str, Any]]:
    """Text and data of a case."""
    text = (CASES / f"{name}.toml").read_text(encoding="utf-8")
    return text, tomllib.loads(text)


def after_rain(name: str, seed: int, model: str, spheres: Path) -> SceneCase:
    """The case from its second phase on, with the spheres of a file."""
    _, data = read(name)
    data["numerics"]["seed"] = seed
    data["law"]["name"] = MODELS[model]
    scene = data["scene"]
    scene["fill"] = [{"name": "bed", "file": str(spheres)}]
    scene["phase"] = scene["phase"][1:]
    first = scene["phase"][0]["name"]
    for body in scene.get("body", []):
        if body.get("phase") == first:
            del body["phase"]
    for wall in scene["wall"]:
        if "phases" in wall:
            wall["phases"] = [p for p in wall["phases"] if p != data["scene"]["phase"][0]["name"]]
    data["output"]["restarts"] = 10
    return parse(data, CASES / f"{name}.toml")


def main() -> int:
    """Run what is asked for; print and keep the numbers."""
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("cases", nargs="*", default=["impact_25k"])
    ask.add_argument("--models", default=",".join(MODELS))
    ask.add_argument("--seeds", default="1,2,3")
    ask.add_argument("--until", type=float)
    options = ask.parse_args()
    for name in options.cases:
        for seed in map(int, options.seeds.split(",")):
            spheres = RUNS / name / f"seed{seed}" / "spheres.csv"
            if not spheres.exists():
                rain(name, seed)
            for model in filter(None, options.models.split(",")):
                case = after_rain(name, seed, model, spheres)
                run(case, read(name)[0], engine(model), spheres.parent / model.replace("/", "_"), options.until)
                path = curve(spheres.parent / model.replace("/", "_"))
                print(name, seed, model, path[-1], 1e3 * (path[:, 1].min() - 0.06), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
