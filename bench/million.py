# SPDX-License-Identifier: GPL-2.0-or-later
"""A dense bed of 1 million plastic spheres: seconds per step, memory per sphere, ratio to built-in hertz, 1 to 2 ranks.

    .venv/bin/python bench/million.py [--cells 63] [--steps 500] [--steps-alone 100] [--json]

A periodic face-centred packing, 4 cells^3 spheres with 12 contacts each, pressed by 0.2 % of the diameter and stirred
at 0.1 m/s, so that its contacts load and unload. Both models have the same tangential springs and friction. The runs
take turns; the four of them need about a quarter of an hour on two cores. The floor is the time in which the machine
copies as many bytes as a step must read and write.
"""

import argparse
import json
import os
import re
import tempfile
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from unittest.mock import patch

import numpy as np

from epdem.engines.liggghts import launcher

DIAMETER, DENSITY, PRESS = 2e-3, 2500.0, 2e-3
# Bytes that a step reads and writes per sphere at least: 6 contacts (history 80, list and flag 8, atoms 37); numbers of
# the first half step (17 read, 9 written), of the second (14, 6), of forces set to zero (6) and of distances (6).
TRAFFIC = 6 * 125 + 58 * 8
DECK = """units si
atom_style granular
boundary p p p
newton off
communicate single vel yes
lattice fcc {constant!r}
region box block 0 {edge!r} 0 {edge!r} 0 {edge!r}
create_box 1 box
create_atoms 1 box
set group all diameter {diameter!r} density {density!r}
{stir}
velocity all set v_vx v_vy v_vz
neighbor {skin!r} bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 1e8
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientFriction peratomtypepair 1 0.3
{own}
pair_style gran model {model} tangential history
pair_coeff * *
fix motion all nve/sphere
timestep 2e-6
thermo_style custom step atoms ke
thermo {every}
run {steps}
"""
MODELS = {
    "ep/thornton": "fix m4 all property/global yieldPressure peratomtype 1e6",
    "hertz": "fix m4 all property/global coefficientRestitution peratomtypepair 1 0.9",
}


def deck(model: str, cells: int, steps: int) -> str:
    """The packing with one model; velocities of 0.1 m/s in random directions."""
    constant = 2**0.5 * DIAMETER * (1.0 - PRESS)
    # `velocity create` knows temperatures only; uniform numbers per atom do the same here
    seeds = zip("xyz", (48611, 48619, 48623), strict=True)
    stir = "\n".join(f"variable v{a} atom random(-0.1,0.1,{seed})" for a, seed in seeds)
    return DECK.format(
        stir=stir,
        constant=constant,
        edge=cells * constant,
        diameter=DIAMETER,
        density=DENSITY,
        skin=0.1 * DIAMETER,
        own=MODELS[model],
        model=model,
        steps=steps,
        every=max(1, steps // 10),
    )


def peak_memory(pids: list[int]) -> int:
    """Sum of the largest resident sets so far [bytes]."""
    total = 0
    for pid in pids:
        try:
            found = re.search(r"VmHWM:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text())
            total += 1024 * int(found.group(1)) if found else 0
        except OSError:
            continue
    return total


def engines(folder: Path) -> list[int]:
    """Processes of LIGGGHTS that work in `folder`."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                name = (entry / "comm").read_text().strip()
                if name.startswith("epdem-liggghts"[:15]) and (entry / "cwd").readlink() == folder:
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


def measure(model: str, ranks: int, cells: int, steps: int, folder: Path) -> dict:
    """One run: seconds per step in the loop, peak memory."""
    (folder / "in.million").write_text(deck(model, cells, steps))
    memory, done = [0], threading.Event()

    def watch() -> None:
        while not done.wait(0.5):
            memory[0] = max(memory[0], peak_memory(engines(folder.resolve())))

    thread = threading.Thread(target=watch, daemon=True)
    thread.start()
    try:
        with patch.dict(os.environ, {} if model.startswith("ep/") else {"EPDEM_LOOP": "generic"}):
            wall = launcher.run("in.million", folder, ranks=ranks)
    finally:
        done.set()
        thread.join()
    text = (folder / launcher.OUT).read_text(errors="replace")
    loop = re.search(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms", text)
    if loop is None:
        raise SystemExit(f"{model}, {ranks} ranks: LIGGGHTS failed: {text[-500:]}")
    atoms, taken = int(loop.group(3)), int(loop.group(2))
    return {
        "model": model,
        "ranks": ranks,
        "spheres": atoms,
        "steps": taken,
        "seconds_per_step": float(loop.group(1)) / taken,
        "bytes_per_sphere": memory[0] / atoms,
        "wall_seconds": wall,
    }


def copies(size: int) -> float:
    """Bytes per second that are read and written by copies of `size` bytes."""
    one, other = np.ones(size // 8), np.zeros(size // 8)
    start = time.perf_counter()
    for _ in range(10):
        np.copyto(other, one)
    return 20 * size / (time.perf_counter() - start)


def bandwidth(processes: int) -> float:
    """Bytes per second that so many processes copy at the same time; the best of three tries."""
    with ProcessPoolExecutor(processes) as pool:
        return max(sum(pool.map(copies, [2**28] * processes)) for _ in range(3))


def line(r: dict) -> str:
    """One run as a line of text."""
    return (
        f"{r['model']:12s} {r['ranks']} rank(s): {r['spheres']} spheres, {r['steps']} steps, "
        f"{r['seconds_per_step']:.4f} s per step, {r['bytes_per_sphere']:.0f} bytes per sphere"
    )


def main() -> None:
    """Run every model on 1 and 2 ranks and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=63, help="unit cells along an edge; 63: 1 000 188 spheres")
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--steps-alone", type=int, default=100, help="steps of the runs on one rank")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory(prefix="epdem_million_") as folder:
        for ranks in (2, 1):
            for model in MODELS:
                steps = options.steps if ranks > 1 else options.steps_alone
                rows.append(measure(model, ranks, options.cells, steps, Path(folder)))
                if not options.json:
                    print(line(rows[-1]), flush=True)
    seconds = {(r["model"], r["ranks"]): r["seconds_per_step"] for r in rows}
    ratios = {f"ratio to hertz, {n} rank(s)": seconds["ep/thornton", n] / seconds["hertz", n] for n in (1, 2)}
    for n in (1, 2):
        ratios[f"ep/thornton to floor, {n} rank(s)"] = (
            seconds["ep/thornton", n] * bandwidth(n) / (TRAFFIC * rows[0]["spheres"])
        )
    ratios["speed-up from 1 to 2 ranks"] = seconds["ep/thornton", 1] / seconds["ep/thornton", 2]
    if options.json:
        print(json.dumps({"runs": rows} | ratios, indent=1))
    else:
        print(", ".join(f"{name}: {value:.2f}" for name, value in ratios.items()))


if __name__ == "__main__":
    main()
