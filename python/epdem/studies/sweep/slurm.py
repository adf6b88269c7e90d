# SPDX-License-Identifier: GPL-2.0-or-later
"""A sweep on a cluster: an array of Slurm's whose tasks each run a share of the points; how far a sweep is.

submitit submits and requeues. What is finished is known from the folders of the points alone: a job that is stopped by
its walltime or preempted is queued again and goes on, and so does a sweep whose command is given again.
"""

import json
import shlex
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from ...base.files import write_text
from ...base.processes import is_alive
from ...errors import CaseError, EngineError, Stopped
from . import folder as store
from .folder import Sweep
from .run import record_death, work

TASKS = 1000  # of an array; a cluster takes 1001 if it does not say otherwise
POLL = 1.0  # [s] between two looks at the queue
SILENCE = 600.0  # [s] that Slurm may be without an answer, as while its controller starts again
JOBS = "slurm/jobs.json"
ENDED = ("COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "BOOT_FAIL", "DEADLINE")
Parameters = dict[str, str]
# Options that submitit sets itself, and options by which a point is stopped and requeued in time.
KEPT = ("array", "output", "error", "signal", "open-mode", "job-name")
SPREAD = ("nodes", "N", "ntasks", "n", "ntasks-per-node")  # one of these: the ranks of a point may lie on several nodes
TIME = "60"  # [min] default walltime of a job
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
    """Work of a job; submitit queues it again before its walltime ends, Slurm after a preemption.

    A job that receives the signal to stop waits for its end: Slurm does not queue a job again that ends by itself.
    """

    def __call__(self, folder: Path, numbers: list[int]) -> None:
        sweep = store.read(folder)
        try:
            for _ in work(sweep, folder, [n for n in numbers if not store.is_finished(sweep, folder, n)], jobs=1):
                pass
        except Stopped:
            while True:
                signal.pause()

    def checkpoint(self, folder: Path, numbers: list[int]) -> Any:
        """The submission that continues this job."""
        import submitit

        return submitit.helpers.DelayedSubmission(self, folder, numbers)


def _submit(sweep: Sweep, folder: Path, numbers: list[int], given: Parameters) -> dict[str, list[int]]:
    """Submit points as an array; the points of each task by the name of its job. Raises EngineError."""
    try:
        import submitit
    except ImportError:
        raise EngineError("--slurm needs submitit, which is not installed; pip install 'epdem[slurm]'") from None
    tasks = min(len(numbers), TASKS)
    shares = [numbers[task::tasks] for task in range(tasks)]
    try:
        executor = submitit.SlurmExecutor(
            folder=folder / "slurm", max_num_timeout=1000, python=shlex.quote(sys.executable)
        )
        cpus = {} if set(SPREAD) & set(given) else {"cpus-per-task": str(sweep.ranks)}
        extra = cpus | {"time": TIME} | {k: v or True for k, v in given.items()}
        executor.update_parameters(
            job_name=sweep.name,
            additional_parameters=extra,
            array_parallelism=TASKS,
            signal_delay_s=WARNING,
            srun_args=["--nodes=1", "--ntasks=1"],  # of however many nodes, one process works at the points
        )
        jobs = executor.map_array(Task(), [folder] * tasks, shares)
    except (RuntimeError, OSError, submitit.core.utils.FailedJobError) as error:
        reason = " ".join(str(error).split())
        raise EngineError(f"--slurm: the jobs were not taken: {reason}") from None
    return {str(job.job_id): points for job, points in zip(jobs, shares, strict=True)}


def alive(jobs: Sequence[str]) -> set[str] | None:
    """Which of the jobs wait or run; None if Slurm does not answer."""
    try:
        done = subprocess.run(["squeue", "-h", "-r", "--me", "-o", "%i %T"], capture_output=True, text=True)
    except OSError:
        return None
    if done.returncode:
        return None
    return {line.split()[0] for line in done.stdout.splitlines() if line.strip()} & set(jobs)


def ended(job: str) -> str | None:
    """A sentence on the end of a job that `alive` does not name; None if the job is requeued and waits.

    Slurm keeps nothing of a task that is cancelled before it begins.
    """
    answer = subprocess.run(["scontrol", "show", "job", "-o", job], capture_output=True, text=True).stdout
    states = [word.partition("=")[2] for word in answer.split() if word.startswith("JobState=")]
    if states and states[0] not in ENDED:
        return None
    return f"its job {job} ended as {states[0]}" if states else f"its job {job} was cancelled"


def run_jobs(sweep: Sweep, folder: Path, numbers: list[int], given: Parameters) -> Iterator[int]:
    """Run points as jobs of Slurm and wait for their end; yields how many have ended since the last look.

    Ctrl-C ends the waiting alone; the same call later waits for the jobs that are still there and submits the rest. A
    point whose job ended before it is stored as failed, with the state of the job. Raises CaseError, EngineError.
    """
    folder = folder.absolute()
    jobs = _living(folder)
    under_way = {sweep.identities[n - 1] for points in jobs.values() for n in points if n <= len(sweep.points)}
    new = [n for n in numbers if sweep.identities[n - 1] not in under_way]
    for n in new:  # of points that failed before
        (store.point_folder(sweep, folder, n) / store.FINISHED).unlink(missing_ok=True)
    if new:
        jobs |= _submit(sweep, folder, new, given)
        write_text(folder / JOBS, json.dumps(jobs))
    yield from _wait(sweep, folder, jobs)


def _living(folder: Path) -> dict[str, list[int]]:
    try:
        known: dict[str, list[int]] = json.loads((folder / JOBS).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    there = alive(list(known))
    if there is None:
        raise EngineError("--slurm: squeue does not answer; is this a node of a Slurm cluster?")
    return {job: points for job, points in known.items() if job in there}


def _wait(sweep: Sweep, folder: Path, jobs: dict[str, list[int]]) -> Iterator[int]:
    left, heard = dict(jobs), time.monotonic()
    while left:
        before = sum(map(len, left.values()))
        there = alive(list(left))  # None while the controller is away: its jobs are still there
        heard = heard if there is None else time.monotonic()
        if time.monotonic() - heard > SILENCE:
            raise EngineError(
                f"--slurm: squeue has not answered for {SILENCE:g} s; the jobs go on, "
                "and the same command later waits for them"
            )
        for job in set() if there is None else set(left) - there:
            how = ended(job)
            for n in left.pop(job) if how else ():
                if not store.is_finished(sweep, folder, n):
                    began = store.record(sweep, folder, n)["state"] == store.RUNNING
                    record_death(sweep, folder, n, f"{how} {'while it ran' if began else 'before it began'}")
        yield before - sum(map(len, left.values()))
        if left:
            time.sleep(POLL)


def status(folder: Path) -> dict[str, Any]:
    """Progress of a sweep: counts by state, times [s], reasons of failed points."""
    sweep = store.read(folder)
    records = store.records(sweep, folder)
    host = socket.gethostname()
    jobs = {about["job"] for about in records if about.get("job") and about["state"] == store.RUNNING}
    there = (alive(list(jobs)) or set()) if jobs else set()

    def state(about: dict[str, Any]) -> str:
        gone = about["state"] == store.RUNNING and not (
            is_alive(about["pid"], about["begin"]) if about["host"] == host else about["job"] in there
        )
        return store.WAITING if gone else str(about["state"])

    states = [state(about) for about in records]
    seconds = [a["seconds"] for a in records if "seconds" in a]
    counts = {state: states.count(state) for state in store.STATES}
    failed = [
        {"point": n, "folder": str(store.point_folder(sweep, folder, n)), "reason": a["reason"]}
        for n, a in enumerate(records, start=1)
        if a["state"] == store.FAILED
    ]
    left = counts[store.WAITING] + counts[store.RUNNING]
    mean = sum(seconds) / len(seconds) if seconds else float("nan")
    return {
        "case": sweep.name,
        "points": len(records),
        **counts,
        "seconds": sum(seconds),
        "longest": max(seconds, default=float("nan")),
        "work_left": left * mean if left else 0.0,
        "failures": failed,
    }
