# SPDX-License-Identifier: GPL-2.0-or-later
"""Completed stages: a result is stored with the hash of all its inputs, and a rerun with the same hash uses it."""

import hashlib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from . import __version__, paths


@cache
def library_hash() -> str:
    """Hash of what is compiled: both libraries and the launcher, as far as they are there."""
    compiled = [paths.native("libepdem.so"), paths.native("libepdem_liggghts.so"), paths.launcher()]
    return _hash(__version__, [path for path in compiled if path and path.is_file()])


@cache
def product_hash() -> str:
    """Hash of this product as installed: what is compiled, templates, Python sources and the materials file."""
    package = Path(__file__).parents[1]
    ours = [*paths.beside("templates").rglob("*.j2"), *package.rglob("*.py"), *package.rglob("*.toml")]
    return _hash(library_hash(), sorted(ours))


def _hash(first: str, files: Iterable[Path]) -> str:
    sha = hashlib.sha256(first.encode())
    for path in files:
        sha.update(path.name.encode() + path.read_bytes())
    return sha.hexdigest()


def inputs_hash(files: Iterable[Path], *facts: object) -> str:
    """Hash of a stage's inputs: this product, the files written for an engine, and `facts` (plan, engine, version).

    `facts` count by their repr, which must hold every digit and no address.
    """
    sha = hashlib.sha256(product_hash().encode())
    for path in sorted(files):
        sha.update(path.name.encode() + b"\0" + path.read_bytes())
    sha.update(repr(facts).encode())
    return sha.hexdigest()
