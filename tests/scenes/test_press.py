# SPDX-License-Identifier: GPL-2.0-or-later
"""A press: stages to pressures, hold and release, in two engines; its table by routes that do not use it."""

import math
import re

import numpy as np
import pandas as pd
import pytest
from rich.table import Table
from scene_runs import LAMMPS, LIGGGHTS, PRESSES, ran, run, write_case
from stored_runs import CASES

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.report.pages import scene_page, scene_sentences, write_page
from epdem.report.scenes import key
from epdem.scenes.judge import summary
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables import stages
from epdem.scenes.tables.columns import units
from epdem.studies.soften import soften
from epdem.studies.sweep.table import numbers_of

SIDE, HEIGHT, RADIUS, COUNT = 0.5e-3, 1.4e-3, 50e-6, 150
PRESSURES = [10e6, 40e6]


def press(**scene):
    """A box with 150 spheres, pressed fast to two pressures; without friction, so that no energy is missing."""
    data = read_toml(CASES / "press_tablet.toml")
    del data["contact"], data["scene"]["diameter"]
    more = {"box": [f"{SIDE} m", f"{SIDE} m"], "height": f"{HEIGHT} m", "count": COUNT, "speed": "3 m/s"}
    more |= {"stages": [f"{x} Pa" for x in PRESSURES], "unload_speed": "0.5 m/s"}
    data["output"] |= {"rows": 1500, "particles": 10}
    data["scene"] |= more | scene
    data["measured"] = {"source": "by hand", "pressures": ["15 MPa", "39 MPa", "1 GPa"]}
    data["measured"] |= {"relative_densities": [0.6, 0.75, 0.99]}
    return {key: value for key, value in data.items() if value is not None}


def without(data, *keys):
    """The data of a case without keys of its scene."""
    return data | {"scene": {key: value for key, value in data["scene"].items() if key not in keys}}


def plate(outcome, name, step):
    """Height [m] of a plate in a frame, from the spheres that touch it and their overlaps in the engine."""
    contacts, spheres = outcome.results.contacts, outcome.results.particles
    there = contacts[(contacts["step"] == step) & (contacts["wall"] == name)].set_index("i")
    z = spheres[spheres["step"] == step].set_index("id")["z"][there.index]
    found = z + (1.0 if name == "punch" else -1.0) * (RADIUS - there["overlap"])
    assert (abs(found - found.median()) < 1e-9).mean() > 0.5
    return found.median()


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    """The outcome in LIGGGHTS, with the forces on the sides measured as well."""
    sides = [{"name": f"on_{wall}", "kind": "force", "wall": wall} for wall in ("left", "right", "front", "back")]
    folder = tmp_path_factory.mktemp("press")
    return ran(press(measure=sides), folder)


@pytest.mark.parametrize(
    ("engine", "energy"),
    [
        *(pytest.param(*e.values, True, marks=e.marks) for e in PRESSES),
        pytest.param("liggghts", False, marks=pytest.mark.liggghts),
    ],
)
def test_a_step_too_large_for_the_pressed_bed_is_named(engine, energy, pressed, tmp_path):
    """Three times the step of the case; at that step nothing is said."""
    data = press()
    data["numerics"] = {"time_step": f"{3 * plan(parse(press())).time_step!r} s"}
    data["output"] |= {"energy": energy, "color": "speed"}
    found = ran(data, tmp_path, engine)
    said = [w for w in found.warnings if "gains energy that no wall puts in" in w]
    assert len(said) == 1 and "give numerics.time_step = '" in said[0] and not found.passed
    assert not any("gains energy" in w for w in pressed.warnings)


@pytest.mark.liggghts
def test_the_table_of_stages_has_the_numbers_of_rows_frames_and_energies(pressed):
    found, rows, spheres = pressed.results.tables["stages"], pressed.results.rows, pressed.results.particles
    assert found["phase"].to_list() == [f"{name}{k}" for k in (1, 2) for name in ("stage", "hold", "release")]
    at = rows.set_index("step").loc[found["step"]]
    holds = found["phase"].str.startswith("hold").to_numpy()
    assert found["pressure"][holds].to_numpy() == pytest.approx(at["pressure"][holds]) and (at["pressure"] > 0).all()
    reached = found.set_index("phase")["pressure"]
    for k, pressure in enumerate(PRESSURES, 1):
        assert reached[f"stage{k}"] == pytest.approx(pressure, rel=5e-3)
        assert reached[f"release{k}"] <= 0.011 * pressure
    by_phase = found.set_index("phase")
    assert by_phase["asked"].dropna().to_dict() == pytest.approx({"stage1": PRESSURES[0], "stage2": PRESSURES[1]})
    assert by_phase["reached"].dropna().to_dict() == {name: reached[name] for name in ("stage1", "stage2")}
    assert (by_phase["peak"] >= by_phase["pressure"]).all()
    assert by_phase["error"]["stage1"] == pytest.approx(by_phase["peak"]["stage1"] / PRESSURES[0] - 1)  # a wave
    assert 0.005 < by_phase["error"]["stage1"] < 0.1
    height = np.array([plate(pressed, "punch", step) for step in found["step"]])
    assert found["height"].to_numpy() == pytest.approx(height, rel=1e-6)
    volume = COUNT * 4 / 3 * math.pi * RADIUS**3
    assert found["relative_density"].to_numpy() == pytest.approx(volume / (SIDE**2 * height), rel=1e-6)
    assert found["porosity"].to_numpy() == pytest.approx(1 - found["relative_density"])
    springback = found.set_index("phase")["springback"].dropna()
    assert springback.to_dict() == pytest.approx(
        {f"release{k}": height[3 * k - 1] / height[3 * k - 2] - 1 for k in (1, 2)}, rel=1e-4
    )
    assert (springback > 0.002).all() and (springback < 0.1).all()
    # on the sides: LIGGGHTS's own sums of each wall
    sums = at[[f"on_{wall}" for wall in ("left", "right", "front", "back")]].sum(axis=1)
    hold = (found["phase"] == "hold2").to_numpy()
    radial = (sums / (4 * SIDE * height)).to_numpy()
    assert found["radial_pressure"].to_numpy()[hold] == pytest.approx(radial[hold], rel=0.02)
    # the force of the punch times its way
    work = -np.cumsum(rows["pressure"] * SIDE**2 * np.diff(rows["punch_z"], prepend=HEIGHT))
    assert found["work"].iloc[-1] == pytest.approx(work.iloc[-1], rel=0.05)
    kept = found["plastic"] + found["elastic"]
    assert kept.iloc[:5].to_numpy() == pytest.approx(found["work"].iloc[:5], rel=0.1)
    assert len(spheres[spheres["step"] == found["step"].iloc[-1]]) == COUNT


def figures(outcome):
    """The panel of each figure of a press, by its heading."""
    return {chart.heading: chart.panels[0] for chart in key(outcome.plan, outcome.results.tables)}


@pytest.mark.liggghts
def test_a_softened_press_reaches_the_densities_of_the_press(pressed):
    """Strain and inertia grow."""
    path = pressed.folder.parent / "soft.toml"
    path.write_text(soften(pressed.folder.parent / "case.toml", 10.0).text)
    soft = run(path, out=path.with_suffix(""))
    assert soft.plan.time_step > 2 * pressed.plan.time_step
    hard, soft = (x.results.tables["stages"].set_index("phase") for x in (pressed, soft))
    error = soft["reached"].dropna().to_numpy() / (np.array(PRESSURES) / 10**0.8) - 1
    assert abs(error[0]) < 0.06 and abs(error[1]) < 5e-3  # the first stage ends in a wave, in other packings, too
    names = ["stage1", "stage2", "release1", "release2"]
    difference = (soft["relative_density"] - hard["relative_density"])[names].to_numpy()
    assert np.abs(difference).max() < 0.05  # the packings differ


def off(points, x, y):
    """How far the farthest of `points` is from the nearest of (x, y), over the largest of each."""
    curve = np.column_stack([x, y])
    apart = np.abs(points.to_numpy()[:, None] - curve[None]) / np.abs(curve).max(axis=0)
    return apart.max(axis=2).min(axis=1).max()


@pytest.mark.liggghts
def test_the_figures_have_the_numbers_of_rows_stages_and_sides(pressed):
    found, tables = figures(pressed), pressed.results.tables
    assert [*found] == [
        "Force over displacement",
        "Density over pressure",
        "Springback",
        "Pressure on the sides by height",
    ]
    ends, rows = tables["stages"].set_index("phase"), pressed.results.rows.set_index("step")
    punch, *marks = found["Force over displacement"].series
    seen = rows.iloc[int(np.argmax(rows["pressure"] > 1e-3 * rows["pressure"].max())) - 1 :]  # the punch bears
    assert off(seen[["punch_z", "pressure"]] * [-1, SIDE**2] + [HEIGHT, 0], punch.x, punch.y) < 1e-6
    assert len(punch.y) == len(seen) + len(ends), "the curve goes through the ends of phases"
    for mark, name in zip(marks, ("stage1", "stage2"), strict=True):
        assert mark.name.startswith(f"{name}, ") and mark.y[0] == pytest.approx(ends["reached"][name] * SIDE**2)
        assert mark.x[0] == pytest.approx(HEIGHT - ends["height"][name])
    density, borne = found["Density over pressure"], ends[ends["pressure"] > 1e-3 * ends["pressure"].max()]
    assert density.x.log and np.asarray(density.series[1].y) == pytest.approx(borne["relative_density"].to_numpy())
    for curve, name in zip(found["Springback"].series, ("release1", "release2"), strict=True):
        before = ends.index[ends.index.get_loc(name) - 1]
        way = np.arange(1, len(curve.y) - 1) - 0.5  # the middles of rows, from the height of the end of loading
        strain = 100 * 0.5 * way * pressed.plan.every * pressed.plan.time_step / ends["height"][before]
        assert curve.name == f"{name}, {100 * ends['springback'][name]:.3g} %"
        assert (curve.y[0], curve.y[-1]) == pytest.approx((0.0, 100 * ends["springback"][name]))
        borne = rows["pressure"].loc[: ends["step"][name]].to_numpy()[-len(way) :]
        fast = np.minimum.accumulate(borne) > 0.05 * borne[0]  # it slows near a hundredth
        assert fast[: fast.size // 2].all()
        assert np.asarray(curve.y)[1:-1][fast] == pytest.approx(strain[fast], rel=1e-3)
        assert np.asarray(curve.x)[1:-1] == pytest.approx(borne)
    for curve, name in zip(found["Pressure on the sides by height"].series, ("stage1", "stage2"), strict=True):
        slices = np.diff(curve.y)[::2]
        assert len(slices) > 2 and sum(slices) == pytest.approx(ends["height"][name])
        mean = np.average(np.asarray(curve.x)[::2], weights=slices)
        assert mean == pytest.approx(ends["radial_pressure"][name])


SI = {"MPa": 1e6, "kPa": 1e3, "mm": 1e-3, "um": 1e-6, "%": 0.01}


def in_si(heads, rows):
    """Columns of texts in SI by the names of their heads, as NAME [UNIT]."""
    found = {}
    for head, column in zip(heads, zip(*rows, strict=True), strict=True):
        name, _, unit = head.removesuffix("]").partition(" [")
        texts = [math.nan if x == "-" else float(x) if re.fullmatch(r"[-+.e\d]+", x) else x for x in column]
        found[name] = [x * SI.get(unit, 1.0) if isinstance(x, float) else x for x in texts]
    return found


@pytest.mark.liggghts
def test_page_terminal_figures_and_csv_have_the_same_numbers(pressed):
    """Read back from what a reader sees, with the units that stand there; all in SI are those of results.h5."""
    page = write_page(pressed, ["svg"]).read_text()
    assert page.index(">Stages</h2>") < page.index(">Force over displacement</h2>") < page.index(">The bed</h2>")
    ends, folder = pressed.results.tables["stages"], pressed.folder
    seen = {}
    for table in re.findall(r"<table class=.sorts.>.*?</table>", page, re.S)[:2]:
        heads = re.findall(r"<button[^>]*>([^<]*)<", table)
        rows = [re.findall(r"<td[^>]*>([^<]*)<", row) for row in table.split("<tr>")[2:]]
        seen |= in_si(heads, rows)
    assert {*seen} == {*ends} - {"step", "time", "porosity"} | {"passed"}
    within = ends["error"].abs().dropna() <= 0.02
    assert [x for x in seen["passed"] if isinstance(x, str)] == ["yes" if x else "no" for x in within]
    (shown,) = [x for x in summary.shown(pressed) if isinstance(x, Table) and str(x.title) == "stages"]
    printed = in_si(
        [str(c.header) for c in shown.columns], zip(*(map(str, c.cells) for c in shown.columns), strict=True)
    )
    pd.testing.assert_frame_equal(pd.DataFrame(printed), pd.DataFrame(seen)[[*printed]])
    before_decks = page.partition(">Case file</h2>")[0]
    assert "[Pa]" not in before_decks and "asked [MPa]" in page and "height [mm]" in page
    for name, values in seen.items():
        if name == "phase":
            assert values == ends["phase"].to_list()
        elif name != "passed":
            digits = 5e-2 if name == "error" else 1e-4
            assert values == pytest.approx(ends[name].to_list(), rel=digits, nan_ok=True)
    drawn = pd.read_csv(folder / "key.csv")
    assert set(drawn["panel"]) == {"force on the punch [N] against displacement [mm]"}
    marks = drawn[drawn["series"].str.startswith("stage")]
    asked = ends[ends["asked"].notna()]
    assert (HEIGHT - 1e-3 * marks["x"]).to_numpy() == pytest.approx(asked["height"].to_numpy(), rel=1e-6)
    assert (marks["y"] / SIDE**2).to_numpy() == pytest.approx(asked["reached"].to_numpy(), rel=1e-6)
    rows = pd.read_csv(folder / "results.csv")
    density = pd.read_csv(folder / "densification.csv")
    punch = density[density["series"] == "punch"]
    known = rows[rows["pressure"] >= 1e6 * punch["x"].min()]
    assert len(known) > 100
    assert off(known[["pressure", "relative_density"]], 1e6 * punch["x"], punch["y"]) < 1e-6
    said = re.search(r"Relative density: ([.\d]+) at ([.\d]+) MPa, .*? Springback: ([.\d]+), ([.\d]+) %", page)
    back = ends["springback"].dropna().to_list()
    assert [float(x) for x in said.groups()] == pytest.approx(
        [asked["relative_density"].iloc[0], 1e-6 * asked["reached"].iloc[0], 100 * back[0], 100 * back[1]], rel=5e-3
    )


@pytest.mark.liggghts
def test_lines_go_through_three_stages_or_are_not_drawn(pressed):
    """Stages on given lines: 1/slope of Heckel and a, 1/b of Kawakita are those of the lines."""
    p, tables = pressed.plan, dict(pressed.results.tables)
    assert not {"Heckel's line", "Kawakita's line"} & {*figures(pressed)}
    x = np.array([10e6, 20e6, 40e6])
    stage = tables["stages"].iloc[:1]
    for name, solid in (
        ("Heckel, 3 points, 1/slope = 50 MPa", 1.0 - np.exp(-0.5 - x / 50e6)),
        ("Kawakita, 3 points, a = 0.8, 1/b = 5 MPa", 0.2 / (1.0 - 0.8 * x / (x + 5e6))),
    ):
        made = pd.concat([stage] * 3).assign(pressure=x, relative_density=solid, porosity=1.0 - solid)
        rows = tables["rows"].assign(relative_density=0.2)
        found = key(p, tables | {"stages": made.reset_index(drop=True), "rows": rows})
        assert name in [series.name for chart in found for series in chart.panels[0].series]


@pytest.mark.liggghts
def test_rows_have_height_and_density_and_the_page_the_table_of_stages(pressed):
    p, rows = pressed.plan, pressed.results.rows
    last = rows[rows["pressure"] < 0.5 * PRESSURES[0]].iloc[100]  # 3 m/s, half a row before its end
    height = HEIGHT - 3.0 * p.time_step * (last["step"] - 0.5 * p.every)
    assert last["height"] == pytest.approx(height, rel=1e-7) and units(rows)["height"] == "m"
    volume = COUNT * 4 / 3 * math.pi * RADIUS**3
    assert last["relative_density"] == pytest.approx(volume / (SIDE**2 * height), rel=1e-7)
    dense = pressed.results.tables["stages"].set_index("phase")["relative_density"]["stage2"]
    assert numbers_of(pressed.results)["relative_density_max"] == pytest.approx(dense, rel=3e-3)  # a target of a fit
    (part,) = [part for part in scene_page(pressed).parts if getattr(part, "title", "").startswith("Plates")]
    assert "0.8 to 1.3 times that of finite elements" in part.note


@pytest.mark.liggghts
def test_measured_densities_stand_beside_those_of_the_first_load(pressed):
    p, tables = pressed.plan, pressed.results.tables
    (line,) = stages.against_measured(p, tables)
    rows, density = (tables["rows"][name].to_numpy() for name in ("pressure", "relative_density"))
    differences = []
    for pressure, value in ((15e6, 0.6), (39e6, 0.75)):
        after = int(np.flatnonzero(rows >= pressure)[0])
        assert density[after - 1] <= density[after] < density[after - 1] + 0.01
        differences.append(density[after] - value)
    said = [float(x) for x in re.findall(r"([+-]\d\.\d+) at", line)]
    assert said == pytest.approx(differences, abs=0.01)
    assert line.endswith("not reached at 1000 MPa (by hand)")
    points = figures(pressed)["Density over pressure"].series[-1]
    assert points.name == "measured" and [*points.y] == [0.6, 0.75, 0.99]
    assert line[1:] in " ".join(scene_sentences(pressed))


@pytest.mark.parametrize("engine", PRESSES)
def test_a_round_die_has_the_same_densities_in_every_engine(engine, tmp_path):
    data = without(press(diameter="0.6 mm", count=120, stages=["30 MPa"]), "box", "hold")
    found = ran(data, tmp_path, engine).results.tables["stages"].set_index("phase")
    assert found.index.to_list() == ["stage1", "release1"]
    assert found["relative_density"]["stage1"] == pytest.approx(0.67, abs=0.03)  # random packings differ
    assert 0.0 < found["springback"]["release1"] < 0.1
    assert 0.3 < found["radial_over_axial"]["stage1"] < 1.0


def round_die(particles, folder, engine, walls="powder"):
    """Powder in a round die without friction, to 40 MPa."""
    data = without(
        press(diameter="0.6 mm", count=120, stages=["40 MPa"], walls=walls, particles=particles), "box", "hold"
    )
    data["materials"]["soft"] = data["materials"]["powder"] | {"young_modulus": "6 GPa", "yield_stress": "60 MPa"}
    return ran(data, folder, engine)


@pytest.mark.parametrize("engine", PRESSES)
def test_the_energies_of_two_powders_in_a_round_die_close_and_the_mixture_lies_between_them(engine, tmp_path):
    """A soft sphere between hard ones is not softer than between soft ones; triangles of a wall take no energy.

    The force of the law in the table of contacts is that of the engine."""
    half = [{"material": name, "radius": "50 um", "share": 0.5} for name in ("powder", "soft")]
    density = []
    for n, (particles, walls) in enumerate([(half[:1], "powder"), (half, "powder"), (half[1:], "soft")]):
        outcome = round_die([p | {"share": 1.0 / len(particles)} for p in particles], tmp_path / f"{n}", engine, walls)
        balance = outcome.results.tables["energy_balance"]
        assert balance["balance"].abs().max() < 4e-3 * balance["work"].max()
        contacts = outcome.results.contacts
        of_engine = np.linalg.norm(contacts[["force_x", "force_y", "force_z"]], axis=1)
        np.testing.assert_allclose(contacts["force"], of_engine, rtol=1e-8, atol=1e-9 * of_engine.max())
        density.append(outcome.results.tables["stages"]["relative_density"].iloc[0])
    assert density[0] < density[1] < density[2]


@pytest.mark.parametrize("engine", PRESSES)
def test_two_punches_press_as_one_that_is_twice_as_fast(engine, tmp_path):
    """A box without friction, powder without weight; the floor moves as far as the punch until the release."""
    data = press(double_action=True, stages=["40 MPa"], hold="5 us")
    two = run(write_case(data, tmp_path), engine, out=tmp_path / "two")
    one = run(write_case(press(stages=["40 MPa"], hold="5 us"), tmp_path / "one"), engine, out=tmp_path / "one/out")
    found, other = (outcome.results.tables["stages"].set_index("phase") for outcome in (two, one))
    assert found["relative_density"].to_numpy() == pytest.approx(other["relative_density"].to_numpy(), abs=0.02)
    assert found["pressure"]["stage1"] == pytest.approx(found["opposite_pressure"]["stage1"], rel=0.1)
    pressed = two.results.phases.set_index("phase").loc["stage1"]
    low, high = (plate(two, name, pressed["end"]) for name in ("floor", "punch"))
    assert found["height"]["stage1"] == pytest.approx(high - low, rel=1e-6)
    assert low == pytest.approx(HEIGHT - high, rel=1e-3), "each goes half of the way"
    assert two.passed


@pytest.mark.liggghts
def test_an_ejection_pushes_the_tablet_by_its_way_against_the_friction_of_the_sides(tmp_path):
    sides = [
        {"name": f"on_{wall}", "kind": "force", "wall": wall, "component": "z"}
        for wall in ("left", "right", "front", "back")
    ]
    # slower than 3 m/s, at which the pressure rises by more than 2 % of itself between two looks
    slow = press(stages=["40 MPa"], hold=None, eject="0.1 mm", measure=sides, speed="1 m/s")
    data = slow | {"contact": {"friction": 0.3}}
    data["scene"] = {key: value for key, value in data["scene"].items() if value is not None}
    outcome = ran(data, tmp_path)
    found = outcome.results.tables["stages"].set_index("phase")
    assert found.index.to_list() == ["stage1", "release1", "eject"]
    z = outcome.results.particles.groupby("step")["z"].mean()
    assert z[found["step"]["eject"]] - z[found["step"]["release1"]] == pytest.approx(
        1e-4, rel=0.07
    )  # it yields a little
    rows = outcome.results.rows.set_index("step").loc[found["step"]["release1"] :]
    friction = rows[[m["name"] for m in sides]].sum(axis=1)
    pushed = (rows["floor_pressure"] - rows["pressure"]) * SIDE**2
    assert pushed.iloc[-50:].mean() == pytest.approx(friction.iloc[-50:].mean(), rel=0.05)
    assert found["opposite_pressure"]["eject"] > 2.0 * found["pressure"]["eject"]
    kept = found["radial_pressure"] / found["radial_pressure"]["stage1"]
    assert 0 < kept["release1"] < 0.3 and kept["eject"] < 0.6, "the sides retreat, and the floor presses them out again"
    (said,) = [warning for warning in outcome.warnings if "phase eject" in warning]
    assert "its forces are too large" in said and outcome.passed


@pytest.mark.parametrize("engine", PRESSES)
def test_the_work_of_a_press_needs_no_energy_balance(engine, tmp_path):
    """The force of the punch times its way."""
    data = without(press(stages=["10 MPa"]), "hold")
    data["output"] |= {"energy": False, "color": "speed"}
    found = ran(data, tmp_path, engine).results
    way = -np.diff(found.rows["punch_z"], prepend=HEIGHT)
    work = (found.rows["pressure"] * SIDE**2 * way).cumsum().iloc[-1]
    assert found.stages["work"].iloc[-1] == pytest.approx(work, rel=0.05) and work > 0.0


@pytest.mark.parametrize("engine", [LIGGGHTS, LAMMPS])
def test_a_stage_that_is_passed_before_the_force_is_looked_at_fails(engine, tmp_path):
    """Four spheres bear the punch at a relative density of 0.08, and the force is looked at from 0.4 on."""
    data = without(press(stages=["1 MPa"], count=4, speed="1 m/s"), "hold")
    data["output"]["energy"] = False
    data["output"]["color"] = "speed"
    outcome = ran(data, tmp_path, engine)
    found = outcome.results.stages.set_index("phase").loc["stage1"]
    rows = outcome.results.rows
    assert found["peak"] >= rows["pressure"].max() > 2e6 and found["error"] == pytest.approx(found["peak"] / 1e6 - 1.0)
    assert not outcome.passed
    assert [x for x in outcome.warnings if x.startswith("phase stage1: ") and "beside the 1 MPa asked for" in x]


@pytest.mark.parametrize("engine", [LIGGGHTS, LAMMPS])
def test_a_stage_has_its_pressure_and_a_density_that_does_not_follow_the_rows(engine, tmp_path):
    """Looks and slowing plates do not know the rows, so that the run up to the stage is the same to the bit."""
    found = []
    for rows in (100, 700):
        data = without(press(stages=["10 MPa"]), "hold")
        data["output"] |= {"rows": rows, "energy": False, "color": "speed"}
        outcome = run(write_case(data, tmp_path / f"{rows}"), engine, out=tmp_path / f"{rows}/out")
        found.append(outcome.results.stages.set_index("phase").loc["stage1"])
    assert found[0]["reached"] == pytest.approx(10e6, rel=5e-3) and found[0]["reached"] == found[1]["reached"]
    assert found[0]["relative_density"] == pytest.approx(found[1]["relative_density"], rel=1e-6)
