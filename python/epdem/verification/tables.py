# SPDX-License-Identifier: GPL-2.0-or-later
"""DataFrames as tables on the console."""

import math
from typing import TYPE_CHECKING

from rich.table import Table

from ..base.terminal import table

if TYPE_CHECKING:  # slow to import
    import pandas as pd


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
