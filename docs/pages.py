# SPDX-License-Identifier: GPL-2.0-or-later
"""What the scripts that write pages of the documentation share."""

import re
from pathlib import Path

import pandas as pd

from epdem.base.terminal import cell

DOCS = Path(__file__).parent


def markdown(frame: pd.DataFrame) -> str:
    """A frame as a Markdown table."""
    head = [f"| {' | '.join(map(str, frame.columns))} |", f"|{'---|' * len(frame.columns)}"]
    return "\n".join(
        head + [f"| {' | '.join(cell(value, 3) for value in row)} |" for row in frame.itertuples(index=False)]
    )


def store(name: str, frame: pd.DataFrame) -> None:
    """Write docs/data/NAME.csv, the numbers behind a page, with three digits."""
    frame.to_csv(DOCS / f"data/{name}.csv", index=False, float_format="%.3g", lineterminator="\n")


def load(name: str) -> pd.DataFrame:
    """The table docs/data/NAME.csv."""
    return pd.read_csv(DOCS / f"data/{name}.csv")


def replace_tables(page: str, tables: dict[str, str]) -> None:
    """Replace the tables of docs/PAGE.md between <!--NAME--> and <!--/-->; an empty one stays as it is."""
    path = DOCS / f"{page}.md"
    text = path.read_text(encoding="utf-8")
    for name, table in tables.items():
        if table:
            mark = rf"(<!--{name}-->\n).*?(<!--/-->)"
            text = re.sub(mark, lambda m, t=table: f"{m[1]}{t}\n{m[2]}", text, flags=re.DOTALL)
    path.write_text(text, encoding="utf-8")
