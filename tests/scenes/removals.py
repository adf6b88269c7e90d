# SPDX-License-Identifier: GPL-2.0-or-later
"""Proof that a deck holds nothing its scene does not need: each line is removed in turn and the deck runs again."""

import hashlib
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from epdem.base.processes import ROW
from epdem.engines.liggghts.launcher import command

GUARD = "# guard: "


@dataclass(frozen=True)
class Removal:
    """What became of the run without one line: "breaks", "changes", "guard" (not tried) or "nothing"."""

    file: str
    line: str
    effect: str


def fingerprint(folder: Path, deck: str, seconds: float = 120.0, *, rows: bool = True) -> str | None:
    """Hash of all that a deck's run puts out (thermo rows if `rows`, dump files), or None if it fails."""
    try:
        done = subprocess.run(command(deck), cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, timeout=seconds)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode:
        return None
    sha = hashlib.sha256()
    timed = False
    for line in done.stdout.splitlines():
        words = line.split()
        if rows and words[:1] == [b"Step"]:
            timed = words[-1] == b"CPU"  # the last column of LIGGGHTS's own choice, never twice the same
        elif not rows or not ROW.match(line):
            continue
        sha.update(b" ".join(words[:-1] if timed else words))
    for path in sorted(folder.iterdir()):
        if re.search(r"\.(bin|txt|vtk|ppm)$", path.name):
            sha.update(path.name.encode())
            if not path.name.startswith("restart"):  # these hold times of day
                sha.update(path.read_bytes())
    return sha.hexdigest()


def _run_without(source: Path, scratch: Path, deck: str, file: str | None, index: int, rows: bool) -> str | None:
    shutil.rmtree(scratch, ignore_errors=True)
    shutil.copytree(source, scratch)
    if file is not None:
        lines = (scratch / file).read_text().splitlines(keepends=True)
        del lines[index]
        (scratch / file).write_text("".join(lines))
    return fingerprint(scratch, deck, rows=rows)


def removals(source: Path, scratch: Path, deck: str, files: list[str], *, rows: bool = True) -> list[Removal]:
    """The effect of removing each line of `files` from the deck in `source`, which must not have run there yet."""
    whole = _run_without(source, scratch, deck, None, 0, rows)
    if whole is None:
        raise AssertionError(f"{source}/{deck} does not run")
    if _run_without(source, scratch, deck, None, 0, rows) != whole:
        raise AssertionError(f"{source}/{deck} does not repeat itself; removals would prove nothing")
    found = []
    for file in files:
        for index, line in enumerate((source / file).read_text().splitlines()):
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            if GUARD in line:
                found.append(Removal(file, line, "guard"))
                continue
            now = _run_without(source, scratch, deck, file, index, rows)
            found.append(Removal(file, line, "breaks" if now is None else "nothing" if now == whole else "changes"))
    return found
