# SPDX-License-Identifier: GPL-2.0-or-later
"""What epdem's models cost in LIGGGHTS, as ratios to its own `hertz` with the same tangential model.

Run: .venv/bin/python bench/liggghts_speed.py [--quick]

Every model sees the same deck and the same positions; the models take turns, and each keeps the fastest of many runs
of two steps, because on a shared machine the noise only adds. Instruction counts (callgrind)
repeat exactly and are the number to watch.
"""

import argparse
import re
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "engines"))

from plugin_decks import good, launcher, per_pair  # noqa: E402

MODELS = ("hertz", "ep/hertz", "ep/thornton", "ep/johnson", "ep/cavity", "thornton_ning")
LIMITS = {("frozen", "ep/thornton"): 1.00, ("frozen", "ep/cavity"): 1.25}
RADIUS, SHRINK = 2e-3, 0.999

DECK = """atom_style granular
atom_modify map array
boundary p p p
newton off
communicate single vel yes
units si
{processors}read_data packing.data
neighbor 8e-4 bin
neigh_modify delay 0
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
thermo_style custom step atoms ke
thermo 100000
thermo_modify lost error norm no
run {warm}
{unload}{runs}"""


def packing(cells, spacing, jitter, speed=0.0):
    """Data file of a jittered face-centred cubic packing in a periodic box: 4 cells^3 spheres."""
    rng = np.random.default_rng(3)
    edge = spacing * 2 * RADIUS * np.sqrt(2)
    corner = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    x = ((corner + np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])) * edge).reshape(-1, 3)
    x = (x + rng.uniform(-jitter, jitter, x.shape) * 2 * RADIUS) % (cells * edge)
    v = rng.uniform(-speed, speed, x.shape)
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


def deck(model, *, steps, chunks=1, dt="1e-13", warm=2, unload=True, restitution=True, ranks=1):
    foreign = model == "thornton_ning"
    return DECK.format(
        model=model,
        runs=f"run {steps}\n" + f"run {steps} pre no\n" * (chunks - 1),
        dt=dt,
        warm=warm,
        processors="processors 2 1 1\n" if ranks == 2 else "",
        restitution=per_pair("coefficientRestitution", 0.7, 1) if restitution or not model.startswith("ep/") else "",
        friction=per_pair("coefficientFriction", 0.5, 1),
        surface=per_pair("surfaceEnergy", 0.0, 1) if foreign else "",
        unload=f"set group all diameter {2 * RADIUS * SHRINK!r}\n" if unload else "",
    )


SCENES = {
    # spacing 1.01 and jitter 0.03: about half of the neighbours touch; loaded, then unloaded by a third
    "frozen": {"data": (17, 1.01, 0.03), "run": {}},
    "frozen, no restitution": {"data": (17, 1.01, 0.03), "run": {"restitution": False}},
    "frozen, 2 ranks": {"data": (17, 1.01, 0.03), "run": {"ranks": 2}},
    "dynamic": {"data": (17, 0.999, 0.002, 0.05), "run": {"dt": "2e-6", "unload": False, "warm": 50}},
}


def seconds(text):
    """Least loop and pair time of the runs in a log after the first, which warms up [s]."""
    loops = re.findall(r"Loop time of (\S+)", text)[1:]
    pairs = re.findall(r"Pair  time \(%\) = (\S+)", text)[1:]
    return np.array([min(map(float, loops)), min(map(float, pairs))])


def timed(folder, scene, models, repeats, steps=2, chunks=120):
    """model -> fastest (loop, pair) in ms per step; the models take turns."""
    data = packing(*SCENES[scene]["data"])
    options = SCENES[scene]["run"]
    best = {}
    for _ in range(repeats):
        for model in models:
            result = good(
                folder,
                deck(model, steps=steps, chunks=chunks, **options),
                files={"packing.data": data},
                ranks=options.get("ranks", 1),
            )
            now = seconds(result.text) / steps * 1e3
            best[model] = np.minimum(best.get(model, now), now)
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
    ask.add_argument("--models", default=",".join(MODELS))
    quick, models = (args := ask.parse_args()).quick, args.models.split(",")
    failed = False
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        print("| scene | model | loop ms/step | x hertz | pair ms/step | x hertz |\n|---|---|---|---|---|---|")
        for scene in list(SCENES)[: 2 if quick else None]:
            best = timed(folder, scene, models, 2 if quick else 6)
            for model in models:
                loop, pair = best[model] / best["hertz"]
                limit = LIMITS.get((scene, model))
                verdict = "" if limit is None else f" (limit {limit}: {'kept' if loop <= limit else 'EXCEEDED'})"
                failed |= limit is not None and loop > limit
                print(
                    f"| {scene} | {model} | {best[model][0]:.3f} | {loop:.3f}{verdict} | {best[model][1]:.3f} | "
                    f"{pair:.3f} |",
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
