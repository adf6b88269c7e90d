# SPDX-License-Identifier: GPL-2.0-or-later
"""A pool of processes: a process that dies takes its own item with it and no other; none outlives us."""

import contextlib
import ctypes
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any

from ...base import processes
from ...base.processes import end_with_parent
from ...errors import Stopped

_FORK = multiprocessing.get_context("fork")  # with all that is imported here: a start takes a few milliseconds
STOPPED = 143  # exit code of a process that received SIGTERM


class Died(Exception):
    """The process of an item ended before its result; the text says how."""


def cores() -> int:
    """Number of processors that this process may use."""
    return len(os.sched_getaffinity(0))


def each(function: Callable[[Any], Any], items: Iterable[Any], jobs: int) -> Iterator[tuple[Any, Any]]:
    """(item, function(item)) in the order of completion, by `jobs` processes; Died for an item whose process died.

    Raises what `function` raises, and Stopped if a process received SIGTERM from another one. On any exception, Ctrl-C
    too, all processes are stopped.
    """
    waiting = iter(items)
    team: dict[Connection, tuple[BaseProcess, Any]] = {}
    try:
        for item in waiting:
            _start_worker(function, item, team)
            if len(team) >= jobs:
                break
        while team:
            for ready in wait(list(team)):
                assert isinstance(ready, Connection)
                process, item = team[ready]
                try:
                    good, result = ready.recv()
                except (EOFError, OSError):
                    del team[ready]
                    process.join()
                    ready.close()
                    if process.exitcode == STOPPED:
                        raise Stopped from None
                    good, result = True, Died(_exit_reason(process.exitcode))
                if not good:
                    raise result
                following = next(waiting, None)
                if isinstance(result, Died):
                    if following is not None:
                        _start_worker(function, following, team)
                elif following is None:
                    del team[ready]
                    _end_worker(process, ready)
                else:
                    ready.send(following)
                    team[ready] = process, following
                yield item, result
    finally:
        for process, _ in team.values():
            process.terminate()
        for pipe in team:  # a process that lost the signal (Python drops errors in callbacks) ends with its item
            pipe.close()
        for process, _ in team.values():
            process.join()


def _exit_reason(code: int | None) -> str:
    if code is not None and code < 0:
        return f"its process was ended by signal {-code}{' (out of memory?)' if code == -9 else ''}"
    return f"its process ended with exit code {code}"


def _start_worker(function: Callable[[Any], Any], item: Any, team: dict[Connection, tuple[BaseProcess, Any]]) -> None:
    ours, theirs = _FORK.Pipe()
    process = _FORK.Process(target=_work, args=(function, theirs, [*team, ours], os.getpid()))
    with processes.uninterrupted():
        process.start()
        team[ours] = process, item
    theirs.close()
    ours.send(item)


def _end_worker(process: BaseProcess, pipe: Connection) -> None:
    with contextlib.suppress(OSError):
        pipe.send(None)
    process.join()
    pipe.close()


def _keep_memory() -> None:
    """Keep freed memory for the next item: to get 13 MB from the kernel again took a third of a point's time."""
    trim_threshold, mmap_threshold = -1, -3  # of malloc.h
    with contextlib.suppress(AttributeError):  # a C library without it
        mallopt = ctypes.CDLL(None).mallopt
        mallopt(trim_threshold, 1 << 28)
        mallopt(mmap_threshold, 1 << 25)


def _work(function: Callable[[Any], Any], pipe: Connection, others: list[Connection], parent: int) -> None:
    """Loop of a process of the pool: items, until the parent sends None or has ended."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all: our parent stops us in good order
    signal.signal(signal.SIGUSR2, signal.SIG_IGN)  # Slurm warns every process of a job; our parent queues it again
    processes.install_signal_handlers(signal.SIGTERM)
    end_with_parent()  # a parent that is killed cannot
    _keep_memory()
    for other in others:  # an open end of a pipe here would hide that the process has ended
        other.close()
    try:
        while os.getppid() == parent and (item := pipe.recv()) is not None:
            try:
                answer = True, function(item)
            except Exception as error:
                answer = False, error
            pipe.send(answer)
    except Stopped:
        os._exit(STOPPED)  # without flushing or removing files of the parent
    except (EOFError, OSError):
        os._exit(1)
    os._exit(0)
