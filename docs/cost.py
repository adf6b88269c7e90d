# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/cost.md and its figure: error against run time of every law, for impacts and for a bulk scene.

Run: .venv/bin/python docs/cost.py      (needs LIGGGHTS; some minutes)
"""

from pathlib import Path

import pandas as pd
from pages import markdown

from epdem.studies import cost
from epdem.studies.cost import REFERENCE, Outcome
from epdem.studies.cost_report import bulk_table, cheapest_table, error_table, figure
from epdem.studies.stability import bulk_cost

DOCS = Path(__file__).parent
LAWS = ["thornton", "cavity", "johnson", "hertz"]

BULK = """
## A bulk scene

The same question for two blocks of {spheres} steel spheres together that meet at 300 m/s: the error of the plastic
work, of its mean and (rms) of single spheres, both over the mean, against a run at a quarter of the finest step; the
engine's loop time in runs that record nothing, not even that work, and the same over that of LIGGGHTS's own elastic
`hertz` (`{reference}`) with the same steps (medians of interleaved runs and half the distance of the
quartiles). `order` is that of the rms between neighbouring rows; the error of the mean may pass through zero. Steps are
shares of the smallest of all these laws' stability limits at 300 m/s. Elastic spheres fly on and collide with others,
yielding ones stay together: the ratio is that of the scenes, not of the models alone. Hertz contacts dissipate nothing.

{table}
"""


def document(outcome: Outcome, bulk: pd.DataFrame | None, command: str) -> str:
    """The text of docs/cost.md."""
    text = f"""# Error against run time

Written by

    {command}

(case `{outcome.case.name}`, {outcome.seconds:.0f} s). Errors are those of
the worst speed and phase of the case; times are medians of interleaved
runs that record nothing, stepping alone (the engine's own loop time). Absolute times belong to one machine and what
else it did; the ratio to LIGGGHTS's own elastic `hertz` (`{REFERENCE}`) in the same run
is the figure of merit (median and half the distance of the quartiles, from 300 steps in contact on).

{markdown(cheapest_table(outcome.models))}

`not reached`: no number of steps up to {outcome.rows["steps"].max()} keeps e_n within that error.

![error of e_n against stepping time and steps](figures/cost.png)

## All errors

{markdown(error_table(outcome.rows))}
"""
    if bulk is not None:
        text += BULK.format(spheres=bulk["spheres"].iloc[0], reference=REFERENCE, table=markdown(bulk_table(bulk)))
    return text


def main() -> None:
    """Run impacts and the bulk scene; write page and figure."""
    case = DOCS.parent / "cases/steel_wall.toml"
    outcome = cost.run(case, engines=["embedded", "liggghts"], laws=LAWS, repetitions=3)
    figure(outcome, DOCS / "figures/cost.png")
    (DOCS / "cost.md").write_text(document(outcome, bulk_cost.run(LAWS), "python docs/cost.py"))


if __name__ == "__main__":
    main()
