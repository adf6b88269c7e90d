# SPDX-License-Identifier: GPL-2.0-or-later
"""A stage: one engine runs one job. Its tables are stored with the hash of the inputs from which they follow."""

import hashlib
import re
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TypeVar

import pandas as pd

from ..base.files import claim
from .engine import Engine, Feature, check, refusal

Tables = dict[str, pd.DataFrame]
Job = TypeVar("Job")
Result = TypeVar("Result")

FORMAT = 2  # raise it with each change of the way in which tables are made from what an engine has written
_COMMENT = re.compile(r"""^#.*|[ \t]+#[^"'\n]*$""", re.M)


@dataclass(frozen=True)
class Inputs:
    """Inputs of a stage. files: texts of the engine's files by their path. key: hash of all inputs."""

    files: dict[str, str]
    key: str


@dataclass(frozen=True)
class Stage:
    """Result of a stage. seconds: times that the run took, by name; reused: the tables come from an earlier run."""

    inputs: Inputs
    tables: Tables
    seconds: dict[str, float]
    reused: bool = False


def without_comments(text: str) -> str:
    """The text of a deck without titles, sources and reasons.

    A comment behind a command stays if a quotation mark follows its #, which may then stand inside of a text.
    """
    return _COMMENT.sub("", text)


def parts_hash(tool: Engine[Job, Result]) -> str:
    """Hash of the compiled parts of epdem that an engine loads."""
    sha = hashlib.sha256()
    for path in tool.parts():
        status = path.stat()
        sha.update(_file_hash(path, status.st_mtime_ns, status.st_size))
    return sha.hexdigest()


@cache
def _file_hash(path: Path, changed: int, size: int) -> bytes:
    return path.name.encode() + hashlib.sha256(path.read_bytes()).digest()


def write_deck(tool: Engine[Job, Result], job: Job, folder: Path, *, force: bool = False) -> list[Path]:
    """Write the deck of a job into `folder`, where `force` allows other files; its files. Raises CaseError."""
    if Feature.DECK not in tool.features:
        raise refusal(
            tool, job, f"engine {tool.name}: it reads no deck", fits=lambda features: Feature.DECK in features
        )
    check(tool, job)
    files = tool.files(job)
    with claim(folder, force=force, files=files):
        return tool.put(files, folder)


def inputs(tool: Engine[Job, Result], job: Job, *, version: str, facts: object = (), ranks: int = 1) -> Inputs:
    """Inputs of a job. Raises CaseError.

    version: of the engine. facts: numbers and names on which tables depend and that no file of the engine holds; they
    count by their repr.
    """
    files = tool.files(job)
    read = sorted((name, without_comments(text)) for name, text in files.items())
    known = (FORMAT, read, facts, tool.name, version, parts_hash(tool), ranks)
    return Inputs(files, hashlib.sha256(repr(known).encode()).hexdigest())


def stage(now: Inputs, compute: Callable[[], tuple[Tables, dict[str, float]]], stored: Stage | None = None) -> Stage:
    """The `stored` stage if its inputs are those of the job, `now`, else the one that `compute` makes.

    compute: runs the engine; its tables, and times of its own. Raises what `compute` raises.
    """
    if stored is not None and stored.inputs.key == now.key:
        return replace(stored, inputs=now, reused=True)
    start = time.perf_counter()
    tables, seconds = compute()
    return Stage(now, tables, seconds | {"seconds": time.perf_counter() - start})
