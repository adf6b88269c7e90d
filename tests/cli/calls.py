# SPDX-License-Identifier: GPL-2.0-or-later
"""How tests call the command: its exit code, its words, and what it leaves in the current folder."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import pytest
import typer

from epdem.cli import main
from epdem.studies.sweep import folder as sweep_folder
from epdem.studies.sweep.run import plan
from epdem.verification import figures
from epdem.verification.commands import app

CASES = Path(__file__).parents[2] / "cases"
TOP = typer.main.get_command(app).commands
COMMANDS = {name: c for name, c in TOP.items() if name not in ("export", "verify")}
COMMANDS |= {f"{group} {name}": c for group in ("export", "verify") for name, c in TOP[group].commands.items()}


@dataclass(frozen=True)
class Call:
    """What a command did; `files` is a hash of each file of the current folder."""

    code: int
    out: str
    err: str
    files: tuple[tuple[str, str], ...]


def quick_figures(monkeypatch) -> None:
    """The figure of pressures for the two that run impacts: what is drawn is not the matter."""
    for name in ("restitution", "adhesion_by_strength"):
        monkeypatch.setattr(figures, name, figures.mean_pressure)


def call(words, capsys, monkeypatch) -> Call:
    """The command, as "verify cost" in one word, in this process, in the current folder, as its entry point runs it."""
    words = [*str(words[0]).split(), *words[1:]]
    monkeypatch.setattr("sys.argv", ["epdem", *map(str, words)])
    monkeypatch.setattr("signal.signal", lambda *words: None)
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        main.main()
    written = {str(p): hashlib.sha256(p.read_bytes()).hexdigest() for p in Path().rglob("*") if p.is_file()}
    code = ended.value.code
    return Call(code if isinstance(code, int) else 0, *capsys.readouterr(), tuple(sorted(written.items())))


def make_sweep(case: str, folder: Path) -> None:
    """The folder of a sweep of two points of which none has run."""
    radii = {"impact.body.radius": "1 mm,2 mm"}
    sweep_folder.write(plan(Path(case), radii, engines=["embedded"]), folder)
