# SPDX-License-Identifier: GPL-2.0-or-later
"""Phases of scenes in YADE: spheres that come and leave, conditions, walls that turn, press or come; drum, peening."""

import numpy as np
import pytest
from parts_cases import BED, FLOOR, own, parts
from scene_runs import assert_alike, in_hosts, run, write_case
from test_parts_motions import BOX, FALL, PLATE

from engines.lammps_decks import needs_lammps
from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.errors import EngineError
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables.columns import last_frame

pytestmark = pytest.mark.yade("module")

BALL = {"material": "glass", "radius": "1.5 mm"}
UP = {"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "0.2 m/s"]}
SPIN = {"wall": "lid", "kind": "rotate", "axis": [0.0, 1.0, 0.0], "origin": ["0 mm", "0 mm", "6 mm"], "rate": "4 rad/s"}
SHAKE = {"wall": "lid", "kind": "vibrate", "amplitude": ["0 mm", "0 mm", "0.3 mm"], "frequency": "100 Hz"}
PRESS = {"wall": "lid", "kind": "press", "direction": [0.0, 0.0, 1.0], "force": "0.5 N", "highest_speed": "0.2 m/s"}
COUNT, FORCE = {"count": 3, "after": "0 s"}, {"wall": "lid", "force": "0.01 N", "after": "0 s"}


def balls(**scene):
    """Spheres at places of their own: one leaves the room, one comes with the second phase, one is held by a gate."""

    def ball(name, x, y, z, **keys):
        return BALL | {"name": name, "position": [f"{x} mm", f"{y} mm", f"{z} mm"]} | keys

    body = [
        ball("leaves", 7, 7, 20, velocity=["1 m/s", "0 m/s", "0 m/s"]),
        ball("on_gate", -6, 6, 18, velocity=["0 m/s", "0 m/s", "-0.4 m/s"]),
        ball("on_lid", 1, 2, 9.0, velocity=["0 m/s", "0 m/s", "-0.5 m/s"]),
        ball("on_trap", 7, -7, 8, velocity=["0 m/s", "0 m/s", "-0.3 m/s"]),
        ball("late", 0.5, -3, 12, velocity=["0 m/s", "0.1 m/s", "-0.9 m/s"], phase="on"),
    ]
    planes = [
        {"kind": "plane", "axis": "z", "material": "steel"} | x
        for x in (
            {"name": "gate", "at": "16 mm", "phases": ["fall"]},
            {"name": "trap", "at": "4 mm", "phases": ["on"]},
        )
    ]
    lid = PLATE | {"center": ["0 mm", "0 mm", "6 mm"], "size": ["9 mm", "9 mm"]}
    data = parts(wall=[FLOOR, *planes, lid], fill=[], body=body, open_boundary=True) | {
        "numerics": {"time_step": "5e-6 s"}
    }
    data["output"] = {"rows": 40, "particles": 40, "loads": True}
    data["scene"] |= scene
    return data


@pytest.mark.liggghts
@pytest.mark.parametrize(
    ("move", "until"), [(UP, COUNT), (SPIN, FORCE), (SHAKE, COUNT), (PRESS, FORCE)], ids=lambda x: x.get("kind", "")
)
def test_spheres_gates_and_conditions_do_the_same_in_both_engines(until, move, tmp_path):
    """Motions that go on over the end of a phase that ends early."""
    phases = [FALL | {"until": until, "move": [move]}, FALL | {"name": "on", "duration": "8 ms", "move": [move]}]
    ours, theirs = in_hosts(balls(phase=phases), tmp_path, "yade", "liggghts")
    ends = ["phase", "begin", "end", "until"]
    assert ours.phases[ends].equals(theirs.phases[ends]) and ours.phases["until"].iloc[0] == "reached"
    assert 0 < ours.phases["end"].iloc[0] < 0.5 * 0.06 / 5e-6
    one, other = (last_frame(r.particles).set_index("id") for r in (ours, theirs))
    assert [*one.index] == [*other.index] == [2, 3, 4, 5], "the first one left, the last one came"
    assert np.abs(one[["x", "y", "z"]] - other[["x", "y", "z"]]).to_numpy().max() < 5e-6
    assert np.abs(one[["vx", "vy", "vz"]] - other[["vx", "vy", "vz"]]).to_numpy().max() < 5e-3
    assert other.loc[2, "vz"] > 0 < other.loc[4, "vz"], "thrown back by the gate that was, and by the one that came"
    force = np.abs(theirs.rows["lid_force_z"]).max()
    assert np.abs(ours.rows["lid_force_z"] - theirs.rows["lid_force_z"]).max() < 0.05 * force


def test_a_stream_has_its_rate_and_ends_with_its_count(tmp_path):
    """2 kHz from a layer at the top; with a wall that turns below, whose work closes the balance."""
    layer = BED["region"] | {"z": ["30 mm", "38 mm"]}
    lid = PLATE | {"center": ["0 mm", "0 mm", "9 mm"], "size": ["12 mm", "12 mm"]}
    turn = {
        "wall": "lid",
        "kind": "rotate",
        "axis": [0.0, 1.0, 0.0],
        "origin": ["0 mm", "0 mm", "9 mm"],
        "rate": "20 rad/s",
    }
    phases = [FALL | {"duration": "50 ms", "move": [turn]}]
    fill = BED | {"region": layer, "count": 60, "rate": "2 kHz", "velocity": ["0 m/s", "0 m/s", "-1 m/s"]}
    data = parts(wall=[BOX, lid], fill=[fill], phase=phases)
    data["output"] = {"rows": 50, "particles": 50, "energy": True}
    outcome = run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out")
    found = outcome.results
    rows = found.rows
    assert outcome.passed, found.checks
    # a batch falls out of the layer in 2 * 8 mm / (1 m/s + sqrt(1 + 2 g 8 mm)) = 7.7 ms and has 15 spheres
    flowing = rows[rows["time"].between(1e-3, 0.022)]
    excess = flowing["particles"] - 2000 * flowing["time"]
    assert (excess > -1).all() and (excess < 17).all()
    assert rows["particles"].iloc[0] > 0 and rows["particles"].iloc[-1] == 60
    first = found.particles.groupby("id").first()
    assert first["z"].between(0.029, 0.0385).all() and (first["vz"] < -0.9).all()


def test_a_fill_of_a_later_phase_finds_places_between_the_spheres_that_are_there(tmp_path):
    more = BED | {"name": "more", "count": 30, "phase": "on", "region": {"diameter": "17 mm", "z": ["0 mm", "30 mm"]}}
    still = [FALL | {"duration": "1 ms"}, FALL | {"name": "on", "duration": "1 ms"}]
    data = parts(wall=[FLOOR, BOX], fill=[BED | {"count": 60}, more], phase=still, gravity="0 m/s^2")
    data["numerics"]["highest_speed"] = "1 m/s"
    found = run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out").results
    last = last_frame(found.particles)
    x, r = last[["x", "y", "z"]].to_numpy(), last["radius"].to_numpy()
    gap = np.linalg.norm(x[:, None] - x, axis=2) - r[:, None] - r + np.eye(len(x))
    assert len(last) == 90 and gap.min() > 0 and not last[["vx", "vy", "vz"]].to_numpy().any()
    new = x[last["id"] > 60]
    assert (np.hypot(new[:, 0], new[:, 1]) < 7e-3).all() and ((new[:, 2] > 1.5e-3) & (new[:, 2] < 28.5e-3)).all()
    late = found.particles[found.particles["id"] > 60]
    assert late["step"].min() >= found.phases["begin"].iloc[1]


def test_a_fill_without_room_ends_the_run_with_one_sentence(tmp_path):
    inside = {"x": ["-4 mm", "4 mm"], "y": ["-4 mm", "4 mm"], "z": ["5 mm", "13 mm"]}
    more = BED | {"name": "more", "count": 2, "phase": "on", "region": inside}
    held = BALL | {"name": "held", "radius": "9 mm", "frozen": True, "position": ["0 mm", "0 mm", "9 mm"]}
    data = parts(fill=[more], body=[held], phase=[FALL | {"duration": "1 ms"}, FALL | {"name": "on"}])
    with pytest.raises(EngineError, match=r"scene\.fill\.more: no room is left for sphere \d+ without overlap after"):
        run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out")


def test_a_wall_holds_its_force_after_a_phase_until_a_force(tmp_path):
    hold = PRESS | {"direction": [0.0, 0.0, -1.0], "force": "0.2 N", "highest_speed": "0.03 m/s"}
    lid = PLATE | {"center": ["0 mm", "0 mm", "15 mm"]}
    bed = BED | {"region": BED["region"] | {"z": ["0 mm", "14 mm"]}}
    phases = [
        {
            "name": "press",
            "duration": "1 s",
            "until": {"wall": "lid", "force": "0.1 N", "after": "0 s"},
            "move": [hold],
        },
        {"name": "hold", "duration": "0.4 s", "move": [hold]},
    ]
    data = parts(wall=[BOX, lid], fill=[bed], phase=phases) | {"contact": {"friction": 0.5}}
    data["output"] = {"rows": 400, "particles": 2, "loads": True}
    found = run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out").results
    rows, end = found.rows, found.phases["end"].iloc[0]
    force = np.linalg.norm(rows[["lid_force_x", "lid_force_y", "lid_force_z"]], axis=1)
    assert force[rows["step"] == end] >= 0.1 > force[rows["step"] < end].max()
    assert force[-50:].mean() == pytest.approx(0.2, rel=0.02)
    assert found.phases["until"].to_list() == ["reached", ""] and found.phases["end_time"].iloc[0] < 1


def test_a_condition_that_is_not_reached_is_named_in_yade(tmp_path):
    phases = [
        FALL | {"name": n, "duration": "10 ms", "until": {"kinetic_energy": x}}
        for n, x in (("a", "1 J"), ("b", "1e-30 J"))
    ]
    data = parts(phase=[*phases, FALL | {"duration": "5 ms"}]) | {"output": {"rows": 30, "particles": 2}}
    outcome = run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out")
    table = outcome.results.phases
    assert table["until"].to_list() == ["reached", "not reached", ""]
    assert 1e-3 < table["end_time"].iloc[0] < 3e-3, "looked at from a tenth of the duration"
    assert outcome.results.rows["step"].iloc[-1] == outcome.plan.steps == table["end"].iloc[-1]
    assert any(said.startswith("scene.phase.b.until was not reached") for said in outcome.warnings)


def test_motions_that_phases_name_in_another_order_go_on():
    lids = [PLATE | {"name": name, "center": ["0 mm", "0 mm", f"{z} mm"]} for name, z in (("lid", 6), ("roof", 9))]
    both = [UP, UP | {"wall": "roof"}]
    phases = [FALL | {"name": name, "move": move} for name, move in (("one", both), ("two", both[::-1]))]
    text = scene_engine("yade").files(plan(parse(parts(wall=[FLOOR, *lids], phase=phases))))["scene.py"]
    compile(text, "scene.py", "exec")
    assert text.count("def motions()") == 1


@needs_lammps
@pytest.mark.liggghts
def test_a_plate_that_changes_its_motion_rubs_spheres_in_all_hosts_alike(tmp_path):
    """Pressed, at rest and drawn back: the slip of each step is that of its own motion."""
    body = [
        BALL | {"name": f"b{k}", "position": [f"{x} mm", f"{y} mm", "1.5 mm"]}
        for k, (x, y) in enumerate([(1.1, -0.4), (-2.2, -0.7), (0.2, 3.1)])
    ]
    moves = [
        [{"wall": "lid", "kind": "linear", "velocity": [f"{x} m/s", "0 m/s", f"{z} m/s"]}]
        for x, z in ((0.05, -0.2), (-0.04, 0.1))
    ]
    phases = [
        FALL | {"name": name, "duration": "0.4 ms", "move": move}
        for name, move in (("press", moves[0]), ("hold", []), ("draw", moves[1]))
    ]
    lid = PLATE | {"center": ["0 mm", "0 mm", "3.01 mm"], "size": ["14 mm", "14 mm"]}
    data = parts(wall=[FLOOR, lid], fill=[], body=body, phase=phases, gravity="0 m/s^2")
    data |= {"contact": {"friction": 0.3}, "numerics": {"time_step": "4e-6 s"}}
    data["output"] = {"rows": 100, "particles": 2, "loads": True}
    theirs, *others = (found.rows for found in in_hosts(data, tmp_path, "liggghts", "lammps", "yade"))
    columns = ["lid_force_x", "lid_force_z", "floor_force_z", "kinetic_energy"]
    for ours in others:
        assert_alike(ours, theirs, columns, 1e-6)
    assert (np.abs(theirs[columns]).max() > 0).all()


@pytest.mark.liggghts
@pytest.mark.parametrize("size", ["20 mm", "11 mm"], ids=["endless", "with edges"])
def test_a_plate_shakes_spheres_of_a_periodic_room_as_in_liggghts(size, tmp_path):
    """Spheres that meet across the sides of the room, and a plate as wide as the room or narrower."""
    body = [
        BALL | {"name": f"b{k}", "position": [f"{x} mm" for x in at], "velocity": [f"{v} m/s" for v in way]}
        for k, (at, way) in enumerate(
            (
                ((9.5, 3, 8), (0.5, 0, -0.4)),
                ((-8, 3, 8), (0, 0, -0.4)),
                ((4, -0.5, 9), (0, 0.2, -0.6)),
                ((-3, -9, 9), (0, -0.9, -0.3)),
            )
        )
    ]
    lid = PLATE | {"center": ["0 mm", "0 mm", "4 mm"], "size": [size, size]}
    data = parts(
        wall=[FLOOR, lid], fill=[], body=body, periodic=True, phase=[FALL | {"duration": "24 ms", "move": [SHAKE]}]
    )
    data |= {"numerics": {"time_step": "5e-6 s"}, "output": {"rows": 24, "particles": 24, "loads": True}}
    ours, theirs = in_hosts(data, tmp_path, "yade", "liggghts")
    one, other = (r.particles.set_index(["step", "id"]) for r in (ours, theirs))
    one, other = one.loc[one.index.intersection(other.index)], other.loc[one.index.intersection(other.index)]
    way = (one[["x", "y", "z"]] - other[["x", "y", "z"]]).to_numpy()
    way[:, :2] -= 20e-3 * np.round(way[:, :2] / 20e-3)
    assert len(way) >= 96 and np.abs(way).max() < 1e-4
    speeds = np.abs(one[["vx", "vy", "vz"]] - other[["vx", "vy", "vz"]]).max().max()
    assert speeds < 2e-2
    assert (np.abs(np.diff(theirs.particles.query("id == 1")["vx"])) > 0.05).any(), "met across the side"


def test_the_torque_of_a_drum_gives_its_bed_the_energy_that_it_has(tmp_path):
    """With partial slip, of which every energy is known, so that a wrong torque leaves a balance."""
    data = own("drum_beads")
    data["scene"] |= {"duration": "40 ms", "count": 60, "angular_velocity": "600 rpm"}
    data["scene"] |= {"diameter": "16 mm", "length": "8 mm", "particles": [{"material": "beads", "radius": "0.7 mm"}]}
    data |= {"contact": {"friction": 0.5, "tangential": "partial_slip"}}
    data["output"] = {"rows": 40, "particles": 40, "energy": True, "loads": True}
    outcome = run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out")
    assert "torque_of_the_bed" in outcome.results.checks["key"].to_list()
    balance = outcome.results.energy_balance
    assert outcome.passed, outcome.results.checks
    assert balance["work"].iloc[-1] > 0.5 * balance["kinetic"].max() > 0
    assert balance["balance"].abs().max() < 0.01 * balance["work"].iloc[-1]


def test_shot_rebounds_and_leaves_with_its_energy(tmp_path):
    """The check of the case compares the rebound of single shot with theory; what leaves takes its energy along."""
    data = own("peening_steel")
    data["scene"] |= {"count": 12, "duration": "0.55 ms"}
    data["output"] |= {"rows": 60, "particles": 60, "energy": True}
    outcome = run(write_case(data, tmp_path), engine="yade", out=tmp_path / "out")
    found = outcome.results
    assert outcome.passed, found.checks
    assert found.rows["particles"].iloc[0] == 12 > found.rows["particles"].iloc[-1]
    assert found.energy_balance["lost_spheres_energy"].iloc[-1] > 0
