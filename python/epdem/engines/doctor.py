# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem doctor`: which engines are installed, which models LIGGGHTS has, and what to install."""

import shutil
from dataclasses import dataclass

from rich.text import Text

from ..base import paths
from ..base.declarations import declarations, library_path
from ..base.processes import captured_output
from ..base.terminal import Shown
from ..errors import EngineError, EpdemError
from ..jobs.engine import Feature
from ..laws import library as claw
from . import ENGINES
from .liggghts import launcher


@dataclass(frozen=True)
class Finding:
    """One check; `advice` is empty if it passes."""

    part: str
    ok: bool
    detail: str
    advice: str = ""
    needed: bool = True


def _library() -> Finding:
    try:
        return Finding("C library", True, f"{claw.version()}, laws {', '.join(declarations())}: {library_path()}")
    except (EpdemError, OSError) as error:
        return Finding("C library", False, str(error), "run 'make setup' or 'pip install .'")


def _mpi() -> Finding:
    if shutil.which("mpirun") is None:
        advice = "apt-get install openmpi-bin (only --ranks above 1 needs it)"
        return Finding("MPI", False, "mpirun not found", advice, needed=False)
    said = captured_output(["mpirun", "--version"])
    return Finding("MPI", True, next((t.strip() for t in said.splitlines() if t.strip()), ""), needed=False)


def _models() -> Finding:
    """The models of epdem that the LIGGGHTS in use can create."""
    if reason := launcher.missing():
        return Finding("models in LIGGGHTS", False, "not here", reason)
    path, laws = paths.launcher(), tuple(declarations())
    assert path is not None  # launcher.missing() says so
    try:
        found = launcher.examine(path, laws)
    except EngineError as error:
        return Finding("models in LIGGGHTS", False, str(error), "run 'make setup', or name another one")
    lacks = tuple(law for law in laws if law not in found.models)
    names = ", ".join(f"ep/{law}" for law in found.models) or "none of epdem's"
    advice = launcher.advice(lacks, found.version)
    return Finding("models in LIGGGHTS", not lacks, f"{names}: {path} ({found})", advice, needed=not found.models)


def examine() -> list[Finding]:
    """All findings, in the order of repair."""
    findings = [_library()]
    for name, kind in ENGINES.items():
        tool = kind()
        reason = tool.missing()
        detail, advice = ("not here", reason) if reason else (tool.version(), "")
        findings.append(
            Finding(f"engine {name}", reason is None, detail, advice, needed=Feature.DECK not in kind.features)
        )  # the embedded one
    return [*findings, _models(), _mpi()]


def shown(findings: list[Finding]) -> list[Shown]:
    """The findings as lines."""
    lines: list[Shown] = []
    for f in findings:
        state, colour = ("ok", "green") if f.ok else ("missing", "red") if f.needed else ("absent", "yellow")
        lines.append(Text.assemble((state, colour), f" {f.part}: {f.detail}"))
        lines += [f"   -> {f.advice}"] if f.advice else []
    return lines
