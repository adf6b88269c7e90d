# SPDX-License-Identifier: GPL-2.0-or-later
"""An engine running: its own thermo lines as progress, its end in good order whatever happens here."""

import os
import re
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

from .. import paths
from ..errors import EngineError
from ..processes import kill, last_words

ROW = re.compile(rb"^ +(\d+)( +[-+.\deainf]+)+ *$")
OUT = "out.liggghts"


def command(deck: str, ranks: int) -> list[str]:
    """The command that runs a deck in its folder. Raises EngineError if our LIGGGHTS is not there."""
    launcher = paths.launcher()
    if launcher is None:
        raise EngineError("LIGGGHTS with our models was not found; run 'make setup'")
    words = [str(launcher), "-in", deck, "-log", "none"]
    if ranks == 1:
        return words
    root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    return ["mpirun", "-np", str(ranks), "--oversubscribe", *root, *words]


def run(
    deck: str, folder: Path, *, ranks: int = 1, append: bool = False, tell: Callable[[int], None] = lambda step: None
) -> float:
    """Run a LIGGGHTS deck to its end, its words into out.liggghts (continued with `append`); see `follow`."""
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    return follow(command(deck, ranks), folder, OUT, name="LIGGGHTS", env=environment, append=append, tell=tell)


def follow(
    words: list[str],
    folder: Path,
    out: str,
    *,
    name: str,
    env: dict[str, str],
    append: bool = False,
    tell: Callable[[int], None] = lambda step: None,
) -> float:
    """Run a command in `folder` to its end, `tell` every thermo row's step; seconds taken.

    Both streams go into the file `out` (continued with `append`). Raises EngineError with the engine's last words. On
    any exception, Ctrl-C too, the engine and all its ranks are stopped first; what they wrote stays.
    """
    path, start = folder / out, time.perf_counter()
    with path.open("ab" if append else "wb") as log:
        try:
            process = subprocess.Popen(
                words,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                env=env,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
        except OSError as error:
            raise EngineError(f"{name} cannot be started ({error})") from None
        try:
            with process.stdout as stream:
                for line in stream:
                    log.write(line)
                    if found := ROW.match(line):
                        log.flush()
                        tell(int(found.group(1)))
            status = process.wait()
        except BaseException:
            kill(process)
            raise
    if status:
        how = f"signal {-status}" if status < 0 else f"exit code {status}"
        raise EngineError(f"{name} failed ({how}); {path}: {last_words(path)}")
    return time.perf_counter() - start
