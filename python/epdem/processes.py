# SPDX-License-Identifier: GPL-2.0-or-later
"""Other programs: started, watched and stopped, with their last words when they fail."""

import os
import signal
import subprocess
from pathlib import Path

from .errors import EngineError


def last_words(log: Path, lines: int = 3) -> str:
    """The last ERROR line of a log, or else its last lines; '' if there are none."""
    if not log.exists():
        return ""
    text = [t for t in log.read_text(errors="replace").splitlines() if t.strip()]
    errors = [t for t in text if t.startswith("ERROR") or "Error:" in t]
    return errors[-1] if errors else " | ".join(text[-lines:])


def call(command: list[str], folder: Path, *, log: str, seconds: float, env: dict[str, str] | None = None) -> None:
    """Run `command` in `folder`, both streams into `log`. Raises EngineError if it fails, hangs or is not there."""
    path = folder / log
    with path.open("wb") as stream:
        try:
            process = subprocess.Popen(
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=stream,
                stderr=subprocess.STDOUT,
                env=env,
                start_new_session=True,
            )
        except OSError as error:
            raise EngineError(f"{command[0]}: cannot be started ({error})") from None
        try:
            status = process.wait(timeout=seconds)
        except BaseException as error:  # a time-out or Ctrl-C: no orphan stays behind
            kill(process)
            if isinstance(error, subprocess.TimeoutExpired):
                words = last_words(path)
                raise EngineError(
                    f"{command[0]} did not end within {seconds:g} s and was stopped; {path}: {words}"
                ) from None
            raise
    if status:
        how = f"signal {-status}" if status < 0 else f"exit code {status}"
        raise EngineError(f"{command[0]} failed ({how}); {path}: {last_words(path)}")


def ask(command: list[str], env: dict[str, str] | None = None) -> str:
    """What a program says of itself, on both streams. Raises EngineError if it cannot be started or does not end."""
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, errors="replace", timeout=60, stdin=subprocess.DEVNULL, env=env
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise EngineError(f"{command[0]}: cannot be asked for its version ({error}); see epdem doctor") from None
    return done.stdout + done.stderr


def kill(process: subprocess.Popen[bytes]) -> None:
    """Stop a process and all that it started."""
    for sign, patience in ((signal.SIGTERM, 5), (signal.SIGKILL, 5)):
        try:
            os.killpg(process.pid, sign)
            process.wait(timeout=patience)
            return
        except ProcessLookupError:
            return
        except subprocess.TimeoutExpired:
            continue
