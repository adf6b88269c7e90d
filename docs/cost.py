# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/cost.md, its figure and tables, and data/step_times.csv: error against run time of every law in every host.

Run: .venv/bin/python docs/cost.py [--page]      (needs LIGGGHTS, LAMMPS and YADE; a quarter of an hour)
"""

import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from pages import DOCS, load, markdown, store

from epdem.case.impact import load as load_case
from epdem.engines import scene_engine
from epdem.report.chart import save
from epdem.scenes.plan.timestep import stable_step
from epdem.scenes.run import run_plan
from epdem.scenes.tables.columns import last_frame
from epdem.theory.backbones import ADHESIVE, LAWS
from epdem.verification import cost
from epdem.verification.cost import EXPONENT, REFERENCE, chart, tables
from epdem.verification.stability.bulk import convergence, scene_case, with_step

NAMES = ("cost", "cost_models", "cost_bulk", "cost_bed")  # errors of impacts by steps, their summary, the bulk scenes
HOSTS = ["embedded", "liggghts", "lammps", "yade"]
OTHERS = {"liggghts-hertz": "LIGGGHTS's `hertz`", "lammps-hertz": "LAMMPS's `hertz/material`"}
OTHERS |= {"lammps-mdr": "LAMMPS's `mdr`", "yade-mindlin": "YADE's Mindlin"}
YIELDING = ["thornton", "cavity", "johnson"]  # of the bulk scenes
CASES = DOCS.parent / "cases"
WEAKER = "cavity_adhesive"  # the work of adhesion of the case is close to its limit
STEPS = (10, 17, 30, 55, 100, 170, 300, 550, 1000)
OUTPUT = {"rows": 400, "particles": 1, "energy": True, "loads": True}
SHARES = (0.2, 0.1, 0.05, 0.025, 0.0125)  # of the stability limit, of the bed

TEXT = """# Accuracy and cost

`.venv/bin/python docs/cost.py` writes this page, its figure and the tables in `docs/data`.

The case is `steel_wall`: impacts of a steel sphere on a steel wall at 0.09 to 268 times the yield speed
(`adhesion_thornton_1998` for `jkr` and `thornton_ning`, with half of its work of adhesion for `cavity_adhesive`).
Errors are maxima over all speeds and 8 starting phases. Times are medians of the loop time of interleaved runs without
output, from {timed} steps in contact on. Absolute times depend on the machine and its load; the figure of merit is the
ratio to LIGGGHTS's own elastic `hertz` (`{reference}`) in the same run. `meyer` has a hardening exponent of {exponent}.
The same law has the same error in every host. The error of LAMMPS's `mdr` is the error against its own limit of small
steps.

![error of e_n against time and steps](figures/cost.png)

The table shows the steps in the shortest contact for a largest error of e_n (the first of
{steps}) and the run time in each host over the time of
`{reference}` with the same error of 0.1 %; a dash: not there. LIGGGHTS's own `thornton_ning` reaches
none of these errors.

{models}

`epdem run CASE --error 1e-3` finds the step for an error, and prints the cost from the ratios per step in
`data/step_times.csv`, which this command writes; `epdem predict CASE --error 1e-3` prints both without a run. The
measured error lies between 0.5 and 1.5 of the requested one (`tests/engines/test_error_option.py`) unless five steps
in contact, the smallest number, are more accurate. [cost.csv](data/cost.csv) has the errors of e_n, contact time and
peak force at every number of steps, [cost_models.csv](data/cost_models.csv) order and times [ns] of every model.

## Scenes

Two blocks of {spheres} steel spheres collide at 300 m/s. The table shows the rms error of the plastic work of single
spheres over the mean, against a run at a quarter of the finest step, and the order between the last two steps. The
steps are fractions of the smallest stability limit of these laws at 300 m/s ([cost_bulk.csv](data/cost_bulk.csv)).

{scene}

A plate presses {bed_spheres} steel spheres in LIGGGHTS. The table shows the largest change over the laws when the step
is halved, relative to the quantity: density of the bed (from the mean height of its spheres), mean force on the plate
in the second half of the stroke, plastic work ([cost_bed.csv](data/cost_bed.csv)). The changes of the force do not fall
with the step: spheres that meet one another at random take other paths after any change. [Speed](speed.md) has the run
times of beds.

{bed}
"""


def _ten(models: pd.DataFrame) -> pd.DataFrame:
    """A line for each law, and for each model of other codes: steps for an error, cost in each host."""
    models = models.set_index("model")
    targets = [name for name in models if name.startswith("steps_for")]
    steps = models["steps_for_0.001"]
    costs = models["ratio_to_hertz"] * steps / steps.get(REFERENCE, np.nan)
    rows: dict[str, dict] = {}
    for label, model in models[models["steps_for_0.01"].notna()].iterrows():
        engine, _, law = str(label).partition(", ")
        host = engine.split("-")[0]
        name = law or OTHERS.get(engine, engine)
        rows.setdefault(name, {"law": name} | {t: model[t] for t in targets})[host] = costs[label]
    return pd.DataFrame(list(rows.values())).rename(columns=lambda c: c.replace("steps_for_", "steps for "))


def document(errors: pd.DataFrame, models: pd.DataFrame, scene: pd.DataFrame, bed: pd.DataFrame) -> str:
    """The text of docs/cost.md from the tables of docs/data."""
    wide = scene.pivot_table(index="model", columns="share", values="rms", sort=False)
    wide = wide[sorted(wide, reverse=True)].assign(order=scene.groupby("model", sort=False)["order"].last())
    halved = bed.groupby("share", sort=False)[["density", "force", "plastic_work"]].max().reset_index()
    return TEXT.format(
        reference=REFERENCE,
        exponent=EXPONENT,
        timed=cost.TIMED,
        steps=", ".join(map(str, sorted(errors["steps"].unique()))),
        models=markdown(_ten(models)),
        spheres=scene["spheres"].iloc[0],
        scene=markdown(wide.reset_index()),
        bed_spheres=bed["spheres"].iloc[0],
        bed=markdown(halved),
    )


def bed_convergence(laws: list[str], lattice: tuple[int, int, int] = (6, 6, 12)) -> pd.DataFrame:
    """Change of density, force and plastic work of a pressed bed from each share of the stability limit to its half."""
    rows = []
    for law in laws:
        with tempfile.TemporaryDirectory(prefix="epdem-bed-") as scratch:
            case = scene_case("plate", law, Path(scratch), lattice=lattice, **OUTPUT)
            found = {}
            for share in (*SHARES, SHARES[-1] / 2):
                p = with_step(case, share * stable_step(case, 0.0))
                done = run_plan(p, scene_engine("liggghts"), Path(scratch))
                last, force = last_frame(done["particles"]), done["rows"]["plate_force_z"].to_numpy()
                numbers = 1.0 / last["z"].mean(), force[len(force) // 2 :].mean(), last["plastic_work"].sum()
                found[share] = np.array(numbers)
        for share in SHARES:
            change = np.abs(found[share] / found[share / 2] - 1.0)
            names = dict(zip(("density", "force", "plastic_work"), change, strict=True))
            rows.append({"law": law, "spheres": len(last), "share": share} | names)
    return pd.DataFrame(rows)


def joined(plain: cost.Outcome, *others: cost.Outcome) -> cost.Outcome:
    """The first outcome with the rows of the others, whose reference is its own."""
    rows, models = (
        pd.concat([a, *(b[~b["model"].isin(a["model"])] for b in more)], ignore_index=True)
        for a, *more in zip(*((o.rows, o.models) for o in (plain, *others)), strict=True)
    )
    return replace(plain, rows=rows, models=models)


def main() -> None:
    """Run impacts and the bulk scenes; write tables, figure and page. --page: write figure and page from the tables."""
    if "--page" not in sys.argv:
        laws = [name for name in LAWS]
        plain = cost.run(CASES / "steel_wall.toml", engines=HOSTS, laws=laws, steps=STEPS, progress=print)
        sticky = CASES / "adhesion_thornton_1998.toml"
        with tempfile.TemporaryDirectory(prefix="epdem-cost-") as scratch:
            weaker = Path(scratch) / sticky.name
            weaker.write_text(sticky.read_text(encoding="utf-8").replace("0.2 J/m^2", "0.1 J/m^2"), encoding="utf-8")
            of_path = {sticky: [law for law in ADHESIVE if law != WEAKER], weaker: [WEAKER]}
            found = [
                cost.run(path, engines=HOSTS, laws=laws, steps=STEPS, progress=print) for path, laws in of_path.items()
            ]
        outcome = joined(plain, *found)
        bulk = convergence(YIELDING, scene_engine("liggghts"))
        for name, table in zip(NAMES, [*tables(outcome).values(), bulk, bed_convergence(YIELDING)], strict=True):
            store(name, table)
    errors, models, *scenes = map(load, NAMES)
    save(chart(errors, load_case(CASES / "steel_wall.toml").case.title), DOCS / "figures", data=False)
    parts = models["model"].str.partition(", ")
    ratios = pd.DataFrame({"engine": parts[0], "law": parts[2], "ratio": models["ratio_to_hertz"]})
    ratios[ratios["law"] != ""].to_csv(DOCS.parent / "data/step_times.csv", index=False, lineterminator="\n")
    (DOCS / "cost.md").write_text(document(errors, models, *scenes), encoding="utf-8")


if __name__ == "__main__":
    main()
