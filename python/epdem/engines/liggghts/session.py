# SPDX-License-Identifier: GPL-2.0-or-later
"""A LIGGGHTS that stays from deck to deck: many short runs for one start."""

import os
import pty
import re
import select
import subprocess
import time
import tty
from pathlib import Path

from ...base import processes, stopping
from ...errors import EngineError
from . import launcher

END = "epdem: end of the deck"
# What stands unchanged as one word of a deck; another folder gets its own process.
PLAIN = re.compile(r"[\w./+=-]+")


class Session:
    """A process of LIGGGHTS on one rank, which reads decks from us; `clear` behind each leaves nothing to the next.

    If it dies, the deck that it ran has failed, and the next one starts another process. It ends with our process.
    """

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None
        self._screen = -1
        self._folder = Path()

    def run(self, deck: str, folder: Path, *, log: str, seconds: float, out: str = launcher.OUT) -> float:
        """Run a deck in its folder to its end; seconds taken. Raises EngineError as `processes.call` does."""
        start = time.monotonic()
        said = bytearray()
        command = launcher.command("none")[0]
        try:
            process = self._at(folder)
            assert process.stdin
            process.stdin.write(f'log {log}\ninclude {deck}\nclear\nlog none\nprint "{END}"\n'.encode())
            process.stdin.flush()
            while not said.endswith(f"{END}\n".encode()):
                left = start + seconds - time.monotonic()
                if left <= 0.0:
                    raise EngineError(f"{command} did not end within {seconds:g} s and was stopped; see {folder / log}")
                if select.select([self._screen], [], [], left)[0]:
                    said += self._read()
        except (BrokenPipeError, EOFError):
            (folder / out).write_bytes(said)
            status = self._process.wait() if self._process else 1
            self.stop()
            raise EngineError(processes.failure(command, status, folder / out)) from None
        except BaseException:  # a time-out, Ctrl-C: the process is stopped too
            self.stop()
            raise
        (folder / out).write_bytes(said.removesuffix(f"{END}\n".encode()))
        return time.monotonic() - start

    def _at(self, folder: Path) -> "subprocess.Popen[bytes]":
        """The process, in `folder`."""
        place = folder.resolve()
        way = os.path.relpath(place, self._folder) if self._process else ""
        if self._process and PLAIN.fullmatch(way):
            assert self._process.stdin
            self._process.stdin.write(f"shell cd {way}\n".encode())
        else:
            self.stop()
            with stopping.uninterrupted():
                self._process = self._started(place)
        self._folder = place
        return self._process

    def _started(self, folder: Path) -> "subprocess.Popen[bytes]":
        command = [launcher.command("none")[0], "-log", "none"]
        self._screen, theirs = pty.openpty()  # in a pipe its output would stay in a buffer
        tty.setraw(theirs)
        try:
            return processes.started(command, folder, stdin=subprocess.PIPE, stdout=theirs, env=launcher.environment())
        finally:
            os.close(theirs)

    def _read(self) -> bytes:
        try:
            piece = os.read(self._screen, 1 << 16)
        except OSError:  # of a terminal whose other side is closed
            piece = b""
        if not piece:
            raise EOFError
        return piece

    def stop(self) -> None:
        """End the process, if there is one."""
        if self._screen >= 0:
            os.close(self._screen)
        if self._process:
            assert self._process.stdin
            self._process.stdin.close()
            processes.kill(self._process)
        self._process, self._screen = None, -1
