# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem verify ...`; the command line mounts `app`."""

import typer

from .cost import cost
from .crosscheck import crosscheck
from .data import data
from .figures import figures
from .motion import motion
from .rerun import rerun
from .stability import stability

app = typer.Typer()
for command in (crosscheck, cost, stability, motion, data, figures, rerun):
    app.command()(command)
