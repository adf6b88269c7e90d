# SPDX-License-Identifier: GPL-2.0-or-later
"""Starting LIGGGHTS with our models: what the executable has, command and environment."""

import os
import re
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...base import paths
from ...base.processes import call, captured_output, said_by
from ...errors import EngineError

MPIRUN = "mpirun"
INSTALL = "apt-get install liggghts libliggghts-dev libopenmpi-dev, then 'make setup'"
OUT = "out.liggghts"  # both of its streams
LONG_TRIANGLES = (
    "a triangle of a wall is many times longer than a period of the room; give the wall as an STL file of shorter "
    "triangles, or enlarge the room along its periodic axis"
)


def missing() -> str | None:
    """None if LIGGGHTS with our models can run here, else a sentence with the command that installs it."""
    launcher = paths.launcher()
    if launcher is not None and not (launcher.is_file() and os.access(launcher, os.X_OK)):
        return f"{launcher} is not a program; EPDEM_LIGGGHTS names it: name another one, or none"
    if launcher is None:
        return f"LIGGGHTS with our models was not found; {INSTALL}"
    return None


def command(deck: str, *, ranks: int = 1) -> list[str]:
    """The command that runs a deck in its folder, with a LIGGGHTS that is not `missing`."""
    liggghts = [str(paths.launcher()), "-in", deck, "-log", "none"]
    if ranks == 1:
        return liggghts
    if "SLURM_JOB_ID" in os.environ and shutil.which("srun"):  # the cluster's own way, which keeps account of it
        nodes = min(ranks, int(os.environ.get("SLURM_JOB_NUM_NODES", "1")))
        # without -c, Slurm 24.11 reserves all processors of the job's task (SLURM_CPUS_PER_TASK) for each rank
        return ["srun", "--overlap", "--mpi=pmix", "-N", str(nodes), "-n", str(ranks), "-c", "1", *liggghts]
    root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    mpirun = shutil.which("mpirun.openmpi") or MPIRUN  # PyPI's MPICH may stand before OpenMPI on PATH
    # unbound: OpenMPI binds the ranks of every run to the first cores, whatever else runs there
    return [mpirun, "-np", str(ranks), "--oversubscribe", "--bind-to", "none", *root, *liggghts]


def environment(ranks: int = 1) -> dict[str, str]:
    """This process's, with one thread per rank; waiting ranks yield the processor to those that compute: ranks that
    spin took twice to ten times as long beside other programs.

    A single rank inside a job of Slurm gets no variables of Slurm: MPI would look for an srun that did not start it.
    """
    ours = {k: v for k, v in os.environ.items() if ranks > 1 or not k.startswith(("SLURM_", "PMI"))}
    return ours | {"OMP_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}


def run(deck: str, folder: Path, *, ranks: int = 1, out: str = OUT, **how: Any) -> float:
    """Run a deck in its folder to its end; seconds taken. `how` as in processes.call."""
    try:
        return call(command(deck, ranks=ranks), folder, log=out, env=environment(ranks), **how)
    except EngineError as error:
        if "region_neighbor_list" in str(error):  # corners of meshes: 11 periods fail, 7 run
            raise EngineError(f"{error}; {LONG_TRIANGLES}") from None
        raise


@dataclass(frozen=True)
class Executable:
    """`version` is "" for a program that does not say it; `models` are the models of epdem that it has."""

    path: Path
    version: str
    superquadrics: bool
    vtk: bool
    mpi: bool
    models: tuple[str, ...]

    def __str__(self) -> str:
        parts = {"superquadrics": self.superquadrics, "VTK": self.vtk, "MPI": self.mpi}
        built = [f"{'with' if has else 'without'} {part}" for part, has in parts.items()]
        return ", ".join([self.version or "version unknown", *built])


def version(path: Path | None = None) -> str:
    """Name and version of a LIGGGHTS, as "LIGGGHTS-PUBLIC 3.8.0"; None: the one of epdem. Raises EngineError."""
    path = path or paths.launcher()
    return (_version(_help(path)) if path else "") or "LIGGGHTS (version unknown)"


def examine(path: Path, laws: tuple[str, ...]) -> Executable:
    """Parts of a LIGGGHTS, found by one short run for each of `laws`. Raises EngineError if it does not start."""
    text = _help(path)
    return Executable(
        path,
        _version(text),
        superquadrics="superquadric" in _styles(text, "Atom styles"),
        vtk="custom/vtk" in _styles(text, "Dump styles"),
        mpi="libmpi" in captured_output(["ldd", str(path)]) if shutil.which("ldd") else False,
        models=tuple(law for law in laws if _has(law)),
    )


def _help(path: Path) -> str:
    return said_by([str(path), "-log", "none", "-h"], environment())


def _version(text: str) -> str:
    found = re.search(r"\bVersion (LIGGGHTS[-\w]*) ([\d.]+)", text)
    return f"{found[1]} {found[2]}" if found else ""


def _styles(text: str, heading: str) -> list[str]:
    _, _, rest = text.partition(f"* {heading}")
    return rest.partition("\n* ")[0].split()


def _has(law: str) -> bool:
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "in.doctor"
        deck.write_text(
            "atom_style granular\nnewton off\ncommunicate single vel yes\nregion box block 0 1 0 1 0 1\n"
            f"create_box 1 box\npair_style gran model ep/{law} tangential off\n",
            encoding="utf-8",
        )
        try:
            run(deck.name, Path(folder), seconds=60)
        except EngineError:
            return False
    return True


def advice(laws: tuple[str, ...], version: str = "") -> str:
    """How an executable without these models, of a LIGGGHTS that says this version, gets them; "" for none."""
    if not laws:
        return ""
    get = f"to get {', '.join('ep/' + law for law in laws)}: "
    if version.startswith("LIGGGHTS-PFM"):
        return (
            f"{get}'epdem export liggghts --out SRC' has the laws without adhesion for LIGGGHTS-PFM; for the others "
            "take LIGGGHTS-PUBLIC or LIGGGHTS-INL"
        )
    plugin = paths.native("libepdem_liggghts.so")
    preload = f"LD_PRELOAD={plugin} with Debian's liggghts, " if plugin else ""
    own = "'epdem export liggghts --out SRC' for a tree that you build yourself"
    return f"{get}{preload}epdem-liggghts in place of it, or {own}"
