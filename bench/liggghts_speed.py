# SPDX-License-Identifier: GPL-2.0-or-later
"""What epdem's models cost in LIGGGHTS, as ratios to its own `hertz` with the same tangential model.

Run: .venv/bin/python bench/liggghts_speed.py [--quick]

Every model sees the same deck and starts from the same positions; the models take turns, and each keeps its fastest
run, because on a shared machine the noise only adds. The moving packings are dense, so that they keep their contacts
whatever a model dissipates: the number of contacts stands in the table. Instruction counts (callgrind) repeat exactly
and are the number to watch.
"""

import argparse
import math
import re
import shutil
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "engines"))

from plugin_decks import good, launcher, per_pair  # noqa: E402

MODELS = ("hertz", "ep/hertz", "ep/thornton", "ep/johnson", "ep/cavity", "thornton_ning")
LIMITS = {"frozen": {"ep/thornton": 1.00, "ep/cavity": 1.25}, "moving": {"ep/thornton": 1.03, "ep/cavity": 1.15}}
RADIUS, SHRINK = 2e-3, 0.999

DECK = """atom_style granular
atom_modify map array
boundary p p p
newton off
communicate single vel yes
units si
{processors}read_data packing.data
neighbor {skin} bin
neigh_modify delay 0{lists}
fix m1 all property/global youngsModulus peratomtype 1e8
fix m2 all property/global poissonsRatio peratomtype 0.3
{restitution}{friction}fix p1 all property/global yieldPressure peratomtype 1e6
fix p2 all property/global yieldStress peratomtype 3.6e5
fix p3 all property/global coefficientYieldRatio peratomtype 0.01
{surface}pair_style gran model {model} tangential history
pair_coeff * *
timestep {dt}
fix move all nve/sphere
compute contacts all contact/atom
compute touching all reduce sum c_contacts
thermo_style custom step atoms c_touching
thermo 100000
thermo_modify lost error norm no
run {warm}
{unload}{runs}"""


def packing(cells, spacing, jitter, speed=0.0, shear=0.0):
    """Data file of a jittered face-centred cubic packing in a periodic box: 4 cells^3 spheres.

    Random velocities to `speed` [m/s], and v_x to `shear` [m/s] as one sine wave over the height of the box.
    """
    rng = np.random.default_rng(3)
    edge = spacing * 2 * RADIUS * math.sqrt(2)
    corner = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    x = ((corner + np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])) * edge).reshape(-1, 3)
    x = (x + rng.uniform(-jitter, jitter, x.shape) * 2 * RADIUS) % (cells * edge)
    v = rng.uniform(-speed, speed, x.shape)
    v[:, 0] += shear * np.sin(2 * np.pi * x[:, 2] / (cells * edge))
    lines = ["packing", "", f"{len(x)} atoms", "1 atom types", ""]
    lines += [f"0.0 {cells * edge!r} {c}lo {c}hi" for c in "xyz"]
    lines += [
        "",
        "Atoms",
        "",
        *(f"{i + 1} 1 {2 * RADIUS} 2500.0 {p[0]!r} {p[1]!r} {p[2]!r}" for i, p in enumerate(x.tolist())),
    ]
    lines += ["", "Velocities", "", *(f"{i + 1} {p[0]!r} {p[1]!r} {p[2]!r} 0 0 0" for i, p in enumerate(v.tolist()))]
    return "\n".join([*lines, ""])


def deck(model, *, steps, chunks=1, dt="1e-13", warm=2, unload=True, restitution=True, ranks=1, skin="8e-4", lists=""):
    foreign = model == "thornton_ning"
    return DECK.format(
        model=model,
        runs=f"run {steps}\n" + f"run {steps} pre no\n" * (chunks - 1),
        dt=dt,
        skin=skin,
        lists=f" {lists}" if lists else "",
        warm=warm,
        processors="processors 2 1 1\n" if ranks == 2 else "",
        restitution=per_pair("coefficientRestitution", 0.7, 1) if restitution or not model.startswith("ep/") else "",
        friction=per_pair("coefficientFriction", 0.5, 1),
        surface=per_pair("surfaceEnergy", 0.0, 1) if foreign else "",
        unload=f"set group all diameter {2 * RADIUS * SHRINK!r}\n" if unload else "",
    )


FROZEN = {"data": (17, 1.01, 0.03), "steps": 2, "chunks": 120}
DYNAMIC = {"data": (17, 0.985, 0.002, 0.05), "steps": 100, "chunks": 3}
SHEARED = {"data": (17, 0.985, 0.002, 0.05, 0.5), "steps": 100, "chunks": 3}
THIN = {"skin": "1e-4", "lists": "every 18 check no"}
MOVING = {"dt": "2e-6", "unload": False, "warm": 50}
SCENES = {
    # spacing 1.01 and jitter 0.03: about half of the neighbours touch; loaded, then unloaded by a third
    "frozen": FROZEN | {"run": {}},
    "frozen, no restitution": FROZEN | {"run": {"restitution": False}},
    "frozen, 2 ranks": FROZEN | {"run": {"ranks": 2}},
    "moving": DYNAMIC | {"run": MOVING},
    "moving, 2 ranks": DYNAMIC | {"run": MOVING | {"ranks": 2}},
    # a thin skin, and the neighbour lists made anew every 18 steps for every model
    "moving, sheared": SHEARED | {"run": MOVING | THIN},
    "moving, sheared, 2 ranks": SHEARED | {"run": MOVING | THIN | {"ranks": 2}},
}


@dataclass
class Cost:
    """Fastest loop and pair time [ms per step], contacts at the end, and lists made anew on the way."""

    loop: float = math.inf
    pair: float = math.inf
    contacts: int = 0
    rebuilds: int = 0


def read(text, steps):
    """Cost from a log; its first run warms up and does not count."""
    loops = re.findall(r"Loop time of (\S+)", text)[1:]
    pairs = re.findall(r"Pair  time \(%\) = (\S+)", text)[1:]
    touching = re.findall(r"^ *\d+ +\d+ +(\d+) *$", text, re.MULTILINE)
    rebuilds = re.findall(r"Neighbor list builds = (\d+)", text)[1:]
    least = [min(map(float, values)) / steps * 1e3 for values in (loops, pairs)]
    return Cost(*least, int(touching[-1]) // 2, sum(map(int, rebuilds)))


def timed(folder, scene, models, repeats):
    """model -> Cost; the models take turns."""
    what = SCENES[scene]
    data, options, best = packing(*what["data"]), what["run"], {}
    for _ in range(repeats):
        for model in models:
            text = deck(model, steps=what["steps"], chunks=what["chunks"], **options)
            log = good(folder, text, files={"packing.data": data}, ranks=options.get("ranks", 1)).text
            now, old = read(log, what["steps"]), best.get(model, Cost())
            best[model] = replace(now, loop=min(now.loop, old.loop), pair=min(now.pair, old.pair))
    return best


def instructions(folder, model):
    """Instructions in the pair loop for one step of a frozen packing of 2048 spheres, by callgrind."""
    files, counts = {"packing.data": packing(8, 1.01, 0.03)}, []
    command = shutil.which("valgrind")
    script = folder / "count.sh"
    folder.mkdir(parents=True, exist_ok=True)
    script.write_text(
        f"#!/bin/sh\nexec {command} --tool=callgrind --callgrind-out-file=/dev/null "
        f"--toggle-collect='LAMMPS_NS::PairGranProxy::compute_force*' {launcher()} \"$@\"\n"
    )
    script.chmod(0o755)
    for steps in (2, 12):
        text = good(folder, deck(model, steps=steps), files=files, command=str(script), timeout=300).text
        counts.append(int(re.findall(r"Collected : (\d+)", text)[-1]))
    return (counts[1] - counts[0]) / 10


def main():
    ask = argparse.ArgumentParser(description=__doc__)
    ask.add_argument("--quick", action="store_true", help="two repeats, frozen packing only, no callgrind")
    ask.add_argument("--scenes", default=",".join(s.replace(",", ";") for s in SCENES), help="';' for ',' in a name")
    ask.add_argument("--models", default=",".join(MODELS))
    quick, models = (args := ask.parse_args()).quick, args.models.split(",")
    failed = False
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print("| scene | model | contacts | lists | loop ms/step | x hertz | pair ms/step | x hertz |")
        print("|---|---|---|---|---|---|---|---|")
        wanted = [name.replace(";", ",") for name in args.scenes.split(",")]
        for scene in wanted[: 2 if quick else None]:
            best = timed(folder, scene, models, 2 if quick else 6)
            for model in models:
                now, hertz = best[model], best["hertz"]
                loop, limit = now.loop / hertz.loop, LIMITS[scene.split(",")[0]].get(model)
                verdict = "" if limit is None else f" (limit {limit}: {'kept' if loop <= limit else 'EXCEEDED'})"
                failed |= limit is not None and loop > limit
                print(
                    f"| {scene} | {model} | {now.contacts} | {now.rebuilds} | {now.loop:.3f} | {loop:.3f}{verdict} | "
                    f"{now.pair:.3f} | {now.pair / hertz.pair:.3f} |",
                    flush=True,
                )
        if not quick and shutil.which("valgrind"):
            print("\n| model | instructions in the pair loop per step, 2048 spheres | x hertz |\n|---|---|---|")
            count = {model: instructions(folder, model) for model in models}
            for model in models:
                print(f"| {model} | {count[model]:.0f} | {count[model] / count['hertz']:.4f} |")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
