# SPDX-License-Identifier: GPL-2.0-or-later
"""How far a sweep is."""

import fcntl
from pathlib import Path
from typing import Any

from ...base.files import LOCK
from . import folder as store
from . import slurm


def status(folder: Path) -> dict[str, Any]:
    """How far a sweep is: counts by state, times [s], reasons of failed points, and whether it is running now."""
    sweep = store.read(folder)
    records = store.records(sweep, folder)
    here = running(folder)
    jobs = {about["job"] for about in records if about.get("job") and about["state"] == store.RUNNING}
    there = (slurm.alive(list(jobs)) or set()) if jobs else set()

    def state(about: dict[str, Any]) -> str:
        gone = about["state"] == store.RUNNING and not (about["job"] in there if about["job"] else here)
        return store.WAITING if gone else str(about["state"])

    states = [state(about) for about in records]
    seconds = [a["seconds"] for a in records if "seconds" in a]
    counts = {state: states.count(state) for state in store.STATES}
    failed = [
        {"point": n, "folder": str(store.of(sweep, folder, n)), "reason": a["reason"]}
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


def running(folder: Path) -> bool:
    """Whether a process on this machine is at work in the folder of a sweep now."""
    try:
        with (folder / LOCK).open() as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except OSError:
        return True
    return False
