# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of parts in YADE: spheres that come and leave, conditions, walls that turn or come; drum, hopper."""

import math

import numpy as np
import pytest
from parts_cases import BED, BOX, FLOOR, bead, linear, mm, mps, own, parts, timed, vibrating
from scene_runs import assert_alike, in_hosts, ran
from test_parts_motions import FALL, PLATE

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.engines.yade import deck as scene_deck
from epdem.errors import EngineError
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables.columns import last_frame

BALL = {"material": "glass", "radius": "1.5 mm"}
UP = linear("lid", 0, 0, 0.2)
SPIN = {"wall": "lid", "kind": "rotate", "axis": [0.0, 1.0, 0.0], "origin": mm(0, 0, 6), "rate": "4 rad/s"}
SHAKE = vibrating("lid", mm(0, 0, 0.3), "100 Hz")
COUNT = {"count": 3, "after": "0 s"}


def balls(**scene):
    """Spheres at places of their own: one leaves the room, one comes with the second phase, one is held by a gate."""

    def ball(name, x, y, z, **keys):
        return BALL | {"name": name, "position": mm(x, y, z)} | keys

    body = [
        ball("leaves", 7, 7, 20, velocity=mps(1, 0, 0)),
        ball("on_gate", -6, 6, 18, velocity=mps(0, 0, -0.4)),
        ball("on_lid", 1, 2, 9.0, velocity=mps(0, 0, -0.5)),
        ball("on_trap", 7, -7, 8, velocity=mps(0, 0, -0.3)),
        ball("late", 0.5, -3, 12, velocity=mps(0, 0.1, -0.9), phase="on"),
    ]
    planes = [
        {"kind": "plane", "axis": "z", "material": "steel"} | x
        for x in ({"name": "gate", "at": "16 mm", "phases": ["fall"]}, {"name": "trap", "at": "4 mm", "phases": ["on"]})
    ]
    lid = PLATE | {"center": mm(0, 0, 6), "size": mm(9, 9)}
    data = parts(wall=[FLOOR, *planes, lid], fill=[], body=body, open_boundary=True) | {
        "numerics": {"time_step": "5e-6 s"}
    }
    data["output"] = {"rows": 40, "particles": 40, "loads": True}
    data["scene"] |= scene
    return data


@pytest.mark.yade("module")
@pytest.mark.liggghts
@pytest.mark.parametrize("move", [UP, SPIN, SHAKE], ids=lambda x: x["kind"])
def test_spheres_gates_and_conditions_do_the_same_in_both_engines(move, tmp_path):
    """Motions that go on over the end of a phase that ends early."""
    phases = [FALL | {"until": COUNT, "move": [move]}, FALL | timed("on", "8 ms", move=[move])]
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


def more_spheres(low):
    """A bed below 18 mm, and 30 spheres that come with the second phase from a height [mm] on."""
    more = BED | {"name": "more", "count": 30, "phase": "on", "region": BED["region"] | {"z": mm(low, 38)}}
    still = [FALL | {"duration": "1 ms"}, FALL | timed("on", "1 ms")]
    bed = BED | {"count": 60, "region": BED["region"] | {"z": mm(0, 18)}}
    data = parts(wall=[FLOOR, BOX], fill=[bed, more], phase=still, gravity="0 m/s^2")
    data["numerics"]["highest_speed"] = "1 m/s"
    return data


@pytest.mark.yade("module")
def test_a_fill_of_a_later_phase_comes_in_it_as_the_table_of_the_deck_has_it(tmp_path):
    found = ran(more_spheres(20), tmp_path, "yade").results
    last = last_frame(found.particles)
    late = found.particles[found.particles["id"] > 60]
    assert len(last) == 90 and late["step"].min() >= found.phases["begin"].iloc[1]
    drawn = np.loadtxt(tmp_path / "out/spheres_on.txt")
    assert last[["x", "y", "z", "radius"]].to_numpy()[60:] == pytest.approx(drawn[:, :4], rel=1e-12)
    assert not last[["vx", "vy", "vz"]].to_numpy().any() and (drawn[:, 2] > 21.5e-3).all()


@pytest.mark.yade("module")
def test_a_fill_where_spheres_are_ends_the_run_with_one_sentence(tmp_path):
    words = r"scene\.fill\.more: at the begin of phase on another sphere is there; raise the region, or use --eng"
    with pytest.raises(EngineError, match=words):
        ran(more_spheres(0), tmp_path, "yade")


@pytest.mark.yade("module")
def test_motions_that_phases_name_in_another_order_go_on():
    lids = [PLATE | {"name": name, "center": mm(0, 0, z)} for name, z in (("lid", 6), ("roof", 9))]
    both = [UP, UP | {"wall": "roof"}]
    phases = [FALL | {"name": name, "move": move} for name, move in (("one", both), ("two", both[::-1]))]
    text = scene_engine("yade").files(plan(parse(parts(wall=[FLOOR, *lids], phase=phases))))["scene.py"]
    compile(text, "scene.py", "exec")
    assert text.count("def motions()") == 1


@pytest.mark.yade("module")
@pytest.mark.lammps
@pytest.mark.liggghts
def test_a_plate_that_changes_its_motion_rubs_spheres_in_all_hosts_alike(tmp_path):
    """Pressed, at rest and drawn back: the slip of each step is that of its own motion."""
    body = [
        BALL | {"name": f"b{k}", "position": mm(x, y, 1.5)}
        for k, (x, y) in enumerate([(1.1, -0.4), (-2.2, -0.7), (0.2, 3.1)])
    ]
    moves = [[linear("lid", x, 0, z)] for x, z in ((0.05, -0.2), (-0.04, 0.1))]
    phases = [
        FALL | timed(name, "0.4 ms", move=move)
        for name, move in (("press", moves[0]), ("hold", []), ("draw", moves[1]))
    ]
    lid = PLATE | {"center": mm(0, 0, 3.01), "size": mm(14, 14)}
    data = parts(wall=[FLOOR, lid], fill=[], body=body, phase=phases, gravity="0 m/s^2")
    data |= {"contact": {"friction": 0.3}, "numerics": {"time_step": "4e-6 s"}}
    data["output"] = {"rows": 100, "particles": 2, "loads": True}
    theirs, *others = (found.rows for found in in_hosts(data, tmp_path, "liggghts", "lammps", "yade"))
    columns = ["lid_force_x", "lid_force_z", "floor_force_z", "kinetic_energy"]
    for ours in others:
        assert_alike(ours, theirs, columns, 1e-6)
    assert (np.abs(theirs[columns]).max() > 0).all()


@pytest.mark.yade("module")
@pytest.mark.liggghts
@pytest.mark.parametrize("size", mm(20, 11), ids=["endless", "with edges"])
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
    lid = PLATE | {"center": mm(0, 0, 4), "size": [size, size]}
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


@pytest.mark.yade("module")
def test_the_torque_of_a_drum_gives_its_bed_the_energy_that_it_has(tmp_path):
    """With partial slip, of which every energy is known, so that a wrong torque leaves a balance."""
    data = own("drum_beads")
    data["scene"] |= {"duration": "40 ms", "count": 60, "angular_velocity": "600 rpm"}
    data["scene"] |= {"diameter": "16 mm", "length": "8 mm", "particles": [{"material": "beads", "radius": "0.7 mm"}]}
    data |= {"contact": {"friction": 0.5, "tangential": "partial_slip"}}
    data["output"] = {"rows": 40, "particles": 40, "energy": True, "loads": True}
    outcome = ran(data, tmp_path, "yade")
    assert "torque_of_the_bed" in outcome.results.checks["key"].to_list()
    balance = outcome.results.energy_balance
    assert outcome.passed, outcome.results.checks
    assert balance["work"].iloc[-1] > 0.5 * balance["kinetic"].max() > 0
    assert balance["balance"].abs().max() < 0.01 * balance["work"].iloc[-1]


@pytest.mark.yade("module")
def test_beads_leave_a_hopper_when_its_shutter_is_gone_in_yade(tmp_path):
    data = own("hopper_beads")
    data["scene"] |= {"bin_diameter": "20 mm", "bin_height": "30 mm", "outlet": "10 mm", "outlet_height": "10 mm"}
    data["scene"] |= {"count": 30, "fill_time": "0.12 s", "duration": "0.08 s"}
    data |= {"output": {"rows": 6, "particles": 10, "energy": True}, "numerics": {"time_step": "5e-5 s"}}
    outcome = ran(data, tmp_path, "yade")
    spheres, contacts, (fill, _) = outcome.results.particles, outcome.results.contacts, outcome.plan.phases
    outlet = next(w.at for w in outcome.plan.scene.gates)
    before, after = spheres[spheres["step"] <= fill.end], spheres[spheres["step"] == outcome.plan.steps]
    assert outcome.passed and len(after) == 30
    assert before["z"].min() > outlet, "held"
    assert (after["z"] < outlet).mean() > 0.9, "through, but for some on the cone"
    resting = contacts["step"] <= fill.end
    assert {"hopper", "shutter"} <= {*contacts[resting]["wall"]} and "shutter" not in {*contacts[~resting]["wall"]}


BODIES = """x,y,z,radius,vx,vy,vz
0.0002,0.0001,0.0162,0.0015,0,0,-1
-0.0051,0.0042,0.0115,0.0012,0.3,0,-0.5
"""


@pytest.mark.yade("module")
@pytest.mark.liggghts
def test_the_same_bodies_do_the_same_in_both_engines(tmp_path):
    """Without friction (YADE has another); of a file, one frozen; a plate of triangles rises; two time steps."""
    table = {"name": "table", "file": str(tmp_path / "spheres.csv"), "material": "glass"}
    (tmp_path / "spheres.csv").write_text(BODIES)
    frozen = bead("held", mm(0, 0, 11), "2 mm", "steel", frozen=True)
    fast = bead("fast", mm(5, -4, 12), "1.5 mm", "glass", velocity=mps(0, 0, -1))
    up = linear("lid", 0, 0, 0.3)
    phases = [FALL | {"duration": "5 ms", "move": [up]}, FALL | timed("on", "5 ms")]
    data = parts(wall=[FLOOR, PLATE | {"center": mm(0, 1, 6)}], fill=[table], body=[frozen, fast], phase=phases)
    data["scene"]["phase"][1]["time_step"] = "5e-6 s"
    data["numerics"] = {"time_step": "1e-5 s"}
    data["output"] = {"rows": 10, "particles": 10, "loads": True}
    found = in_hosts(data, tmp_path, "yade", "liggghts")
    one, other = (r.particles.set_index(["step", "id"]) for r in found)
    assert one.index.equals(other.index) and len(one) == 4 * 13  # rows of 125 steps end both phases
    speeds = ["vx", "vy", "vz"]
    assert np.abs(one[["x", "y", "z"]] - other[["x", "y", "z"]]).to_numpy().max() < 1e-6
    difference = np.abs(one[speeds] - other[speeds]).max(axis=1)
    assert (
        difference.max() < 2e-3 and difference.loc[other.index[-1][0]].max() < 5e-5
    )  # half a step of a contact, after
    assert other.loc[other.index[-1][0], "vz"].max() > 0.3  # something rebounds
    assert not one.xs(3, level="id")[speeds].to_numpy().any()  # the frozen one
    loads = [f"lid_force_{axis}" for axis in "xyz"] + ["floor_force_z"]
    one, other = (r.rows[[*loads, "time", "lid_torque_y"]].to_numpy() for r in found)
    assert np.abs(one - other).max(axis=0) == pytest.approx(0, abs=0.02 * np.abs(other[:, 2]).max())
    assert np.abs(other[:, 2]).max() > 1e-3 and found[0].phases.equals(found[1].phases)


def test_every_pair_has_its_friction_if_one_is_not_the_smaller_of_two():
    """Of a pair that its MatchMaker does not name YADE takes the mean of two angles."""
    data = parts() | {"contact": {"friction": 0.3, "wall_friction": 0.6}}
    found = scene_deck.deck(plan(parse(data)))
    angles = dict.fromkeys([(0, 0)], math.atan(0.3)) | dict.fromkeys([(0, 1), (1, 1)], math.atan(0.6))
    (friction,) = [v for v in found.contact.functors.pairs if v.name == "frictAngle"]
    assert friction.matches == tuple((*pair, pytest.approx(angle)) for pair, angle in angles.items())


def test_a_wall_of_any_name_leaves_the_table_of_the_spheres():
    texts = scene_deck.files(plan(parse(parts(wall=[FLOOR, PLATE | {"name": "spheres"}]))))
    assert len(texts["spheres.txt"].splitlines()) == 1 + BED["count"]
    assert len(texts["wall_spheres.txt"].splitlines()) == 1 + 1  # rectangle
