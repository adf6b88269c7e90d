# SPDX-License-Identifier: GPL-2.0-or-later
"""Time of a dense bed in LAMMPS: `pair_style ep` beside LAMMPS's own contact models.

    .venv/bin/python bench/lammps_speed.py [--steps 500] [--rounds 3] [--simd avx2]

19,652 spheres with 12 contacts each in a periodic box, sticking and yielding, on one core. The models take turns, the
shortest pair time and loop time of each count, as LAMMPS prints them. Exit code 1 if a ratio to `granular` is above its
limit.
"""

import argparse
import itertools
import math
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from epdem.engines.lammps import launcher

RADIUS, CELLS = 2e-3, 17  # [m]; cells of the face-centred lattice along an edge
EDGE = 2 * RADIUS * math.sqrt(2) * 0.998 * CELLS  # of the box [m]: neighbours overlap by 0.2 % of their diameter
PAIR_LIMIT, WHOLE_LIMIT = 0.30, 0.40
OWN = "granular hertz/material ... mindlin ... tsuji"
OURS = "ep thornton ... tangential history"
MODELS = {
    OWN: "pair_style granular\npair_coeff * * hertz/material 1e8 0.9 0.3 tangential mindlin NULL 0.0 0.3 damping tsuji",
    "gran/hertz/history": "pair_style gran/hertz/history 7.3e7 NULL 50.0 NULL 0.3 0\npair_coeff * *",
    OURS: "pair_style ep\npair_coeff * * thornton 1e8 0.3 4e5 tangential history 0.3",
}
DECK = """units si
atom_style sphere
newton off
comm_modify vel yes
boundary p p p
read_data bed.data
{model}
neighbor 0.0008 bin
neigh_modify delay 0
fix motion all nve/sphere
timestep 1e-6
thermo {steps}
run {steps}
"""


def data() -> str:
    """The bed as a data file."""
    rng, a = random.Random(7), EDGE / CELLS
    corners = [(0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)]
    cells = itertools.product(itertools.product(range(CELLS), repeat=3), corners)
    places = [[((i + c) * a + rng.uniform(-3e-6, 3e-6)) % EDGE for i, c in zip(*cell, strict=True)] for cell in cells]
    lines = ["bed", "", f"{len(places)} atoms", "1 atom types", *(f"0 {EDGE!r} {x}lo {x}hi" for x in "xyz")]
    lines += ["", "Atoms # sphere", ""]
    lines += [f"{n} 1 {2 * RADIUS} 2500 {x!r} {y!r} {z!r}" for n, (x, y, z) in enumerate(places, 1)]
    lines += ["", "Velocities", ""]
    for n in range(1, len(places) + 1):
        lines.append(f"{n} {' '.join(str(rng.uniform(-0.05, 0.05)) for _ in range(3))} 0 0 0")
    return "\n".join([*lines, ""])


def times(model: str, steps: int, folder: Path, simd: str) -> tuple[float, float]:
    """(pair time, loop time) of a run [s]."""
    (folder / "in.bed").write_text(DECK.format(model=MODELS[model], steps=steps))
    env = launcher.environment() | ({"EPDEM_SIMD": simd} if simd else {})
    done = subprocess.run(
        [str(launcher.program()), "-in", "in.bed", "-log", "none"],
        cwd=folder,
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    loop = re.search(r"^Loop time of (\S+)", done.stdout, re.MULTILINE)
    pair = re.search(r"^Pair +\| \S+ +\| (\S+)", done.stdout, re.MULTILINE)
    if done.returncode or not (loop and pair):
        sys.exit(f"{model}: {done.stdout[-800:]}")
    return float(pair[1]), float(loop[1])


def main() -> int:
    """0 if both ratios are within their limits."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--simd", default="", help="sse2, avx2 or avx512; without: the widest")
    given = parser.parse_args()
    if reason := launcher.missing():
        sys.exit(reason)
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in MODELS}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "bed.data").write_text(data())
        for _, name in itertools.product(range(given.rounds), MODELS):
            found[name].append(times(name, given.steps, folder, given.simd))
    best = {name: [min(column) for column in zip(*rows, strict=True)] for name, rows in found.items()}
    print("| pair style | pair time [s] | ratio | whole run [s] | ratio |\n|---|---|---|---|---|")
    for name, (pair, whole) in best.items():
        shares = pair / best[OWN][0], whole / best[OWN][1]
        print(f"| `{name}` | {pair:.2f} | {shares[0]:.2f} | {whole:.2f} | {shares[1]:.2f} |")
    return int(best[OURS][0] > PAIR_LIMIT * best[OWN][0] or best[OURS][1] > WHOLE_LIMIT * best[OWN][1])


if __name__ == "__main__":
    sys.exit(main())
