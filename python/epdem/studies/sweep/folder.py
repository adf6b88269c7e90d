# SPDX-License-Identifier: GPL-2.0-or-later
"""A sweep on disk: its definition, and for each point a folder with its record.

The name of a folder is the hash of what the point sets and of the engines, so that a sweep that has grown finds again
what is finished. `point.json` is written whole or not at all: state and results never disagree. While a point runs it
has `running.json` instead. `results.h5`, of engines with decks, holds the tables, which are judged anew when the case
or the version of epdem has changed and the inputs of the engine have not.
"""

import contextlib
import copy
import hashlib
import json
import os
import socket
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import tomlkit

from ...base import paths
from ...base.files import MARKER, results_folder, write_text
from ...base.processes import is_alive
from ...case.keys import keys_of
from ...case.messages import shorten
from ...case.scene import is_scene
from ...case.toml import file_names
from ...errors import CaseError
from .points import Point, assign

DEFINITION, CASE, POINTS, FINISHED, STARTED = "sweep.json", "case.toml", "points", "point.json", "running.json"
WAITING, RUNNING, DONE, FAILED = "waiting", "running", "done", "failed"
STATES = (WAITING, RUNNING, DONE, FAILED)


@dataclass(frozen=True)
class Sweep:
    """Definition of a sweep: case (TOML text), points and engines; points are numbered from 1."""

    name: str
    case: str
    points: tuple[Point, ...]
    engines: tuple[str, ...]
    laws: tuple[str, ...] = ()
    ranks: int = 1
    versions: dict[str, str] = field(default_factory=dict)  # of the engines

    @cached_property
    def tables(self) -> dict[str, Any]:
        return tomlkit.parse(self.case).unwrap()

    @property
    def scene(self) -> bool:
        return is_scene(self.tables)

    @cached_property
    def units(self) -> dict[str, str | None]:
        """The SI unit of each key that the points set; None for a key that is no quantity."""
        keys = keys_of(self.data(1))
        return {name: keys[name].unit for point in self.points[:1] for name in point}

    @property
    def numbers(self) -> range:
        return range(1, len(self.points) + 1)

    @property
    def default_folder(self) -> Path:
        return results_folder(None, f"{self.name}_sweep")

    @cached_property
    def _document(self) -> tomlkit.TOMLDocument:
        return tomlkit.parse(self.case)

    def text(self, number: int) -> str:
        """The case file of a point, comments and all."""
        point = self.points[number - 1]  # every point sets the same keys, unless others go with a law, or tables come
        plain = "law.name" not in point and all(isinstance(value, str | int | float) for value in point.values())
        document = self._document if plain else tomlkit.parse(self.case)
        for key, value in point.items():
            assign(document, key, value)
        return document.as_string()

    def data(self, number: int) -> dict[str, Any]:
        """The TOML tables of a point's case."""
        tables = copy.deepcopy(self.tables)
        for key, value in self.points[number - 1].items():
            assign(tables, key, value)
        return tables

    @cached_property
    def identities(self) -> tuple[str, ...]:
        """The names of the points' folders, by what each point sets, the engines and the laws."""
        rest = repr((self.engines, self.laws, self.ranks))
        return tuple(hashlib.sha256(f"{point!r}{rest}".encode()).hexdigest()[:32] for point in self.points)

    def place(self, number: int) -> str:
        """The number and keys of a point, for messages."""
        settings = ", ".join(f"{key} = {shorten(str(value))}" for key, value in self.points[number - 1].items())
        return f"point {number} ({settings})"

    @cached_property
    def _hashes(self) -> dict[str, str]:
        names = file_names(self.tables).union(*map(file_names, self.points))
        return {name: hashlib.sha256(Path(name).read_bytes()).hexdigest() for name in names if Path(name).is_file()}

    def inputs(self, number: int) -> str:
        """Hash of the case of a point with its files, of the engines and of what they read of epdem: a point with
        another one is looked at again, and its engines run if their own inputs have changed."""
        names = file_names(self.data(number)) if file_names(self.points[number - 1]) else file_names(self.tables)
        contents = [self._hashes[name] for name in sorted(names) if name in self._hashes]
        known = (self.data(number), self.identities[number - 1], sorted(self.versions.items()), contents)
        return hashlib.sha256(f"{paths.product_hash(sources=False)}{known!r}".encode()).hexdigest()


def write(sweep: Sweep, folder: Path) -> None:
    """Store the definition in `folder`."""
    (folder / POINTS).mkdir(parents=True, exist_ok=True)
    (folder / POINTS / MARKER).write_text("{}", encoding="utf-8")  # each point has a marker: a job may run it alone
    write_text(folder / DEFINITION, json.dumps(asdict(sweep)))


def read(folder: Path) -> Sweep:
    """The definition that `write` stored. Raises CaseError."""
    try:
        raw: dict[str, Any] = json.loads((folder / DEFINITION).read_text(encoding="utf-8"))
        return Sweep(**(raw | {key: tuple(raw[key]) for key in ("points", "engines", "laws")}))
    except (OSError, ValueError, KeyError, TypeError):
        raise CaseError(f"{folder}: not a folder of a sweep; 'epdem sweep CASE --out {folder}' makes one") from None


def is_stored(sweep: Sweep, folder: Path) -> bool:
    """Whether the definition in `folder` is that of this sweep."""
    with contextlib.suppress(CaseError):
        return json.dumps(asdict(read(folder))) == json.dumps(asdict(sweep))
    return False


def point_folder(sweep: Sweep, folder: Path, number: int) -> Path:
    """The folder of a point."""
    return folder / POINTS / sweep.identities[number - 1]


def record(sweep: Sweep, folder: Path, number: int) -> dict[str, Any]:
    """Stored record of a point; {"state": "waiting"} without one, or if its inputs have changed."""
    place = point_folder(sweep, folder, number)
    for name in (FINISHED, STARTED):
        try:
            content = json.loads((place / name).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            continue
        if (
            isinstance(content, dict)
            and content.get("inputs") == sweep.inputs(number)
            and content.get("state") in STATES
        ):
            return content
    return {"state": WAITING}


def is_finished(sweep: Sweep, folder: Path, number: int) -> bool:
    """Whether a point is done or has failed."""
    return record(sweep, folder, number)["state"] in (DONE, FAILED)


def records(sweep: Sweep, folder: Path) -> list[dict[str, Any]]:
    """`record` of every point, in their order."""
    return [record(sweep, folder, n) for n in sweep.numbers]


def begin(sweep: Sweep, folder: Path, number: int) -> dict[str, Any]:
    """Make a point's folder, write its case, and mark it as running; returns the record that `end` takes."""
    place = point_folder(sweep, folder, number)
    place.mkdir(parents=True, exist_ok=True)
    (place / FINISHED).unlink(missing_ok=True)
    write_text(place / CASE, sweep.text(number), sync=False)
    about = {
        "state": RUNNING,
        "reason": "",
        "inputs": sweep.inputs(number),
        "host": socket.gethostname(),
        "pid": os.getpid(),
        "started": time.strftime("%Y-%m-%d %H:%M:%S"),
        "begin": time.time(),
    }
    (place / STARTED).write_text(json.dumps(about), encoding="utf-8")
    return about


def end(
    sweep: Sweep, folder: Path, number: int, about: dict[str, Any], *, rows: dict[str, Any] | None, reason: str = ""
) -> None:
    """Store a point's results (columns of rows), or the reason why there are none."""
    place = point_folder(sweep, folder, number)
    state = {
        "state": FAILED if rows is None else DONE,
        "reason": reason,
        "seconds": max(time.time() - about["begin"], 0.0),
    }
    write_text(place / FINISHED, json.dumps(about | state | {"rows": rows or {}}), sync=False)
    (place / STARTED).unlink(missing_ok=True)


def to_do(sweep: Sweep, folder: Path, *, retry_failed: bool, only: Sequence[int] | None = None) -> list[int]:
    """The numbers of the points to run: unfinished points, of these `only`, once where points are equal."""
    done = (DONE,) if retry_failed else (DONE, FAILED)
    wanted = [n for n in only or sweep.numbers if record(sweep, folder, n)["state"] not in done]
    return list({sweep.identities[n - 1]: n for n in reversed(wanted)}.values())[::-1]


def status(folder: Path) -> dict[str, Any]:
    """Progress of a sweep: counts by state, times [s], reasons of failed points.

    A point that began on another machine runs until its record says otherwise.
    """
    sweep = read(folder)
    about, host = records(sweep, folder), socket.gethostname()
    for row in about:
        if row["state"] == RUNNING and row["host"] == host and not is_alive(row["pid"], row["begin"]):
            row["state"] = WAITING
    states = [row["state"] for row in about]
    seconds = [row["seconds"] for row in about if "seconds" in row]
    counts = {state: states.count(state) for state in STATES}
    failed = [
        {"point": n, "folder": str(point_folder(sweep, folder, n)), "reason": row["reason"]}
        for n, row in enumerate(about, start=1)
        if row["state"] == FAILED
    ]
    left = counts[WAITING] + counts[RUNNING]
    mean = sum(seconds) / len(seconds) if seconds else float("nan")
    return {
        "case": sweep.name,
        "points": len(about),
        **counts,
        "seconds": sum(seconds),
        "longest": max(seconds, default=float("nan")),
        "work_left": left * mean if left else 0.0,
        "failures": failed,
    }
