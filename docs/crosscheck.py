# SPDX-License-Identifier: GPL-2.0-or-later
"""The table and figure of docs/crosscheck.md and docs/data/crosscheck.csv: three cases on every code.

Run: .venv/bin/python docs/crosscheck.py [--page]      (needs LIGGGHTS, LAMMPS and YADE; some minutes)
"""

import sys

import pandas as pd
from pages import DOCS, load, markdown, replace_tables, store

from epdem.report.chart import Axis, Chart, Panel, Series, save
from epdem.verification.engine_comparison import crosscheck
from epdem.verification.variants import VARIANTS

CASES = ("steel_wall", "two_materials", "oblique_steel")


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """One row per model: errors of e_n in each case, of the rest in all, and the largest change of e_n by a variant."""
    rows = rows[rows["model"] != "theory"]
    by = rows.groupby("model", sort=False)
    found = rows.pivot_table(index="model", columns="case", values="e_n_error", sort=False)
    found = found.reindex(columns=CASES).add_prefix("e_n: ")
    found["contact time"] = by["contact_time_error"].max()
    found["peak force"] = by["force_max_error"].max()
    found["psi_2"] = by["psi_2_error"].max()
    found["order"] = by["order"].first()
    changes = rows[list(VARIANTS)].max(axis=1)
    found["change"] = changes.groupby(rows["model"], sort=False).max()
    found["momentum"] = by["momentum"].max()
    return found.reset_index()


def chart(found: pd.DataFrame) -> Chart:
    """Errors of e_n by case, one line of the figure per model, the first at the top."""
    places = -found.index.to_numpy(float)
    errors = [Series(name, found[f"e_n: {name}"].to_numpy(), places, k, None, k) for k, name in enumerate(CASES)]
    lines = Axis("", low=places.min() - 0.5, high=0.5, ticks=dict(zip(places, found["model"], strict=True)))
    return Chart(
        "crosscheck",
        "Laws of epdem in four codes, and laws of other codes",
        "Largest error of e_n of every model in three cases; the four engines of epdem lie on each other.",
        [Panel(Axis("largest error of $e_n$", log=True, low=1e-6, high=1.0), lines, errors)],
    )


def main() -> None:
    """Run the cases (not with `--page`); write the table of all numbers, the table of the page and the figure."""
    if sys.argv[1:] != ["--page"]:
        found = [crosscheck(DOCS.parent / f"cases/{name}.toml").table.assign(case=name) for name in CASES]
        store("crosscheck", pd.concat(found, ignore_index=True))
    shown = table(load("crosscheck"))
    cases = [f"e_n: {name}" for name in CASES]
    short = shown.drop(columns=cases)
    short.insert(1, "e_n", shown[cases].max(axis=1))
    replace_tables("crosscheck", {"models": markdown(short)})
    save(chart(shown), DOCS / "figures", data=False)


if __name__ == "__main__":
    main()
