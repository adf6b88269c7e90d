# SPDX-License-Identifier: GPL-2.0-or-later
"""Places of the installed parts and the user's settings; hashes of the product."""

import hashlib
import os
import shutil
import sys
import sysconfig
import tomllib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from ..errors import CaseError, EngineError
from . import __version__

DEFAULT_ENGINE = "liggghts"  # of every command and function that is given none


def config_file() -> Path:
    """Path of the user's configuration file."""
    return Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config") / "epdem" / "config.toml"


def setting() -> str | None:
    """`liggghts` in [engine]; None without it or without the file. Raises CaseError for a file that is wrong."""
    path = config_file()
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return None
    except (OSError, ValueError, RecursionError) as error:
        raise CaseError(f"{path}: {error}; mend or remove it") from None
    for name, keys in values.items():
        if name != "engine" or not isinstance(keys, dict):
            raise CaseError(f"{path}: {name}: is not known; there is [engine]")
        for word, value in keys.items():
            if word != "liggghts":
                raise CaseError(f"{path}: engine.{word}: is not known; there is liggghts")
            if not isinstance(value, str) or not value:
                raise CaseError(f"{path}: engine.{word} = {value!r}, must be a text; write it in quotes")
    return values["engine"].get("liggghts") if "engine" in values else None


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

    EPDEM_LIGGGHTS names it, or [engine] liggghts in the user's configuration file; else it is our own
    `epdem-liggghts` beside this Python or on PATH. Raises CaseError for a configuration file that is wrong.
    """
    named = os.environ.get("EPDEM_LIGGGHTS") or setting()
    if named:
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
