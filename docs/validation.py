# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/validation.md: the headline claims, what each is compared with, its newest value, command and test.

Run: .venv/bin/python docs/validation.py            (needs LIGGGHTS; 30 s)

It runs the commands of docs/claims.toml and writes their values into docs/claims.toml and the page.
"""

import shlex
import tempfile
from pathlib import Path
from typing import Any

import pandas as pd
import tomlkit
from pages import store

from epdem.engines import engine
from epdem.impacts.run import run
from epdem.impacts.store import read as read_results
from epdem.verification.engine_comparison import crosscheck

ROOT = Path(__file__).parents[1]
CLAIMS, PAGE = ROOT / "docs/claims.toml", ROOT / "docs/validation.md"
HEAD = """# Claims and their tests

`.venv/bin/python docs/validation.py` runs the commands of `docs/claims.toml` and writes this page. An error is the
maximum over all speeds and 8 starting phases. A test runs the commands again.

The rows compare an engine with the theory of the same law: they verify the numerics, not that a metal obeys the law.
Measured impacts are ten numbers from two kinds of sources ([evidence](evidence.md#measured-impacts)).

| claim | value | tolerance | compared with | command | test |
|---|---|---|---|---|---|
"""
COMMANDS = """
[commands.csv](data/commands.csv) has the command or test of the other numbers of each page. Run times come from one
machine on one day.
"""


def read() -> dict[str, Any]:
    """The claims by name, and the commands of other numbers by page in `commands`."""
    return tomlkit.parse(CLAIMS.read_text(encoding="utf-8"))


def claims_of(read: dict[str, Any]) -> dict[str, Any]:
    """The claims alone."""
    return {name: claim for name, claim in read.items() if name != "commands"}


def shown(value: float) -> str:
    """An error with two digits, as pages print it."""
    return f"{value:.1e}".replace("e-0", "e-")


def rows(command: str, folder: Path) -> pd.DataFrame:
    """The comparison of `epdem run CASE -e ENGINE [-l LAW ...] [--steps N]` or `epdem verify crosscheck CASE -e MODEL`.

    Raises ValueError for another command.
    """
    match shlex.split(command):
        case ["epdem", "verify", "crosscheck", case, "-e", model]:
            crosscheck(ROOT / case, engines=[model], out=folder)
            return read_results(folder / "results.h5").comparison
        case ["epdem", "run", case, *options]:
            given = list(zip(options[::2], options[1::2], strict=True))
            tools = [engine(value) for flag, value in given if flag == "-e"]
            laws = [value for flag, value in given if flag == "-l"]
            steps = next((int(value) for flag, value in given if flag == "--steps"), None)
            return run(ROOT / case, engines=tools, laws=laws, steps=steps, out=folder).results.comparison
    raise ValueError(f"{command}: not a command that this script measures")


def measure(claims: dict[str, Any]) -> dict[str, float]:
    """The values that the commands give now, by name; each command runs once."""
    with tempfile.TemporaryDirectory() as scratch:
        commands = dict.fromkeys(claim["command"] for claim in claims.values())
        tables = {command: rows(command, Path(scratch) / str(n)) for n, command in enumerate(commands)}
    return {name: float(tables[claim["command"]][claim["column"]].max()) for name, claim in claims.items()}


def page(read: dict[str, Any]) -> str:
    """The text of the page."""
    text = HEAD
    for c in claims_of(read).values():
        tolerance = f"{c['tolerance']:g}" if "tolerance" in c else "–"
        cells = c["what"], shown(c["value"]), tolerance, c["reference"], f"`{c['command']}`", f"`tests/{c['test']}`"
        text += f"| {' | '.join(cells)} |\n"
    return text + COMMANDS


def commands(read: dict[str, Any]) -> pd.DataFrame:
    """The commands of the numbers of each page."""
    lines = [(name, what, command) for name, numbers in read["commands"].items() for what, command in numbers]
    return pd.DataFrame(lines, columns=["page", "numbers", "command"])


def main() -> None:
    """Measure and write all of it."""
    found = read()
    for name, value in measure(claims_of(found)).items():
        found[name]["value"] = float(f"{value:.3g}")
    CLAIMS.write_text(tomlkit.dumps(found), encoding="utf-8")
    PAGE.write_text(page(found), encoding="utf-8")
    store("commands", commands(found))


if __name__ == "__main__":
    main()
