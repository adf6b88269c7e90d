# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/validation.md: every claim with a number, what it is compared with, its newest value, command and test.

Run: .venv/bin/python docs/validation.py      (needs LIGGGHTS; 20 s)

It writes value and date into docs/claims.toml, the page, and the numbers between <!--v:NAME--> and <!--/--> in
README.md and docs/*.md.
"""

import datetime
import re
import shlex
import tempfile
from pathlib import Path
from typing import Any

import pandas as pd
import tomlkit

from epdem.engines import engine
from epdem.impacts.run import run

ROOT = Path(__file__).parents[1]
CLAIMS, PAGE = ROOT / "docs/claims.toml", ROOT / "docs/validation.md"
MARK = re.compile(r"<!--v:(\w+)-->(.*?)<!--/-->")
HEAD = """# What is claimed, and what holds it

Written by `.venv/bin/python docs/validation.py` from `docs/claims.toml`: it runs the commands, and a test compares
every number of README and docs that is marked with this table. An error is the largest over all speeds and 8 starting
phases. Run times are those of one machine on one day; all other rows are measured again by the test.

| claim | value | tolerance | compared with | evidence | date | command | test |
|---|---|---|---|---|---|---|---|
"""


def read() -> dict[str, Any]:
    """The claims by name."""
    return tomlkit.parse(CLAIMS.read_text(encoding="utf-8"))


def shown(claim: dict[str, Any]) -> str:
    """The value as pages print it: two digits of an error, three of all else."""
    value = float(claim["value"])
    return f"{value:.1e}".replace("e-0", "e-") if claim.get("column") else f"{value:.3g}"


def rows(command: str, folder: Path) -> pd.DataFrame:
    """The comparison that `epdem run CASE -e ENGINE [--steps N]` makes, without its figures. ValueError for another."""
    program, name, case, flag, tool, *more = shlex.split(command)
    if (program, name, flag) != ("epdem", "run", "-e") or (more and more[0] != "--steps"):
        raise ValueError(f"{command}: not a command that this script measures")
    steps = int(more[1]) if more else None
    return run(ROOT / case, engines=[engine(tool)], steps=steps, out=folder).results.comparison


def measure(claims: dict[str, Any]) -> dict[str, float]:
    """The values that the commands give now, by name; each command runs once."""
    commands = dict.fromkeys(claim["command"] for claim in claims.values() if "column" in claim)
    with tempfile.TemporaryDirectory() as scratch:
        tables = {command: rows(command, Path(scratch) / str(k)) for k, command in enumerate(commands)}
    return {n: float(tables[c["command"]][c["column"]].max()) for n, c in claims.items() if "column" in c}


def page(claims: dict[str, Any]) -> str:
    """The text of the page."""
    lines = []
    for c in claims.values():
        tolerance = f"{c['tolerance']:g}" if "tolerance" in c else "–"
        test = c["test"] if c["test"] == "by hand" else f"`tests/{c['test']}`"
        cells = (c["what"], shown(c), tolerance, c["reference"], c["kind"], c["date"], f"`{c['command']}`", test)
        lines.append(f"| {' | '.join(map(str, cells))} |\n")
    return HEAD + "".join(lines)


def filled(text: str, claims: dict[str, Any]) -> str:
    """A page with the newest numbers between its marks. KeyError for a mark without a claim."""
    return MARK.sub(lambda found: f"<!--v:{found[1]}-->{shown(claims[found[1]])}<!--/-->", text)


def pages() -> list[Path]:
    """The pages that may have marks."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def main() -> None:
    """Measure, and write all of it."""
    claims, today = read(), datetime.date.today().isoformat()
    for name, value in measure(claims).items():
        claims[name]["value"], claims[name]["date"] = float(f"{value:.3g}"), today
    CLAIMS.write_text(tomlkit.dumps(claims), encoding="utf-8")
    PAGE.write_text(page(claims), encoding="utf-8")
    for path in pages():
        path.write_text(filled(path.read_text(encoding="utf-8"), claims), encoding="utf-8")


if __name__ == "__main__":
    main()
