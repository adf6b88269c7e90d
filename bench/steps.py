# SPDX-License-Identifier: GPL-2.0-or-later
"""ns per step of every law, in the C interface's batch and in plain loops, and the choices behind `cavity`.

Run: .venv/bin/python bench/steps.py [--json FILE]

Every number is the fastest of many short passes: on a shared machine the noise only adds.
"""

import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from epdem.base.declarations import declarations
from epdem.laws.library import Law

ROOT = Path(__file__).resolve().parent.parent
E_STAR, R_STAR, MASS = 1.14e11, 0.01, 0.033
STRENGTH = {"yield_pressure": 2.8e9, "yield_stress": 1e9}
HARDENING = {"meyer": {"hardening_exponent": 0.25}}


def batch(name: str, passes: int = 12) -> float:
    """ns per step of 256 impacts in one call of the C interface, no samples kept."""
    strength = declarations()[name].strength
    law = Law(name, E_star=E_STAR, **({strength: STRENGTH[strength]} if strength else {}), **HARDENING.get(name, {}))
    numbers = {"R_star": R_STAR, "m_star": MASS, "speed": np.geomspace(0.1, 100, 256), "time_step": 2e-7, "gap": 1e-9}
    best = np.inf
    for _ in range(passes):
        start = time.perf_counter()
        out = law.impacts(**numbers, steps=100_000)
        best = min(best, (time.perf_counter() - start) / out["steps"].sum() * 1e9)
    return float(best)


def compiled() -> list[list[str]]:
    """The lines of bench/steps.cpp, built as the C library is."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "steps"
        include = ROOT / "cpp_contact" / "include"
        command = ["g++", "-std=c++17", "-O3", f"-I{include}", ROOT / "bench/steps.cpp", "-o", program]
        subprocess.run(command, check=True)
        output = subprocess.run(program, capture_output=True, text=True).stdout  # its exit code means nothing
        return [line.split() for line in output.splitlines()]


def main() -> None:
    """Print two tables; with --json also store them."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--json", type=Path)
    arguments = options.parse_args()
    lines, found = compiled(), {"laws": {}, "cavity": {}, "segment": {}}
    print("ns per step       prescribed   one impact   C interface, 256 impacts")
    for kind, name, *values in lines:
        numbers = [float(v) for v in values]
        if kind == "law":
            keys = ("prescribed", "impact", "batch")
            found["laws"][name] = dict(zip(keys, [*numbers, batch(name)], strict=True))
            print(
                f"  {name:<14} {found['laws'][name]['prescribed']:11.1f} {numbers[1]:12.1f} "
                f"{found['laws'][name]['batch']:12.1f}"
            )
        elif kind == "choice":
            found["cavity"][name] = numbers[0]
        else:
            found["segment"][name] = dict(zip(("many", "chain", "error"), numbers, strict=True))
    print("\n`cavity`, prescribed: the backbone's values at alpha_max kept or computed again, the segment function")
    for name, value in found["cavity"].items():
        print(f"  {name:<24} {value:6.1f} ns per step")
    print("\nsegment function: ns per value, ns when each waits for the one before, largest relative error")
    for name, row in found["segment"].items():
        print(f"  {name:<12} {row['many']:6.1f} {row['chain']:6.1f}   {row['error']:.0e}")
    if arguments.json:
        arguments.json.write_text(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
