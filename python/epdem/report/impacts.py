# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a run of impacts as data: restitution, errors, loops, forces, slip."""

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..base.files import claim
from ..impacts import oblique
from ..impacts.experiment import Experiment
from ..impacts.measurement import CHECKED
from ..impacts.prediction import Prediction, predict
from ..impacts.run import Outcome
from ..theory.printed import wu_restitution
from ..theory.yielding import FIRST_YIELD_ROUNDED, yield_speed
from .chart import GREY, INK, PALETTE, Axis, Chart, Panel, Series, save

FINE = 240  # speeds of a line of theory
SLIPS = 80  # of a line of theory
ROUND_OFF = 1e-14  # errors below are zeros
MEASURED = 5  # kind of the points of a measurement, which engines do not reach
SPEED = Axis("speed", "m/s", log=True)


def charts(outcome: Outcome) -> list[Chart]:
    """The figures of the page."""
    return [main_chart(outcome), errors(outcome), *loops(outcome)]


def save_figure(outcome: Outcome) -> Path:
    """Draw the main figure into the folder of a run; its PNG file."""
    with claim(outcome.folder, force=True):
        return save(main_chart(outcome), outcome.folder)[0]


def main_chart(outcome: Outcome) -> Chart:
    """The figure of a run: e_n against speed, or slip after against slip before oblique impacts."""
    return slip(outcome) if outcome.case.impact.oblique else restitution(outcome)


def _fine(x: Experiment, others: Sequence[float] = ()) -> Experiment:
    low, high = float(min([*x.speed, *others])), float(max([*x.speed, *others]))
    margin = 1.0 if high > low else 2.0  # one speed alone is drawn with its surroundings
    return replace(x, speed=np.geomspace(low / margin, high * margin, FINE))


def first_yield(x: Experiment) -> float:
    """Speed [m/s] at which the softer body first yields (8.84 with 1.60 Y); NaN where nothing says so."""
    known = [b.yield_stress for b in (x.body, x.target) if b.yield_stress is not None and not b.rigid]
    if not known or x.law.adheres:
        return math.nan
    pair = {"E_star": x.E_star, "R_star": x.R_star, "m_star": x.m_star}
    return float(yield_speed(p_y=FIRST_YIELD_ROUNDED * min(known), **pair))


def _error(what: str) -> Axis:
    return Axis(f"{what}_error", log=True)


def _tolerance(speed: np.ndarray, value: float) -> Series:
    return Series(f"tolerance {value:g}", [speed.min(), speed.max()], [value, value], GREY, "dash")


def _visible(values: np.ndarray) -> np.ndarray:
    """Errors for a logarithmic axis, on which zeros have no place."""
    return np.where(np.asarray(values, float) > ROUND_OFF, values, math.nan)


def restitution(outcome: Outcome) -> Chart:
    """e_n against speed, theory as lines and engines as points, with the fit 8.88 where it holds; errors below."""
    rows, several = outcome.results.comparison, len(outcome.predictions) > 1
    above: list[Series] = []
    below: list[Series] = []

    def named(name: str, law: str) -> str:
        return f"{name}, {law}" if several else name

    known, ends = outcome.case.measured, []
    for i, law in enumerate(outcome.predictions):
        x = outcome.plans[law].experiment
        fine = _fine(x, known.speeds if known else ())
        line = predict(fine)
        ends.append((x, line))
        above.append(Series(named("theory", law), fine.speed, line.e_n, i % len(PALETTE) if several else INK))
        engines = rows[rows["law"] == law].groupby("engine", sort=False)
        for k, (name, part) in enumerate(engines):
            colour = (i if several else k) % len(PALETTE)
            speed = part["speed"].to_numpy()
            above.append(Series(named(str(name), law), speed, part["e_n"].to_numpy(), colour, None, k))
            below.append(Series("", speed, _visible(part["e_n_error"]), colour, None, k))
    fit = ""
    v_y0, plastic = first_yield(x), any(p.yields for p in outcome.predictions.values())
    if plastic and fine.speed[-1] > 100 * v_y0 and x.viscous_restitution is None:
        beyond = fine.speed[fine.speed >= 100 * v_y0]
        values = wu_restitution(beyond, v_y0=v_y0)
        above.append(Series("finite-element fit, eq. 8.88", beyond, values, INK, "dash"))
        fit = _beside_fit(float(values[-1]), ends)
    if known:
        above.append(Series("measured", np.array(known.speeds), np.array(known.e_n), INK, None, MEASURED))
    below.append(_tolerance(fine.speed, outcome.case.check.e_n))
    said = ", ".join(rows["engine"].unique())
    return Chart(
        "e_n",
        outcome.case.case.title,
        f"Coefficient of restitution against impact speed: theory as lines, {said} as points. Below, the largest error "
        f"over the starting phases; the largest of all is {rows['e_n_error'].max():.1e}.{fit}",
        [Panel(SPEED, Axis("coefficient of restitution e_n"), above, 3.0), Panel(SPEED, _error("e_n"), below, 1.4)],
        heading="Restitution against impact speed",
    )


def _beside_fit(fit: float, lines: list[tuple[Experiment, Prediction]]) -> str:
    """Sentences on the deviation of each law from the finite-element fit at the last speed of its line."""
    said = " The fit by Wu et al. 2003 begins at 100 times the speed of first yield."
    for x, line in lines:
        top, radius = float(line.overlap_max[-1]), float(line.radius_max[-1])
        deviation = float(line.e_n[-1]) / fit - 1.0
        said += (
            f" At {line.speed[-1]:.4g} m/s e_n of {x.law.name} is {100 * abs(deviation):.0f} % "
            f"{'above' if deviation > 0 else 'below'} the fit, with a contact area of "
            f"{radius**2 / (x.R_star * top):.1f} pi R* alpha;"
        )
    return f"{said[:-1]}, which is 2 pi R* alpha in the fully plastic contact of the fit."


def errors(outcome: Outcome) -> Chart:
    """The errors of all checked quantities against speed, largest over the phases."""
    rows, series = outcome.results.comparison, []
    for k, ((engine, law), part) in enumerate(rows.groupby(["engine", "law"], sort=False)):
        for i, name in enumerate(CHECKED):
            values = _visible(part[f"{name}_error"])
            label = f"{name}, {engine}" + (f", {law}" if rows["law"].nunique() > 1 else "")
            series.append(Series(label, part["speed"].to_numpy(), values, i, None, k))
    worst = ", ".join(f"{name} {rows[name + '_error'].max():.1e}" for name in CHECKED)
    return Chart(
        "errors",
        "Errors against theory",
        f"Largest error over the starting phases against impact speed, for each checked quantity: {worst}. Zeros are "
        "not on the logarithmic axis.",
        [Panel(SPEED, Axis("error, largest over phases", log=True), series)],
        file=False,
    )


def loops(outcome: Outcome) -> list[Chart]:
    """Force against overlap and against time of the chosen impacts, with the theory of the first law."""
    found = {key: table for key, table in outcome.results.paths.items() if len(table)}
    if not found:
        return []
    law = next(iter(found)).split("/")[0]
    speeds = np.unique(next(iter(found.values()))["speed"])
    prediction = predict(replace(outcome.plans[law].experiment, speed=speeds, oblique=None))
    by_overlap, by_time = _theory_loops(outcome.plans[law].experiment, prediction), []
    for k, (key, table) in enumerate(found.items()):
        for i, (speed, part) in enumerate(table.groupby("speed")):
            name = key.split("/")[1] if len(outcome.plans) == 1 else ", ".join(reversed(key.split("/")))
            top, observation_time = prediction.overlap_max[i], prediction.duration[i]
            force = part["force"] / prediction.force_max[i]
            thin = slice(None, None, max(1, len(part) // 40))
            once = "" if i else name
            by_overlap.append(Series(once, part["overlap"][thin] / top, force[thin], i, None, k))
            named = f"{name}, {speed:.3g} m/s" if k == 0 else once
            by_time.append(Series(named, part["time"] / observation_time, force, i, "solid" if k == 0 else "dot"))
    said = ", ".join(f"{v:.3g}" for v in speeds)
    force_axis = Axis("force / force_max")
    return [
        Chart(
            "loops",
            "Force against overlap",
            f"Loading and unloading at {said} m/s: theory as lines, engines as points, over the largest of "
            "theory. The energy between the two "
            "branches is lost.",
            [Panel(Axis("overlap / overlap_max"), force_axis, by_overlap)],
            file=False,
        ),
        Chart(
            "force",
            "Force against time",
            f"Contact force from first touch to the end of the contact at {said} m/s, as the engines compute it, "
            "over the peak and the contact time of theory.",
            [Panel(Axis("time / contact_time"), force_axis, by_time)],
            file=False,
        ),
    ]


def _theory_loops(x: Experiment, prediction: Prediction) -> list[Series]:
    """Loading and unloading of theory at each speed; none with adhesion or a dashpot."""
    if x.law.adheres or x.viscous_restitution is not None:
        return []
    law, series = x.backbone(), []
    for k, (speed, top) in enumerate(zip(prediction.speed, prediction.overlap_max, strict=True)):
        up = np.linspace(0.0, 1.0, 120)[1:] * top
        down = np.linspace(float(law.residual_overlap(top)), top, 120)[::-1]
        force = np.concatenate([law.force(up), law.unloading_force(down, np.full(down.shape, top))])
        overlap = np.concatenate([up, down]) / top
        series.append(Series(f"theory, {speed:.3g} m/s", overlap, force / prediction.force_max[k], k))
    return series


def _slip_line(x: Experiment, speed: float, psi_1: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """psi_1 and psi_2 of theory at a speed, on a grid over the range of psi_1: impacts without spin that slip so."""
    psi = np.linspace(psi_1.min(), psi_1.max(), SLIPS)
    friction = replace(x.friction_of_oblique(), angle=np.arctan(psi * oblique.unit(x)), spin=np.zeros(SLIPS))
    line = predict(replace(x, speed=np.full(SLIPS, speed), oblique=friction)).rebound
    assert line is not None
    return line.psi_1, line.psi_2


def slip(outcome: Outcome) -> Chart:
    """psi_2 against psi_1: theory with partial slip and the line of sliding; engines as points, errors below."""
    rows, colour = outcome.results.comparison, 0
    above: list[Series] = []
    below: list[Series] = []
    for law, prediction in outcome.predictions.items():
        r = prediction.rebound
        assert r is not None
        for speed in np.unique(prediction.speed):
            there = prediction.speed == speed
            name = f"partial slip, {law} {speed:.3g} m/s, e_n = {prediction.e_n[there][0]:.3f}"
            above.append(
                Series(name, *_slip_line(outcome.plans[law].experiment, speed, r.psi_1), colour % len(PALETTE))
            )
            part = rows[(rows["law"] == law) & (rows["speed"] == speed)]
            for k, (engine, points) in enumerate(part.groupby("engine", sort=False)):
                psi_1, own = points["psi_1"].to_numpy(), colour % len(PALETTE)
                above.append(
                    Series(str(engine) if colour == 0 else "", psi_1, points["psi_2"].to_numpy(), own, None, k)
                )
                below.append(Series("", psi_1, _visible(points["psi_2_error"]), own, None, k))
            colour += 1
    ends = rows["psi_1"].to_numpy()
    above.append(Series("", [ends.min(), ends.max()], [0.0, 0.0], GREY, "solid", width=0.6))
    if outcome.case.tolerances.psi_2 < np.inf:
        below.append(_tolerance(ends, outcome.case.tolerances.psi_2))
    before = Axis("psi_1: slip before the impact over mu v_n / kappa")
    return Chart(
        "psi",
        outcome.case.case.title,
        "Slip of the surfaces after oblique impacts against that before: theory with partial slip as lines, engines as "
        f"points. Below, the largest error over the starting phases, {rows['psi_2_error'].max():.1e} at most.",
        [Panel(before, Axis("psi_2: slip after the impact"), above, 3.0), Panel(before, _error("psi_2"), below, 1.4)],
        heading="Slip after against slip before",
    )
