# SPDX-License-Identifier: GPL-2.0-or-later
"""The command `epdem verify figures`."""

from pathlib import Path
from typing import Annotated

import typer

from ...base.terminal import status
from ...cli.options import AsJson, Force, Formats, formats, print_files


def figures(
    out: Annotated[Path, typer.Option("--out", "-o", help="folder for the figures")] = Path("runs/figures"),
    pictures: Formats = None,
    force: Force = False,
    as_json: AsJson = False,
) -> None:
    """Draw figures 8.16, 8.17 and 8.19 of Seville and Wu (2016) and figure 10 of Thornton and Ning (1998)."""
    from ...base.files import claim
    from ..figures import draw_all

    kinds = formats(pictures)
    with claim(out, force=force), status() as progress:
        progress("four figures")
        paths = draw_all(out, kinds)
    print_files(paths, as_json)
