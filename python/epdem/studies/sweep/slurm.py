# SPDX-License-Identifier: GPL-2.0-or-later
"""A sweep on a cluster: an array of Slurm's whose tasks each run a share of the points, as `epdem sweep --only` does.

submitit submits, and queues a task again before its walltime ends. What is finished is known from the folders of the
points alone: a task that is stopped or preempted goes on, and so does a sweep whose command is given again.
"""

import contextlib
import shlex
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...base.files import claim, write_text
from ...errors import CaseError, EngineError, Stopped
from . import folder as store
from .folder import Sweep
from .run import check_points, run

TASKS = 1000  # of an array; a cluster takes 1001 if it does not say otherwise
ARRAYS = "slurm/arrays"  # numbers of the submitted arrays
Parameters = dict[str, str]
# Options that submitit or we set, and options by which a point is stopped and requeued in time.
KEPT = ("array", "output", "error", "signal", "open-mode", "job-name", "dependency")
SPREAD = ("nodes", "N", "ntasks", "n", "ntasks-per-node")  # one of these: the ranks of a point may lie on several nodes
TIME = "60"  # [min] default walltime of a task
WARNING = 90  # [s] from the signal to the end of the walltime


def parameters(texts: Sequence[str]) -> Parameters:
    """Parameters of sbatch from texts as "partition=long,time=2:00:00". Raises CaseError."""
    values: Parameters = {}
    for pair in ",".join(texts).split(",") if texts else []:
        name, _, value = pair.strip().partition("=")
        if not name or name in KEPT:
            why = "epdem sets it itself; leave it out" if name else "write NAME=VALUE, as partition=long"
            raise CaseError(f"--slurm {pair!r}: {why}")
        values[name] = value
    return values


class Task:
    """A task of the array: it runs its points and fails unless they are done and within their tolerances.

    A task that receives the signal to stop waits for its end: Slurm does not queue a task again that ends by itself.
    """

    def __call__(self, folder: Path, numbers: list[int]) -> None:
        try:
            passed = run(store.read(folder), folder, only=numbers, jobs=1).passed
        except Stopped:
            while True:
                signal.pause()
        if not passed:
            raise EngineError(f"points {numbers} are not all done and within tolerance; epdem status {folder}")

    def checkpoint(self, folder: Path, numbers: list[int]) -> Any:
        """The submission that continues this task."""
        import submitit

        return submitit.helpers.DelayedSubmission(self, folder, numbers)


def submit(
    sweep: Sweep, folder: Path, given: Parameters, *, retry_failed: bool = False, force: bool = False
) -> str | None:
    """Submit the missing points of a sweep as an array; its number, or None if no point is missing.

    The array begins when the arrays of earlier calls have ended, so that no two tasks run one point. Raises CaseError
    before anything is submitted if a point is wrong, EngineError if Slurm does not take the array.
    """
    numbers, folder = store.to_do(sweep, folder, retry_failed=retry_failed), folder.absolute()
    check_points(sweep, numbers)
    if not numbers:
        return None
    with claim(folder, force=force):
        store.write(sweep, folder)
        for n in numbers:  # of points that failed before
            (store.point_folder(sweep, folder, n) / store.FINISHED).unlink(missing_ok=True)
        earlier = ""
        with contextlib.suppress(OSError):
            earlier = (folder / ARRAYS).read_text(encoding="utf-8")
        after = {"dependency": f"afterany:{earlier}"} if earlier else {}
        array = _submit(sweep, folder, numbers, after | given)
        write_text(folder / ARRAYS, f"{earlier}:{array}".lstrip(":"))
    return array


def _submit(sweep: Sweep, folder: Path, numbers: list[int], given: Parameters) -> str:
    try:
        import submitit
    except ImportError:
        raise EngineError("--slurm needs submitit, which is not installed; pip install 'epdem[slurm]'") from None
    tasks = min(len(numbers), TASKS)
    try:
        executor = submitit.SlurmExecutor(
            folder=folder / "slurm", max_num_timeout=1000, python=shlex.quote(sys.executable)
        )
        cpus = {} if set(SPREAD) & set(given) else {"cpus-per-task": str(sweep.ranks)}
        executor.update_parameters(
            job_name=sweep.name,
            additional_parameters=cpus | {"time": TIME} | {k: v or True for k, v in given.items()},
            array_parallelism=TASKS,
            signal_delay_s=WARNING,
            srun_args=["--nodes=1", "--ntasks=1"],  # of however many nodes, one process works at the points
        )
        jobs = executor.map_array(Task(), [folder] * tasks, [numbers[task::tasks] for task in range(tasks)])
    except (RuntimeError, OSError, submitit.core.utils.FailedJobError) as error:
        reason = " ".join(str(error).split())
        raise EngineError(f"--slurm: the jobs were not taken: {reason}") from None
    return str(jobs[0].job_id).partition("_")[0]
