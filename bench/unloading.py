# SPDX-License-Identifier: GPL-2.0-or-later
"""Make data/compaction/unloading.csv: finite elements of lattices that are pressed, held and released; minutes.

.venv/bin/python bench/unloading.py > data/compaction/unloading.csv
"""

import io
import subprocess
import tempfile
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).with_name("finite_elements.cpp")
SHARES = (0.90, 0.75, 0.50, 0.25, 0.10, 0.02)  # of the held force
CASES = [
    ("fcc", "120", "0", (0.85, 0.95)),
    ("fcc", "120", "0.34", (0.80, 0.85, 0.92, 0.95, 0.98)),
    ("fcc", "120", "0.45", (0.85, 0.95)),
    ("fcc", "30", "0.2", (0.85, 0.92, 0.95)),
    ("bcc", "120", "0.34", (0.80, 0.90, 0.95)),
    ("bcc", "30", "0.2", (0.90,)),
    ("sc", "120", "0.34", (0.65, 0.80, 0.90, 0.95, 0.98)),
    ("sc", "120", "0.45", (0.80, 0.95)),
    ("sc", "30", "0.2", (0.80, 0.90, 0.95)),
    ("hex", "120", "0.34", (0.80, 0.92)),
    ("hex", "30", "0.2", (0.80, 0.92)),
    ("die", "120", "0.34", (0.65, 0.80, 0.90, 0.95)),
    ("die", "30", "0.2", (0.80, 0.90, 0.95)),
]


def main() -> None:
    """Print the table: the force of the first planes that move, and their way back at shares of it."""
    print("lattice,E_over_Y,nu,density,force," + ",".join(f"way_{round(100 * s):02d}" for s in SHARES))
    with tempfile.TemporaryDirectory() as folder:
        program = str(Path(folder) / "finite_elements")
        words = ["-std=c++17", "-O3", "-march=native", "-ffast-math"]
        subprocess.run(["g++", *words, str(SOURCE), "-o", program], check=True)
        for name, E, nu, densities in CASES:
            for density in densities:
                line = [program, name, E, nu, "12", str(density), "0.02", "0.0015"]
                done = subprocess.run(line, check=True, capture_output=True, text=True)
                rows = np.genfromtxt(io.StringIO(done.stdout), delimiter=",", skip_header=1)
                held, back = rows[rows[:, 0] == 1], rows[rows[:, 0] == 2]
                column = 3 if name == "die" else 2
                peak = held[-3:, column].mean()
                ways = [np.interp(-s, -back[:, column] / peak, back[:, 1] - held[-1, 1]) for s in SHARES]
                print(f"{name},{E},{nu},{density:g},{peak:.4f}," + ",".join(f"{w:.5f}" for w in ways), flush=True)


if __name__ == "__main__":
    main()
