# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors of the adhesive laws of C++ in two-body impacts by velocity Verlet, and the speed of their theory.

Run: .venv/bin/python bench/adhesion.py [--liggghts COUNT]      (a minute; in LIGGGHTS half a second for each impact)

The numbers of docs/adhesion.md: error of e_n against theory as a maximum over 8 phases, over the speed and over the
whole domain, the sticking speed by bisection, and the time of a million e_n of theory. With --liggghts the whole domain
alone, COUNT points of a Latin hypercube, in LIGGGHTS.
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "battery"))

from adhesive import DENSITY, Contact, ask, e_n_errors  # noqa: E402  it lies beside the tests

from epdem import Case, run  # noqa: E402
from epdem.errors import CaseError  # noqa: E402
from epdem.theory import adhesion  # noqa: E402

STRENGTHS = {"jkr": None, "3.04 GPa": 3.04e9, "1 GPa": 1e9, "0.5 GPa": 0.5e9}
SPEEDS = (0.05, 0.1, 0.3, 1.0, 10.0)
STEPS = (100, 400, 1600)


def by_speed() -> None:
    """One line for each strength and speed."""
    print("steel, R* 10 um, Gamma 0.2 J/m^2: e_n of theory and its largest error at", *STEPS, "steps in contact")
    for name, p_y in STRENGTHS.items():
        c = Contact(p_y)
        cases = [(c, V) for V in SPEEDS]
        errors = [e_n_errors(cases, steps) for steps in STEPS]
        for k, (_, V) in enumerate(cases):
            e_n = float(adhesion.e_n(c.theory, m_star=c.m_star, speed=V))
            print(f"  {name:<9} {V:6.2f} m/s  {e_n:.8f}  " + "  ".join(f"{e[k]:.1e}" for e in errors))


def over_the_domain(count: int = 3000) -> None:
    """V/V_s 3 to 3000 (a third at 3), Gamma 1e-6 to 10 J/m^2, R* 1 um to 10 mm, p_y/E* 1e-4 to 0.1; E* 118 GPa."""
    rng, cases, strain = np.random.default_rng(1), [], []
    for _ in range(count):
        p_y = None if rng.random() < 0.1 else 1.18e11 * 10 ** rng.uniform(-4, -1)
        c = Contact(p_y, 10 ** rng.uniform(-6, 1), 10 ** rng.uniform(-6, -2), 1.18e11)
        V = c.V_s * (3.0 if rng.random() < 1 / 3 else 10 ** rng.uniform(np.log10(3), np.log10(3000)))
        cases.append((c, V))
        strain.append(float(c.theory.radius_of_work(0.5 * c.m_star * V * V)) / c.R_star)
    errors = e_n_errors(cases, 400)
    print(f"\n{count} random impacts of the whole domain, 400 steps: error of e_n, median and largest")
    by_strain(np.array(strain), errors)


def in_liggghts(count: int) -> None:
    """The same domain, p_y always finite: a sphere of steel on a wall, one process for each point."""
    print(f"{count} points of a Latin hypercube in LIGGGHTS, 8 phases, 400 steps in contact")
    print("| V/V_s | Gamma [J/m2] | R [m] | p_y/E* | a_max/R* | e_n | error | over e_n |\n" + 8 * "|---" + "|")
    rng, errors, strain = np.random.default_rng(1), [], []
    places = (np.array([rng.permutation(count) for _ in range(4)]).T + rng.uniform(size=(count, 4))) / count
    low, high = np.log10([(3, 3000), (1e-6, 10), (1e-6, 1e-2), (1e-4, 0.1)]).T
    for times, gamma, radius, strength in 10 ** (low + places * (high - low)):
        c = Contact(None, gamma, radius)
        c = Contact(strength * c.E_star, gamma, radius)
        steel = {"young_modulus": 215e9, "poisson_ratio": 0.3, "density": DENSITY, "yield_stress": c.p_y / 2.8}
        case = Case(
            materials={"steel": steel},
            impact={
                "kind": "sphere-wall",
                "body": {"radius": radius, "material": "steel"},
                "target": {"material": "steel"},
                "speeds": [times * c.V_s],
            },
            law={"name": "thornton_ning", "work_of_adhesion": gamma, "yield_pressure": c.p_y},
            numerics={"steps_in_contact": 400, "phases": 8},
        )
        deepest = float(c.theory.radius_of_work(0.5 * c.m_star * (times * c.V_s) ** 2)) / radius
        point = f"| {times:.3g} | {gamma:.2g} | {radius:.2g} | {strength:.2g} | {deepest:.2g} |"
        try:
            with tempfile.TemporaryDirectory(prefix="epdem-adhesion-") as scratch:
                row = run(case, out=Path(scratch) / "run").table.iloc[0]
        except CaseError:  # the bodies would pass through each other
            print(f"{point} not representable | | |", flush=True)
            continue
        strain.append(deepest)
        errors.append(float(row["e_n_error"] * row["e_n_theory"]))
        print(f"{point} {row['e_n']:.5f} | {errors[-1]:.1e} | {row['e_n_error']:.1e} |", flush=True)
    by_strain(np.array(strain), np.array(errors))


def by_strain(strain: np.ndarray, errors: np.ndarray) -> None:
    """One line for each range of a_max/R*."""
    for low, high in ((0, 0.1), (0.1, 0.3), (0.3, 1), (1, np.inf)):
        these = errors[(strain >= low) & (strain < high)]
        if len(these):
            print(f"  a_max/R* {low:g} to {high:g}: {len(these):5d} impacts  {np.median(these):.1e}  {these.max():.1e}")


def sticking() -> None:
    """Bisection between V_s/2 and 2 V_s."""
    print("\nsticking speed by bisection, 400 steps in contact at 3 V_s: theory, and largest deviation of 4 phases")
    for name, p_y in (*STRENGTHS.items(), ("0.25 GPa", 0.25e9)):
        c, worst = Contact(p_y), 0.0
        dt = float(adhesion.contact_time(c.theory, m_star=c.m_star, speed=3 * c.V_s)) / 400
        for phase in (0.1, 0.35, 0.6, 0.85):
            low, high = 0.5 * c.V_s, 2 * c.V_s
            for _ in range(16):
                V = 0.5 * (low + high)
                ((rebound, *_),) = ask([c.line(V, dt, phase, 2000)])
                low, high = (low, V) if rebound > 0 else (V, high)
            worst = max(worst, abs(0.5 * (low + high) / c.V_s - 1))
        print(f"  {name:<9} {c.V_s:.8f} m/s  {worst:.1e}")


def speed_of_theory() -> None:
    """Minimum of 5 passes."""
    for name, p_y, count in (("jkr", None, 1_000_000), ("thornton_ning", 1e9, 100_000)):
        c, best = Contact(p_y), np.inf
        for _ in range(5):
            start = time.perf_counter()
            adhesion.e_n(c.theory, m_star=c.m_star, speed=np.geomspace(1e-3, 10, count))
            best = min(best, time.perf_counter() - start)
        print(f"  {name:<14} {count} e_n of theory in {best:.3f} s")


def main() -> None:
    ask_for = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask_for.add_argument("--liggghts", type=int, default=0, metavar="COUNT", help="the whole domain in LIGGGHTS")
    count = ask_for.parse_args().liggghts
    if count:
        return in_liggghts(count)
    by_speed()
    over_the_domain()
    sticking()
    print()
    speed_of_theory()


if __name__ == "__main__":
    main()
