# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem doctor`: which engines are installed, whether the plugin loads, and what to install."""

import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path

from ..base import paths
from ..base.processes import ask
from ..errors import EngineError, EpdemError
from ..laws import library as claw
from ..liggghts import launcher
from . import ENGINES


@dataclass(frozen=True)
class Finding:
    """One thing looked at; `advice` is empty where all is well."""

    part: str
    ok: bool
    detail: str
    advice: str = ""
    needed: bool = True


def _library() -> Finding:
    try:
        return Finding("C library", True, f"{claw.version()}, laws {', '.join(claw.laws())}: {claw.library_path()}")
    except (EpdemError, OSError) as error:
        return Finding("C library", False, str(error), "run 'make setup' or 'pip install .'")


def _first_line(command: list[str]) -> str | None:
    if shutil.which(command[0]) is None:
        return None
    return next((t.strip() for t in ask(command).splitlines() if t.strip()), "")


def _mpi() -> Finding:
    line = _first_line(["mpirun", "--version"])
    advice = "" if line else "apt-get install openmpi-bin (only --ranks above 1 needs it)"
    return Finding("MPI", line is not None, line or "mpirun not found", advice, needed=False)


def _plugin() -> Finding:
    """Load the plugin into the installed LIGGGHTS and let it create every model of ours."""
    plugin = paths.native("libepdem_liggghts.so")
    if reason := launcher.missing():
        return Finding("plugin", False, "not here", reason)
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "in.doctor"
        models = "\n".join(f"pair_style gran model ep/{name} tangential off" for name in claw.laws())
        deck.write_text(
            "atom_style granular\nnewton off\ncommunicate single vel yes\nregion box block 0 1 0 1 0 1\n"
            f"create_box 1 box\n{models}\n",
            encoding="utf-8",
        )
        try:
            launcher.run(deck.name, Path(folder), seconds=60)
        except EngineError as error:
            return Finding("plugin", False, f"does not load: {error}", "run 'make setup': it fits the LIGGGHTS it met")
    return Finding("plugin", True, f"loads, models {', '.join('ep/' + n for n in claw.laws())}: {plugin}")


def examine() -> list[Finding]:
    """All findings, in the order a user would mend them."""
    findings = [_library()]
    for name, kind in ENGINES.items():
        tool = kind()
        reason = tool.missing()
        detail, advice = ("not here", reason) if reason else (tool.version(), "")
        findings.append(Finding(f"engine {name}", reason is None, detail, advice, needed=name == "embedded"))
    return [*findings, _plugin(), _mpi()]
