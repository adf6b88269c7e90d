# SPDX-License-Identifier: GPL-2.0-or-later
"""Starting YADE, and the modules in a deck."""

import hashlib
import os
import shutil
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from ...base import paths
from ...base.declarations import library_path
from ...base.files import atomic, write_texts
from ...base.processes import call
from ...errors import EngineError

OUT = "out.yade"  # both streams
INSTALL = "apt-get install yade"
MODULE, PROGRAM = "epdem_yade.so", "epdem_yade.program"  # the module, and the path of the program that it is built for
BUILD = "run 'make yade', or name one by EPDEM_YADE_MODULE"  # the module
MODULES = Path(__file__).parents[2] / "yade/deck_modules"


def command() -> str:
    """YADE's program; EPDEM_YADE names another one."""
    return os.environ.get("EPDEM_YADE", "yade")


def missing() -> str | None:
    """None if YADE can run here, else a sentence with the command that installs it."""
    return None if shutil.which(command()) else f"YADE was not found ({command()}); {INSTALL}"


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


@cache
def module_version() -> str:
    """Name and hash of the module."""
    path = module()
    return f"epdem_yade {hashlib.sha256(path.read_bytes()).hexdigest()[:12]}" if path else "no epdem_yade"


def deck_modules(names: Sequence[str]) -> dict[str, str]:
    """These Python modules of a deck by path beside the deck."""
    note = '"""The part of epdem that YADE needs; it came with the deck."""\n'
    files = {"epdem/__init__.py": note, "epdem/yade/__init__.py": note, "epdem/yade/deck_modules/__init__.py": note}
    return files | {
        f"epdem/yade/deck_modules/{name}.py": (MODULES / f"{name}.py").read_text(encoding="utf-8") for name in names
    }


def write_deck_modules(folder: Path, *, classes: bool, scene: bool = False) -> list[Path]:
    """Write what a deck imports into its folder. Raises EngineError.

    classes: a copy of epdem_yade, and the modules of a scene; else the contacts of impacts and a copy of the C library.
    """
    path = module() if classes else library_path()
    assert path is not None  # `classes` says so
    copy = folder / (MODULE if classes else f"epdem/yade/deck_modules/{path.name}")
    names = ("recorder", "spheres") if scene else () if classes else ("contacts",)
    written = write_texts(folder, deck_modules(names)) if names else []
    copy.parent.mkdir(parents=True, exist_ok=True)
    with atomic(copy, sync=False) as temporary:
        shutil.copyfile(path, temporary)
    return [*written, copy]


def environment() -> dict[str, str]:
    """Ours without what would lead the system Python, which YADE embeds, to packages of another one."""
    kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP", "DISPLAY")}
    return {"HOME": "/tmp", **kept, "OMP_NUM_THREADS": "1"}  # YADE does not start without a home
