# SPDX-License-Identifier: GPL-2.0-or-later
"""The pages of `epdem verify`: crosscheck, cost, stability, data."""

from dataclasses import replace
from pathlib import Path

from ..impacts.measurement import UNITS
from ..report import pages as common
from ..report.chart import GREY, Axis, Chart, Panel, Series
from ..report.page import Facts, Page, Part, Rows
from .cost import Outcome as Cost
from .cost import chart
from .cost import tables as tables_of_cost
from .engine_comparison import Crosscheck
from .measured_data import Validation
from .stability.suite import Outcome as Stability
from .stability.suite import summary

LABELS = {"e_n": "e_n", "dent_width": "width of the dent [m]"}


def of_crosscheck(check: Crosscheck) -> Path:
    """Write the page of a run on all engines with the table of models in front."""
    base = common.impacts_page(check.outcome)
    models = len(check.table) - 1
    said = [f"{models} models ran the case; their values are those at {check.table['speed'].iloc[0]:.4g} m/s."]
    if check.others_outside:
        said.append(
            f"Models of other codes outside of the tolerances of the case: {', '.join(check.others_outside)}. "
            "The verdict counts epdem's engines only."
        )
    note = "Errors are the largest over speeds and phases; swap to restart: changes of e_n in variants of the set-up."
    parts: list[Part] = [Rows("All models", check.table, UNITS, note)]
    parts += [Facts("Laws and theories of their own", check.notes)] if check.notes else []
    parts += [Facts("Left out", check.absent)] if check.absent else []
    page = replace(base, sentences=[*said, *base.sentences], parts=parts + base.parts, passed=check.passed)
    return common.write_study_page(page, check.outcome.folder, ("png",))


def _study_page(title: str, sentence: str, parts: list[Part], *, passed: bool | None = None) -> Page:
    every = [*parts, common.origin({}, {})]
    return Page(title, [sentence], every, passed=passed, command=common.command())


def of_cost(outcome: Cost, folder: Path) -> Path:
    """Write the page of error against run time."""
    _, *tables = tables_of_cost(outcome).items()
    parts: list[Part] = [
        chart(outcome.rows, outcome.case.case.title),
        *(Rows(title, table) for title, table in tables),
    ]
    parts.append(Rows("Errors and times", outcome.rows, {"ns_per_impact": "ns"}))
    names, steps = ", ".join(outcome.models["model"]), outcome.rows["steps"].nunique()
    said = f"Error of e_n and stepping time of {names} at {steps} numbers of steps in contact."
    title = f"{outcome.case.case.title}: error against run time"
    return common.write_study_page(_study_page(title, said, parts), folder)


def of_stability(outcome: Stability, folder: Path) -> Path:
    """Write the page of the extreme cases."""
    verdicts = outcome.verdicts
    tables = {"By engine and law": summary(verdicts), "Every case": verdicts}
    tables |= {"Round-off": outcome.roundoff, "Bulk scenes": outcome.bulk}
    parts: list[Part] = [Rows(title, table) for title, table in tables.items() if not table.empty]
    count = verdicts["status"].value_counts()
    said = f"{len(verdicts)} extreme cases: " + ", ".join(f"{n} {status}" for status, n in count.items()) + "."
    page = _study_page("Stiff and extreme cases", said, parts, passed=outcome.passed)
    return common.write_study_page(page, folder)


def validation_chart(v: Validation) -> Chart:
    """Value of the first engine over the measured value, for every law and point."""
    points = v.points[v.points["engine"] == v.points["engine"].iloc[0]]
    series = [
        Series(law, own["number"].to_numpy(float), 1.0 + own["error"].to_numpy(float), k, None, k)
        for k, (law, own) in enumerate(points.groupby("law", sort=False))
    ]
    series.append(Series("measured", [1.0, float(points["number"].max())], [1.0, 1.0], GREY, "solid", width=0.8))
    first = points.drop_duplicates("number")
    names = ", ".join(f"{r.number} {r.set} {LABELS[r.quantity]} {r.measured:g}" for r in first.itertuples())
    alt = f"Law over measured value for every law; the measured numbers are {names}."
    x = Axis("measured number, in the order of the table")
    return Chart("validate", "Laws against measured impacts", alt, [Panel(x, Axis("law over measured"), series)])


def of_validation(v: Validation) -> Path:
    """Draw the figure of measured sets and write their page into the folder of the study."""
    chart = validation_chart(v)
    parts: list[Part] = [chart, Rows("By set, law and engine", v.summary), Rows("Every point", v.points)]
    parts += [Facts(one.head["title"], {k: one.head[k] for k in ("source", "material", "read")}) for one in v.sets]
    parts += [Facts("Left out", v.absent)] if v.absent else []
    said = f"{len(v.points)} comparisons with measured numbers; nothing is fitted, and no law has a tolerance here."
    return common.write_study_page(_study_page("Laws against measured impacts", said, parts), v.folder, ("png",))
