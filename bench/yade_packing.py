# SPDX-License-Identifier: GPL-2.0-or-later
"""A packing of 10,000 spheres in YADE and in LIGGGHTS from the same places: each energy, and their difference.

    .venv/bin/python bench/yade_packing.py [spheres]

Spheres of two sizes fall into a box with friction (partial slip), dashpot and plastic contacts. YADE runs the classes
of epdem_yade (`make yade`). The script prints the energies at the end and the largest difference of any row over the
energy of the fall; 1 if a difference exceeds LIMIT. Takes a few minutes.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

from epdem import Scene, run
from epdem.engines.yade import launcher

LIMIT = 0.01
SPACING = 4.2e-3  # [m]
GLASS = {"young_modulus": "10 MPa", "poisson_ratio": 0.25, "density": "2500 kg/m^3", "yield_stress": "0.05 MPa"}


def scene(folder: Path, count: int) -> Scene:
    """The scene of a packing, whose table of spheres is written into a folder."""
    draw = np.random.default_rng(1)
    side = max(2, round((count / 2) ** (1 / 3)))
    half = 0.5 * SPACING * side
    lines = ["x,y,z,radius,vx,vy,vz"]
    for k in range(count):
        index = np.array([k % side, k // side % side, k // side**2])
        x, y, z = SPACING * (index + 0.5) - [half, half, 0.0] + 0.2e-3 * draw.random(3)
        lines.append(f"{x!r},{y!r},{z!r},{draw.choice([1.5e-3, 1.9e-3])!r},0,0,-0.5")
    (folder / "spheres.csv").write_text("\n".join([*lines, ""]).replace("np.float64(", "").replace(")", ""))
    top = SPACING * (count // side**2 + 2)
    planes = (
        ("floor", "z", 0.0),
        ("left", "x", -half),
        ("right", "x", half),
        ("front", "y", -half),
        ("back", "y", half),
    )
    walls = [{"name": n, "kind": "plane", "axis": a, "at": f"{x} m", "material": "glass"} for n, a, x in planes]
    span = [f"{-half} m", f"{half} m"]
    tables = {
        "case": {"name": "packing", "title": "Packing", "source": "a benchmark"},
        "materials": {"glass": GLASS},
        "law": {"name": "thornton"},
        "contact": {"friction": 0.4, "tangential": "partial_slip"},
        "viscous": {"restitution": 0.8},
        "scene": {
            "kind": "parts",
            "room": {"x": span, "y": span, "z": ["0 m", f"{top} m"]},
            "wall": walls,
            "fill": [{"name": "table", "file": str(folder / "spheres.csv"), "material": "glass"}],
            "phase": [{"name": "fall", "duration": "60 ms"}],
        },
        "output": {"rows": 30, "particles": 6, "energy": True},
        "numerics": {"time_step": "1e-5 s"},
    }
    return Scene(**tables)


def main() -> int:
    """Print the table; 1 if an energy differs by more than LIMIT of the energy of the fall."""
    if launcher.module() is None:
        raise SystemExit("the module epdem_yade is not built; run 'make yade'")
    with tempfile.TemporaryDirectory() as scratch:
        packing = scene(Path(scratch), int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
        found = {}
        for tool in ("yade", "liggghts"):
            found[tool] = run(packing, engines=tool, out=Path(scratch) / tool).tables["energy_balance"]
    yade, liggghts = found["yade"], found["liggghts"]
    fall = np.ptp(liggghts["gravity"]) + liggghts["kinetic"].iloc[0]
    print(f"energy of the fall {fall:.4g} J; at the end, and the largest difference of a row over the fall")
    worst = 0.0
    for name in [n for n in yade if n not in ("step", "time")]:
        off = float(np.abs(yade[name] - liggghts[name]).max() / fall)
        worst = max(worst, off)
        print(f"{name:10} {yade[name].iloc[-1]:12.5g} {liggghts[name].iloc[-1]:12.5g} {off:9.2e}")
    print(f"largest {worst:.2e} (limit {LIMIT}: {'kept' if worst <= LIMIT else 'EXCEEDED'})")
    return int(worst > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
