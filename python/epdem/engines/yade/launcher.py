# SPDX-License-Identifier: GPL-2.0-or-later
"""Starting YADE, and the modules in a deck."""

import os
import re
import shutil
from pathlib import Path
from typing import Any

from ...base import paths
from ...base.declarations import library_path
from ...base.files import atomic
from ...base.processes import call, said_by
from ...errors import EngineError

OUT = "out.yade"  # both streams
INSTALL = "apt-get install yade"
MODULE, PROGRAM = "epdem_yade.so", "epdem_yade.program"  # the module, and the path of the program that it is built for
BUILD = "run 'make yade', or name one by EPDEM_YADE_MODULE"  # the module
PACKAGE = "epdem/yade/deck_modules"  # of the modules of a deck
MODULES = Path(__file__).parents[2] / "yade/deck_modules"


def command() -> str:
    """YADE's program; EPDEM_YADE names another one."""
    return os.environ.get("EPDEM_YADE", "yade")


def missing() -> str | None:
    """None if YADE can run here, else a sentence with the command that installs it."""
    return None if shutil.which(command()) else f"YADE was not found ({command()}); {INSTALL}"


def version() -> str:
    """YADE's version, and whether its laws are those of the module epdem_yade."""
    match = re.search(r"version: (\S+)", said_by([command(), "--version"], environment()))
    laws = "epdem_yade" if module() else "normal impacts with the C library ('make yade' builds all else)"
    return f"YADE {match.group(1) if match else '(version unknown)'}, {laws}"


def run(script: str, folder: Path, *, ranks: int = 1, out: str = OUT, **how: Any) -> float:
    """Run a script in its folder to its end; seconds taken. A run has one rank; `how` as in processes.call."""
    return call([command(), "-n", "-x", script], folder, log=out, env=environment(), **how)


def module() -> Path | None:
    """The module epdem_yade: of EPDEM_YADE_MODULE (its file or folder), else of `make yade` for the program in use.

    None: only normal impacts run, with the C library. Raises EngineError if EPDEM_YADE_MODULE names no module.
    """
    if named := os.environ.get("EPDEM_YADE_MODULE"):
        path = Path(named) / MODULE if Path(named).is_dir() else Path(named)
        if path.name != MODULE or not path.is_file():
            raise EngineError(
                f"EPDEM_YADE_MODULE = {named}: there is no {MODULE}; name the folder in which the commands of 'epdem "
                "export yade' have built it, or leave the variable unset"
            )
        return path
    built, program = paths.native(MODULE), paths.native(PROGRAM)
    found = shutil.which(command())
    if program and found and Path(found).resolve() != Path(program.read_text(encoding="utf-8").strip()):
        return None
    return built


def deck_modules(*, classes: bool, scene: bool) -> dict[str, str]:
    """The Python modules that a deck imports by their paths beside it: those of a scene; contacts without classes."""
    names = ("recorder", "spheres") if scene else () if classes else ("contacts",)
    note = '"""The part of epdem that YADE needs; it came with the deck."""\n'
    found = {f"{package}/__init__.py": note for package in ("epdem", "epdem/yade", PACKAGE) if names}
    return found | {f"{PACKAGE}/{name}.py": (MODULES / f"{name}.py").read_text(encoding="utf-8") for name in names}


def copy_part(folder: Path, *, classes: bool) -> Path:
    """The copy beside a deck of epdem_yade, or of the C library, which the contacts of impacts call."""
    path = module() if classes else library_path()
    assert path is not None  # `classes` says so
    copy = folder / (MODULE if classes else f"{PACKAGE}/{path.name}")
    with atomic(copy, sync=False) as temporary:
        shutil.copyfile(path, temporary)
    return copy


def environment() -> dict[str, str]:
    """Ours without what would lead the system Python, which YADE embeds, to packages of another one."""
    kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP", "DISPLAY")}
    return {"HOME": "/tmp", **kept, "OMP_NUM_THREADS": "1"}  # YADE does not start without a home
