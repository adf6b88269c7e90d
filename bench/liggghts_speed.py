# SPDX-License-Identifier: GPL-2.0-or-later
"""Cost of epdem's models in LIGGGHTS, as ratios to LIGGGHTS's `hertz` with the same tangential model.

Run: .venv/bin/python bench/liggghts_speed.py [--quick]

A model name can end in a loop: ep/thornton@avx2 and @sse2 name the instruction set of epdem's pair loop, @generic
takes LIGGGHTS's loop. A name can hold a tangential model other than history: ep/thornton+ep/partial_slip. All models
run the same deck from the same positions, in turn. The shortest step of each model in processor time counts
(step_times.cpp), because other work on the machine only adds time. The moving packings are dense: their number of
contacts, a column of the table, hardly depends on the dissipation of the model. The frozen and the moving packing give
two equations for the cost of a touching pair and of a pair apart; docs/figures/contact_cost.png shows both costs.
Instruction counts (callgrind) are exactly reproducible, and they ignore the latency of divisions and roots. Every run
is stored in runs/bench, and an interrupted bench continues.

The exit code is 1 if the pair loop of one of epdem's models takes longer than the pair loop of `hertz`, or if
`ep/meyer` exceeds HARDENING.
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

import lammps_packings  # noqa: E402
import store  # noqa: E402
from dense_packings import SCENES, bed_data, deck, packing, poured  # noqa: E402
from plugin_decks import good, launcher  # noqa: E402

MODELS = (
    "hertz",
    "ep/hertz",
    "ep/thornton",
    "ep/johnson",
    "ep/cavity",
    "ep/meyer",
    "ep/thornton@avx2",
    "ep/thornton@sse2",
    "ep/thornton@generic",
    "ep/jkr",
    "ep/thornton_ning",
    "ep/thornton+ep/partial_slip",
    "ep/thornton+ep/partial_slip_2",
    "ep/cavity+ep/partial_slip",
    "ep/cavity+ep/partial_slip_2",
    "thornton_ning",
    *(lammps_packings.MODELS if lammps_packings.available() else ()),
)
# largest pair time over the pair time of hertz
LIMITS = {
    "ep/hertz": 0.45,
    "ep/thornton": 0.45,
    "ep/johnson": 0.45,
    "ep/cavity": 0.60,
    "ep/jkr": 1.25,
    "ep/thornton_ning": 1.4,
}
LIMITS |= {"ep/thornton@avx2": 0.45, "ep/thornton@sse2": 0.75}
HARDENING = {"below their largest overlap": 1.15, "all at their largest overlap": 1.4}  # ep/meyer over ep/thornton
WHOLE_STEP = 0.5  # largest time of a whole step of ep/thornton over a whole step of hertz
CLOCK = (ROOT / "bench" / "step_times.cpp").read_text() + (ROOT / "bench" / "lammps_packings.py").read_text()
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
    made = store.FOLDER / "libtimes.so"
    made.parent.mkdir(parents=True, exist_ok=True)
    mpi = subprocess.run(["mpicxx", "--showme:compile"], capture_output=True, text=True, check=True).stdout.split()
    styles = ROOT / "cpp_contact" / "liggghts" / "styles"
    line = ["g++", "-std=c++17", "-O2", "-fPIC", "-shared", "-DOMPI_SKIP_MPICXX", f"-I{styles}"]
    line += ["-isystem", "/usr/include/liggghts", *mpi, str(ROOT / "bench" / "step_times.cpp"), "-o", str(made)]
    subprocess.run(line, check=True)
    return str(made)


def start(folder, name, text, more=None, **options):
    """A run of the model `name`, MODEL or MODEL@LOOP."""
    loop = name.partition("@")[2] or ("" if "ep/" in name else "generic")  # LIGGGHTS's models with all that is its own
    env = {"EPDEM_LOOP": loop} if loop == "generic" else {"EPDEM_SIMD": loop} if loop else {}
    return good(folder, text, env=env | (more or {}), **options).text


def data_of(scene):
    """The data file of a scene; the data file of the settled bed is the end of a run."""
    if SCENES[scene]["data"]:
        return packing(*SCENES[scene]["data"])

    def pour():
        with tempfile.TemporaryDirectory() as name:
            good(Path(name), poured(), timeout=3600)
            return bed_data((Path(name) / "bed.txt").read_text())

    return store.once("settled bed", poured(), pour)


def measured(folder, scene, name, data, beside=""):
    """Cost of one run."""
    what = SCENES[scene]
    if name in lammps_packings.MODELS:
        loop, pair, contacts, neighbours = lammps_packings.timed(folder, name, data, what)
        return Cost(loop, pair, contacts, 0, neighbours)
    model, options = name.partition("@")[0], what["run"]
    words = beside if model.startswith("ep/") or not beside.endswith(" on") else ""
    times = folder / "times"
    times.unlink(missing_ok=True)
    text = start(
        folder,
        name,
        deck(model, steps=what["steps"], words=words, **options),
        files={"packing.data": data},
        ranks=options.get("ranks", 1),
        preload=stopwatch(),
        more={"EPDEM_TIMES": str(times)},
    )
    return read(text, times.read_text())


def timed(folder, scene, models, repeats, beside=""):
    """name -> Cost; the models take turns. `beside`: models and settings after the tangential one."""
    data, best = data_of(scene), {}
    for repeat in range(repeats):
        for name in models:
            if name in lammps_packings.MODELS and scene not in ("frozen", "moving"):
                continue
            key = re.sub(r"\W+", "_", f"{scene} {name} {beside} {repeat}")
            kept = store.once(
                key, (SCENES[scene], name, beside, CLOCK), lambda n=name: vars(measured(folder, scene, n, data, beside))
            )
            now, old = Cost(**kept), best.get(name, Cost())
            best[name] = replace(now, loop=min(now.loop, old.loop), pair=min(now.pair, old.pair))
    return best


def instructions(folder, model, grow=False):
    """Instructions in the pair loop for one step of a frozen packing of 2048 spheres, by callgrind.

    grow: all contacts are at their largest overlap; else all contacts are below it.
    """
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
            folder,
            model,
            deck(model.partition("@")[0], steps=steps, unload=not grow),
            files=files,
            command=str(script),
            timeout=300,
        )
        counts.append(int(re.findall(r"Collected : (\d+)", text)[-1]))
    return (counts[1] - counts[0]) / 10


def table_of_scenes(folder, scenes, models, repeats):
    """Prints one row per scene and model; (scene -> name -> Cost, rows of the common table)."""
    print("| scene | model | contacts | lists | loop ms/step | x hertz | pair ms/step | x hertz |")
    print("|---|---|---|---|---|---|---|---|")
    costs, rows = {}, []
    for scene in scenes:
        best = costs[scene] = timed(folder, scene, models, repeats)
        hertz = best["hertz"]
        for name, now in best.items():
            limit, ratio = LIMITS.get(name), now.pair / hertz.pair
            if name.startswith("ep/"):
                rows.append((f"pairs, {scene}: {name}", ratio, limit))
            if name == "ep/thornton":
                rows.append((f"whole step, {scene}: {name}", now.loop / hertz.loop, WHOLE_STEP))
            verdict = "" if limit is None else f" (limit {limit}: {'kept' if ratio <= limit else 'missed'})"
            loop = f"{now.loop:.3f} | {now.loop / hertz.loop:.3f}"
            pair = f"{now.pair:.3f} | {ratio:.3f}{verdict}"
            print(f"| {scene} | {name} | {now.contacts} | {now.rebuilds} | {loop} | {pair} |", flush=True)
    return costs, rows


def table_of_pairs(costs):
    """ns of a touching pair and of a pair apart, from the two packings of one type on one rank."""
    print("\n| model | ns per touching pair | ns per pair that does not touch | x hertz, touching |\n|---|---|---|---|")
    times = {}
    for name in costs["frozen"]:
        some = [costs[scene][name] for scene in ("frozen", "moving")]
        pairs = np.array([[c.contacts, c.neighbours - c.contacts] for c in some], float)
        times[name] = np.linalg.solve(pairs, np.array([c.pair for c in some]) * 1e6)
        if times[name][1] < 0:  # a contact costs less where few touch: its mean in the moving packing, and no other
            times[name] = np.array([some[1].pair * 1e6 / some[1].contacts, np.nan])
    for name, (touching, apart) in times.items():
        print(f"| {name} | {touching:.1f} | {apart:.1f} | {touching / times['hertz'][0]:.2f} |")
    return times


def figure(times):
    """docs/figures/contact_cost.png: both costs of each model as points, ours in colour."""
    from epdem.report.chart import GREY, Axis, Chart, Panel, Series, save

    names = [name for name in times if "@" not in name]
    series = []
    for k, (what, marker) in enumerate((("touches", 0), ("apart", 4))):
        for colour, whose in ((0, "our models"), (GREY, "others")):
            at = [n for n, name in enumerate(names) if name.startswith("ep/") is (colour == 0)]
            cost, places = [times[names[n]][k] for n in at], [len(names) - n for n in at]
            series.append(Series(f"{what}, {whose}", cost, places, colour, None, marker))
    rows = Axis("", ticks=dict(zip(range(len(names), 0, -1), names, strict=True)))
    panel = Panel(Axis("time of a pair and step on one core", "ns", log=True), rows, series)
    save(Chart("contact_cost", "Cost of a contact", "ns of each model", [panel]), ROOT / "docs" / "figures", data=False)


def table_beside(folder, repeats):
    """Pair time of ep/thornton with other models, over hertz with these models and over ep/thornton alone; rows."""
    print("\n| moving, with | hertz pair ms/step | ep/thornton pair ms/step | x hertz | x ep/thornton alone |")
    print("|---|---|---|---|---|")
    alone, rows = None, []
    for words in ("", *BESIDE):
        best = timed(folder, "moving", ("hertz", "ep/thornton"), repeats, words)
        hertz, ours = best["hertz"].pair, best["ep/thornton"].pair
        alone = alone or ours
        if words:
            rows.append((f"pairs, moving: ep/thornton with {words}, over ep/thornton alone", ours / alone, 1.15))
        print(
            f"| {words or 'nothing'} | {hertz:.3f} | {ours:.3f} | {ours / hertz:.3f} | {ours / alone:.3f} |", flush=True
        )
    return rows


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--quick", action="store_true", help="two repeats, three scenes, no callgrind")
    ask.add_argument("--scenes", default=",".join(s.replace(",", ";") for s in SCENES), help="';' for ',' in a name")
    ask.add_argument("--models", default=",".join(MODELS))
    args = ask.parse_args()
    hardening = {}
    models, repeats = args.models.split(","), 2 if args.quick else 6
    wanted = [name.replace(";", ",") for name in args.scenes.split(",")]
    if args.quick:
        wanted = [s for s in wanted if s in ("frozen", "moving", "moving, two materials", "settled bed")]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        costs, rows = table_of_scenes(folder, wanted, models, repeats)
        if {"frozen", "moving"} <= costs.keys():
            figure(table_of_pairs(costs))
        rows += table_beside(folder, repeats)
        store.report("liggghts_speed", rows)
        if not args.quick and shutil.which("valgrind"):
            print("\n| model | instructions in the pair loop per step, 2048 spheres | x hertz |\n|---|---|---|")
            ours = [m for m in models if m not in lammps_packings.MODELS]
            count = {model: instructions(folder, model) for model in ours}  # valgrind knows no AVX-512
            for model in ours:
                print(f"| {model} | {count[model]:.0f} | {count[model] / count['hertz']:.4f} |")
            if {"ep/meyer", "ep/thornton"} <= count.keys():
                grown = [instructions(folder, model, grow=True) for model in ("ep/meyer", "ep/thornton")]
                ratios = (count["ep/meyer"] / count["ep/thornton"], grown[0] / grown[1])
                hardening = dict(zip(HARDENING, ratios, strict=True))
                print("\n| contacts | instructions of ep/meyer over ep/thornton | limit |\n|---|---|---|")
                for what, ratio in hardening.items():
                    print(f"| {what} | {ratio:.3f} | {HARDENING[what]} |")
    slow = any(ratio > 1.0 for what, ratio, _ in rows if "@" not in what and "alone" not in what)
    return int(slow or any(ratio > HARDENING[what] for what, ratio in hardening.items()))


if __name__ == "__main__":
    sys.exit(main())
