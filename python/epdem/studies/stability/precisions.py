# SPDX-License-Identifier: GPL-2.0-or-later
"""Round-off of positions in YADE's builds of other precisions: the same script, YADE's own Hertz contact.

Our laws need attributes that the elastic-plastic class has in YADE's default build only; round-off needs no law.
"""

import json
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from ...base import rendering as decks
from ...base.processes import call, last_words
from ...errors import EngineError
from ...yade.launcher import environment
from .cases import build
from .running import position_floor, setting

PROGRAMS = ("yade", "yade-longdouble", "yade-float128")  # 53, 64 and 113 bits; the last is the reference
SHARE = 0.01  # of the stability limit


def available() -> bool:
    """Whether all of PROGRAMS are here."""
    return all(shutil.which(p) for p in PROGRAMS)


def rebound(program: str, folder: Path, script: str) -> np.ndarray:
    """e_n of every phase from one program, shape (phases,). Raises EngineError with the end of its log."""
    path = folder / "roundoff.py"
    path.write_text(script, encoding="utf-8")
    log = folder / "out.roundoff"
    call([program, "-n", "-x", path.name], folder, log=log.name, seconds=120, env=environment())
    lines = [line for line in log.read_text(errors="replace").splitlines() if line.startswith("RESULT ")]
    if not lines:
        raise EngineError(f"{program}: no result; {log}: {last_words(log)}")
    return np.array(json.loads(lines[0].removeprefix("RESULT ")))


def floors(*, times: Sequence[float] = (1e-4, 1e-2, 1e2)) -> pd.DataFrame:
    """One row per speed: largest deviation of e_n from the finest precision over 8 phases, and the formula's."""
    rows = []
    template = decks.environment().get_template("yade/roundoff.py.j2")
    with tempfile.TemporaryDirectory(prefix="epdem-yade-") as scratch:
        for t in times:
            s = setting(build("roundoff", ratio=1e4, times=t), "hertz")
            dt, v, body = SHARE * s.limit, float(s.x.speed[0]), s.x.body
            script = template.render(
                radius=body.radius,
                speed=v,
                young_modulus=body.young_modulus,
                poisson_ratio=body.poisson_ratio,
                density=body.density,
                gaps=(np.arange(8) + 0.5) / 8 * v * dt,
                time_step=dt,
                steps=int(2 * s.contact_time / dt),
            )
            e = {program: rebound(program, Path(scratch), script) for program in PROGRAMS}
            row = {"overlap_max": s.overlap_max, "steps": s.contact_time / dt}
            row |= {p: float(np.abs(e[p] / e[PROGRAMS[-1]] - 1).max()) for p in PROGRAMS[:-1]}
            row["formula"] = position_floor(radius=body.radius, recovered=s.recovered, steps=row["steps"])
            row["formula, 64 bits"] = row["formula"] / 2**11
            rows.append(row)
    return pd.DataFrame(rows)
