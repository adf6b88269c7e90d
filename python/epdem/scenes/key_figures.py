# SPDX-License-Identifier: GPL-2.0-or-later
"""The figure that says most about a scene of its kind: key.png beside the results."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..base.files import atomic
from ..case.parts import Parts
from ..case.scene import Compaction, Drum, Hopper, Peening, Settle
from . import checks
from .measures import unit
from .plan import ScenePlan

Tables = dict[str, pd.DataFrame]


def _hopper(p: ScenePlan, s: Hopper, tables: Tables, axis: Any) -> None:
    """Mass below the outlet against time, and the line of Beverloo from where a fifth has come out."""
    spheres = tables["particles"]
    steps = np.sort(spheres["step"].unique())
    below = spheres[spheres["z"] < p.layout.gates[0].place].groupby("step")["mass"].sum().reindex(steps, fill_value=0.0)
    time, out = p.time_at(steps), below.to_numpy()
    axis.plot(time, 1e3 * out, "o-", ms=3, lw=1, label="below the outlet")
    flow = checks.discharge(p, s, spheres)
    rate = checks.beverloo(flow, s.outlet, s.gravity)
    total = float(spheres[spheres["step"] == steps[-1]]["mass"].sum())
    begin = int(np.argmax(out > 0.2 * total))
    last = time[begin] + 0.4 * total / rate
    line = 1e3 * (out[begin] + rate * np.array([0.0, last - time[begin]]))
    axis.plot([time[begin], last], line, "k--", label=f"Beverloo, {1e3 * rate:.3g} g/s")
    axis.set(xlabel="time [s]", ylabel="mass [g]")
    axis.legend(fontsize=8)


def _compaction(p: ScenePlan, s: Compaction, tables: Tables, axis: Any) -> None:
    """Force on the plate against its displacement, loading and unloading."""
    rows = tables["rows"]
    way = 1e3 * (s.box[2] - rows["plate_z"])
    loading = (rows["step"] <= p.phases[-2].end).to_numpy()
    axis.plot(way[loading], rows["plate_force"][loading], label="loading")
    axis.plot(way[~loading], rows["plate_force"][~loading], label="unloading")
    axis.set(xlabel="displacement of the plate [mm]", ylabel="force [N]")
    axis.legend(fontsize=8)


def _drum(p: ScenePlan, s: Drum, tables: Tables, axis: Any) -> None:
    """Torque on the drum against time; without it the bed's centre of mass, which its turn carries up the wall."""
    rows = tables["rows"]
    if "torque" in rows:
        axis.plot(rows["time"], rows["torque"], lw=1)
        axis.set(xlabel="time [s]", ylabel="torque [N m]")
        return
    sums = tables["particles"].eval("mx = mass * x").groupby("step")[["mx", "mass"]].sum()
    axis.plot(p.time_at(sums.index.to_numpy()), 1e3 * sums["mx"] / sums["mass"], lw=1)
    axis.set(xlabel="time [s]", ylabel="x of the centre of mass [mm]")


def _peening(p: ScenePlan, s: Peening, tables: Tables, axis: Any) -> None:
    """Speeds of the shot upwards after its impact, and e_n v of theory for one impact on the target."""
    spheres = tables["particles"]
    up = spheres[spheres["vz"] > 1e-3 * s.speed].groupby("id")["vz"].max()
    axis.hist(up, bins=30, label=f"{len(up)} spheres")
    expected = checks.single_rebound(p.case, s)
    axis.axvline(expected, color="k", ls="--", label=f"one impact, theory: {expected:.4g} m/s")
    axis.set(xlabel="rebound speed [m/s]", ylabel="number")
    axis.legend(fontsize=8)


def _settle(p: ScenePlan, s: Settle, tables: Tables, axis: Any) -> None:
    """Height below which 95 % of the mass lie, and kinetic energy, against time."""
    rows = tables["rows"]
    moving = rows[rows["kinetic_energy"] > 0]
    axis.semilogy(moving["time"], moving["kinetic_energy"], "C1", lw=1)
    axis.set(xlabel="time [s]", ylabel="kinetic energy [J]")
    frames = tables["particles"].groupby("step")["z"].quantile(0.95)
    other = axis.twinx()
    other.plot(p.time_at(frames.index.to_numpy()), 1e3 * frames, "C0o-", ms=3, lw=1)
    other.set_ylabel("height of 95 % [mm]", color="C0")


DRAW: dict[type, Callable[..., None]] = {
    Hopper: _hopper,
    Compaction: _compaction,
    Drum: _drum,
    Peening: _peening,
    Settle: _settle,
}


def key(p: ScenePlan, tables: Tables, path: Path) -> bool:
    """Draw the key figure of a scene into `path`; of a scene of parts its measures. False: there is nothing to draw."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    s = p.case.scene
    curves = tables.get("measures")
    if isinstance(s, Parts):
        draw = (
            []
            if curves is None
            else [partial(_measure, m.name, unit(m), curves) for m in s.measure if m.name in curves]
        )
    else:
        frames = "particles" in tables and tables["particles"]["step"].nunique() > 1
        drawn = frames or isinstance(s, Compaction) or "torque" in tables["rows"]
        draw = [partial(DRAW[type(s)], p, s, tables)] if drawn else []
    if not draw:
        return False
    fig, axes = plt.subplots(len(draw), 1, figsize=(6, max(4.0, 2.2 * len(draw))), layout="constrained", squeeze=False)
    for axis, one in zip(axes[:, 0], draw, strict=True):
        one(axis)
        axis.grid(alpha=0.3)
    axes[0, 0].set_title(p.case.case.title, parse_math=False, fontsize=10)
    with atomic(path) as temporary:
        fig.savefig(temporary, dpi=200)
    plt.close(fig)
    return True


def _measure(name: str, si: str, curves: pd.DataFrame, axis: Any) -> None:
    axis.plot(curves["time"], curves[name], "o-", ms=3, lw=1)
    axis.set(xlabel="time [s]", ylabel=f"{name} [{si}]" if si else name)
