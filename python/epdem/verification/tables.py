# SPDX-License-Identifier: GPL-2.0-or-later
"""DataFrames as tables on the console."""

import math
from typing import TYPE_CHECKING

from rich.table import Table

from ..base.terminal import table

if TYPE_CHECKING:  # slow to import
    import pandas as pd

_VALUES = {
    "model": "model",
    "e_n": "e_n",
    "e_n_theory": "its theory",
    "contact_time": "t_c [us]",
    "force_max": "F_max [N]",
    "e_n_error": "error e_n",
    "contact_time_error": "t_c",
    "force_max_error": "F_max",
    "psi_2_error": "psi_2",
    "e_t_error": "e_t",
    "order": "order",
    "seconds": "s",
    "check": "check",
}
_CHANGES = {
    "model": "model",
    "unequal_error": "error",
    "swap": "swap",
    "sort": "sort",
    "migration": "migration",
    "restart": "restart",
    "momentum": "momentum",
}
_CHECK_NOTE = "check: against the tolerances of the case; deviations of other codes are theirs and fail nothing"
_CHANGES_TITLE = "Two spheres of unequal radii and moduli"
_CHANGES_NOTE = """error: of e_n; swap to restart: changes of e_n in these variants of the set-up;
momentum: lost, as a share of one body's change. A serial YADE sorts nothing and has no ranks (-);
an embedded contact has neither ids nor restarts."""


def cell(value: object) -> str:
    """A table cell: three digits, a dash for NaN."""
    if isinstance(value, float):
        return "-" if math.isnan(value) else f"{value:.3g}"
    return str(value)


def frame_table(title: str, frame: "pd.DataFrame") -> Table:
    """A DataFrame as a table."""
    shown = table(title, map(str, frame.columns))
    for row in frame.itertuples(index=False):
        shown.add_row(*map(cell, row))
    return shown


def _crosscheck_cell(name: str, value: object) -> str:
    if not isinstance(value, float):
        return str(value)
    if value != value:
        return "-"
    if value == float("inf"):
        return "failed"
    if name == "contact_time":
        return f"{value * 1e6:.4g}"
    if name in ("e_n", "e_n_theory", "force_max", "order", "seconds"):
        return f"{value:.{2 if name in ('order', 'seconds') else 6}{'f' if name != 'force_max' else 'g'}}"
    return "0" if value == 0 else f"{value:.1e}"


def _crosscheck_table(title: str, heads: dict[str, str], frame: "pd.DataFrame") -> Table:
    names = [name for name in heads if name in frame]
    shown = table(title, [heads[name] for name in names], left=("model",))
    for row in frame[names].to_dict("records"):
        shown.add_row(*(_crosscheck_cell(str(name), value) for name, value in row.items()))
    return shown


def crosscheck_tables(title: str, frame: "pd.DataFrame") -> list[Table | str]:
    """The tables of a crosscheck with a note below each: values and errors, and changes in variants of the set-up."""
    head = f"{title}: values at {frame['speed'].iloc[0]:.4g} m/s, largest errors over speeds and phases"
    shown: list[Table | str] = [_crosscheck_table(head, _VALUES, frame)]
    if not (changed := frame.dropna(subset="momentum")).empty:
        shown += [_crosscheck_table(_CHANGES_TITLE, _CHANGES, changed), _CHANGES_NOTE]
    return [*shown, _CHECK_NOTE]
