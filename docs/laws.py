# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/figures/laws.png: four laws against equations 8.83, 8.86 and 8.88 of Seville and Wu 2016; meyer.png: exponents.

Lines are theory, points are LIGGGHTS runs.

Run: .venv/bin/python docs/laws.py      (needs LIGGGHTS; 5 s)

The sphere of cases/steel_wall.toml with a yield stress of 50 MPa, so that a_max/R* stays below 0.1 up to
10,000 v_y0: e_n depends on v/v_y0 alone.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from epdem.case.impact import load
from epdem.engines import engine
from epdem.impacts.experiment import Experiment, bodies, pair_of
from epdem.impacts.measurement import compare
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.impacts.run import run_plan
from epdem.laws.strengths import default_numbers
from epdem.report.chart import GREY, INK, Axis, Chart, Panel, Series, save
from epdem.theory import printed
from epdem.theory.backbones import LAWS as BACKBONES
from epdem.theory.printed import wu_restitution
from epdem.theory.yielding import FIRST_YIELD_ROUNDED, yield_speed

ROOT = Path(__file__).parents[1]
YIELD_STRESS = 50e6  # [Pa]
SPEEDS = np.geomspace(0.3, 1e4, 30)  # of v_y0
LAWS = ("hertz", "thornton", "johnson", "cavity")
EXPONENTS = (0.0, 0.1, 0.2, 0.3, 0.5, 0.7)


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
    rows = compare("liggghts", x.law.name, stage.tables["impacts"], prediction, x.check)
    return rows["e_n"].to_numpy(), float(rows["e_n_error"].max())


def figure() -> Chart:
    """e_n of the laws over speed with the printed equations, and its deviation from the fit 8.88; prints errors."""
    pair = steel("cavity", SPEEDS)
    numbers = {"E_star": pair.E_star, "R_star": pair.R_star, "m_star": pair.m_star}
    Y = YIELD_STRESS
    ratios = (FIRST_YIELD_ROUNDED, BACKBONES["thornton"].declaration().default_ratio)
    v_y0, v_y = (yield_speed(p_y=ratio * Y, **numbers) for ratio in ratios)
    fine = np.geomspace(SPEEDS[0], SPEEDS[-1], 400)
    fit = wu_restitution(fine * v_y0, v_y0=v_y0)
    above: list[Series] = []
    below: list[Series] = []
    for k, name in enumerate(LAWS):
        line = predict(steel(name, fine * v_y0)).e_n
        points, error = liggghts(steel(name, SPEEDS * v_y0))
        print(f"{name:<10} largest error of e_n in LIGGGHTS, 400 steps in contact, 8 phases: {error:.1e}")
        above += [Series(f"{name}, theory", fine, line, k), Series(f"ep/{name}, LIGGGHTS", SPEEDS, points, k, None, k)]
        if name != "hertz":
            there = points / wu_restitution(SPEEDS * v_y0, v_y0=v_y0) - 1
            below += [Series("", fine, line / fit - 1, k), Series("", SPEEDS, there, k, None, k)]
    johnson = printed.johnson_restitution(
        fine * v_y0, p_m=BACKBONES["johnson"].declaration().default_ratio * Y, **numbers
    )
    above.append(Series("8.83 Thornton 1997", fine, printed.thornton_restitution(fine * v_y0, v_y=v_y), INK, "dot"))
    above.append(Series("8.86 Johnson 1985", fine, np.where(johnson <= 1.1, johnson, np.nan), INK, "dashdot"))
    above.append(Series("8.88 Wu et al. 2003, finite elements", fine, fit, INK, "dash"))
    below += [Series("", [SPEEDS[0], SPEEDS[-1]], [level, level], GREY, "dash") for level in (-0.05, 0.0, 0.05)]
    ticks = {level: f"{level:g}" for level in (0.2, 0.3, 0.5, 0.7, 1.0)}
    speed = Axis("impact speed over that of first yield $v/v_{y0}$", log=True)
    return Chart(
        "laws",
        "Four laws: theory, equations 8.83, 8.86, 8.88, and LIGGGHTS",
        "Coefficient of restitution of four laws against impact speed, theory as lines and LIGGGHTS as points; below, "
        "the deviation from the finite-element fit 8.88 with a band of 5 %.",
        [
            Panel(
                speed, Axis("coefficient of restitution $e_n$", log=True, low=0.15, high=1.1, ticks=ticks), above, 3.0
            ),
            Panel(speed, Axis("$e_n$ over 8.88, less 1", low=-0.25, high=0.25), below, 1.4),
        ],
    )


def hardening() -> Chart:
    """e_n of meyer over v/v_y for exponents from 0 to 0.7, with 8.83 and Hertz; prints errors."""
    pair = steel("meyer", SPEEDS)
    p_y = pair.law.parameters["yield_pressure"]
    v_y = float(yield_speed(p_y=p_y, E_star=pair.E_star, R_star=pair.R_star, m_star=pair.m_star))
    ratio, fine, series = np.geomspace(0.3, 1000, 20), np.geomspace(0.3, 1000, 400), []
    for k, exponent in enumerate(EXPONENTS):
        law = replace(pair.law, parameters=pair.law.parameters | {"hardening_exponent": exponent})
        points, error = liggghts(replace(pair, law=law, speed=ratio * v_y))
        print(f"x = {exponent:<7g} largest error of e_n in LIGGGHTS: {error:.1e}")
        line = predict(replace(pair, law=law, speed=fine * v_y)).e_n
        series += [Series(f"x = {exponent:g}", fine, line, k), Series("", ratio, points, k, None, k)]
    series.append(Series("8.83 Thornton 1997", fine, printed.thornton_restitution(fine, v_y=1.0), INK, "dot"))
    series.append(Series("Hertz, x = 1", [fine[0], fine[-1]], [1.0, 1.0], INK, "dash"))
    ticks = {level: f"{level:g}" for level in (0.2, 0.3, 0.5, 0.7, 1.0)}
    return Chart(
        "meyer",
        "Law meyer: restitution for exponents of hardening",
        "Coefficient of restitution of law meyer against impact speed over yield speed for several exponents, theory "
        "as lines and LIGGGHTS as points, between equation 8.83 and Hertz.",
        [
            Panel(
                Axis("impact speed over yield speed $v/v_y$", log=True),
                Axis("coefficient of restitution $e_n$", log=True, low=0.18, high=1.1, ticks=ticks),
                series,
            )
        ],
    )


def main() -> None:
    """Draw both figures."""
    for chart in (figure(), hardening()):
        (path,) = save(chart, ROOT / "docs/figures", data=False)
        print(f"wrote {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
