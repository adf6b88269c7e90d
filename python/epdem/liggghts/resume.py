# SPDX-License-Identifier: GPL-2.0-or-later
"""The deck that continues a scene from a restart file."""

from dataclasses import replace
from pathlib import Path

from .. import rendering as decks
from ..case.scene import SceneCase
from . import scene_tables as tables
from .launcher import OUT
from .scene_deck import deck


def write_resume(case: SceneCase, folder: Path, restart: str, step: int) -> Path:
    """in.resume, which continues from the restart file `restart` written at `step`."""
    d = deck(case)
    phase = next((i for i, p in enumerate(d.phases) if step < p.end), len(d.phases))
    rows = tables.rows(folder / OUT, d.time_step).set_index("step")
    if rows["particles"].get(step) == case.scene.count:  # poured out: LIGGGHTS refuses an insertion that lies behind it
        d = replace(d, insertions=tuple(f for f in d.insertions if not f.rate))
    path = folder / "in.resume"
    path.write_text(
        decks.render("liggghts/scene_resume.in.j2", deck=replace(d, from_restart=restart, resumed_phase=phase))
    )
    return path
