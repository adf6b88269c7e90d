# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of docs/crosscheck.md and docs/data/crosscheck.csv: three cases on every code.

Run: .venv/bin/python docs/crosscheck.py      (needs LIGGGHTS, LAMMPS and YADE; some minutes)
"""

import pandas as pd
from pages import DOCS, load, markdown, replace_tables, store

from epdem.verification.engine_comparison import crosscheck
from epdem.verification.invariance.pairs import VARIANTS

CASES = ("steel_wall", "two_materials", "oblique_steel")


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """One row per model: errors of each case, and the largest change of e_n by a variant of the set-up."""
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


def main() -> None:
    """Run the cases; write the table of all numbers and the table of the page."""
    found = [crosscheck(DOCS.parent / f"cases/{name}.toml").table.assign(case=name) for name in CASES]
    store("crosscheck", pd.concat(found, ignore_index=True))
    replace_tables("crosscheck", {"models": markdown(table(load("crosscheck")))})


if __name__ == "__main__":
    main()
