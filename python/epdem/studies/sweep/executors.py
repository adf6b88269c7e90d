# SPDX-License-Identifier: GPL-2.0-or-later
"""Who runs a sweep: processes on this machine, or jobs of a cluster."""

from collections.abc import Sequence
from pathlib import Path

from ...base.files import atomic
from ...base.folders import claim, refuse_existing
from ...errors import CaseError
from . import folder as store
from . import run, slurm
from .folder import Sweep
from .run import Report, SweepOutcome


def execute(
    sweep: Sweep,
    folder: Path,
    executor: str,
    given: Sequence[str] = (),
    *,
    jobs: int | None = None,
    retry_failed: bool = False,
    force: bool = False,
    report: Report = lambda done, total: None,
) -> SweepOutcome:
    """Run a sweep by the executor "local" or "slurm"; `given` are the parameters of the latter. Raises CaseError."""
    if executor == "slurm":
        if jobs is not None:
            raise CaseError("--jobs is for --executor local; give the jobs of a cluster by --slurm array_parallelism=N")
        parameters = slurm.parameters(given)
        return slurm.run(sweep, folder, parameters, retry_failed=retry_failed, force=force, report=report)
    if executor != "local":
        raise CaseError(f"--executor {executor!r} does not exist; there are local, slurm")
    if given:
        raise CaseError("--slurm goes with --executor slurm or --write-script")
    return run.run(sweep, folder, jobs=jobs, retry_failed=retry_failed, force=force, report=report)


def write_script(sweep: Sweep, folder: Path, given: Sequence[str], path: Path, *, force: bool = False) -> None:
    """Store the sweep in `folder` and write the batch script that runs it to `path`. Raises CaseError."""
    refuse_existing(path, force=force, option="--write-script")
    text = slurm.script(sweep, folder, slurm.parameters(given))
    run.check_points(sweep, range(1, len(sweep.points) + 1))
    with claim(folder, force=force):
        store.write(sweep, folder)
    with atomic(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
