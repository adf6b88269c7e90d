# SPDX-License-Identifier: GPL-2.0-or-later
"""A stored run once more, from nothing but its results file: the same decks and, on one rank, the same numbers."""

import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
import tomlkit

from ..base.tables import attributes, open_results
from ..case.toml import file_names, files_in
from ..engines import scene_engine
from ..errors import CaseError
from ..impacts import run as impacts
from ..impacts import store
from ..scenes import run as scenes
from ..scenes.tables import results as scene_store
from .models import engine
from .runner import Progress, silent

CASE = "case.toml"  # in the scratch folder


@dataclass(frozen=True)
class Rerun:
    """Every deck and table of a results file: its name, and what differs ('' if nothing)."""

    path: Path
    versions: dict[str, tuple[str, str]]  # of programs that have changed since: before and now
    differences: dict[str, str]

    @property
    def same(self) -> bool:
        return not any(self.differences.values())


def rerun(path: Path, progress: Progress = silent) -> Rerun:
    """Run what `path`, results.h5 of impacts or of a scene, was made by, in a scratch folder, and compare.

    Raises CaseError for a file that is none, EngineError.
    """
    with open_results(path, "a results file of epdem") as file:
        scene = attributes(file).get("kind") == "scene"
    with tempfile.TemporaryDirectory(prefix="epdem-rerun-") as scratch:
        try:
            return (_scene if scene else _impacts)(path, Path(scratch), progress)
        except CaseError as error:
            raise CaseError(str(error).replace(str(Path(scratch) / CASE), f"{path}: the stored case")) from None


def _case(text: str, folder: Path) -> Path:
    path = folder / CASE
    path.write_text(text, encoding="utf-8")
    return path


def _scene(path: Path, scratch: Path, progress: Progress) -> Rerun:
    old = scene_store.read(path)
    about = old.attributes
    name, ranks = str(about["engine"]), int(str(about["ranks"]))
    document, places = tomlkit.parse(old.case_text), _files(path, old, scratch)
    for table, key in files_in(document):
        table[key] = str(places[table[key]])
    progress(f"{name}: {about['steps']} steps")
    scenes.run(_case(document.as_string(), scratch), scene_engine(name), out=scratch / "out", ranks=ranks)
    new = scene_store.read(scratch / "out/results.h5")
    found = _texts(old.decks, new.decks) | _tables(old.tables, new.tables)
    return Rerun(path, _versions(about, new.attributes), found)


def _files(path: Path, old: scene_store.SceneResults, scratch: Path) -> dict[str, Path]:
    """The files that a scene names, written to `scratch`: their names and places."""
    if old.files is None and file_names(tomllib.loads(old.case_text)):
        raise CaseError(f"{path}: does not hold the files that its case names (an earlier version); run the case again")
    places = {name: scratch / f"{n}_{Path(name).name}" for n, name in enumerate(old.files or {})}
    for name, place in places.items():
        place.write_bytes((old.files or {})[name])
    return places


def _impacts(path: Path, scratch: Path, progress: Progress) -> Rerun:
    old = store.read(path)
    found: dict[str, str] = {}
    versions: dict[str, tuple[str, str]] = {}
    case = _case(old.case_text, scratch)
    for key, about in old.runs.items():
        law, name = key.split("/")
        if "own_law" not in about:
            raise CaseError(f"{path}: {key} does not hold how it was run (an earlier version); run the case again")
        progress(f"{name}, {law}")
        out = scratch / law / name
        impacts.run(
            case,
            engines=[engine(name)],
            laws=() if about["own_law"] else (law,),
            ranks=int(str(about["ranks"])),
            steps=int(str(about["steps"])) or None,
            error=float(str(about.get("error", 0.0))) or None,
            out=out,
        )
        new = store.read(out / "results.h5")
        mine = {k: v for k, v in old.decks.items() if k.startswith(f"{key}/")}
        found |= _texts(mine, new.decks) | _tables({key: old.impacts[key]}, new.impacts)
        versions |= _versions(old.attributes, new.attributes)
    return Rerun(path, versions, found)


def _versions(
    old: dict[str, object] | dict[str, str], new: dict[str, object] | dict[str, str]
) -> dict[str, tuple[str, str]]:
    names = [n for n in new if n == "epdem" or n.startswith("version")]
    return {n: (str(old[n]), str(new[n])) for n in names if n in old and old[n] != new[n]}


def _texts(old: dict[str, str], new: dict[str, str]) -> dict[str, str]:
    return {f"deck {n}": "" if new.get(n) == text else _line(text, new.get(n)) for n, text in old.items()}


def _line(old: str, new: str | None) -> str:
    """The first line that differs."""
    if new is None:
        return "is not written any more"
    before, after = old.splitlines(), new.splitlines()
    n = next((k for k, (a, b) in enumerate(zip(before, after, strict=False)) if a != b), min(len(before), len(after)))
    return f"differs from line {n + 1} on"


def _tables(old: dict[str, pd.DataFrame], new: dict[str, pd.DataFrame]) -> dict[str, str]:
    return {f"table {n}": _columns(table, new[n]) if n in new else "is not there" for n, table in old.items()}


def _columns(old: pd.DataFrame, new: pd.DataFrame) -> str:
    if old.shape != new.shape or list(old) != list(new):
        return f"has {new.shape} rows and columns, had {old.shape}"
    wrong = [str(name) for name in old if not old[name].equals(new[name])]
    return f"other numbers in {', '.join(wrong)}" if wrong else ""
