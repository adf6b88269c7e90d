# SPDX-License-Identifier: GPL-2.0-or-later
"""Spheres that have left a room whose boundary is closed: which, when, where they were last."""

import numpy as np
import pandas as pd

from .plan import ScenePlan

NAMED = 3  # spheres that are named one by one
ADVICE = "close the walls, enlarge scene.room, or give scene.open_boundary = true"


def lost_spheres(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> list[str]:
    """A sentence for a run that has lost spheres, from the frames or, where they hold none of them, from the rows."""
    rows = tables["rows"]
    if p.scene.open_boundary or rows["particles"].iloc[-1] >= rows["particles"].max():
        return []
    frames = tables.get("particles")
    gone = None
    if frames is not None and len(frames):
        last = frames.drop_duplicates("id", keep="last")
        gone = last[last["step"] < p.frame_steps(p.frames)[-1]]
    if gone is None or gone.empty:
        before = int(np.flatnonzero(np.diff(rows["particles"]) < 0)[0])
        one, other = rows.iloc[before], rows.iloc[before + 1]
        return [
            f"scene: the first of {int(rows['particles'].max() - rows['particles'].iloc[-1])} lost spheres left the "
            f"room between {one['time']:.4g} s and {other['time']:.4g} s; {ADVICE}"
        ]
    times = p.time_at(gone["step"].to_numpy())
    named = [
        f"sphere {x.id} (last at ({x.x:.4g}, {x.y:.4g}, {x.z:.4g}) m with ({x.vx:.3g}, {x.vy:.3g}, {x.vz:.3g}) m/s at "
        f"{time:.4g} s, step {x.step})"
        for x, time in zip(gone.head(NAMED).itertuples(), times, strict=False)
    ]
    more = f" and {len(gone) - NAMED} more" if len(gone) > NAMED else ""
    return [f"scene: {len(gone)} spheres have left the room, {', '.join(named)}{more}; {ADVICE}"]
