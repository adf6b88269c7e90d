# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of invariance in docs/evidence.md: which models give the same results in every set-up in LIGGGHTS.

Run: .venv/bin/python bench/liggghts_invariance.py
"""

import sys
import tempfile
from pathlib import Path

import pandas as pd

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "tests" / "engines")]

from pages import load, markdown, replace_tables, store  # noqa: E402
from plugin_decks import ADHESIVE, LAWS  # noqa: E402
from plugin_invariance import Suite  # noqa: E402

SLIPS = ("ep/thornton ep/partial_slip_2", "ep/cavity ep/partial_slip")  # with another tangential model than history
MODELS = (*(f"ep/{law}" for law in (*LAWS, *ADHESIVE)), *SLIPS, "hertz", "thornton_ning", "edinburgh")
COLUMNS = {  # of the page: the models of which it shows the largest deviation
    "laws of epdem": [m for m in MODELS if m.startswith("ep/") and m not in SLIPS],
    "with partial slip": [*SLIPS],
} | {name: [name] for name in MODELS if not name.startswith("ep/")}
ROWS = {  # of the page: the beginning of the names of its set-ups
    "momentum of a pair, 1 and 2 ranks": ("momentum",),
    "swap of i and j, lists built every step, local computes": ("swap", "neighbour list", "local"),
    "atoms sorted while touching": ("atoms sorted",),
    "migration between ranks, periodic face": ("migration", "periodic"),
    "run split in two, reset_timestep while touching": ("run split", "reset_timestep"),
    "restart, also on other ranks and with models from the file": ("restart",),
    "wall as a mesh, also with restart and 2 ranks": ("wall as", "mesh wall"),
    "rigid rotation, one revolution": ("rigid",),
    "second impact in one list": ("second",),
    "heap, other order of rows or ranks": ("heap, rows", "heap, 2 ranks"),
    "heap, more runs in place of one": ("heap, two runs in", "heap, runs of"),
}


def table(found: pd.DataFrame) -> pd.DataFrame:
    """The largest deviations by groups of set-ups and models; one digit each."""
    rows = []
    for title, heads in ROWS.items():
        part = found[found["set-up"].str.startswith(heads)]
        worst = {name: part[models].max().max() for name, models in COLUMNS.items()}
        rows.append({"set-up": title} | {name: "0" if v == 0 else f"{v:.0e}" for name, v in worst.items()})
    return pd.DataFrame(rows)


def main():
    with tempfile.TemporaryDirectory() as folder:
        columns = {}
        for model in MODELS:
            name, _, tangential = model.partition(" ")
            place = Path(folder) / model.replace("/", "-").replace(" ", "-")
            columns[model] = Suite(name, place, tangential or "history").deviations()
    worst = {
        m: {name: max(v for v in values if v is not None) for name, values in c.items()} for m, c in columns.items()
    }
    store("invariance", pd.DataFrame(worst).rename_axis("set-up").reset_index())
    replace_tables("evidence", {"invariance": markdown(table(load("invariance")))})


if __name__ == "__main__":
    main()
