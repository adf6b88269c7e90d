# SPDX-License-Identifier: GPL-2.0-or-later
"""Starting LIGGGHTS with our models: command, ranks, environment."""

import os
import shutil
from collections.abc import Callable
from pathlib import Path

from ...base import paths
from ...base.paths import config_file
from ...base.processes import call, most_ranks
from ...errors import EngineError
from ...impacts.engine import refuse_ranks

MPIRUN = "mpirun"
INSTALL = "apt-get install liggghts libliggghts-dev libopenmpi-dev, then 'make setup'"
LOG = "log.liggghts"  # LIGGGHTS's own log
OUT = "out.liggghts"  # both of its streams


def missing() -> str | None:
    """None if LIGGGHTS with our models can run here, else a sentence with the command that installs it."""
    launcher = paths.launcher()
    if launcher is not None and not (launcher.is_file() and os.access(launcher, os.X_OK)):
        return f"{launcher} is not a program; EPDEM_LIGGGHTS or {config_file()} names it: name another one, or none"
    if launcher is None:
        return f"LIGGGHTS with our models was not found; {INSTALL}"
    return None


def command(deck: str, *, ranks: int = 1, log: str = "none") -> list[str]:
    """The command that runs a deck in its folder. Raises EngineError if our LIGGGHTS is not there; see refuse_ranks."""
    launcher = paths.launcher()
    if launcher is None:
        raise EngineError(f"LIGGGHTS with our models was not found; {INSTALL}")
    refuse_ranks("liggghts", most_ranks(), ranks, MPIRUN)
    liggghts = [str(launcher), "-in", deck, "-log", log]
    if ranks == 1:
        return liggghts
    if "SLURM_JOB_ID" in os.environ and shutil.which("srun"):  # the cluster's own way, which keeps account of it
        nodes = min(ranks, int(os.environ.get("SLURM_JOB_NUM_NODES", "1")))
        # without -c, Slurm 24.11 reserves all processors of the job's task (SLURM_CPUS_PER_TASK) for each rank
        return ["srun", "--overlap", "--mpi=pmix", "-N", str(nodes), "-n", str(ranks), "-c", "1", *liggghts]
    root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    mpirun = shutil.which("mpirun.openmpi") or MPIRUN  # PyPI's MPICH may stand before OpenMPI on PATH
    return [mpirun, "-np", str(ranks), "--oversubscribe", *root, *liggghts]


def environment(ranks: int = 1) -> dict[str, str]:
    """This process's, with one thread per rank; waiting ranks yield the processor to those that compute.

    A single rank inside a job of Slurm gets no variables of Slurm: MPI would look for an srun that did not start it.
    """
    ours = {k: v for k, v in os.environ.items() if ranks > 1 or not k.startswith(("SLURM_", "PMI"))}
    return ours | {"OMP_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}


def run(
    deck: str,
    folder: Path,
    *,
    ranks: int = 1,
    log: str = "none",
    out: str = OUT,
    seconds: float | None = None,
    append: bool = False,
    report: Callable[[int], None] | None = None,
) -> float:
    """Run a deck in its folder to its end; seconds taken. `log` is LIGGGHTS's own; the rest as in processes.call."""
    arguments = command(deck, ranks=ranks, log=log)
    return call(arguments, folder, log=out, seconds=seconds, env=environment(ranks), append=append, report=report)
