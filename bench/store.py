# SPDX-License-Identifier: GPL-2.0-or-later
"""Measurements that are kept in runs/bench, so that an interrupted bench goes on, and all of them end in one table."""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "runs" / "bench"


def once(name: str, inputs: object, measure: Callable[[], Any], *, fresh: bool = False) -> Any:
    """What `measure` returns (JSON), or what an earlier call with the same inputs and the same launcher has kept."""
    launcher = ROOT / ".venv" / "bin" / "epdem-liggghts"
    code = hashlib.sha256(launcher.read_bytes()).hexdigest() if launcher.exists() else ""
    key = hashlib.sha256(f"{inputs!r}{code}".encode()).hexdigest()
    path = FOLDER / f"{name}.json"
    if path.exists() and not fresh:
        kept = json.loads(path.read_text())
        if kept["key"] == key:
            return kept["value"]
    value = measure()
    FOLDER.mkdir(parents=True, exist_ok=True)
    new = path.with_suffix(".new")
    new.write_text(json.dumps({"key": key, "value": value}))
    new.replace(path)
    return value


def report(script: str, rows: list[tuple[str, float, float | None]]) -> None:
    """Keep the rows (what, ratio, limit or None) of a script for the common table."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / f"table_{script}.json").write_text(json.dumps(rows))


def table(script: str = "*") -> str:
    """The rows that scripts, or one of them, have reported."""
    lines = ["| measured by | what, over LIGGGHTS's hertz | ratio | limit |", "|---|---|---|---|"]
    for path in sorted(FOLDER.glob(f"table_{script}.json")):
        for what, ratio, limit in json.loads(path.read_text()):
            verdict = "" if limit is None else f"{limit:g}: {'kept' if ratio <= limit else 'missed'}"
            lines.append(f"| {path.stem.removeprefix('table_')}.py | {what} | {ratio:.3f} | {verdict} |")
    return "\n".join(lines)
