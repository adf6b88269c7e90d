# SPDX-License-Identifier: GPL-2.0-or-later
"""Discharge of a flat-bottomed bin through round outlets: the power of Beverloo's law, fitted.

    .venv/bin/python bench/bulk_physics.py [--outlets 5 6 7 8 9] [--count 5000] [--bin 20] [--angle 90]

W = C rho_b sqrt(g) (D - k d)^n with n = 5/2, C about 0.58 and k from 1.2 to 1.6 (Beverloo, Leniger and van de Velde
1961, Chem. Eng. Sci. 15, 260). W is the slope of the mass below the outlet against time, while the bin empties from 5 %
to 25 %; rho_b is that of the bed's middle before the outlet opens. Beads, friction and law are those of
cases/hopper_beads.toml, with a fifth of their modulus for the sake of the time step.
"""

import argparse
import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines.liggghts.engine import Liggghts
from epdem.scenes.judge.checks import discharge
from epdem.scenes.plan.plan import plan
from epdem.scenes.run import run_plan
from epdem.scenes.tables.columns import last_frame

CASE = Path(__file__).parents[1] / "cases/hopper_beads.toml"
d, g = 2e-3, 9.81  # mean diameter of the beads [m], gravity [m/s^2]
BEGIN, END = 0.05, 0.25  # parts of the filling that are out when the measurement begins and ends


@dataclass(frozen=True)
class Flow:
    """One discharge: outlet over d, mass flow [kg/s], bulk density [kg/m^3]."""

    outlet: float
    rate: float
    bulk: float

    def constant(self, k: float) -> float:
        """C of Beverloo's law with the power 5/2."""
        return self.rate / (self.bulk * math.sqrt(g) * ((self.outlet - k) * d) ** 2.5)


def scene(outlet: float, count: int, width: float, angle: float) -> dict:
    """TOML data: a bin `width` beads wide with an outlet of `outlet` beads, open until a quarter of it is out."""
    data = read_toml(CASE)
    data["materials"]["beads"] |= {"young_modulus": "2 MPa"}
    height = count * (math.pi / 6) / 0.25 / (math.pi / 4 * (width - 1) ** 2)  # room for a random filling of 25 %
    per_second = 0.58 * 0.6 / (math.pi / 6) * math.sqrt(g / d) * (outlet - 1.4) ** 2.5  # to know when to stop
    data["scene"] |= {
        "bin_diameter": f"{width * d} m",
        "bin_height": f"{height * d:.6g} m",
        "outlet": f"{outlet * d} m",
        "half_angle": f"{angle} deg",
        "count": count,
        "fill_time": "0.12 s",
        "duration": f"{0.38 * count / per_second:.3g} s",
    }
    return data | {"output": {"rows": 100, "particles": 100}, "numerics": {"error": 0.1}}


def flow(outlet: float, count: int, width: float, folder: Path, angle: float = 90.0) -> Flow:
    """Run a discharge in `folder` and measure it; lengths in bead diameters, `angle` in degrees (90: flat bottom)."""
    case = parse(scene(outlet, count, width, angle))
    p = plan(case)
    spheres = run_plan(p, Liggghts(), folder)["particles"]
    last = last_frame(spheres)
    out = last[last["z"] < p.scene.gates[0].at]["mass"].sum() / last["mass"].sum()
    if out < END:
        raise RuntimeError(f"outlet {outlet} d: only {out:.0%} of the filling came out; the flow has stopped")
    found = discharge(p, p.scene.check[0], spheres, (BEGIN, END))
    return Flow(outlet, found.rate, found.bulk)


def power(flows: list[Flow], k: float) -> float:
    """The exponent of (D - k d) that fits best."""
    opening = np.log([f.outlet - k for f in flows])
    return float(np.polyfit(opening, np.log([f.rate / f.bulk for f in flows]), 1)[0])


def main() -> None:
    """Run every outlet; print rates, constants and the fitted power for three values of k."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--outlets", type=float, nargs="+", default=[5, 6, 7, 8, 9], help="in bead diameters")
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--bin", type=float, default=20.0, help="diameter of the bin in bead diameters")
    parser.add_argument("--angle", type=float, default=90.0, help="half angle of the cone; 90: flat bottom")
    options = parser.parse_args()
    flows = []
    print("| D/d | W [g/s] | rho_b [kg/m^3] | C for k = 1.4 |\n|---|---|---|---|")
    for outlet in options.outlets:
        with tempfile.TemporaryDirectory(prefix="epdem_bulk_") as folder:
            flows.append(f := flow(outlet, options.count, options.bin, Path(folder), options.angle))
        constant = f.constant(1.4)
        print(f"| {outlet:g} | {1e3 * f.rate:.2f} | {f.bulk:.0f} | {constant:.2f} |", flush=True)
    for k in (1.2, 1.4, 1.6):
        print(f"k = {k}: n = {power(flows, k):.2f}, mean C = {np.mean([f.constant(k) for f in flows]):.2f}")


if __name__ == "__main__":
    main()
