# SPDX-License-Identifier: GPL-2.0-or-later
"""Processes of this machine: one that dies takes its own item with it and no other; none outlives us."""

import contextlib
import ctypes
import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any

from ...base import processes
from ...errors import Stopped

_FORK = multiprocessing.get_context("fork")  # with all that is imported here: a start takes a few milliseconds
STOPPED = 143  # exit code of a process that received SIGTERM


class Died(Exception):
    """The process of an item ended before its result; the text says how."""


def cores() -> int:
    """Number of processors that this process may use."""
    return len(os.sched_getaffinity(0))


def each(function: Callable[[Any], Any], items: deque[Any], jobs: int) -> Iterator[tuple[Any, Any]]:
    """(item, function(item)) in the order of completion, at most `jobs` at once; Died for an item whose process died.

    Each item has its own process; `items`, which are taken, may grow meanwhile. Raises what `function` raises, and
    Stopped if a process received SIGTERM from another one. On any exception, Ctrl-C too, all processes are stopped.
    """
    team: dict[Connection, tuple[BaseProcess, Any]] = {}
    result: Any
    try:
        while items or team:
            while items and len(team) < jobs:
                ours, theirs = _FORK.Pipe(duplex=False)
                item = items.popleft()
                new = _FORK.Process(target=_work, args=(function, item, theirs, os.getpid()))
                with processes.uninterrupted():
                    new.start()
                    team[ours] = new, item
                theirs.close()  # so that no later process has it: its end is the end of this one
            for pipe in wait(list(team)):
                assert isinstance(pipe, Connection)
                process, item = team[pipe]
                good, result = True, None
                with contextlib.suppress(EOFError, OSError):
                    good, result = pipe.recv()
                with processes.uninterrupted():  # a signal within join would lose the exit code
                    process.join()
                    del team[pipe]
                pipe.close()
                if process.exitcode == STOPPED:
                    raise Stopped
                if not good:
                    raise result
                yield item, Died(_exit_reason(process.exitcode)) if process.exitcode else result
    finally:
        with processes.uninterrupted():
            for living, _ in team.values():
                living.terminate()
            for living, _ in team.values():
                while living.exitcode is None:  # Python drops a signal that comes during a fork
                    living.join(1.0)
                    living.terminate()


def _exit_reason(code: int | None) -> str:
    if code is not None and code < 0:
        return f"its process was ended by signal {-code}{' (out of memory?)' if code == -9 else ''}"
    return f"its process ended with exit code {code}"


def _keep_memory() -> None:
    """Keep freed memory for the next point: to get 13 MB from the kernel again took a third of a point's time."""
    trim_threshold, mmap_threshold = -1, -3  # of malloc.h
    with contextlib.suppress(AttributeError):  # a C library without it
        mallopt = ctypes.CDLL(None).mallopt
        mallopt(trim_threshold, 1 << 28)
        mallopt(mmap_threshold, 1 << 25)


def _work(function: Callable[[Any], Any], item: Any, pipe: Connection, parent: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all: our parent stops us in good order
    signal.signal(signal.SIGUSR2, signal.SIG_IGN)  # Slurm warns every process of a job; our parent queues it again
    try:
        processes.install_signal_handlers(signal.SIGTERM)
        processes.end_with_parent()  # a parent that is killed cannot
        _keep_memory()
        if os.getppid() == parent:
            try:
                answer = True, function(item)
            except Exception as error:
                answer = False, error
            pipe.send(answer)
    except Stopped:
        os._exit(STOPPED)  # without flushing or removing files of the parent
    except OSError:
        os._exit(1)
    os._exit(0)
