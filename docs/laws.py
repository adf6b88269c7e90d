# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/figures/laws.png: every law against equations 8.83, 8.86 and 8.88 of Seville and Wu 2016.

Lines are theory, points are LIGGGHTS runs.

Run: .venv/bin/python docs/laws.py      (needs LIGGGHTS; 5 s)

The sphere of cases/steel_wall.toml with a yield stress of 50 MPa, so that a_max/R* stays below 0.1 up to
10,000 v_y0: e_n depends on v/v_y0 alone.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np

from epdem.case.impact import load
from epdem.engines import engine
from epdem.impacts.comparison import compare
from epdem.impacts.experiment import Experiment, bodies, pair_of
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.impacts.run import run_plan
from epdem.laws.strengths import default_numbers
from epdem.theory import printed
from epdem.theory.backbones import LAWS as BACKBONES
from epdem.theory.yielding import FIRST_YIELD_ROUNDED

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).parents[1]
YIELD_STRESS = 50e6  # [Pa]
SPEEDS = np.geomspace(0.3, 1e4, 30)  # of v_y0
LAWS = {"hertz": "0.5", "thornton": "C0", "johnson": "C1", "cavity": "C2"}


def steel(law: str, speed: np.ndarray) -> Experiment:
    """The impacts of steel_wall with another yield stress, at `speed` [m/s]."""
    case = load(ROOT / "cases/steel_wall.toml")
    body, target = (replace(b, yield_stress=YIELD_STRESS) for b in bodies(case))
    spec = pair_of(default_numbers(law), body, target)
    return Experiment(spec, body, target, speed, numerics=case.numerics, check=case.check)


def liggghts(x: Experiment) -> tuple[np.ndarray, float]:
    """Mean restitution over the phases at each speed, and the largest error against theory."""
    prediction = predict(x)
    with tempfile.TemporaryDirectory() as folder:
        stage = run_plan(plan(x, prediction), engine("liggghts"), Path(folder))
    rows = compare("liggghts", x.law.name, stage.impacts, prediction, x.check)
    return rows["e_n"].to_numpy(), float(rows["e_n_error"].max())


def main() -> None:
    """Draw the figure and print the largest errors of the LIGGGHTS runs."""
    pair = steel("cavity", SPEEDS)
    numbers = {"E_star": pair.E_star, "R_star": pair.R_star, "m_star": pair.m_star}
    Y, plastic = YIELD_STRESS, BACKBONES["thornton"].default_ratio
    p_m = BACKBONES["johnson"].default_ratio * Y
    v_y0, v_y = (printed.yield_speed(p_y=ratio * Y, **numbers) for ratio in (FIRST_YIELD_ROUNDED, plastic))
    fine = np.geomspace(SPEEDS[0], SPEEDS[-1], 400)

    fig, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(7, 7), height_ratios=(3, 1.4), layout="constrained")
    fit = printed.wu(fine * v_y0, v_y0=v_y0)
    for name, colour in LAWS.items():
        line = predict(steel(name, fine * v_y0)).e_n
        points, error = liggghts(steel(name, SPEEDS * v_y0))
        print(f"{name:<10} largest error of e_n in LIGGGHTS, 400 steps in contact, 8 phases: {error:.1e}")
        above.plot(fine, line, "-", color=colour, lw=1.4, label=f"{name}, theory")
        above.plot(SPEEDS, points, "o", color=colour, ms=4, mfc="none", label=f"ep/{name}, LIGGGHTS")
        if name != "hertz":
            below.plot(fine, line / fit - 1, "-", color=colour, lw=1.4)
            below.plot(SPEEDS, points / printed.wu(SPEEDS * v_y0, v_y0=v_y0) - 1, "o", color=colour, ms=4, mfc="none")
    above.plot(fine, printed.thornton(fine * v_y0, v_y=v_y), "k:", lw=1.2, label="8.83 Thornton 1997")
    above.plot(
        fine,
        printed.johnson(fine * v_y0, p_m=p_m, **numbers),
        "k-.",
        lw=1,
        label="8.86 Johnson 1985",
    )
    above.plot(fine, fit, "k--", lw=1.4, label="8.88 Wu et al. 2003, finite elements")
    below.axhspan(-0.05, 0.05, color="0.92")
    below.axhline(0, color="k", ls="--", lw=1)
    above.set(
        ylabel="coefficient of restitution e_n",
        xscale="log",
        yscale="log",
        ylim=(0.15, 1.1),
        title="Four laws: theory, equations 8.83, 8.86, 8.88, and LIGGGHTS",
    )
    below.set(xlabel="impact speed / speed of first yield, v/v_y0", ylabel="e_n / (8.88) - 1", ylim=(-0.25, 0.25))
    ticks = [0.2, 0.3, 0.5, 0.7, 1.0]
    above.set_yticks(ticks, [str(t) for t in ticks], minor=False)
    above.minorticks_off()
    above.legend(fontsize=8, ncols=2)
    for axes in (above, below):
        axes.grid(alpha=0.3)
    path = ROOT / "docs/figures/laws.png"
    path.parent.mkdir(exist_ok=True)
    fig.savefig(path, dpi=130)
    print(f"wrote {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
