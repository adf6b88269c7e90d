# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem verify ...`; `app` has them beside the commands of the product."""

from ...cli.main import app
from .commands import verify

__all__ = ["app"]

app.add_typer(verify, name="verify")
