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
    from ..engines.liggghts import header as sources

    if out is None and check is None:
        raise CaseError("epdem export liggghts: name a folder by --out or --check")
    written = [str(f) for f in sources.write(out)] if out else []
    lacks = sources.check(check) if check else []
    raise answer({"files": written, "lacks": lacks}, written + lacks, as_json, not lacks)


@app.command()
def yade(
    out: Annotated[Path, typer.Option("--out", "-o", help="new folder for the sources")],
    as_json: AsJson = False,
) -> None:
    """Write the sources of the module epdem_yade, which gives YADE the contact laws as C++ classes."""
    from ..engines import sources

    _write(out, sources.yade(), sources.yade_commands(out), as_json=as_json)


@app.command()
def lammps(
    out: Annotated[Path, typer.Option("--out", "-o", help="new folder for the sources")],
    as_json: AsJson = False,
) -> None:
    """Write the sources of epdemplugin.so, which gives LAMMPS the contact laws as a pair style and walls."""
    from ..engines import sources

    _write(out, sources.lammps(), sources.lammps_commands(out), as_json=as_json)


def _write(out: Path, sources: dict[Path, Path], commands: list[str], *, as_json: bool) -> None:
    written = [str(f) for f in write_project(out, sources)]
    raise answer({"files": written}, [*written, "", *commands], as_json)
