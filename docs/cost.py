# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/cost.md, its figure and its tables in docs/data: error against run time of every law.

Run: .venv/bin/python docs/cost.py      (needs LIGGGHTS; some minutes)
"""

import pandas as pd
from pages import DOCS, load, markdown, store

from epdem.engines import scene_engine
from epdem.report.chart import save
from epdem.verification import cost
from epdem.verification.cost import EXPONENT, REFERENCE
from epdem.verification.cost_report import chart, tables
from epdem.verification.stability.bulk import convergence

NAMES = ("cost", "cost_models", "cost_bulk")  # errors of impacts by steps, their summary, the bulk scene
LAWS = ["thornton", "cavity", "johnson", "hertz"]  # of the bulk scene; impacts have meyer, too

TEXT = """# Accuracy and cost

`.venv/bin/python docs/cost.py` writes this page, its figure and the tables in `docs/data`.

The case is `steel_wall`: impacts of a steel sphere on a steel wall at 0.09 to 268 times the yield speed. Errors are
maxima over all speeds and starting phases. Times are medians of the loop time of the engine in interleaved runs without
output. Absolute times depend on the machine and its load. The figure of merit is the ratio to LIGGGHTS's own elastic
`hertz` (`{reference}`) in the same run, from 300 steps in contact on. `meyer` has a hardening exponent of {exponent}.

![error of e_n against stepping time and steps](figures/cost.png)

- `best_error`: smallest error of e_n up to {most} steps; `order`: that of its fall with the steps.
- `steps_for_E`: smallest number of steps in contact with an error of e_n of at most E; a dash: none.

{models}

[cost.csv](data/cost.csv) has the errors of e_n, contact time and peak force (maximum and root of the mean square) at
every number of steps; [cost_models.csv](data/cost_models.csv) has the stepping time, start and set-up [ns, s].

## A bulk scene

Two blocks of {spheres} steel spheres collide at 300 m/s. The table shows the rms error of the plastic work of single
spheres over the mean, against a run at a quarter of the finest step, and the order between the last two steps. The
steps are fractions of the smallest stability limit of these laws at 300 m/s. [cost_bulk.csv](data/cost_bulk.csv) also
has the error of the mean. [Speed](speed.md) has the run times of beds.

{scene}
"""


def document(errors: pd.DataFrame, models: pd.DataFrame, scene: pd.DataFrame) -> str:
    """The text of docs/cost.md from the tables of docs/data."""
    shown = ["model", "order", "best_error", "ns_per_step", "ratio_to_hertz"]
    shown += [name for name in models if name.startswith("steps_for")]
    wide = scene.pivot_table(index="model", columns="share", values="rms", sort=False)
    wide = wide[sorted(wide, reverse=True)].assign(order=scene.groupby("model", sort=False)["order"].last())
    return TEXT.format(
        reference=REFERENCE,
        exponent=EXPONENT,
        most=errors["steps"].max(),
        models=markdown(models[shown]),
        spheres=scene["spheres"].iloc[0],
        scene=markdown(wide.reset_index()),
    )


def main() -> None:
    """Run impacts and the bulk scene; write tables, figure and page."""
    outcome = cost.run(
        DOCS.parent / "cases/steel_wall.toml", engines=["embedded", "liggghts"], laws=[*LAWS, "meyer"], repetitions=3
    )
    save(chart(outcome), DOCS / "figures", data=False)
    for name, table in zip(NAMES, tables(outcome, convergence(LAWS, scene_engine("liggghts"))).values(), strict=True):
        store(name, table)
    (DOCS / "cost.md").write_text(document(*map(load, NAMES)), encoding="utf-8")


if __name__ == "__main__":
    main()
