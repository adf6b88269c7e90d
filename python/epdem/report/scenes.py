# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a scene as data, and the picture of its bed."""

from dataclasses import replace

import numpy as np

from ..base.readable import in_words
from ..case.outputs import MassFlow, ReboundSpeed
from ..case.parts import MEASURES, Histogram
from ..jobs.stage import Tables
from ..scenes.judge import checks
from ..scenes.judge.measures import PRESS_FIGURES, curve
from ..scenes.judge.summary import SceneOutcome
from ..scenes.plan.plan import ScenePlan
from ..scenes.tables.columns import LOADS, place, units
from . import pictures, press
from .chart import GREY, INK, PALETTE, Axis, Chart, Panel, Series, plain
from .page import Picture

TIME = Axis("time", "s")
BINS = 30
COLOURS = {"kinetic": 0, "rotation": INK, "elastic": 2, "plastic": 1, "friction": 4, "springs": 3}
COLOURS |= {"lost_spheres_energy": 6, "adhesion": 5}
COLUMNS = 3  # of small panels


def charts(outcome: SceneOutcome) -> list[Chart]:
    """The key figure, measures, rows against time and energy balance: each if the results have data for it."""
    tables = outcome.results.tables
    energy = [energy_balance(outcome)] if "energy_balance" in tables else []
    return [*key(outcome.plan, tables), *measures(outcome.plan, tables), *histograms(outcome), *rows(outcome), *energy]


def measures(p: ScenePlan, tables: Tables) -> list[Chart]:
    """The measures against time."""
    found = [m for m in p.scene.measure if not isinstance(m, Histogram) and m.name not in p.scene.key_figure]
    curves = {m.name: (MEASURES[m.kind].unit, *curve(m, tables)) for m in found}
    return _against_time(p, "scene_measures", "Measures against time", curves)


def rows(outcome: SceneOutcome) -> list[Chart]:
    """Every column of the rows against time; measured loads, which are measures, not."""
    table, measured = outcome.results.tables["rows"], {m.name for m in outcome.plan.scene.measure}
    known, time = units(table), table["time"].to_numpy()
    shown = table.drop(columns=["step", "time", *measured], errors="ignore")
    curves = {str(name): (known.get(str(name), ""), time, shown[name].to_numpy(float)) for name in shown}
    return _against_time(outcome.plan, "scene", "Rows against time", curves)


def _against_time(
    p: ScenePlan, name: str, heading: str, curves: dict[str, tuple[str, np.ndarray, np.ndarray]]
) -> list[Chart]:
    """A chart of (unit, times, values) by name; the three components of a load share a panel, constant curves are
    numbers in its text. None without a curve that changes."""
    constant = {label: y[0] for label, (_, _, y) in curves.items() if np.unique(y).size == 1}
    found: dict[str, Panel] = {}
    for label, (unit, time, y) in curves.items():
        if label not in constant:
            load, component = (label[:-2], label[-1]) if label.endswith(LOADS) else (label, "")
            panel = found.setdefault(load, Panel(TIME, Axis(load, unit), []))
            panel.series.append(Series(component, time, y, "xyz".find(component)))
    if not found:
        return []
    alt = f"Against time: {', '.join(found)}."
    if constant:
        said = (f"{label} = {in_words(value, curves[label][0], 5)}" for label, value in constant.items())
        alt += f" Constant: {', '.join(said)}."
    if len(p.phases) > 1:
        alt += f" Dotted lines: ends of the phases {', '.join(phase.name for phase in p.phases[:-1])}."
    panels, columns = [_with_phases(p, panel) for panel in found.values()], min(COLUMNS, len(found))
    return [Chart(name, p.case.case.title, alt, panels, columns=columns, heading=heading)]


def _with_phases(p: ScenePlan, panel: Panel) -> Panel:
    """A panel against time with a dotted line at the end of each phase but the last."""
    values = np.concatenate([np.asarray(series.y, float) for series in panel.series])
    values = values[np.isfinite(values) & ((values > 0) | (not panel.y.log))]
    if not values.size:
        return panel
    ends = p.phase_table["end_time"][:-1]
    lines = [Series("", [end, end], [values.min(), values.max()], GREY, "dot") for end in ends]
    return replace(panel, series=[*panel.series, *lines])


def histograms(outcome: SceneOutcome) -> list[Chart]:
    """One chart for each histogram that the scene measures."""
    title, drawn = outcome.case.case.title, []
    for k, m in enumerate(m for m in outcome.plan.scene.measure if isinstance(m, Histogram)):
        bins = outcome.results.tables["histograms"]
        part = bins[bins["measure"] == m.name]
        edges = np.repeat(np.append(part["low"], part["high"].iloc[-1]), 2)
        heights = np.concatenate([[0], np.repeat(part["number"], 2), [0]])
        panel = Panel(
            Axis(m.kind, MEASURES[m.kind].unit), Axis("number"), [Series("", edges, heights, k % len(PALETTE))]
        )
        alt = f"Histogram of {m.kind}: {int(part['number'].sum())} values."
        drawn.append(Chart(f"scene_{m.name}", f"{title}: {m.name}", alt, [panel], heading=f"Histogram {m.name}"))
    return drawn


def energy_balance(outcome: SceneOutcome) -> Chart:
    """Every term of the energy balance against time."""
    table = outcome.results.tables["energy_balance"]
    time, series = table["time"].to_numpy(), []
    gravity = table["gravity"] - table["gravity"].min()
    if gravity.max() > 0:
        series.append(Series("gravity", time, gravity.to_numpy(), INK, "dashdot"))
    for name, shade in COLOURS.items():
        if name in table and table[name].abs().max() > 0:
            series.append(Series(name, time, table[name].to_numpy(), shade))
    if table["work"].abs().max() > 0:
        series.append(Series("work", time, table["work"].to_numpy(), INK, "dash"))
    if "friction" not in table or "springs" in table:
        series.append(Series("balance", time, table["balance"].to_numpy(), GREY))
    alt = "Terms of the energy balance against time; gravity is above its lowest value, work is done by the walls."
    if "friction" in table and "springs" not in table:
        alt += " Friction is the remainder of the balance."
    panels = [_with_phases(outcome.plan, Panel(TIME, Axis("energy", "J"), series))]
    return Chart("energy", f"{outcome.case.case.title}: energy", alt, panels, heading="Energy balance against time")


def bed(outcome: SceneOutcome) -> list[Picture]:
    """The picture of walls and spheres in the last frame, drawn into the folder of the run; none without frames."""
    table = outcome.results.tables.get("particles")
    if table is None or table.empty:
        return []
    path = outcome.folder / "bed.png"
    return [Picture("The bed", pictures.bed(outcome.plan, table, path), file=path)]


def _mass_flow(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Mass below the outlet against time, and the line of Beverloo from where a fifth has come out."""
    spheres = tables["particles"]
    steps, (flow,) = np.sort(spheres["step"].unique()), [x for x in p.scene.check if isinstance(x, MassFlow)]
    below = spheres[spheres["z"] < flow.at].groupby("step")["mass"].sum().reindex(steps, fill_value=0.0)
    time, out = p.time_at(steps), below.to_numpy()
    series, expected = [Series("scene", time, out, 0)], tables["checks"].query("key == 'mass_flow'")["expected"]
    for rate in expected:
        total = float(spheres[spheres["step"] == steps[-1]]["mass"].sum())
        begin = int(np.argmax(out > 0.2 * total))
        ends = time[begin] + np.array([0.0, 0.4 * total / rate])
        series.append(Series(f"Beverloo, {rate:.3g} kg/s", ends, out[begin] + rate * (ends - ends[0]), INK, "dash"))
    return [Panel(TIME, Axis("mass below the outlet", "kg"), series)]


def _column(p: ScenePlan, tables: Tables, name: str) -> list[Panel]:
    """A column of the rows or of the measures against time; kinetic energy, which falls by powers of ten, as such."""
    table = tables["measures" if name in tables.get("measures", ()) else "rows"]
    axis = Axis(name, units(table).get(name, ""), log=name == "kinetic_energy")
    return [Panel(TIME, axis, [Series("", table["time"].to_numpy(), table[name].to_numpy(float), 0)])]


def _rebound_speed(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Speeds of the spheres upwards after their impact, and e_n v of theory for one impact on the target."""
    spheres, (s,) = tables["particles"], [x for x in p.scene.check if isinstance(x, ReboundSpeed)]
    up = spheres[spheres["vz"] > 1e-3 * s.speed].groupby("id")["vz"].max().to_numpy()
    number, edges = np.histogram(up, BINS)
    expected = checks.single_rebound(p.case, s)
    series = [
        Series(f"{len(up)} spheres", np.repeat(edges, 2)[1:-1], np.repeat(number, 2), 0),
        Series("one impact, theory", [expected] * 2, [0.0, float(max(number.max(), 1))], INK, "dash"),
    ]
    return [Panel(Axis("rebound speed", "m/s"), Axis("number"), series)]


def _moving_walls(p: ScenePlan, tables: Tables) -> list[Panel]:
    """Force over displacement of each wall that moves only with constant velocities and whose force is in the rows:
    a curve for each of its phases, both along the first of its motions."""
    rows, step = tables["rows"], tables["rows"]["step"].to_numpy()
    middle, found = p.middles(rows), []
    named = {row.wall: row for row in p.scene.row if row.force and not row.area}
    for name in dict.fromkeys([*p.loads, *named]):
        velocities = [phase.moves[name].constant_velocity for phase in p.phases if name in phase.moves]
        moving = [np.array(v) for v in velocities if v and any(v)]
        if not moving or None in velocities:
            continue
        along = moving[0] / np.linalg.norm(moving[0])
        if name in p.loads:
            force = -rows[[f"{name}_force_{axis}" for axis in "xyz"]].to_numpy() @ along
        else:
            force = -named[name].sign * rows[named[name].name].to_numpy() * along[named[name].axis]
        start = p.triangles[name][0, 0]
        way = sum(along[k] * (place(p, name, k, middle) - start[k]) for k in range(3))
        series: list[Series] = []
        for phase in p.phase_steps:
            if any(phase.velocity(name)):
                during = (step > phase.end - phase.steps) & (step <= phase.end)
                series.append(Series(phase.name, way[during], force[during], len(series) % len(PALETTE)))
        found.append(Panel(Axis(f"displacement of {name}", "m"), Axis(f"force on {name}", "N"), series))
    return found


OF_FRAMES = {"mass_flow": _mass_flow, "rebound_speed": _rebound_speed}


def panels(p: ScenePlan, tables: Tables) -> list[Panel]:
    """The panels of the key figure, which share their x axis; none where the tables lack the data."""
    frames = "particles" in tables and tables["particles"]["step"].nunique() > 1
    found: list[Panel] = []
    for name in (name for name in p.scene.key_figure if name not in PRESS_FIGURES):
        if name not in OF_FRAMES:
            found += _column(p, tables, name)
        elif frames:
            found += OF_FRAMES[name](p, tables)
    return found if p.scene.key_figure else _moving_walls(p, tables)


def key(p: ScenePlan, tables: Tables) -> list[Chart]:
    """The key figure of a scene, if there is one, and the figures of a press, each for itself; the first is `key`."""
    found, title = [], p.case.case.title
    if shared := panels(p, tables):
        said = plain(" and ".join(f"{panel.y.label} against {panel.x.label}" for panel in shared))
        found.append(Chart("key", title, f"{said}.", shared, heading=f"Key figure: {said}"))
    for name in (name for name in p.scene.key_figure if name in PRESS_FIGURES):
        heading, caption, panels_of = press.FIGURES[name]
        if drawn := panels_of(p, tables):
            found.append(Chart(name if found else "key", title, caption, drawn, heading=heading))
    return found
