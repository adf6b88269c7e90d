# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem verify ...`; `app` has them beside the commands of the product."""

import typer

from ...cli.main import app
from .contacts import contacts
from .cost import cost
from .crosscheck import crosscheck
from .data import data
from .figures import figures
from .motion import motion
from .rerun import rerun
from .stability import stability

__all__ = ["app"]

verify = typer.Typer(
    no_args_is_help=True, help="Verify laws and engines against theory, measurements, each other and other codes."
)
for command in (crosscheck, cost, stability, motion, contacts, data, figures, rerun):
    verify.command()(command)
app.add_typer(verify, name="verify")
