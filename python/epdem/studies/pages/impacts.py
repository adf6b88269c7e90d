# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a run of impacts."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...base.files import claim
from ...base.tables import unit_of
from ...case.impact import load
from ...engines.reasons import citations
from ...impacts import charts
from ...impacts.comparison import CHECKED, UNITS
from ...impacts.experiment import Body, Experiment
from ...impacts.prediction import predict
from ...impacts.report import against_measured, mark, worst, yielding
from ...impacts.run import Outcome
from ...laws.strengths import law_named
from ...report.chart import Axis, Chart, Panel, Series
from ...report.page import NAME, Facts, Lines, Page, Part, Rows, write
from ..calibrate import Calibration, experiment
from . import common

COLUMNS = ("engine", "law", "speed", *(f"{n}{k}" for n in CHECKED for k in ("", "_theory", "_error")))
OBLIQUE = ("angle", "spin_before", "e_t", "e_t_theory", "psi_1", "psi_2", "psi_2_theory", "psi_2_error", "spin")


def of_impacts(outcome: Outcome) -> Path:
    """Write report.html into the folder of a run; its path."""
    said = common.command()
    with claim(outcome.folder, force=True):
        digest = mark(outcome, said, NAME)
        return write(outcome.folder / NAME, lambda: page(outcome, said), mark=digest)


def of_calibration(case: Path, found: Calibration, folder: Path, *, force: bool = False) -> Path:
    """Write the page of a strength that was found for a case into `folder`: the curve e_n(v) that it gives.

    Raises CaseError for a folder with a page of another kind, without `force`.
    """
    x = experiment(case, found)
    middle = found.speed or np.median([speed for speed, _ in found.measured] or [found.yield_speed])
    line = replace(x, speed=np.geomspace(0.1, 100.0, 200) * middle)
    series = [Series("theory", line.speed, predict(line).e_n)]
    points = found.measured or (((found.speed, found.e_n),) if found.speed and found.e_n else ())
    if points:
        speeds, values = np.array(points).T
        series.append(Series("measured", speeds, values, 1, None, charts.MEASURED))
    alt = f"Coefficient of restitution of law {found.law} with {found.parameter} = {found.value:.4g} Pa against speed."
    chart = Chart("e_n", "Restitution with this strength", alt, [Panel(charts.SPEED, Axis("e_n"), series)])
    bare = [replace(b, yield_stress=None) for b in (x.body, x.target)]  # whose own strength plays no part
    facts = Facts("Bodies and law", _facts(replace(x, body=bare[0], target=bare[1], source=found.source)))
    parts: list[Part] = [
        chart,
        facts,
        common.origin({}, {}),
        Facts("What to cite", citations(load(case), [found.law], [])),
    ]
    said = sentences_of_calibration(found)
    made = Page(f"Strength of law {found.law} from {found.source}", said, parts, command=common.command())
    with claim(folder, force=force, files=[NAME]):
        return write(folder / NAME, lambda: made)


def sentences_of_calibration(c: Calibration) -> list[str]:
    """What was found, with its standard errors, and the lines of the case file."""
    lines = [f'{c.parameter} = "{c.value / 1e6:.6g} MPa"']
    errors, more = "", ""
    if c.hardening_exponent is not None and c.standard_errors is not None:
        lines.append(f"hardening_exponent = {c.hardening_exponent:.4g}")
        errors = f" +- {c.standard_errors[0] / 1e6:.2g} MPa"
        fits = f"largest residual of e_n {c.largest_residual:.2g} standard errors"
        if c.scatter is not None:
            fits = f"scatter of e_n about the fit {c.scatter:.2g}, to be compared with the error of the measurement"
        more = (
            f", hardening_exponent = {c.hardening_exponent:.4g} +- {c.standard_errors[1]:.2g} (standard errors, "
            f"correlation {c.correlation:.3f}; {fits})"
        )
    return [
        f"law {c.law}, {c.source}: {c.parameter} = {c.value / 1e6:.6g} MPa{errors}{more}, "
        f"that is yield_stress = {c.yield_stress / 1e6:.6g} MPa, yield speed {c.yield_speed:.4g} m/s",
        f"in the case file, under [law]: {'; '.join(lines)}",
    ]


def page(outcome: Outcome, command: str = "") -> Page:
    """The page of a run."""
    results, several = outcome.results, len(outcome.plans) > 1
    parts: list[Part] = [*figures(outcome), table(outcome)]
    for law, p in outcome.plans.items():
        parts.append(Facts("Bodies and law" + f" {law}" * several, _facts(p.experiment)))
    allowed = {name: f"{value:g}" for name, value in outcome.case.check.model_dump().items()}
    parts += [Facts("Tolerances of the case", allowed), common.case_lines(results.case_text), *decks(outcome)]
    return common.page_of(
        outcome,
        sentences(outcome),
        parts,
        hashes={key: run["inputs"] for key, run in results.runs.items()},
        laws=list(outcome.plans),
        engines=list(dict.fromkeys(results.comparison["engine"])),
        command=command,
    )


def sentences(outcome: Outcome) -> list[str]:
    """What ran and came out, in words."""
    rows, said = outcome.results.comparison, []
    for law, p in outcome.plans.items():
        speed, prediction = p.experiment.speed, outcome.predictions[law]
        span = f"{speed.min():.4g} to {speed.max():.4g} m/s" if speed.size > 1 else f"{speed[0]:.4g} m/s"
        said.append(
            f"Law {law}: {speed.size} impacts at {span}, each from {p.phases} starting phases within a step of "
            f"{p.time_step:.4g} s; {yielding(prediction)}. e_n of theory goes from {prediction.e_n.max():.4f} to "
            f"{prediction.e_n.min():.4f}."
        )
    said += [f"Engine {line}." for line in worst(outcome)]
    said += [line[0].upper() + line[1:] + "." for line in against_measured(outcome)]
    residual = rows["energy_residual"].abs().max()
    if residual == residual:
        said.append(f"The energy balance of an impact closes within {residual:.1e} of its kinetic energy.")
    return said


def figures(outcome: Outcome) -> list[Chart]:
    """The figures of the page."""
    return [charts.main_chart(outcome), charts.errors(outcome), *charts.loops(outcome)]


def table(outcome: Outcome) -> Rows:
    """All rows of the comparison."""
    rows = outcome.results.comparison
    columns = [*COLUMNS[:3], *(k for k in OBLIQUE if k in rows), *COLUMNS[3:], "steps_in_contact", "passed"]
    note = "Means over the phases; errors are the largest over the phases. A click on a heading sorts."
    units = {name: unit_of(name, UNITS) for name in columns}
    return Rows("Measured and predicted", rows[columns], units, note)


def _facts(x: Experiment) -> dict[str, str]:
    facts = {"body": _body(x.body), "target": _body(x.target), "law": x.law.name}
    units = {p.name: p.unit for p in law_named(x.law.name).parameters if p.unit != "1"}
    facts |= {name: f"{value:.6g} {units.get(name, '')}".rstrip() for name, value in x.law.parameters.items()}
    facts |= {"E*": f"{x.E_star:.6g} Pa", "R*": f"{x.R_star:.6g} m", "m*": f"{x.m_star:.6g} kg"}
    v_y0 = charts.first_yield(x)
    facts |= {"speed of first yield (8.84, 1.60 Y)": f"{v_y0:.4g} m/s"} if v_y0 == v_y0 else {}
    return facts | {"source": x.source}


def _body(b: Body) -> str:
    shape = f"sphere, R = {b.radius:.6g} m" if b.radius < float("inf") else "wall"
    if b.rigid:
        return f"{shape}, rigid"
    strength = "" if b.yield_stress is None else f", Y = {b.yield_stress:.4g} Pa"
    return f"{shape}, {b.material}: E = {b.young_modulus:.4g} Pa, nu = {b.poisson_ratio:g}{strength}"


def decks(outcome: Outcome) -> list[Lines]:
    """Every deck that ran, line by line, with the reasons that the templates of the engine state."""
    stored: dict[tuple[str, str], dict[str, str]] = {}
    for key, text in outcome.results.decks.items():
        law, engine, name = key.split("/", 2)
        stored.setdefault((law, engine), {})[name] = text
    return [
        lines
        for (law, engine), texts in stored.items()
        for lines in common.decks(engine, outcome.plans.get(law), texts, f" of {engine}, law {law}")
    ]
