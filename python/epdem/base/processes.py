# SPDX-License-Identifier: GPL-2.0-or-later
"""Other programs: started, watched and stopped; errors quote the end of their logs; none outlives this process.

Signals that stop a run (Ctrl-C, SIGTERM, a closed terminal) raise Stopped, but not where it would be lost.
"""

import contextlib
import ctypes
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any

from ..errors import EngineError, Stopped

if TYPE_CHECKING:  # slow to import: by what looks for processes
    import psutil

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
AGAIN = 0.01  # [s] after which a Stopped that Python has dropped is raised once more
_blocks = 0  # of `uninterrupted` that have begun
_came = False  # a signal, during these


def install_signal_handlers(*numbers: signal.Signals) -> None:
    """Let these signals (default: SIGNALS) raise Stopped in this process; forked processes call it again.

    Raises Stopped if a signal came between the fork and this call.
    """
    global _blocks, _came
    came, _blocks, _came = _came, 0, False
    for number in numbers or SIGNALS:
        signal.signal(number, _stop)
    signal.signal(signal.SIGALRM, _stop)
    sys.unraisablehook = _raise_stopped
    if came:
        _raise()


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


def _raise_stopped(what: Any) -> None:
    """Raise a Stopped again that Python dropped in a callback (a destructor, a weak reference)."""
    if what.exc_type is Stopped:
        signal.setitimer(signal.ITIMER_REAL, AGAIN)
    else:
        sys.__unraisablehook__(what)


# A row of a table of numbers that begins with the number of a step: the progress of an engine.
ROW = re.compile(rb"^ +(\d+)( +[-+.\deainf]+)+ *$", re.M)
POLL = 0.1  # [s] between two reads of a growing log
PATIENCE = 5.0  # [s] for each of SIGTERM and SIGKILL
FOLDER = "EPDEM_FOLDER"  # environment variable of an engine and all that it starts: the folder of its run
_PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None)
_said: dict[tuple[str | int | None, ...], str] = {}  # by words, path and state of a program


def last_words(log: Path) -> str:
    """The last ERROR line of a log, or else its last lines; '' if there are none."""
    if not log.exists():
        return ""
    text = [t for t in log.read_text(errors="replace").splitlines() if t.strip()]
    errors = [t for t in text if t.startswith("ERROR") or "Error:" in t]
    return errors[-1] if errors else " | ".join(text[-3:])


def call(
    command: list[str],
    folder: Path,
    *,
    log: str,
    seconds: float | None = None,
    env: dict[str, str] | None = None,
    append: bool = False,
    report: Callable[[int], None] | None = None,
) -> float:
    """Run `command` in `folder` to its end, both streams into `log` (continued with `append`); seconds taken.

    `report` is given the step of every row (ROW) of the log. Raises EngineError with the end of its log if it
    fails, prints a line of ERROR, takes more than `seconds` or is not there. On any exception, Ctrl-C too, the program
    and all that it started are stopped first; what they wrote stays. If this process itself is killed, the program
    receives SIGTERM.
    """
    path, start, rest = folder / log, time.monotonic(), b""
    end = math.inf if seconds is None else start + seconds
    env = (os.environ if env is None else env) | {FOLDER: str(folder.resolve())}
    if not append:
        path.unlink(missing_ok=True)  # what still has the log of an earlier run open writes no row of this one
    with path.open("ab" if append else "wb") as stream, path.open("rb") as reader:
        begin, process = reader.seek(0, os.SEEK_END), None

        def follow() -> None:
            nonlocal rest
            if report:
                lines, _, rest = (rest + reader.read()).rpartition(b"\n")
                for row in ROW.finditer(lines):
                    report(int(row[1]))

        try:
            with uninterrupted():
                try:
                    process = subprocess.Popen(
                        command,
                        cwd=folder,
                        stdin=subprocess.DEVNULL,
                        stdout=stream,
                        stderr=subprocess.STDOUT,
                        env=env,
                        start_new_session=True,
                        preexec_fn=end_with_parent,
                    )
                except OSError as error:
                    raise EngineError(f"{command[0]}: cannot be started ({error})") from None
            while process.poll() is None:
                left = end - time.monotonic()
                if left <= 0.0:
                    end_of_log = last_words(path)
                    raise EngineError(
                        f"{command[0]} did not end within {seconds:g} s and was stopped; {path}: {end_of_log}"
                    )
                with contextlib.suppress(subprocess.TimeoutExpired):
                    process.wait(timeout=None if report is None and left == math.inf else min(left, POLL))
                follow()
            follow()
            reader.seek(begin)
            failed = process.returncode or any(line.startswith(b"ERROR") for line in reader)
        except BaseException:  # a time-out, Ctrl-C or an error of the caller: the process is stopped too
            if process:
                kill(process)
            raise
    if failed:
        how = f"exit code {process.returncode}" if process.returncode >= 0 else f"signal {-process.returncode}"
        raise EngineError(f"{command[0]} failed ({how}); {path}: {last_words(path)}")
    return time.monotonic() - start


def captured_output(command: list[str], env: dict[str, str] | None = None) -> str:
    """The output of a program on both streams; files that it writes into its folder are deleted.

    Raises EngineError if it cannot be started or does not end.
    """
    with tempfile.TemporaryDirectory(prefix="epdem-ask-") as folder:
        try:
            done = subprocess.run(
                command,
                cwd=folder,
                capture_output=True,
                text=True,
                errors="replace",
                timeout=60,
                stdin=subprocess.DEVNULL,
                env=env,
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            raise EngineError(f"{command[0]}: its version cannot be read ({error}); see epdem doctor") from None
    return done.stdout + done.stderr


def said_by(command: list[str], env: dict[str, str]) -> str:
    """What a program prints as its version or help: captured_output, once while the file of the program stays."""
    path = shutil.which(command[0], path=env.get("PATH"))
    status = Path(path).stat() if path else None
    key = (*command, path, *((status.st_mtime_ns, status.st_size) if status else ()))
    if key not in _said:
        _said[key] = captured_output(command, env)
    return _said[key]


def end_with_parent() -> None:
    """In the child: SIGTERM when its parent dies, however it dies. mpirun then ends its ranks; SIGKILL would not."""
    _libc.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


def kill(process: subprocess.Popen[bytes]) -> None:
    """Stop a process and its session, new members too: mpirun gives each rank its own process group."""
    import psutil

    for stop in (psutil.Process.terminate, psutil.Process.kill):
        asked: set[psutil.Process] = set()
        end = time.monotonic() + PATIENCE
        while (members := session(process.pid)) and time.monotonic() < end:
            for member in (m for m in members if m not in asked):
                with contextlib.suppress(psutil.NoSuchProcess):
                    stop(member)
            asked.update(members)
            psutil.wait_procs(members, timeout=POLL)
    process.wait()


def session(leader: int) -> "list[psutil.Process]":
    """The living processes of the session that `leader` began, the oldest first."""
    import psutil

    members = []
    for member in psutil.process_iter():
        with contextlib.suppress(psutil.NoSuchProcess, ProcessLookupError):
            if os.getsid(member.pid) == leader and member.status() != psutil.STATUS_ZOMBIE:
                members.append(member)
    return members


def is_alive(number: int, at: float) -> bool:
    """Whether the process of this number that was there at a time [s] since 1970 goes on on this machine."""
    import psutil

    with contextlib.suppress(psutil.NoSuchProcess):
        process = psutil.Process(number)
        return bool(process.status() != psutil.STATUS_ZOMBIE and process.create_time() <= at + 1.0)  # clocks differ
    return False


def engines_in(folder: Path) -> list[tuple[int, Path]]:
    """(number, folder of its run) of each living process of an engine that runs in `folder` or below it.

    mpirun and its ranks outlive a killed run by seconds.
    """
    import psutil

    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error, OSError):
            place = process.environ().get(FOLDER)
            living = process.pid != os.getpid() and process.status() != psutil.STATUS_ZOMBIE
            if place and living and Path(place).is_relative_to(folder):
                found.append((process.pid, Path(place)))
    return found


def crowded(ranks: int) -> str | None:
    """A sentence on ranks that share cores with other programs, from the load of a fifth of a second.

    None for one rank, where the cores are free, and in a job of Slurm, which has its own cores.
    """
    if ranks == 1 or "SLURM_JOB_ID" in os.environ:
        return None
    import psutil

    loads, cores = psutil.cpu_percent(0.2, percpu=True), os.sched_getaffinity(0)
    free = sum(1.0 - loads[core] / 100.0 for core in cores)
    if ranks <= free + 0.5:
        return None
    return (
        f"--ranks {ranks}: other programs leave about {free:.1f} of {len(cores)} cores free; a rank that waits for a "
        "core stops all ranks: one rank is probably faster now"
    )


def most_ranks() -> int:
    """As many ranks as there are cores, and two anywhere: more only wait for one another, or hang.

    In a job of Slurm the cores of all its nodes count: "4(x2),3" is three nodes.
    """
    of_job = re.findall(r"(\d+)(?:\(x(\d+)\))?", os.environ.get("SLURM_JOB_CPUS_PER_NODE", ""))
    return max(2, len(os.sched_getaffinity(0)), sum(int(cores) * int(nodes or 1) for cores, nodes in of_job))
