# SPDX-License-Identifier: GPL-2.0-or-later
"""Places of the installed parts; hashes of the product."""

import hashlib
import os
import shutil
import sys
import sysconfig
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from ..errors import EngineError
from . import __version__

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
    """A folder that comes with the package (templates, cases, data): the checkout's own, else the installed copy."""
    folder = _first(_PACKAGE.parents[1] / name, _PACKAGE / name)
    if folder is None:
        raise EngineError(f"{name} not found beside the package; install epdem again: pip install .")
    return folder


@cache
def cpp_sources(host: str = "liggghts") -> tuple[Path, Path]:
    """The folders of the C++ sources for a host and of the laws' headers: the checkout's, else the installed copies."""
    folder = _first(_PACKAGE.parents[1] / "cpp_contact" / host, _PACKAGE / "cpp_contact" / host)
    laws = _first(_PACKAGE.parents[1] / "cpp_contact" / "include", _PACKAGE / "include")
    if folder is None or laws is None:
        raise EngineError("C++ sources not found beside the package; install epdem again: pip install .")
    return folder, laws


def licences() -> tuple[Path, Path]:
    """The texts of the two licences: of the physics, and of all else."""
    folder = beside("LICENSES")
    return folder / "BSD-3-Clause.txt", folder / "GPL-2.0-or-later.txt"


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
def library_hash() -> str:
    """Hash of the compiled parts: both libraries and the launcher, if built."""
    compiled = [native("libepdem.so"), native("libepdem_liggghts.so"), launcher()]
    return _hash(__version__, [path for path in compiled if path and path.is_file()])


@cache
def product_hash() -> str:
    """Hash of the installed product: compiled parts, templates, Python sources and the materials file."""
    package = Path(__file__).parents[1]
    ours = [*beside("templates").rglob("*.j2"), *package.rglob("*.py"), *package.rglob("*.toml")]
    return _hash(library_hash(), sorted(ours))


def _hash(first: str, files: Iterable[Path]) -> str:
    sha = hashlib.sha256(first.encode())
    for path in files:
        sha.update(path.name.encode() + path.read_bytes())
    return sha.hexdigest()
