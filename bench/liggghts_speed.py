# SPDX-License-Identifier: GPL-2.0-or-later
"""What epdem's models cost in LIGGGHTS, as ratios to its own `hertz` with the same tangential model.

Run: .venv/bin/python bench/liggghts_speed.py [--quick]

A model name may carry a loop: ep/thornton@avx2, @sse2 (instruction sets of our pair loop) or @generic (LIGGGHTS's loop
with our model), and before it another tangential model than history: ep/thornton+ep/partial_slip. Every model sees the
same deck and starts from the same positions; the models take turns, and each keeps its shortest step, timed inside the
process (step_times.cpp), because on a shared machine the noise only adds. The moving packings are dense, so that they
keep their contacts whatever a model dissipates: their number stands in the table. From the frozen and the moving
packing, two equations: what a pair that touches costs, and one that does not.
Instruction counts (callgrind) repeat exactly, but know nothing of divisions and roots that wait for each other.
"""

import argparse
import math
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "engines"))

from dense_packings import SCENES, deck, packing  # noqa: E402
from plugin_decks import good, launcher  # noqa: E402

MODELS = (
    "hertz",
    "ep/hertz",
    "ep/thornton",
    "ep/johnson",
    "ep/cavity",
    "ep/thornton@avx2",
    "ep/thornton@sse2",
    "ep/thornton@generic",
    "ep/thornton+ep/partial_slip",
    "ep/thornton+ep/partial_slip_2",
    "ep/cavity+ep/partial_slip",
    "ep/cavity+ep/partial_slip_2",
    "thornton_ning",
)
LIMITS = {"ep/hertz": 0.45, "ep/thornton": 0.45, "ep/johnson": 0.45, "ep/cavity": 0.60}  # pair time over that of hertz
BESIDE = (
    "rolling_friction cdt",
    "rolling_friction epsd2",
    "cohesion sjkr",
    "cohesion sjkr2",
    "viscous on",
    "computePlasticWork on",
)


@dataclass
class Cost:
    """Shortest step and pair evaluation [ms], contacts at the end, lists made anew on the way, pairs in them."""

    loop: float = math.inf
    pair: float = math.inf
    contacts: int = 0
    rebuilds: int = 0
    neighbours: int = 0


def read(text, times):
    """Cost from a log, whose first run warms up, and from what step_times.cpp wrote."""
    pair, step = map(float, times.split())
    touching = re.findall(r"^ *\d+ +\d+ +(\d+) *$", text, re.MULTILINE)
    rebuilds = re.findall(r"Neighbor list builds = (\d+)", text)[1:]
    neighbours = re.findall(r"Total # of neighbors = (\d+)", text)
    return Cost(step, pair, int(touching[-1]) // 2, sum(map(int, rebuilds)), int(neighbours[-1]))


@cache
def stopwatch():
    """step_times.cpp as a library to preload."""
    made = Path(tempfile.mkdtemp(prefix="epdem_times_")) / "libtimes.so"
    mpi = subprocess.run(["mpicxx", "--showme:compile"], capture_output=True, text=True, check=True).stdout.split()
    styles = ROOT / "cpp_contact" / "liggghts" / "styles"
    line = ["g++", "-std=c++17", "-O2", "-fPIC", "-shared", "-DOMPI_SKIP_MPICXX", f"-I{styles}"]
    line += ["-isystem", "/usr/include/liggghts", *mpi, str(ROOT / "bench" / "step_times.cpp"), "-o", str(made)]
    subprocess.run(line, check=True)
    return str(made)


def start(folder, name, text, more=None, **options):
    """A run of the model `name`, MODEL or MODEL@LOOP."""
    loop = name.partition("@")[2]
    env = {"EPDEM_LOOP": loop} if loop == "generic" else {"EPDEM_SIMD": loop} if loop else {}
    return good(folder, text, env=env | (more or {}), **options).text


def timed(folder, scene, models, repeats, beside=""):
    """name -> Cost; the models take turns. `beside`: models and settings after the tangential one."""
    what = SCENES[scene]
    data, options, best = packing(*what["data"]), what["run"], {}
    for _ in range(repeats):
        for name in models:
            model = name.partition("@")[0]
            words = beside if model.startswith("ep/") or not beside.endswith(" on") else ""
            text = deck(model, steps=what["steps"], words=words, **options)
            times = folder / "times"
            times.unlink(missing_ok=True)
            text = start(
                folder,
                name,
                text,
                files={"packing.data": data},
                ranks=options.get("ranks", 1),
                preload=stopwatch(),
                more={"EPDEM_TIMES": str(times)},
            )
            now, old = read(text, times.read_text()), best.get(name, Cost())
            best[name] = replace(now, loop=min(now.loop, old.loop), pair=min(now.pair, old.pair))
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
        text = start(
            folder, model, deck(model.partition("@")[0], steps=steps), files=files, command=str(script), timeout=300
        )
        counts.append(int(re.findall(r"Collected : (\d+)", text)[-1]))
    return (counts[1] - counts[0]) / 10


def table_of_scenes(folder, scenes, models, repeats):
    """Prints one row per scene and model; scene -> name -> Cost, and whether a limit was exceeded."""
    print("| scene | model | contacts | lists | loop ms/step | x hertz | pair ms/step | x hertz |")
    print("|---|---|---|---|---|---|---|---|")
    costs, failed = {}, False
    for scene in scenes:
        best = costs[scene] = timed(folder, scene, models, repeats)
        hertz = best["hertz"]
        for name in models:
            now, limit = best[name], LIMITS.get(name)
            ratio = now.pair / hertz.pair
            verdict = "" if limit is None else f" (limit {limit}: {'kept' if ratio <= limit else 'EXCEEDED'})"
            failed |= limit is not None and ratio > limit
            loop = f"{now.loop:.3f} | {now.loop / hertz.loop:.3f}"
            pair = f"{now.pair:.3f} | {ratio:.3f}{verdict}"
            print(f"| {scene} | {name} | {now.contacts} | {now.rebuilds} | {loop} | {pair} |", flush=True)
    return costs, failed


def table_of_pairs(costs, models):
    """ns of a pair that touches and of one that does not, from the two packings of one type on one rank."""
    print("\n| model | ns per touching pair | ns per pair that does not touch | x hertz, touching |\n|---|---|---|---|")
    rows, times = {}, {}
    for name in models:
        some = [costs[scene][name] for scene in ("frozen", "moving")]
        rows[name] = [[c.contacts, c.neighbours - c.contacts] for c in some]
        times[name] = np.linalg.solve(np.array(rows[name], float), np.array([c.pair for c in some]) * 1e6)
    for name, (touching, apart) in times.items():
        print(f"| {name} | {touching:.1f} | {apart:.1f} | {touching / times['hertz'][0]:.2f} |")


def table_beside(folder, repeats):
    """Pair time of ep/thornton with other models beside it, over hertz with the same and over itself without."""
    print("\n| moving, with | hertz pair ms/step | ep/thornton pair ms/step | x hertz | x ep/thornton alone |")
    print("|---|---|---|---|---|")
    alone = None
    for words in ("", *BESIDE):
        best = timed(folder, "moving", ("hertz", "ep/thornton"), repeats, words)
        hertz, ours = best["hertz"].pair, best["ep/thornton"].pair
        alone = alone or ours
        print(
            f"| {words or 'nothing'} | {hertz:.3f} | {ours:.3f} | {ours / hertz:.3f} | {ours / alone:.3f} |", flush=True
        )


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--quick", action="store_true", help="two repeats, three scenes, no callgrind")
    ask.add_argument("--scenes", default=",".join(s.replace(",", ";") for s in SCENES), help="';' for ',' in a name")
    ask.add_argument("--models", default=",".join(MODELS))
    args = ask.parse_args()
    models, repeats = args.models.split(","), 2 if args.quick else 6
    wanted = [name.replace(";", ",") for name in args.scenes.split(",")]
    if args.quick:
        wanted = [s for s in wanted if s in ("frozen", "moving", "moving, two materials")]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        costs, failed = table_of_scenes(folder, wanted, models, repeats)
        if {"frozen", "moving"} <= costs.keys():
            table_of_pairs(costs, models)
        table_beside(folder, repeats)
        if not args.quick and shutil.which("valgrind"):
            print("\n| model | instructions in the pair loop per step, 2048 spheres | x hertz |\n|---|---|---|")
            count = {model: instructions(folder, model) for model in models}  # valgrind knows no AVX-512
            for model in models:
                print(f"| {model} | {count[model]:.0f} | {count[model] / count['hertz']:.4f} |")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
