# SPDX-License-Identifier: GPL-2.0-or-later
"""Friction under the pressure that a law has while it yields, in place of Hertz's: the table of docs/partial_slip.md.

.venv/bin/python bench/yield_pressure.py
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "physics"))

from slip import G_STAR, KAPPA, LAWS, MU, PAIR, V_Y, M, rebound

from epdem.theory import restitution
from epdem.theory.backbones import Meyer
from epdem.theory.partial_slip import Springs

PSI_1 = np.array([0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0])
V_C = np.sqrt(2 * LAWS["johnson"].work(LAWS["johnson"].yield_overlap) / M)  # johnson yields from here
HARDENED = Meyer(**PAIR, p_y=2.8e9, x=0.3)
IMPACTS = [(LAWS["thornton"], V_Y), (HARDENED, V_Y), (LAWS["johnson"], V_C)]


def flatness(law):
    """tau of a contact that grows: of force, radius and the pressure p at the centre, 3 - 2 pi a^2 p/F; 0 to yield."""

    def tau(alpha):
        grown = 3 - 2 * np.pi * law.radius(alpha) ** 2 * law.pressure_max(alpha) / law.force(alpha)
        return np.where(alpha > law.yield_overlap, np.clip(grown, 0, 1), 0.0)

    return tau


def cut_line_load(x, *, force, a, p):
    """Load per length [N/m] of Hertz's half-ellipse, cut at p [Pa], whose force on the circle a [m] is `force` [N]. The
    ellipse has the peak p_0 with (p/p_0)^2 = 3 (1 - F/(pi a^2 p)); Abel's transform of what is left."""
    x, share = np.asarray(x, float), np.clip(3 * (1 - force / (np.pi * a * a * p)), 1e-6, 1.0)
    inside = np.maximum((a - x) * (a + x), 0.0)
    core = a * a * (1 - share)  # the circle where the pressure is p
    w = np.divide(np.maximum(core - x * x, 0), inside, out=np.ones_like(x), where=inside > 0)
    rim = p / np.sqrt(share) / a * inside * (np.arccos(np.sqrt(w)) - np.sqrt(w * (1 - w)))
    return np.where(x < a, rim + 2 * p * np.sqrt(np.maximum(core - x * x, 0.0)), 0.0)


class CutSprings(Springs):
    """Springs under the cut pressure while the contact grows and yields."""

    pressure = None  # [Pa] of this step; None: Hertz's half-ellipse

    def move(self, slip, *, force, a, a_peak, flatness):
        if self.pressure is None or not (force > 0 and a > self.x[0]):
            return super().move(slip, force=force, a=a, a_peak=a_peak, flatness=flatness)
        load = cut_line_load(self.x, force=force, a=a, p=self.pressure)
        limit = self.mu * load * (0.5 * force / (load.sum() * self.width)) / (4 * self.G_star)
        self.stretch = np.clip(self.stretch + np.asarray(slip)[..., None], -limit, limit)
        return 8 * self.G_star * self.width * self.stretch.sum(axis=-1)


def springs(law, psi_1, speed, *, own, steps=1000, count=400):
    """psi_2 by springs along a line: under the law's own pressure while it yields, or under Hertz's."""
    normal = restitution.impact(law, m_star=M, speed=speed)
    dt, u = float(normal.contact_time) / steps, (MU / KAPPA * speed * np.asarray(psi_1))[:, None]
    line = CutSprings(G_star=G_STAR, mu=MU, a_max=float(normal.radius_max), shape=u.shape, springs=count)
    alpha, v, top, F, T = 0.0, speed, 0.0, 0.0, np.zeros(u.shape)
    for _ in range(int(1.2 * steps)):
        v, u = v - 0.5 * dt * F / M, u - 1.75 * dt / M * T
        alpha += dt * v
        grows, top = alpha >= top, max(alpha, top)
        F, a = (law.force(alpha), law.radius(alpha)) if grows else law.unloading(max(alpha, 0.0), top)
        line.pressure = float(law.pressure_max(top)) if own and grows and top > law.yield_overlap else None
        T = line.move(dt * u, force=float(F), a=float(a), a_peak=float(a), flatness=0.0)
        v, u = v - 0.5 * dt * F / M, u - 1.75 * dt / M * T
        if F == 0 and v < 0:
            break
    return KAPPA / MU * u[:, 0] / speed


def step_error(law, speed, *, own, steps):
    """Largest deviation of psi_2 of 3 nodes from their own 4000 steps, over 8 phases."""
    tau = flatness(law) if own else None
    fine = rebound(law, PSI_1, speed, steps=4000, phases=1, loading_flatness=tau)[0]
    return np.abs(rebound(law, PSI_1, speed, steps=steps, loading_flatness=tau)[0] - fine).max()


def main():
    """One row per law and speed."""
    print("| law | speed | shift of psi_2 | error at 100 steps: Hertz's, own | at 400 steps |\n|---|---|---|---|---|")
    for law, unit in IMPACTS:
        for times in (2, 5, 20):
            shift = np.abs(np.subtract(*(springs(law, PSI_1, times * unit, own=own) for own in (True, False)))).max()
            errors = [
                ", ".join(f"{step_error(law, times * unit, own=own, steps=n):.1e}" for own in (False, True))
                for n in (100, 400)
            ]
            print(f"| `{law.name}` | {times} | {shift:.3f} | {' | '.join(errors)} |", flush=True)


if __name__ == "__main__":
    main()
