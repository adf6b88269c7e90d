# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables and figures of docs/benchmarks.md: what bench/community.py left in runs/community, and `epdem verify data`.

Run: .venv/bin/python docs/benchmarks.py      (without runs of community.py only the measured sets)
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from pages import load, markdown, replace_tables, store

from epdem.errors import CaseError
from epdem.report.chart import GREY, Axis, Chart, Panel, Series, save
from epdem.scenes.tables import results
from epdem.verification.measured_data import validate
from epdem.verification.pages import validation_chart

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "bench"))
from community_models import CURVE, MODELS, RAIN_FRICTION, SHORT, START, YADE, curve, loop  # noqa: E402

LOWEST, AT_30 = (-138.60, -138.33), (-136.73, -135.97)  # [mm] published for 25,000 spheres: 7 codes, 10 seeds
LOWEST_TIME, AT_100 = (31.0, 32.0), (-85.0, -31.0)  # [ms], [mm]
STEPS = {
    "drum": 50_000,
    "impact_50k": 200_000,
    "impact_100k": 200_000,
    "silo_large": 3_333_333,
    "silo_small": 3_333_333,
}


def solid(spheres: Path, low: float = -0.085, high: float = -0.065) -> float:
    """Solid fraction of the box between two heights [m], from the parts of all spheres in it (caps in closed form)."""
    table = pd.read_csv(spheres)
    r = table["radius"]
    below = [np.clip(z - (table["z"] - r), 0.0, 2 * r) for z in (low, high)]  # height of the part below each plane
    parts = [(np.pi * h**2 * (3 * r - h) / 3).sum() for h in below]
    return float((parts[1] - parts[0]) / (0.1 * 0.06 * (high - low)))


def _beds(path: Path) -> tuple[str, str]:
    """(friction of the rain where it is not RAIN_FRICTION, seed) of a run."""
    seed, _, friction = path.parts[-3].removeprefix("seed").partition("_friction")
    return friction, seed


def _impact_runs(runs: Path) -> tuple[pd.DataFrame, list[Series]]:
    """One row per run of the impact, displacements in mm and times in ms, and its curve."""
    rows, series, colours = [], [], [*MODELS, YADE]
    for model in colours:
        paths = sorted((runs / "impact_25k").glob(f"seed*/{model.replace('/', '_')}/{CURVE}"), key=_beds)
        for k, path in enumerate(paths):
            table = curve(path.parent)
            time, moved = 1e3 * table[:, 0], 1e3 * (table[:, 1] - START)
            if not len(time) or time[-1] < 31.5:
                continue
            whole = np.arange(29.0, min(time[-1], 40.0) + 1e-6)
            places = np.interp(whole, time, moved)
            friction, seed = _beds(path)
            row: dict[str, object] = {"model": "YADE" if model == YADE else model, "seed": seed}
            row |= {"rain_friction": friction or RAIN_FRICTION, "solid": solid(path.parents[1] / "spheres.csv")}
            row |= {"at_30_ms": places[1], "lowest_at_whole_ms": places.min(), "time_of_lowest": whole[places.argmin()]}
            row |= {"lowest": moved[time < 40.0].min()}
            row |= {"speed_at_33.5_ms": np.interp(33.5, time, table[:, 2]) if time[-1] > 33.5 else np.nan}
            rows.append(row | {"at_100_ms": moved[-1] if time[-1] > 99.9 else np.nan})
            dash = ("solid", "dash", "dot")[k % 3]
            series.append(Series("" if k else model, table[:, 0], table[:, 1] - START, colours.index(model), dash))
    return pd.DataFrame(rows), series


def impact_table(rows: pd.DataFrame) -> str:
    """The page's table: ranges of each model on beds whose rain had RAIN_FRICTION, below the published ranges."""
    shown = {"at_30_ms": AT_30, "lowest_at_whole_ms": LOWEST, "time_of_lowest": LOWEST_TIME, "at_100_ms": AT_100}
    lines = [{"model": "published, 7 codes, 10 seeds", "runs": ""} | {n: _range(*v) for n, v in shown.items()}]
    for model, part in rows[rows["rain_friction"].astype(float) == float(RAIN_FRICTION)].groupby("model", sort=False):
        line = {"model": f"`{model}`" if model != "YADE" else model, "runs": len(part)}
        lines.append(line | {name: _range(part[name].min(), part[name].max()) for name in shown})
    return markdown(pd.DataFrame(lines))


def _range(low: float, high: float) -> str:
    return "" if np.isnan(low) else f"{low:.5g}" if low == high else f"{low:.5g} to {high:.5g}"


def _impact(runs: Path) -> None:
    """The table of all runs and the figures, if runs are there."""
    rows, series = _impact_runs(runs)
    if rows.empty:
        return
    (ROOT / "docs/data/impact_25k.csv").write_text(rows.to_csv(index=False, float_format="%.5g"))
    for (low, high), time, name in ((AT_30, 0.030, "published range"), (LOWEST, 0.0315, ""), (AT_100, 0.1, "")):
        series.append(Series(name, [time, time], [1e-3 * low, 1e-3 * high], GREY, "solid", 0))
    alt = (
        "Displacement of the sphere against time for every model and seed, with the published ranges at 30 ms, at the "
        "lowest point and at 100 ms."
    )
    whole = Panel(Axis("time", "s"), Axis("displacement", "m"), series)
    low = replace(
        whole, x=Axis("time", "s", low=0.029, high=0.034), y=Axis("displacement", "m", low=-0.1392, high=-0.134)
    )
    for name, panel in (("impact_25k", whole), ("impact_25k_lowest", low)):
        save(Chart(name, "A steel sphere hits 25,000 spheres", alt, [panel]), ROOT / "docs/figures", data=False)


def _drum(runs: Path) -> None:
    """The table of spheres M1 in the quadrants of the drum, if the run is there."""
    names = ["time", "left_below", "right_below", "left_above", "right_above"]
    try:
        measures = results.read(runs / "drum/seed1/ep_hertz/results.h5").tables["measures"]
    except CaseError:
        return
    rows = [(measures["time"] - t).abs().argmin() for t in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 2.0, 3.0, 4.0, 5.0)]
    (ROOT / "docs/data/drum.csv").write_text(measures.iloc[rows][names].to_csv(index=False, float_format="%.6g"))


def _long(runs: Path) -> None:
    """The table of times of the long cases that have run."""
    rows = []
    for name, whole in STEPS.items():
        seconds, steps = map(sum, zip(*(loop(p) for p in (runs / name).glob("s*1/ep_hertz")), (0.0, 0), strict=True))
        if steps >= SHORT:
            each = seconds / steps
            row = {"case": name, "steps run": steps, "ms per step": 1e3 * each, "steps of the whole": whole}
            rows.append(row | {"hours of the whole": each * whole / 3600})
    if rows:
        (ROOT / "docs/data/community_times.csv").write_text(pd.DataFrame(rows).to_csv(index=False, float_format="%.1f"))


def _points(points: pd.DataFrame) -> pd.DataFrame:
    """Every measured number [SI] with the relative errors of the laws in LIGGGHTS."""
    here = points[points["engine"] == "liggghts"]
    keys = ["number", "set", "quantity", "measured", "speed"]
    return here.pivot_table(index=keys, columns="law", values="error", aggfunc="first").reset_index()


def restitution_table(points: pd.DataFrame) -> pd.DataFrame:
    """Every measured e_n with what the laws give, and the rms of the errors of each law."""
    points = points[points["quantity"] == "e_n"].assign(off=points["found"] - points["measured"])
    keys = ["set", "speed", "measured", "uncertainty"]
    wide = points.pivot_table(index=keys, columns="law", values="found").reset_index()
    rms = points.groupby("law")[["off", "in_uncertainties"]].agg(lambda values: (values**2).mean() ** 0.5).T
    names = {"off": "rms of the error", "in_uncertainties": "the same in uncertainties"}
    return pd.concat([wide, rms.rename(index=names).rename_axis("set").reset_index()], ignore_index=True)


def main() -> None:
    """Write the tables of docs/data and of the page, of the runs that are there."""
    runs = ROOT / "runs/community"
    result = validate(out=ROOT / "runs/validate", force=True)
    save(validation_chart(result), ROOT / "docs/figures", data=False)
    store("measured", result.summary)
    found = restitution_table(result.points[result.points["engine"] == "liggghts"])
    store("restitution", found)
    replace_tables("evidence", {"restitution": markdown(load("restitution"))})
    _impact(runs)
    _drum(runs)
    _long(runs)
    store("measured_points", _points(result.points))
    replace_tables("benchmarks", {"impact": impact_table(load("impact_25k"))})


if __name__ == "__main__":
    main()
