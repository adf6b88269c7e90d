# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/figures/tablets.png: tensile strength of tablets over their density, beside Rumpf's line.

Run: .venv/bin/python bench/tablets.py      (LAMMPS; five minutes)

cases/tablet_strength.toml with other thicknesses. Rumpf's line is z D F/(pi d^2), F = strength times pi a^2, with the
bonds that are whole as the jaws come: their number per sphere and mean area are read, nothing is fitted. With surface
energy in place of bonds F is 1.5 pi Gamma R* of spheres that touch, 1.5 pi Gamma E* a/p of dents of the pressure p.
"""

import tempfile
from pathlib import Path

import numpy as np

from epdem import Scene, run
from epdem.report.chart import Axis, Chart, Panel, Series, save

ROOT = Path(__file__).parents[1]
THICKNESSES = (0.55, 0.50, 0.46, 0.43, 0.40)  # [mm]
SURFACES = (0.05, 0.1, 1.0)  # works of adhesion [J/m^2]
E_STAR, PRESSURE = 12e9 / (2 * (1 - 0.34**2)), 280e6  # of the powder, fully plastic [Pa]
STRENGTH, RADIUS, DIE = 100e6, 50e-6, 1e-3  # of bonds [Pa], of spheres and die [m]


def tablet(thickness: float) -> tuple[float, float, float, float, float]:
    """(relative density under the punch, its pressure, share of bonds left by the release, strength, Rumpf's) [Pa]."""
    case = Scene.from_toml(ROOT / "cases/tablet_strength.toml")
    case = case.replace({"scene.thickness": f"{thickness} mm"})
    with tempfile.TemporaryDirectory() as folder:
        tables = run(case, out=Path(folder) / "run", engines="lammps").tables
    rows, contacts, phases = tables["rows"], tables["contacts"], tables["phases"].set_index("phase")
    at = {name: contacts[contacts["step"] == phases["end"][name]] for name in ("press", "free")}
    bonds = {name: there[there["bonded"] > 0] for name, there in at.items()}
    number = rows["particles"].iloc[0]
    density = number * 4 / 3 * np.pi * RADIUS**3 / (np.pi / 4 * DIE**2 * thickness * 1e-3)
    whole, spheres = bonds["free"], rows["particles"].iloc[-1]
    force = STRENGTH * np.pi * float((whole["contact_radius"] ** 2).mean())
    rumpf = 2 * len(whole) / spheres * density * force / (np.pi * (2 * RADIUS) ** 2)
    for gamma in SURFACES if thickness == 0.5 else ():
        dent = E_STAR * float(whole["contact_radius"].mean()) / PRESSURE
        by_surface = (rumpf / force * 1.5 * np.pi * gamma * radius for radius in (RADIUS / 2, dent))
        print(f"Rumpf's line with {gamma} J/m^2 [kPa]: touch, dents", *(f"{1e-3 * x:.2g}" for x in by_surface))
    found = rows["tensile_stress"].rolling(10).mean().max(), rumpf
    return density, rows["pressure"].max(), len(whole) / len(bonds["press"]), *found


def main() -> None:
    """Print the table and draw the figure."""
    print("| relative density | pressure [MPa] | bonds left | strength [MPa] | Rumpf [MPa] |")
    found = []
    for thickness in THICKNESSES:
        found.append(row := tablet(thickness))
        density, pressure, left, strength, rumpf = row
        cells = f"{density:.3f}", f"{pressure / 1e6:.0f}", f"{100 * left:.0f} %", f"{strength / 1e6:.2f}"
        print(f"| {' | '.join(cells)} | {rumpf / 1e6:.2f} |", flush=True)
    density, _, _, strength, rumpf = np.array(found).T
    lines = [
        Series("diametral compression", density, strength / 1e6, 0, None, 0),
        Series("Rumpf 1970, bonds as the jaws come", density, rumpf / 1e6, 1, "dash"),
    ]
    text = "Tensile strength of five pressed tablets over their relative density, beside the line of Rumpf"
    panel = Panel(Axis("relative density under the punch"), Axis("tensile strength", "MPa", log=True), lines)
    save(Chart("tablets", "Strength of tablets", text, [panel]), ROOT / "docs/figures", data=False)


if __name__ == "__main__":
    main()
