# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/validation.md: every claim with a number, what it is compared with, its newest value, command and test.

Run: .venv/bin/python docs/validation.py            (needs LIGGGHTS; 30 s)
     .venv/bin/python docs/validation.py --marks    (runs nothing: takes over numbers that were written by hand)

It writes values and dates into docs/claims.toml, the page, and the numbers between <!--v:NAME--> and <!--/--> in
README.md and docs/*.md. Numbers between <!--by:NAME--> and <!--/by--> come from the command of a record of that name;
where they change, the record gets the date of today.
"""

import datetime
import hashlib
import re
import shlex
import sys
import tempfile
from pathlib import Path
from typing import Any

import pandas as pd
import tomlkit

from epdem.engines import engine
from epdem.impacts import store
from epdem.impacts.run import run
from epdem.verification import crosscheck

ROOT = Path(__file__).parents[1]
CLAIMS, PAGE = ROOT / "docs/claims.toml", ROOT / "docs/validation.md"
MARK = re.compile(r"<!--v:([\w.]+)-->(.*?)<!--/-->")
BLOCK = re.compile(r"<!--by:(\w+)-->(.*?)<!--/by-->", re.S)
CODE = re.compile(
    r"^```.*?^```$|`[^`\n]+`|\$\$.+?\$\$|(?<![\\$\w])\$[^$\n]+(?:\n[^$\n]+)?\$(?!\w)|\]\([^)]*\)", re.M | re.S
)
# what a measurement looks like: an error, a time, a share, a decimal; equations have numbers from 8.76 to 8.89
NUMBER = re.compile(
    r"(?<![\w.])\d+(?:\.\d+)?e-\d+|\b\d+(?:\.\d+)? (?:ns|us|ms|s|min|minutes|seconds|GB|MB)\b|\b\d+(?:\.\d+)? ?%"
    r"|(?<=\|) *-?\d+\.\d+ *(?=\|)|(?<![\w.])(?!8\.[1789]\d\b)\d+\.\d{2,}\b"
)
HEAD = """# What is claimed, and what holds it

Written by `.venv/bin/python docs/validation.py` from `docs/claims.toml`: it runs the commands and fills the numbers of
README and docs. A test finds every error, time, share and decimal of these pages that has no row here. An error is the
largest over all speeds and 8 starting phases. Run times are those of one machine on one day.

## Measured again by the test

| claim | value | tolerance | compared with | evidence | date | command | test |
|---|---|---|---|---|---|---|---|
"""
TABLES = """
## Tables and sentences

The command of a row gives the numbers; the test holds their limits. Rows without a test take minutes, or are run times.

| numbers | page | how many | evidence | date | command | test |
|---|---|---|---|---|---|---|
"""
WHOLE = """
## Pages that a command writes

| page | date | command | test |
|---|---|---|---|
"""


def read() -> dict[str, Any]:
    """The records by name; those of marked blocks in `by`, of whole pages in `pages`, numbers that are given in
    `given`."""
    return tomlkit.parse(CLAIMS.read_text(encoding="utf-8"))


def values(claims: dict[str, Any]) -> dict[str, Any]:
    """The records of single values and of tables."""
    return {name: claim for name, claim in claims.items() if name not in ("by", "pages", "given")}


def shown(claims: dict[str, Any], name: str) -> str:
    """A value as pages print it: two digits of an error, three of all else. KeyError for a name without a record."""
    name, *keys = name.split(".")
    value = claims[name]["value"]
    for key in keys:
        value = value[key]
    number = float(max(_leaves(value)))
    if not ("column" in claims[name] or "columns" in claims[name]):
        return f"{number:.3g}"
    return f"{number:.1e}".replace("e-0", "e-") if number else "0"


def _leaves(value: Any) -> list[float]:
    return [x for v in value.values() for x in _leaves(v)] if isinstance(value, dict) else [float(value)]


def rows(command: str, folder: Path, place: str = "") -> pd.DataFrame:
    """The comparison that `epdem run CASE -e ENGINE [-l LAW ...] [--steps N]` makes, without its figures.

    Of `epdem verify crosscheck CASE -e MODEL` that in its folder, or in the `place` there. Raises ValueError for
    another command.
    """
    if (words := shlex.split(command))[:3] == ["epdem", "verify", "crosscheck"] and words[4] == "-e":
        crosscheck(ROOT / words[3], engines=words[5:], out=folder)
        return store.read(folder / place / "results.h5").comparison
    program, name, case, *options = words
    given = list(zip(options[::2], options[1::2], strict=True))
    if (program, name) != ("epdem", "run") or {flag for flag, _ in given} - {"-e", "-l", "--steps"}:
        raise ValueError(f"{command}: not a command that this script measures")
    tools = [engine(v) for flag, v in given if flag == "-e"]
    laws = [v for flag, v in given if flag == "-l"]
    steps = next((int(v) for flag, v in given if flag == "--steps"), None)
    return run(ROOT / case, engines=tools, laws=laws, steps=steps, out=folder).results.comparison


def measure(claims: dict[str, Any]) -> dict[str, Any]:
    """The values that the commands give now, by name; each command runs once."""
    known = {n: c for n, c in values(claims).items() if "column" in c or "columns" in c}
    with tempfile.TemporaryDirectory() as scratch:
        commands = dict.fromkeys((c["command"], c.get("place", "")) for c in known.values())
        tables = {key: rows(key[0], Path(scratch) / str(k), key[1]) for k, key in enumerate(commands)}
    found: dict[str, Any] = {}
    for name, claim in known.items():
        table = tables[claim["command"], claim.get("place", "")]
        if "column" in claim:
            found[name] = float(table[claim["column"]].max())
            continue
        found[name] = {
            f"{key:g}".replace(".", "_") if isinstance(key, float) else str(key): {
                column: float(part[f"{column}_error"].max()) for column in claim["columns"]
            }
            for key, part in table.groupby(claim["by"], sort=False)
        }
    return found


def pages() -> list[Path]:
    """The pages that may have marks."""
    return [path for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))) if path != PAGE]


def blocks() -> dict[str, dict[str, list[str]]]:
    """The numbers of the marked blocks by record and page, in their order."""
    found: dict[str, dict[str, list[str]]] = {}
    for path in pages():
        for name, text in BLOCK.findall(path.read_text(encoding="utf-8")):
            numbers = re.findall(r"\d[\d.]*(?:e[-+]?\d+)?", text)
            found.setdefault(name, {}).setdefault(path.name, []).extend(numbers)
    return found


def digest(numbers: dict[str, list[str]]) -> str:
    """What changes with any of the numbers of a record."""
    return hashlib.sha256(repr(sorted(numbers.items())).encode()).hexdigest()[:12]


def unmarked(text: str, given: list[str]) -> list[str]:
    """What looks measured in a page, stands in no mark and is not among the `given` numbers."""
    bare = CODE.sub("`", BLOCK.sub("", MARK.sub("", text)))
    return [number for found in NUMBER.findall(bare) if (number := found.strip()) not in given]


def page(claims: dict[str, Any]) -> str:
    """The text of the page."""

    def held(record: dict[str, Any]) -> str:
        return record["test"] if record["test"] == "by hand" else f"`tests/{record['test']}`"

    def line(*cells: object) -> str:
        return f"| {' | '.join(map(str, cells))} |\n"

    text = [HEAD]
    for name, c in values(claims).items():
        tolerance = f"{c['tolerance']:g}" if "tolerance" in c else "–"
        value = shown(claims, name)
        value = f"{len(_leaves(c['value']))} values, largest {value}" if "columns" in c else value
        end = (c["reference"], c["kind"], c["date"], f"`{c['command']}`", held(c))
        text.append(line(c["what"], value, tolerance, *end))
    text.append(TABLES)
    numbers = blocks()
    for name, c in claims["by"].items():
        places = ", ".join(f"[{p}]({p})" if p != "README.md" else p for p in numbers[name])
        count = sum(map(len, numbers[name].values()))
        text.append(line(c["what"], places, count, c["kind"], c["date"], f"`{c['command']}`", held(c)))
    text.append(WHOLE)
    for name, c in claims["pages"].items():
        text.append(line(f"[{name}]({name})", c["date"], f"`{c['command']}`", held(c)))
    return "".join(text)


def filled(text: str, claims: dict[str, Any]) -> str:
    """A page with the newest numbers between its marks. KeyError for a mark without a claim."""
    return MARK.sub(lambda found: f"<!--v:{found[1]}-->{shown(claims, found[1])}<!--/-->", text)


def main() -> None:
    """Measure unless `--marks` is given, and write all of it."""
    claims, today = read(), datetime.date.today().isoformat()
    for name, value in ({} if "--marks" in sys.argv else measure(claims)).items():
        claims[name]["value"], claims[name]["date"] = _rounded(value), today
    for name, numbers in blocks().items():
        record = claims["by"][name]
        if record.get("digest") != digest(numbers):
            record["digest"], record["date"] = digest(numbers), today
    CLAIMS.write_text(tomlkit.dumps(claims), encoding="utf-8")
    for path in pages():
        path.write_text(filled(path.read_text(encoding="utf-8"), claims), encoding="utf-8")
    PAGE.write_text(page(claims), encoding="utf-8")


def _rounded(value: Any) -> Any:
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        table.update({key: _rounded(v) for key, v in value.items()})
        return table
    return float(f"{value:.3g}")


if __name__ == "__main__":
    main()
