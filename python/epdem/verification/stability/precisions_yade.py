# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's builds of other precisions on one script, with YADE's own Hertz contact.

Our laws need attributes that the elastic-plastic class has in YADE's default build only; round-off needs no law.
"""

import json
import shutil
from pathlib import Path

import numpy as np

from ...base import rendering as decks
from ...base.files import write_texts
from ...base.processes import call, last_words
from ...engines.yade.launcher import environment
from ...errors import EngineError
from ...impacts.experiment import Experiment

SCRIPT, OUT = "roundoff.py", "out.roundoff"


def deck(x: Experiment, time_step: float, gaps: np.ndarray, steps: int) -> str:
    """The script of a sphere from so many gaps [m] from a wall."""
    return decks.render(
        "verification/yade/roundoff.py.j2",
        body=x.body,
        speed=float(x.speed[0]),
        gaps=gaps,
        time_step=time_step,
        steps=steps,
    )


def rebounds(program: str, folder: Path, x: Experiment, time_step: float, gaps: np.ndarray, steps: int) -> np.ndarray:
    """e_n of every gap from one program, shape of `gaps`. Raises EngineError with the end of its log."""
    write_texts(folder, {SCRIPT: deck(x, time_step, gaps, steps)})
    log = folder / OUT
    call([program, "-n", "-x", SCRIPT], folder, log=OUT, seconds=120, env=environment())
    lines = [line for line in log.read_text(errors="replace").splitlines() if line.startswith("RESULT ")]
    if not lines:
        raise EngineError(f"{program}: no result; {log}: {last_words(log)}")
    return np.array(json.loads(lines[0].removeprefix("RESULT ")))


# 53, 64 and 113 bits
PROGRAMS = ("yade", "yade-longdouble", "yade-float128")


def available() -> bool:
    """Whether all programs are here."""
    return all(shutil.which(program) for program in PROGRAMS)
