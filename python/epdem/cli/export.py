# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands `epdem export ENGINE`: sources of the contact models for engines that users build themselves."""

from pathlib import Path
from typing import Annotated

import typer

from ..base.files import write_project
from ..errors import CaseError
from .options import AsJson, answer

app = typer.Typer(no_args_is_help=True, help="Write the contact models as sources for an engine that you build.")


@app.callback()
def _export() -> None:
    pass


@app.command()
def liggghts(
    out: Annotated[Path | None, typer.Option("--out", "-o", help="folder src of a LIGGGHTS tree")] = None,
    check: Annotated[Path | None, typer.Option("--check", help="folder src of a tree: print what it lacks")] = None,
    as_json: AsJson = False,
) -> None:
    """Write the models as sources for a LIGGGHTS tree, or print what a tree lacks to be built with them."""
    from ..tools import header as sources

    if out is None and check is None:
        raise CaseError("epdem export liggghts: name a folder by --out or --check")
    written = [str(f) for f in sources.write(out)] if out else []
    lacks = sources.check(check) if check else []
    raise answer({"files": written, "lacks": lacks}, written + lacks, as_json, not lacks)


def _project(host: str, about: str) -> None:
    def export(
        out: Annotated[Path, typer.Option("--out", "-o", help="new folder for the sources")], as_json: AsJson = False
    ) -> None:
        from ..engines import sources

        written = [str(f) for f in write_project(out, sources.files(host))]
        raise answer({"files": written}, [*written, "", *sources.commands(host, out)], as_json)

    app.command(host, help=about)(export)


_project("yade", "Write the sources of the module epdem_yade, which gives YADE the contact laws as C++ classes.")
_project(
    "lammps", "Write the sources of epdemplugin.so, which gives LAMMPS the contact laws as a pair style and walls."
)
