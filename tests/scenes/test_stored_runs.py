# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables of small stored runs of every kind of scene, against geometry, balances and closed forms; no engine runs."""

import itertools
import math
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from stored_runs import RUNS, STORED, data_of, planned

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.engines.frames import Frames
from epdem.engines.liggghts import tables as scene_tables
from epdem.errors import EngineError
from epdem.scenes.judge import checks
from epdem.scenes.judge.energy_balance import closure, energy_balance
from epdem.scenes.plan.quantities import STRAINS, page
from epdem.scenes.tables.columns import NORMAL, UNITS, columns_of_rows, units


@pytest.fixture(scope="module", params=RUNS)
def stored(request):
    """(plan, tables) of a stored run."""
    p = planned(request.param)
    return p, scene_engine(RUNS[request.param][0]).read(p, STORED / request.param)


def test_the_case_of_a_stored_run_is_the_one_that_makes_it():
    for name in RUNS:
        assert planned(name).case == parse(data_of(name))


def test_rows_and_frames_tell_of_the_same_motion(stored):
    p, tables = stored
    rows = tables["rows"].set_index("step")
    assert list(rows.index) == list(range(0, p.steps + 1, p.every))
    assert rows["time"].to_numpy() == pytest.approx(p.time_at(rows.index.to_numpy()))
    table = tables["particles"]
    energy = (0.5 * table["mass"] * (table[["vx", "vy", "vz"]] ** 2).sum(axis=1)).groupby(table["step"]).sum()
    assert len(energy) >= 4 and energy.max() > 0
    assert set(rows.columns) <= columns_of_rows(p)
    # 10 digits of the row in YADE, 8 in LIGGGHTS
    assert rows.loc[energy.index, "kinetic_energy"].to_numpy() == pytest.approx(energy.to_numpy(), rel=1e-7, abs=1e-300)
    assert (table.groupby("step")["id"].count() == rows.loc[energy.index, "particles"]).all()
    density = table["mass"] / (4 / 3 * math.pi * table["radius"] ** 3)
    assert density.to_numpy() == pytest.approx(density.iloc[0], rel=1e-9)


def overlaps(p, frame: pd.DataFrame) -> dict[tuple[int, int], float]:
    """Overlap of every pair that touches, by the places of the spheres alone."""
    length = np.array([p.box[1] - p.box[0], p.box[3] - p.box[2]])
    found = {}
    for a, b in itertools.combinations(frame.to_dict("records"), 2):
        d = np.array([b[x] - a[x] for x in "xyz"])
        if p.scene.periodic:
            d[:2] -= length * np.round(d[:2] / length)
        if (overlap := a["radius"] + b["radius"] - float(np.linalg.norm(d))) > 0:
            found[a["id"], b["id"]] = overlap
    return found


def test_the_contacts_between_spheres_are_all_that_their_places_make(stored):
    p, tables = stored
    pairs = tables["contacts"][tables["contacts"]["wall"] == ""]
    for step, frame in tables["particles"].groupby("step"):
        expected = overlaps(p, frame)
        if p.scene.periodic:
            low, high = p.box[0:4:2], p.box[1:4:2]
            places = frame[["x", "y"]].to_numpy()
            assert (places >= low).all() and (places <= high).all()
        table = pairs[pairs["step"] == step].set_index(["i", "j"])["overlap"]
        assert set(table.index) == set(expected), step
        for pair, value in expected.items():
            assert table[pair] == pytest.approx(value, rel=1e-6, abs=1e-16)  # a difference of numbers 1000 times larger


def test_the_contacts_with_flat_walls_and_the_plate_are_where_these_are(stored):
    p, tables = stored
    places = {w.name: ("xyz".index(w.axis), w.at) for w in p.scene.planes}
    touched = tables["contacts"][tables["contacts"]["wall"].isin([*places, "plate"])]
    assert touched.empty == (p.case.scene.kind == "peening")  # its frames have contacts between spheres alone
    spheres = tables["particles"].set_index(["step", "id"])
    top = {row.step: row.plate_end for row in plate_ends(p, tables)}
    for row in touched.itertuples():
        axis, place = places.get(row.wall, (2, top.get(row.step)))
        s = spheres.loc[(row.step, row.i)]
        distance = abs(s["xyz"[axis]] - place)
        # a mesh moves half a step apart from the spheres
        tolerance = 2 * 4.0 * p.time_step if row.wall == "plate" else 1e-9 * s["radius"]
        assert s["radius"] - distance == pytest.approx(row.overlap, abs=tolerance), row


def plate_ends(p, tables):
    """Height of the plate at the end of each row's interval, by its two strokes."""
    if "plate" not in p.scene.meshes:
        return []
    s, turn = p.case.scene, p.phases[0].end * p.time_step
    rows = tables["rows"][["step", "time"]].copy()
    rows["plate_end"] = (
        s["box"][2]
        - s["speed"] * rows["time"].clip(upper=turn)
        + s["unload_speed"] * (rows["time"] - turn).clip(lower=0)
    )
    return rows.itertuples()


def test_forces_on_the_backbone_are_those_of_hertz_and_of_thornton_s_line():
    """F = 4/3 E* sqrt(R*) delta^1.5 up to delta_y = (pi p_y/2E*)^2 R*, then a line of slope pi p_y R*."""
    elastic = plastic = 0
    for name in ("settle", "hopper", "drum", "compaction", "yade_settle", "yade_compaction"):
        p = planned(name)
        tables = scene_engine(RUNS[name][0]).read(p, STORED / name)
        (material,) = p.case.materials.values()
        E_star, p_y = material.young_modulus / (2 * (1 - material.poisson_ratio**2)), 2.8 * material.yield_stress
        radius = tables["particles"].set_index(["step", "id"])["radius"]
        for row in tables["contacts"].itertuples():
            first = radius[row.step, row.i]
            R_star = first if row.wall else first * radius[row.step, row.j] / (first + radius[row.step, row.j])
            limit = (math.pi * p_y / (2 * E_star)) ** 2 * R_star
            on_limit = 4 / 3 * E_star * math.sqrt(R_star * limit) * limit
            # un- and reloading is Hertz's about the dent: 2/5 of force times way
            way = row.overlap - row.residual_overlap
            assert row.elastic_energy == pytest.approx(0.4 * row.force * max(way, 0.0), rel=1e-6, abs=1e-25)
            if row.delta_max <= limit:
                expected = 4 / 3 * E_star * math.sqrt(R_star * row.overlap) * row.overlap
                elastic += 1
            elif math.isclose(row.overlap, row.delta_max, rel_tol=1e-9):
                expected = on_limit + math.pi * p_y * R_star * (row.overlap - limit)
                plastic += 1
            else:
                assert 0.0 <= row.force < on_limit + math.pi * p_y * R_star * (row.delta_max - limit)
                assert 0.0 < row.residual_overlap < row.delta_max and row.plastic_work > 0.0
                continue
            assert row.force == pytest.approx(expected, rel=1e-9)
            assert (row.plastic_work > 0.0) == (row.delta_max > limit)
    assert elastic >= 3 and plastic >= 3


def test_the_energy_balance_adds_up(stored):
    p, tables = stored
    table, spheres = energy_balance(p, tables), tables["particles"]
    first = spheres[spheres["step"] == table["step"].iloc[0]]
    lift = p.scene.gravity * (first["mass"] * first["z"]).sum()
    assert table["gravity"].iloc[0] == pytest.approx(lift, rel=1e-12, abs=1e-300)
    assert "friction" not in table, "nothing rubs"
    # the work of plate and drum is the sum of means over a row; eight rows are few
    assert closure(table) < 0.02
    assert (np.diff(table["plastic"]) >= -1e-12 * table["plastic"].max()).all()
    verdicts = checks.checks(p, tables | {"energy_balance": table}).set_index("key")["passed"]
    assert verdicts["energy_residual"] == (closure(table) <= 0.01)
    if not p.scene.open_boundary:
        assert verdicts["spheres_in_room"]


def test_the_page_has_the_table_of_quantities():
    assert page() in (Path(__file__).parents[2] / "docs/results.md").read_text()


def test_every_column_has_a_unit_unless_it_is_a_name_or_a_count(stored):
    p, tables = stored
    found = {c for table in [*tables.values(), energy_balance(p, tables)] for c in table}
    named = {row.name: row for row in p.scene.row}
    assert set(named) <= set(tables["rows"]) and {*units(tables["rows"])} >= set(named)
    dents = {f"delta_max_{w.name}" for w in p.scene.planes} & set(tables["particles"])
    of_phases = {"phase", "begin", "end", "until", "held", "value", "opposite"}  # value: in the unit of the condition
    without = {"step", "particles", "id", "type", "wall", "i", "j", *NORMAL, *STRAINS} | of_phases
    assert found - set(UNITS) - set(named) - dents == without


CONTINUED = """
Step Atoms KinEng load1[3]
       0        8             0              0
     625        8          5e-7          1e-3
    1250        8          2e-6          2e-3
Loop time of 1 on 1 procs for 1250 steps with 8 atoms
Step Atoms KinEng load1[3]
    1250        8          2e-6          2e-3
    1875        8          9.9           9.9
LIGGGHTS (Version LIGGGHTS-PUBLIC 3.8.0)
Step Atoms KinEng load1[3]
    1250        8          2e-6             0
    1875        7          4e-6          3e-3
    2500        7          4e-6          3e-3
    3125        7          4e-6          3e-3
    3750        7          4e-6          3e-3
    4375        7          4e-6          3e-3
    5000        7          4e-6          3e-3
"""


def test_a_continued_log_keeps_the_row_of_its_restart_and_replaces_what_came_after_it(tmp_path):
    (tmp_path / "log").write_text(CONTINUED)
    rows = scene_tables.rows(planned("settle"), tmp_path / "log")
    assert rows["step"].to_list() == [*range(0, 5001, 625)]
    # of a plane the log has the force on spheres
    assert (-rows["floor_force_z"]).to_list() == [0, 1e-3, 2e-3, *[3e-3] * 6]
    assert rows["particles"].to_list() == [8] * 3 + [7] * 6


@pytest.mark.parametrize("cut", [1, 5, 60, 10_000])
@pytest.mark.parametrize("kind", ["particles", "contacts", "wall_contacts"])
def test_a_frame_that_is_not_whole_is_an_error_that_names_it_and_can_be_left_out(kind, cut, tmp_path):
    p, engine, last = planned("drum"), scene_engine("liggghts"), 8000
    shutil.copytree(STORED / "drum", tmp_path, dirs_exist_ok=True)
    (path,) = tmp_path.glob(f"{kind}.{last}.*")
    path.write_bytes(path.read_bytes()[:-cut])
    assert Frames(p, tmp_path, scene_tables.kinds(p)).damaged(p.steps) == [last]
    with pytest.raises(EngineError, match=path.name):
        engine.read(p, tmp_path)
    rest = engine.read(p, tmp_path, without=[last])
    assert rest["particles"]["step"].max() == rest["contacts"]["step"].max() == 6000
    path.unlink()
    assert Frames(p, tmp_path, scene_tables.kinds(p)).damaged(p.steps) == [last]


@pytest.mark.parametrize("kind", ["particles", "contacts"])
def test_a_frame_of_yade_is_read_by_its_step_and_is_not_whole_after_a_cut(kind, tmp_path):
    p, engine = planned("yade_settle"), scene_engine("yade")
    shutil.copytree(STORED / "yade_settle", tmp_path, dirs_exist_ok=True)
    path, whole = tmp_path / f"{kind}.5000.npy", engine.read(p, tmp_path)
    shutil.copy(path, tmp_path / f"{kind}.6250.npy")  # of a longer run: not this one's
    (tmp_path / f"{kind}.old.npy").write_text("of the user")
    for name, table in engine.read(p, tmp_path).items():
        assert table.equals(whole[name])
    raw = path.read_bytes()
    for cut in (1, 60, len(raw) - 3, len(raw)):
        path.write_bytes(raw[: len(raw) - cut])
        with pytest.raises(EngineError, match=path.name):
            engine.read(p, tmp_path)
    path.unlink()
    with pytest.raises(EngineError, match=path.name):
        engine.read(p, tmp_path)
