# SPDX-License-Identifier: GPL-2.0-or-later
"""The tables of a crosscheck on the console."""

from typing import TYPE_CHECKING

from ..base.terminal import Shown, frame_table

if TYPE_CHECKING:  # slow to import
    import pandas as pd

VALUES = ["model", "check", "e_n", "e_n_theory", "contact_time", "force_max"]
VALUES += ["e_n_error", "contact_time_error", "force_max_error", "psi_2_error", "e_t_error", "order", "seconds"]
CHANGES = ["model", "unequal_error", "swap", "sort", "migration", "restart", "momentum"]
NOTE = """check: against the tolerances of the case; deviations of other codes are theirs and fail nothing.
unequal_error: of e_n of two spheres of unequal radii and moduli; swap to restart: changes of e_n in these variants of
the set-up; momentum: lost, as a share of one body's change. A serial YADE sorts nothing and has no ranks (-);
an embedded contact has neither ids nor restarts; inf: the run died or lost bodies."""


def crosscheck_tables(title: str, frame: "pd.DataFrame") -> list[Shown]:
    """The tables of a crosscheck: values and errors, then changes in variants of the set-up, and a note."""
    head = f"{title}: values at {frame['speed'].iloc[0]:.4g} m/s, largest errors over speeds and phases"
    values = frame[[name for name in VALUES if name in frame]].round({"order": 2, "seconds": 2})
    shown: list[Shown] = [frame_table(head, values, digits=6)]
    if not (changed := frame.reindex(columns=CHANGES).dropna(subset="momentum")).empty:
        shown.append(frame_table("Two spheres of unequal radii and moduli", changed, digits=2))
    return [*shown, NOTE]
