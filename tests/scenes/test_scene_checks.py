# SPDX-License-Identifier: GPL-2.0-or-later
"""The checks that a user sees, on tables made by hand: each gives the number put in, and fails when it should."""

import math
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from parts_cases import BOX, FLOOR, bead, mm, parts
from stored_runs import data_of

from epdem.case.scene import parse
from epdem.report import scenes as figures
from epdem.scenes.judge import checks
from epdem.scenes.judge.energy_balance import energy_balance, largest_gain
from epdem.scenes.plan.plan import ScenePlan, plan
from epdem.scenes.tables.columns import named_rows
from epdem.scenes.tables.columns import rows as table_of_rows
from epdem.studies.sweep.table import numbers_of, unit

STONE = bead("stone", mm(0, 0, 5), "2 mm", "steel", frozen=True)


def planned(name: str, law: str | None = None, n_rows: int = 40, **scene: object) -> ScenePlan:
    """The plan of a stored run's case with 20 frames and other values of [scene]."""
    data = data_of(name)
    output = {"rows": n_rows, "particles": 20, "loads": True}
    law_table = {"name": law} if law else data["law"]
    return plan(parse(data | {"scene": data["scene"] | scene, "output": output, "law": law_table}))


def frames(p: ScenePlan, spheres: list[dict]) -> pd.DataFrame:
    """The particles' table of spheres whose values are numbers or arrays over the frames."""
    steps = np.arange(0, p.steps + 1, p.frames)
    parts = []
    for k, sphere in enumerate(spheres, 1):
        values = {"x": 0.0, "y": 0.0, "z": 0.0, "vx": 0.0, "vy": 0.0, "vz": 0.0, "radius": 1e-3, "mass": 1e-5} | sphere
        parts.append(pd.DataFrame({"step": steps, "id": k, "type": 1, **values}))
    return pd.concat(parts, ignore_index=True)


def rows(p: ScenePlan, **columns) -> pd.DataFrame:
    """The rows of a plan; columns are numbers or functions of the steps."""
    steps = np.arange(0, p.steps + 1, p.every)
    forces = {
        "floor_load": ("floor_force_z", -1.0),
        "plate_force": ("plate_force_z", 1.0),
        "torque": ("drum_torque_y", 1.0),
    }
    given = {row.name: columns.pop(row.name, 0.0) for row in p.scene.row if row.name in forces}
    names = {"particles": float(p.case.scene["count"]), "kinetic_energy": 0.0} | columns
    values = {n: np.broadcast_to(f(steps) if callable(f) else f, steps.shape) for n, f in names.items()}
    for name, f in given.items():
        column, sign = forces[name]
        values[column] = sign * np.broadcast_to(f(steps) if callable(f) else f, steps.shape)
    found = {int(s): [float(values[n][k]) for n in values] for k, s in enumerate(steps)}
    return named_rows(p, table_of_rows(p, found, list(values)))


def verdict(p: ScenePlan, name: str, **tables: pd.DataFrame) -> dict:
    """The row of the check with this key; rows that say nothing where none are given."""
    table = checks.checks(p, tables if "rows" in tables else {"rows": rows(p)} | tables)
    (row,) = table[table["key"] == name].to_dict("records")
    return row


def test_the_mass_flow_is_the_slope_of_what_is_out_and_beverloo_s_that_of_the_bulk_density():
    """Beads in a column leave one by one, evenly in time: W = m/T. W_B = 0.58 rho_b sqrt(g) (D - 1.4 d)^2.5."""
    p = planned("hopper", count=200, outlet="12 mm")
    n, step = 200, np.arange(0, p.steps + 1, p.frames)
    opened = p.phases[0].end
    low, high = step[step <= opened].max(), p.steps
    (check,) = p.scene.check
    at, outlet = check.at, check.outlet
    height = at + (0.019 - at) * (np.arange(n) + 0.5) / n  # in the cone, too
    leaves = low + (high - low) * (np.arange(n) + 0.5) / n
    spheres = [{"z": np.where(step > t, at - 0.002, z)} for z, t in zip(height, leaves, strict=True)]
    found = verdict(p, "mass_flow", particles=frames(p, spheres))
    flow = n * 1e-5 / ((high - low) * p.time_step)
    # the frames cut the flow into 12 pieces
    assert found["value"] == pytest.approx(flow, rel=0.03)
    # bulk density: even, up to the top of 95 % of the beads
    ends = at + np.array([0.2, 0.7]) * (np.quantile(height, 0.95) - at)
    z = np.linspace(*ends, 20_001)
    radius = np.where(z < 0, 0.01 + (0.01 - outlet / 2) * z / -at, 0.01)
    bulk = 1e-5 * n * 0.5 * 0.95 / np.trapezoid(math.pi * radius**2, z)
    assert found["expected"] == pytest.approx(0.58 * bulk * math.sqrt(9.81) * (0.012 - 1.4 * 0.002) ** 2.5, rel=0.02)
    assert found["passed"] == (abs(found["value"] / found["expected"] - 1) <= 0.2)
    drawn = figures._mass_flow(p, {"particles": frames(p, spheres), "checks": pd.DataFrame([found])})
    assert drawn[0].series[1].name == f"Beverloo, {found['expected']:.3g} kg/s"


def test_a_steep_cone_flows_faster_by_the_factor_of_rose_and_tanaka():
    """F = (tan a tan b)^-0.35 for a < 90 - b, 1 beyond, with b = 45 degrees (Rose and Tanaka 1959); the same bed."""
    rates = {}
    for angle in ("20 deg", "30 deg", "45 deg", "60 deg"):
        p = planned("hopper", count=90, half_angle=angle, outlet="6 mm")
        low = -0.007 / math.tan(math.radians(float(angle[:2])))
        at, step = p.scene.check[0].at, np.arange(0, p.steps + 1, p.frames)
        assert at == pytest.approx(low, abs=1e-5)
        spheres = [{"z": np.where(step > p.steps * (0.5 + k / 190), at - 0.001, 0.0002 * k)} for k in range(90)]
        tables = {"particles": frames(p, spheres)}
        flow = checks.discharge(p, p.scene.check[0], tables["particles"])
        rates[angle] = checks.beverloo(flow, p.scene.check[0], 9.81) / flow.bulk
    assert rates["60 deg"] == pytest.approx(rates["45 deg"], rel=1e-12)
    for angle in ("20 deg", "30 deg"):
        factor = math.tan(math.radians(float(angle[:2]))) ** -0.35
        assert rates[angle] / rates["45 deg"] == pytest.approx(factor, rel=1e-3)


def test_a_flow_that_stops_early_or_is_faster_than_the_frames_says_so():
    p = planned("hopper", count=30, outlet="12 mm")
    step = np.arange(0, p.steps + 1, p.frames)
    for out, words in ((10, "at the end 0.1 of the bed has passed"), (30, "give more output.particles")):
        late = step > 0.9 * p.steps
        spheres = [{"z": np.where(late & (k < out * 0.3 + (out == 30) * 21), -0.05, 0.0005 * k)} for k in range(30)]
        tables = {"particles": frames(p, spheres), "rows": rows(p)}
        assert [w for w in checks.flow_warnings(p, tables) if words in w]
        assert (out == 10) == ("mass_flow" in checks.checks(p, tables)["key"].to_list())


def test_a_hopper_that_does_not_flow_fails_its_check():
    p = planned("hopper", count=30, outlet="12 mm")
    table = frames(p, [{"z": 0.0005 * k} for k in range(30)])
    found = verdict(p, "mass_flow", particles=table)
    assert math.isnan(found["value"]) and found["expected"] > 0 and not found["passed"]
    assert checks.flow_warnings(p, {"particles": table}) == ["no sphere passed the outlet"]


@pytest.mark.parametrize(
    ("beds", "outlet", "why"),
    [
        ([{"z": 0.0005 * k, "vz": -0.5} for k in range(30)], "12 mm", "the bed still falls as the outlet opens"),
        ([{"z": 0.0005 * k} for k in range(30)], "2.7 mm", "is below 1.4 diameters of the spheres"),
        ([{"z": 0.003} for _ in range(30)], "19 mm", "above the outlet is below half of the outlet's 0.019 m"),
        ([{"z": 0.0005 * k} for k in range(5)], "12 mm", "5 spheres above the outlet as it opens are no bed"),
    ],
)
def test_a_mass_flow_without_an_expected_rate_is_not_checked(beds, outlet, why):
    p = planned("hopper", count=len(beds), outlet=outlet)
    tables = {"particles": frames(p, beds), "rows": rows(p)}
    assert "mass_flow" not in checks.checks(p, tables)["key"].to_list()
    assert why in checks.flow_warnings(p, tables)[0]


@pytest.mark.parametrize("kind", ["settle", "hopper"])
def test_a_check_that_would_expect_nothing_compares_nothing(kind):
    """Without gravity weight, rebound and flow are 0, and 0 agrees with any bed at rest."""
    data = data_of(kind)
    data["scene"] |= {"gravity": "0 m/s^2"}
    data["output"] |= {"particles": checks.MANY, "loads": True}
    data["numerics"] |= {"highest_speed": "1 m/s"}
    p = plan(parse(data))
    tables = {"particles": frames(p, [{"z": 0.0005 * k} for k in range(30)]), "rows": rows(p, floor_load=0.0)}
    found = checks.checks(p, tables)
    assert found["key"].to_list() == ["spheres_in_room"]


@pytest.mark.parametrize(("load", "passed"), [(1.0, True), (1.019, True), (0.97, False), (0.0, False)])
def test_the_floor_load_is_the_mean_of_the_last_fifth_over_the_weight(load, passed):
    p = planned("settle")
    weight = 8 * 1e-5 * 9.81
    table = rows(p, floor_load=lambda s: np.where(s > 0.8 * s.max(), load * weight, 99.0))
    found = verdict(p, "floor_load", rows=table, particles=frames(p, [{"z": np.linspace(5e-3, 1e-3, 21)}] * 8))
    assert found["value"] == pytest.approx(load * weight, rel=1e-9, abs=1e-300)
    assert found["expected"] == pytest.approx(weight) and found["passed"] == passed


@pytest.mark.parametrize(("rise", "passed"), [(0.4, True), (1.0, True), (1.05, False)])
def test_an_elastic_bed_may_rise_as_far_as_it_fell_and_no_farther(rise, passed):
    p = planned("settle", law="hertz")
    heights = np.concatenate([np.linspace(5e-3, 1e-3, 11), np.linspace(1e-3, 1e-3 + rise * 4e-3, 11)[1:]])
    found = verdict(p, "rebound_of_the_bed", particles=frames(p, [{"z": heights}]))
    assert found["value"] == pytest.approx(rise * 4e-3) and found["expected"] == pytest.approx(4e-3)
    assert found["passed"] == passed


def test_stiffness_and_work_of_a_press_are_those_of_its_force_curve():
    """Loading F = k x, unloading four times as steep from the turn on: work 1/2 F x in, a quarter of it back."""
    p = planned("compaction", n_rows=1000, height="0.5 mm", unload_speed="0.4 m/s")
    s, turn = p.case.scene, p.phases[0].end
    k, k_back = 1e4, 4e4
    way = s["box"][2] - s["height"]

    def force(step):
        middle = np.maximum(step - 0.5 * p.every, 0)
        down = s["speed"] * np.minimum(middle, turn) * p.phases[0].time_step
        up = s["unload_speed"] * np.maximum(middle - turn, 0) * p.phases[1].time_step
        return np.maximum(k * down - k_back * up, 0)

    table = rows(p, plate_force=force)
    top = table["plate_force"].max()
    found = verdict(p, "loading_stiffness", rows=table)
    assert found["value"] == pytest.approx(k, rel=1e-9)
    assert found["expected"] == pytest.approx(k_back, rel=0.02) and found["passed"]  # the turn lies between two rows
    work = verdict(p, "recovered_work", rows=table)
    assert work["expected"] == pytest.approx(0.5 * k * way**2, rel=0.01)
    assert work["value"] == pytest.approx(0.5 * top**2 / k_back, rel=0.01) and work["passed"]
    late = rows(p, plate_force=lambda step: np.where(step > turn, 1.0, 0.0))
    assert not verdict(p, "recovered_work", rows=late)["passed"], "more got back than put in"
    verdict(p, "loading_stiffness", rows=rows(p, plate_force=0.0))  # a plate that touches nothing has a verdict too


def test_a_sweep_has_a_check_by_its_key_and_with_the_unit_of_its_value():
    """A stiffness is a force per length, work is force times length; a count has no unit."""
    p = planned("compaction")
    tables = {"rows": rows(p, plate_force=1.0)}
    tables["checks"] = checks.checks(p, tables)
    named = numbers_of(SimpleNamespace(tables=tables))
    units = {"loading_stiffness": "N/m", "recovered_work": "J", "spheres_in_room": None}
    assert units.keys() <= named.keys() and {name: unit(name, {}) for name in units} == units
    of_table = dict(zip(tables["checks"]["key"], tables["checks"]["unit"], strict=True))
    assert of_table == {name: of or "" for name, of in units.items()}


def test_the_page_of_results_has_the_key_unit_and_sentence_of_every_check():
    page = (Path(__file__).parents[2] / "docs/results.md").read_text()
    rows_of_page = re.findall(r"^\| `(\w+)` \| ([^|]*) \| (.*) \|$", page, re.M)
    known = {(key, unit, text.replace("{count}", "N")) for key, (unit, text) in checks.CHECKS.items()}
    assert known == {row for row in rows_of_page if row[0] in checks.CHECKS}


def test_only_shot_that_met_the_plate_alone_counts():
    p = planned("peening", law="hertz")
    up = np.where(np.arange(p.steps // p.frames + 1) > 5, 1.0, -1.0)
    spheres = [
        {"vz": 30.0 * up},
        {"vz": 29.99 * up},
        {"vz": 12.0 * up, "vx": 3.0},  # met another one
        {"vz": -30.0},  # still on its way
    ]
    found = verdict(p, "rebound_speed", particles=frames(p, spheres))
    assert found["check"].startswith("2 shots ")
    assert found["value"] == pytest.approx(29.99) and found["expected"] == pytest.approx(30.0, rel=1e-9)
    assert found["passed"]
    assert not verdict(p, "rebound_speed", particles=frames(p, [{"vz": 29.9 * up}]))["passed"]


def test_shot_of_a_coarse_time_step_is_held_against_the_error_that_the_case_allows():
    data = data_of("peening") | {"law": {"name": "hertz"}, "output": {"rows": 40, "particles": 20}}
    data["numerics"] = {"error": 1e-2}
    p = plan(parse(data))
    up = np.where(np.arange(p.steps // p.frames + 1) > 5, 1.0, -1.0)
    for speed, passed in ((29.8, True), (29.5, False)):
        assert verdict(p, "rebound_speed", particles=frames(p, [{"vz": speed * up}]))["passed"] == passed


@pytest.mark.parametrize(("factor", "passed"), [(1.0, True), (1.009, True), (1.02, False)])
def test_the_torque_on_a_drum_is_the_weight_of_its_bed_times_the_arm(factor, passed):
    """A bed of two spheres is carried up and falls back in the first half; then one circles about the axis ever faster:
    T = M g x_cm - m R^2 d(omega)/dt - 2/5 m r^2 d(spin)/dt."""
    p, m, r, R, growth = planned("drum", fixed_ends=False), 1e-5, 1e-3, 4e-3, 300.0
    seconds = p.time_at(np.arange(0, p.steps + 1, p.frames))
    circling = {"z": R, "vx": R * growth * seconds, "omega_y": 7.0 * growth * seconds}
    late = seconds >= 0.5 * seconds[-1]
    resting = {"x": np.where(late, 3e-3, -50e-3), "mass": 2 * m, "omega_y": 0.0}
    torque = 2 * m * 9.81 * 3e-3 - m * growth * R**2 - 0.4 * m * r**2 * 7.0 * growth
    expected = 2 * m * 9.81 * 3e-3
    given = rows(p, torque=lambda s: np.where(s > 0.5 * s.max(), torque + (factor - 1.0) * expected, 99.0))
    found = verdict(p, "torque_of_the_bed", rows=given, particles=frames(p, [circling, resting]))
    assert found["expected"] == pytest.approx(expected, rel=1e-9) and bool(found["passed"]) is passed
    assert found["value"] == pytest.approx(factor * expected, rel=1e-9)


def test_the_torque_of_a_drum_is_not_checked_where_its_ends_are_at_rest_or_friction_of_rolling_turns_spheres():
    resting = planned("drum")
    assert not resting.scene.check and [w.name for w in resting.scene.planes] == ["front", "back"]
    data = data_of("drum") | {"contact": {"rolling": {"model": "cdt", "coefficient": 0.1}}}
    data["scene"] |= {"fixed_ends": False}
    p = plan(parse(data | {"output": {"rows": 40, "particles": 20, "loads": True}}))
    assert p.scene.check and not p.scene.planes
    tables = {"rows": rows(p), "particles": frames(p, [{"omega_y": 0.0}])}
    assert "torque_of_the_bed" not in checks.checks(p, tables)["key"].to_list()


def test_a_lost_sphere_fails_the_check_of_the_room():
    p = planned("drum")
    assert verdict(p, "spheres_in_room")["passed"]
    assert not verdict(p, "spheres_in_room", rows=rows(p, particles=7.0))["passed"]


def test_what_shot_takes_along_when_it_leaves_the_room_stays_in_the_ledger():
    """Kinetic energy of its last frame, and what it lost to dents: then nothing is missing after it has gone."""
    p = planned("peening")
    table = frames(p, [{"vz": 30.0, "plastic_work": 2e-3}, {"vz": -20.0, "plastic_work": 0.0}])
    gone = table["step"].unique()[7]
    table = table[(table["id"] == 2) | (table["step"] <= gone)]
    no_contacts = pd.DataFrame(columns=["step", "elastic_energy"])
    found = energy_balance(p, {"rows": rows(p), "particles": table, "contacts": no_contacts}).set_index("step")
    first, second = 0.5 * 1e-5 * 30.0**2, 0.5 * 1e-5 * 20.0**2
    assert found["lost_spheres_energy"].to_numpy() == pytest.approx(np.where(found.index > gone, first + 2e-3, 0.0))
    assert found["kinetic"].to_numpy() == pytest.approx(second + np.where(found.index > gone, 0.0, first))
    assert np.abs(found["balance"]).max() < 1e-12


def test_a_sphere_that_comes_in_after_another_has_left_is_no_energy_from_nothing():
    """Three spheres in uniform motion; two are in the room at most, so that no frame has all of them."""
    p = planned("peening")
    table = frames(p, [{"vz": 30.0}, {"vz": -20.0}, {"vz": -10.0}])
    steps = table["step"].unique()
    there = {1: (0, 7), 2: (5, 20), 3: (9, 20)}
    inside = [steps[there[x.id][0]] <= x.step <= steps[there[x.id][1]] for x in table.itertuples()]
    no_contacts = pd.DataFrame(columns=["step", "elastic_energy"])
    found = energy_balance(p, {"rows": rows(p), "particles": table[inside], "contacts": no_contacts})
    assert found["step"].iloc[0] == steps[9] and np.abs(found["balance"]).max() < 1e-12


def test_a_row_of_a_press_has_the_height_in_the_middle_of_its_interval():
    """Down from 0.6 mm at 4 m/s, then up at 2 m/s: the force of a row is a mean over the interval before it."""
    p = planned("compaction")
    table, turn = rows(p, plate_force=1.0), p.phases[0].end
    middle, (first, second) = table["step"] - 0.5 * p.every, (phase.time_step for phase in p.phases)
    down = 6e-4 - 4.0 * middle * first
    up = 6e-4 - 4.0 * turn * first + 2.0 * (middle - turn) * second
    expected = np.where(table["step"] <= turn, down, up)[1:]
    assert table["plate_z"].to_numpy()[1:] == pytest.approx(expected, rel=1e-9)
    assert table["stress"].to_numpy() == pytest.approx(1.0 / 4e-4**2)


@pytest.mark.parametrize(
    ("change", "output"),
    [
        ({"measure": [{"name": "up", "kind": "force", "wall": "box"}]}, {"loads": False}),
        ({"wall": [FLOOR | {"phases": ["fall"]}, BOX]}, {}),
        ({"body": [STONE]}, {}),
    ],
    ids=["one wall of two", "a gate", "a stone that stays"],
)
def test_the_weight_of_a_bed_is_compared_only_with_all_that_bears_it(change, output):
    """A bed of one sphere at rest; the walls whose force is known say nothing."""
    data = parts(**({"wall": [FLOOR, BOX]} | change))
    data["output"] |= {"energy": False} | output
    p = plan(parse(data))
    columns = {f"{wall}_force_z": 0.0 for wall in p.loads}
    table = {n: [1.0, 0.0, *columns.values()] for n in (0, p.steps)}
    found = table_of_rows(p, table, ["particles", "kinetic_energy", *columns])
    checked = checks.checks(p, {"rows": found, "particles": frames(p, [{}])})["key"]
    assert columns and "force_on_all_walls" not in set(checked)


@pytest.mark.parametrize(("pressed", "compared"), [(0.0, True), (4.0, True), (65.0, False)])
def test_the_weight_is_not_compared_with_a_sum_of_much_larger_forces(pressed, compared):
    """A lid presses with a force in weights of the bed: the tolerance of 2 % of the largest force stays below 12 %."""
    lid = FLOOR | {"name": "lid", "at": "39 mm"}
    data = parts(wall=[FLOOR, lid])
    data["output"] |= {"energy": False}
    p, spheres = plan(parse(data)), frames(planned("settle"), [{}])
    weight = float(spheres["mass"].iloc[0]) * 9.81
    forces = {"floor_force_z": -(1 + pressed) * weight, "lid_force_z": pressed * weight}
    found = table_of_rows(
        p, {n: [1.0, 0.0, *forces.values()] for n in (0, p.steps)}, ["particles", "kinetic_energy", *forces]
    )
    checked = checks.checks(p, {"rows": found, "particles": spheres})
    checked = checked[checked["key"] == "force_on_all_walls"]
    assert (len(checked) == 1) == compared and checked["passed"].all() and (checked["tolerance"] < 0.12).all()


def test_friction_that_gives_energy_back_fails_a_check():
    """Friction as the rest of a balance: 2 % of the energy that moved came from nothing."""
    table = pd.DataFrame({"kinetic": [1.0, 0.5], "gravity": [0.0, 0.0], "friction": [0.0, -0.02]})
    assert largest_gain(table) == pytest.approx(-0.02)
    assert largest_gain(table.assign(friction=[0.0, 0.3])) == 0.0
