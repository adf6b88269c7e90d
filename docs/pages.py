# SPDX-License-Identifier: GPL-2.0-or-later
"""What the scripts that write pages of the documentation share."""

import pandas as pd

from epdem.base.terminal import cell


def markdown(frame: pd.DataFrame) -> str:
    """A frame as a Markdown table."""
    head = [f"| {' | '.join(map(str, frame.columns))} |", f"|{'---|' * len(frame.columns)}"]
    return "\n".join(
        head + [f"| {' | '.join(cell(value, 3) for value in row)} |" for row in frame.itertuples(index=False)]
    )
