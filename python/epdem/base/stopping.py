# SPDX-License-Identifier: GPL-2.0-or-later
"""Signals that stop a run: Ctrl-C, SIGTERM, a closed terminal. They raise Stopped, but not where it would be lost."""

import contextlib
import signal
import sys
from collections.abc import Iterator
from types import FrameType
from typing import Any

from ..errors import Stopped

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
AGAIN = 0.01  # [s] after which a Stopped that Python has dropped is raised once more
_blocks = 0  # of `uninterrupted` that have begun
_came = False  # a signal, during these


def listen(*numbers: signal.Signals) -> None:
    """From now on these signals (default: SIGNALS) stop this process, a forked one with the state of its parent too."""
    global _blocks, _came
    _blocks, _came = 0, False
    for number in numbers or SIGNALS:
        signal.signal(number, _stop)
    signal.signal(signal.SIGALRM, _stop)
    sys.unraisablehook = _dropped


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """A signal that comes in this block stops us at its end.

    For the start of processes: Python drops what is raised in callbacks of fork, and a process that is not yet known
    would stay behind.
    """
    global _blocks, _came
    _blocks += 1
    try:
        yield
    finally:
        _blocks -= 1
        if _came and not _blocks:
            _came = False
            _raise()


def _stop(number: int, frame: FrameType | None) -> None:
    global _came
    if _blocks:
        _came = True
    else:
        _raise()


def _raise() -> None:
    """The first signal ends the run; further ones must not interrupt that end, or an engine writes on."""
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    raise Stopped


def _dropped(what: Any) -> None:
    """An exception that Python has dropped, because it was raised in a callback (a destructor, a weak reference)."""
    if what.exc_type is Stopped:
        signal.setitimer(signal.ITIMER_REAL, AGAIN)
    else:
        sys.__unraisablehook__(what)
