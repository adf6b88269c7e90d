# SPDX-License-Identifier: GPL-2.0-or-later
"""Places of the installed parts; hashes of the product."""

import hashlib
import os
import shutil
import sys
import sysconfig
from functools import cache
from pathlib import Path

from ..errors import EngineError
from . import __version__

LAWS = "cpp_contact/include"  # the headers of the laws
DEFAULT_ENGINE = "liggghts"  # of every command and function that is given none


_PACKAGE = Path(__file__).resolve().parents[1]


def _first(*candidates: Path) -> Path | None:
    return next((c for c in candidates if c.exists()), None)


@cache
def native(name: str) -> Path | None:
    """A compiled file that came with the package, or None if it was not built."""
    return _first(_PACKAGE / "native" / name, Path(sysconfig.get_path("platlib")) / "epdem" / "native" / name)


@cache
def beside(name: str) -> Path:
    """A folder that comes with the package (templates, cases, C++): the checkout's own, else the installed copy."""
    folder = _first(_PACKAGE.parents[1] / name, _PACKAGE / name)
    if folder is None:
        raise EngineError(f"{name} not found beside the package; install epdem again: pip install .")
    return folder


@cache
def launcher() -> Path | None:
    """The LIGGGHTS with our models that runs decks, or None.

    EPDEM_LIGGGHTS names it; else it is our own `epdem-liggghts` beside this Python or on PATH.
    """
    if named := os.environ.get("EPDEM_LIGGGHTS"):
        return Path(named).expanduser().absolute()
    beside = Path(sys.executable).parent / "epdem-liggghts"
    if beside.exists():
        return beside
    path = shutil.which("epdem-liggghts")
    return Path(path) if path else None


@cache
def product_hash(*, sources: bool = True) -> str:
    """Hash of the installed product: version, compiled parts, templates, tables and, if wanted, Python sources."""
    package = Path(__file__).parents[1]
    compiled = [native("libepdem.so"), native("libepdem_liggghts.so"), launcher()]
    ours = [*beside("templates").rglob("*.j2"), *package.rglob("*.toml")]
    ours += package.rglob("*.py") if sources else []
    sha = hashlib.sha256(__version__.encode())
    for path in [*(path for path in compiled if path and path.is_file()), *sorted(ours)]:
        sha.update(path.name.encode() + path.read_bytes())
    return sha.hexdigest()
