# SPDX-License-Identifier: GPL-2.0-or-later
"""Errors of the adhesive laws of C++ in two-body impacts by velocity Verlet, and the speed of their theory.

Run: .venv/bin/python bench/adhesion.py      (a minute)

The numbers of docs/adhesion.md: error of e_n against theory as a maximum over 8 phases, over the speed and over the
whole domain, the sticking speed by bisection, and the time of a million e_n of theory.
"""

import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "battery"))

from adhesive import Contact, ask, e_n_errors  # noqa: E402  it lies beside the tests

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
    small = np.array(strain)
    errors = e_n_errors(cases, 400)
    print(f"\n{count} random impacts of the whole domain, 400 steps: error of e_n, median and largest")
    for low, high in ((0, 0.1), (0.1, 0.3), (0.3, 1), (1, np.inf)):
        these = errors[(small >= low) & (small < high)]
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


if __name__ == "__main__":
    by_speed()
    over_the_domain()
    sticking()
    print()
    speed_of_theory()
