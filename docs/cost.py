# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/cost.md and its figure: error against run time of every law, for impacts and for a bulk scene.

Run: .venv/bin/python docs/cost.py      (needs LIGGGHTS; some minutes)
"""

from pathlib import Path

import pandas as pd
from pages import markdown

from epdem.engines import scene_engine
from epdem.report.chart import save
from epdem.verification import cost
from epdem.verification.cost import EXPONENT, REFERENCE, Outcome
from epdem.verification.cost_report import chart, tables
from epdem.verification.stability.bulk import convergence

DOCS = Path(__file__).parent
LAWS = ["thornton", "cavity", "johnson", "hertz"]  # of the bulk scene; impacts have meyer, too

BULK = """
## A bulk scene

The scene consists of two blocks of {spheres} steel spheres that collide at 300 m/s. The table shows the error of the
plastic work against a run at a quarter of the finest step: the `error` of the mean and the `rms` error of single
spheres, both over the mean. `order` is the order of the rms error between neighbouring rows. Steps are shares of the
smallest stability limit of these laws at 300 m/s. [speed.md](speed.md) has the run times of beds.

{table}
"""


def document(outcome: Outcome, bulk: pd.DataFrame | None, command: str) -> str:
    """The text of docs/cost.md."""
    errors, models, *scene = (markdown(table) for table in tables(outcome, bulk).values())
    text = f"""# Accuracy and cost

This command writes the page:

```sh by hand
{command}
```

The case is `{outcome.case.name}` ({outcome.seconds:.0f} s). Errors are maxima over all speeds and phases. Times are
medians of the loop time of the engine in interleaved runs without output. Absolute times depend on the machine and its
load. The figure of merit is the ratio to LIGGGHTS's own elastic `hertz` (`{REFERENCE}`) in the same run: median and
distance of the quartiles, from 300 steps in contact on. `meyer` has a hardening exponent of {EXPONENT}.

- `best_error`: smallest error of e_n; `order`: that of its fall with the steps.
- `steps_for_0.01`, `ns_for_0.01`: coarsest steps in contact for an error of e_n of 1 %, and their stepping time of an
  impact [ns].
- `startup`, `setup`: of the engine [s].
- A dash: no number of steps up to {outcome.rows["steps"].max()} keeps e_n within the error; the error has no order.

{models}

![error of e_n against stepping time and steps](figures/cost.png)

`.venv/bin/python docs/cost.py` draws this figure.

## All errors

Errors are relative, the largest and the root of the mean square.

{errors}
"""
    if bulk is not None:
        text += BULK.format(spheres=bulk["spheres"].iloc[0], table=scene[0])
    return text


def main() -> None:
    """Run impacts and the bulk scene; write page and figure."""
    case = DOCS.parent / "cases/steel_wall.toml"
    outcome = cost.run(case, engines=["embedded", "liggghts"], laws=[*LAWS, "meyer"], repetitions=3)
    save(chart(outcome), DOCS / "figures", data=False)
    (DOCS / "cost.md").write_text(
        document(outcome, convergence(LAWS, scene_engine("liggghts")), ".venv/bin/python docs/cost.py")
    )


if __name__ == "__main__":
    main()
