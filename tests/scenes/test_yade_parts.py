# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes of parts in YADE: facets, motions, spheres of a table beside LIGGGHTS; what is refused."""

import math

import numpy as np
import pytest
from parts_cases import BED, FLOOR, bead, linear, mm, mps, own, parts, timed
from scene_runs import in_hosts, ran
from test_parts_motions import FALL, PLATE

from epdem.case.scene import parse
from epdem.engines.yade import deck as scene_deck
from epdem.scenes.plan.plan import plan


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
