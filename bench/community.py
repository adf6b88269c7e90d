# SPDX-License-Identifier: GPL-2.0-or-later
"""The benchmarks of Dosta et al. 2024 (Comput. Phys. Commun. 296, 109066): `make bench-community`.

    .venv/bin/python bench/community.py [CASE ...] [--models hertz,yade,...] [--seeds 1,2,3] [--until 0.1] [--full]
        [--rain-friction 0.3]

Each case of cases/benchmarks is run in two parts: the rain, whose last frame is stored as spheres.csv in
runs/community/CASE/seedN, and the last phase, which every model and engine begins with these spheres. A run that was
stopped goes on from its last restart file. Without --full the cases in LONG run 10,000 steps, on a bed that fell with
smaller moduli. docs/benchmarks.py makes tables and figures of what is there.
"""

import argparse
import os
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from community_models import MODELS, RAIN_FRICTION, SHORT, SPEED, START, YADE, curve, engine, loop

from epdem.case.scene import SceneCase, parse
from epdem.case.toml import LoadedCase
from epdem.engines.frames import whole_restarts
from epdem.engines.liggghts.engine import Liggghts
from epdem.engines.liggghts.launcher import OUT
from epdem.errors import CaseError
from epdem.scenes.judge.summary import SceneOutcome
from epdem.scenes.run import run as run_scene
from epdem.scenes.tables.columns import last_frame

ROOT = Path(__file__).resolve().parents[1]
CASES, RUNS = ROOT / "cases/benchmarks", ROOT / "runs/community"
# Cases for larger machines, and what divides their moduli during the rain where only SHORT steps of them are run.
LONG = {"drum": 1.0, "impact_50k": 100.0, "impact_100k": 100.0, "silo_large": 100.0, "silo_small": 100.0}
YADE_END = 0.032  # [s]
NEAR, G = 2e-3, 9.81  # [m] above the bed, [m/s^2]


class Enough(Exception):
    """The run has the time that was asked for; its restart file is whole."""


def read(name: str) -> dict[str, Any]:
    """The data of a case."""
    return tomllib.loads((CASES / f"{name}.toml").read_text(encoding="utf-8"))


def rain(name: str, seed: int, *, soft: float, friction: float) -> SceneCase:
    """All phases of a case but the last, with one friction for all pairs and moduli that are `soft` times smaller."""
    data = read(name)
    for contact in (data["contact"], *data["contact"].get("pairs", [])):
        contact["friction"] = friction
    data["numerics"]["seed"] = seed
    data["numerics"].pop("skin", None)  # it is for a sphere that comes later
    scene = data["scene"]
    last = scene["phase"].pop()["name"]
    scene["body"] = [b for b in scene.get("body", []) if b.get("phase") != last]
    scene.pop("measure", None)
    data["output"] |= {"restarts": 20, "particles": 2}
    for material in data["materials"].values():
        number, unit = material["young_modulus"].split()
        material["young_modulus"] = f"{float(number) / soft!r} {unit}"
    for phase in scene["phase"]:
        number, unit = phase["time_step"].split()
        phase["time_step"] = f"{float(number) * soft**0.5!r} {unit}"
    return parse(data, CASES / f"{name}.toml")


def fall(name: str, spheres: Path) -> float:
    """The time [s] that the body of a case falls freely, down to NEAR above the highest sphere; 0 without a body.

    The bed is at rest then, and the fall is known exactly: every model and engine begins behind it.
    """
    bodies = read(name)["scene"].get("body", [])
    if not bodies:
        return 0.0
    radius = float(bodies[0]["radius"].split()[0]) * 1e-3
    table = pd.read_csv(spheres)
    way = START - radius - NEAR - float((table["z"] + table["radius"]).max())
    return float(np.floor(2e3 * (np.sqrt(SPEED**2 + 2 * G * way) - SPEED) / G)) / 2e3


def after_rain(name: str, seed: int, model: str, spheres: Path, *, steps: int | None) -> SceneCase:
    """The last phase of a case behind the free fall, with the spheres of a file; `steps` of it, or all."""
    data, begin = read(name), fall(name, spheres)
    data["numerics"]["seed"] = seed
    data["law"]["name"] = MODELS[model]
    scene = data["scene"]
    scene["fill"] = [{"name": "bed", "file": str(spheres)}]
    scene["phase"] = scene["phase"][-1:]
    (phase,) = scene["phase"]
    for body in scene.get("body", []):
        body.pop("phase", None)
        body["position"][2] = f"{START - SPEED * begin - G * begin**2 / 2!r} m"
        body["velocity"][2] = f"{-SPEED - G * begin!r} m/s"
    scene["wall"] = [w for w in scene["wall"] if phase["name"] in w.pop("phases", [phase["name"]])]
    if steps is not None:
        number, unit = data["numerics"]["time_step"].split()
        phase["duration"] = f"{steps * float(number)!r} {unit}"
        data["output"]["particles"] = 10
    else:
        phase["duration"] = f"{float(phase['duration'].split()[0]) - begin!r} s"
        if "move" not in phase:
            data["output"]["restarts"] = 50
    return parse(data, CASES / f"{name}.toml")


def say(what: str) -> Callable[[int, int], None]:
    """Progress in one line every ten seconds."""
    start, last = time.monotonic(), [0.0]

    def report(step: int, steps: int) -> None:
        now = time.monotonic()
        if now - last[0] > 10.0:
            last[0] = now
            print(f"{what}: step {step} of {steps}, {now - start:.0f} s", file=sys.stderr, flush=True)

    return report


def run(case: SceneCase, what: Liggghts, folder: Path, until: float | None = None) -> SceneOutcome | None:
    """A run that goes on where an earlier one was stopped; None if it was stopped at `until` [s]."""
    show, text = say(str(folder.relative_to(RUNS))), (CASES / f"{case.name}.toml").read_text(encoding="utf-8")

    def report(step: int, steps: int) -> None:
        show(step, steps)
        if until is not None and step * (case.numerics.time_step or 0.0) > until:
            raise Enough

    goes_on = not (folder / "results.h5").exists() and bool(whole_restarts(folder, folder / OUT))
    try:
        try:
            return run_scene(LoadedCase(case, text, folder), what, out=folder, resume=goes_on, report=report)
        except CaseError:
            if not goes_on:
                raise
            return run_scene(LoadedCase(case, text, folder), what, out=folder, report=report)  # of another version
    except Enough:
        return None


def bed(name: str, seed: int, *, soft: float, friction: float) -> Path:
    """spheres.csv: the last frame of the rain, which is run if it is not there yet."""
    other = "" if friction == RAIN_FRICTION else f"_friction{friction:g}"
    path = RUNS / name / f"{'seed' if soft == 1.0 else 'soft'}{seed}{other}" / "spheres.csv"
    if not path.exists():
        done = run(rain(name, seed, soft=soft, friction=friction), Liggghts(), path.parent / "bed")
        assert done is not None
        last = last_frame(done.results.tables["particles"]).sort_values("id")
        materials = [done.plan.model.types[int(t) - 1].material for t in last["type"]]
        table = last[["x", "y", "z", "radius", "vx", "vy", "vz"]].assign(material=materials)
        table.to_csv(path, index=False, float_format="%.17g")
    return path


def in_yade(spheres: Path, begin: float, until: float) -> None:
    """The impact with YADE's own model, on the same spheres; a run that was stopped goes on."""
    folder = spheres.parent / YADE
    if (folder / "done").exists():
        return
    folder.mkdir(exist_ok=True)
    script = Path(__file__).with_name("community_yade.py")
    words = ["yade", "-n", "-x", str(script), str(spheres), str(folder / "impactor.txt"), str(begin), str(until)]
    with (folder / "out.yade").open("wb") as stream:
        subprocess.run(words, check=True, stdout=stream, stderr=stream, env=os.environ | {"OMP_NUM_THREADS": "1"})
    (folder / "done").touch()


def one(name: str, seed: int, model: str, *, full: bool, friction: float, until: float | None) -> None:
    """One case, seed and model; what it leaves is read by the report."""
    short = name in LONG and not full
    spheres = bed(name, seed, soft=LONG[name] if short else 1.0, friction=friction)
    begin = fall(name, spheres)
    if model == YADE:
        in_yade(spheres, begin, min(until or YADE_END, YADE_END))
        return
    case = after_rain(name, seed, model, spheres, steps=SHORT if short else None)
    folder = spheres.parent / model.replace("/", "_")
    if until and (known := curve(folder)).size and known[-1, 0] >= until:
        return
    run(case, engine(model, begin), folder, until - begin if until and not short else None)
    seconds, steps = loop(folder)
    if steps:
        print(f"{name}, seed {seed}, {model}: {steps} steps, {1e3 * seconds / steps:.3g} ms each", flush=True)


def main() -> int:
    """Run what is asked for."""
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("cases", nargs="*", default=["impact_25k", *LONG])
    ask.add_argument(
        "--models", help="of hertz, ep/hertz, ep/thornton, yade; default: all for impact_25k, else ep/hertz"
    )
    ask.add_argument("--seeds", help="default: 1,2,3 for impact_25k, else 1")
    ask.add_argument("--until", type=float, help="[s] of the last phase; default: all of it")
    ask.add_argument("--rain-friction", type=float, default=RAIN_FRICTION, help="of all pairs: loose or dense beds")
    ask.add_argument("--full", action="store_true", help="all steps of the long cases")
    options = ask.parse_args()
    for name in options.cases:
        many = name == "impact_25k"
        models = (options.models or (",".join([*MODELS, YADE]) if many else "ep/hertz")).split(",")
        for model in models:
            for seed in map(int, (options.seeds or ("1,2,3" if many and model != YADE else "1")).split(",")):
                one(name, seed, model, full=options.full, friction=options.rain_friction, until=options.until)
    return 0


if __name__ == "__main__":
    sys.exit(main())
