# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the installed parts are: compiled libraries, templates, the LIGGGHTS launcher."""

import os
import shutil
import sys
import sysconfig
from functools import cache
from pathlib import Path

from ..errors import EngineError

_PACKAGE = Path(__file__).resolve().parents[1]


def _first(*candidates: Path) -> Path | None:
    return next((c for c in candidates if c.exists()), None)


@cache
def native(name: str) -> Path | None:
    """A compiled file that came with the package, or None if it was not built."""
    return _first(_PACKAGE / "native" / name, Path(sysconfig.get_path("platlib")) / "epdem" / "native" / name)


@cache
def templates() -> Path:
    """The folder of the deck templates: the checkout's own where there is one, else the installed copy."""
    folder = _first(_PACKAGE.parents[1] / "templates", _PACKAGE / "templates")
    if folder is None:
        raise EngineError("templates not found beside the package; install epdem again: pip install .")
    return folder


@cache
def launcher() -> Path | None:
    """`epdem-liggghts`: LIGGGHTS with our models, or None if it was not built; EPDEM_LAUNCHER names another one."""
    if named := os.environ.get("EPDEM_LAUNCHER"):
        return Path(named).absolute()
    beside = Path(sys.executable).parent / "epdem-liggghts"
    if beside.exists():
        return beside
    path = shutil.which("epdem-liggghts")
    return Path(path) if path else None
