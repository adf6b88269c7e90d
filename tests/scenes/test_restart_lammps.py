# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in LAMMPS whose walls vibrate, press, turn and stop continues to the bit from every restart file."""

import pytest
from parts_cases import BED, BOX, FLOOR, bead, driven, linear, mm, parts, timed, vibrating
from scene_runs import assert_goes_on, restart_steps, run, write_case
from test_parts_motions import PLATE

from epdem.case.scene import parse
from epdem.engines.frames import Frames
from epdem.engines.lammps import tables as tables
from epdem.scenes.plan.plan import plan

pytestmark = pytest.mark.lammps
SHAKE = vibrating("table", ["0.2 mm", "0 m", "0.5 mm"], "60 Hz")
PRESS = driven("lid", [0.0, 0.0, -1.0], "0.2 N", "0.1 m/s")
LIFT = linear("table", 0, 0, 0.02)
TURN = {"wall": "stirrer", "kind": "rotate", "axis": [0.0, 0.0, 1.0], "origin": ["0 m"] * 3, "rate": "40 rad/s"}
STIR = [PRESS, TURN]


def moving(**output) -> dict:
    """A bed on a table that shakes, is lifted and stops, under a plate that a force drives, around a stirrer; a plane
    that is there in two phases, spheres that come with others, two phases that a condition ends, one without frames."""
    table = PLATE | {"name": "table", "center": mm(0, 0, 2), "size": mm(16, 17)}
    lid = PLATE | {"center": mm(0, 0, 36), "wear": "1e-9 m^2/N"}
    stirrer = PLATE | {"name": "stirrer", "axis": "x", "center": mm(0, 0, 6), "size": mm(8, 5)}
    gate = FLOOR | {"name": "gate", "at": "1 mm", "phases": ["shake", "press"]}
    bed = BED | {"region": BED["region"] | {"z": mm(10, 34)}}
    ball = bead("ball", ["0 m", "0 m", "33 mm"], "1.5 mm", "steel")
    phases = [
        timed("shake", "0.4 s", until={"kinetic_energy": "2 uJ", "after": "30 ms"}, move=[SHAKE]),
        timed("press", "0.4 s", until={"wall": "lid", "force": "0.1 N"}, move=[SHAKE, PRESS, TURN]),
        timed("hold", "20 ms", move=STIR, record=False, time_step="8e-6 s"),
        timed("lift", "20 ms", move=[LIFT]),
        timed("rest", "15 ms", move=[TURN]),
    ]
    found = parts(wall=[BOX, table, lid, stirrer, gate], fill=[bed], body=[ball | {"phase": "lift"}], phase=phases)
    return found | {"viscous": {"restitution": 0.9}, "output": {"rows": 60, "particles": 60, "loads": True} | output}


def test_a_run_with_moving_walls_goes_on_bitwise(tmp_path):
    """A phase that its condition ends between two restart files has none at its end."""
    p = plan(parse(moving(restarts=60)))
    whole, steps = assert_goes_on(p, tmp_path, "lammps", of=slice(3, None, 18))
    assert "not reached" not in {*whole["phases"]["until"]} and (whole["rows"]["lid_force_z"] > 0.1).any()
    assert whole["walls"]["wear"].any()
    assert len({*steps} & {*whole["phases"]["end"].iloc[:-1]}) >= 2


@pytest.mark.parametrize(("kind", "left"), [("particles", -200), ("contacts", 0)])
def test_a_damaged_frame_is_written_again(kind, left, tmp_path):
    """A file of no byte is no frame without contacts: an engine that was killed had opened it."""
    path = write_case(moving(restarts=6, contacts=10), tmp_path)
    whole = run(path, "lammps", out=tmp_path / "whole")
    assert len(restart_steps(tmp_path / "whole")) <= 2  # of those that the engine has gone on after the newest is kept
    later = tmp_path / "whole" / f"{kind}.{whole.plan.steps}.txt"
    text = later.read_text()
    later.write_text(text[:left])
    frames = Frames(whole.plan, tmp_path / "whole", tables.kinds(whole.plan))
    assert frames.damaged(whole.plan.steps) == [whole.plan.steps]
    again = run(path, "lammps", out=tmp_path / "whole", resume=True, force=True)
    assert again.results.particles.equals(whole.results.particles) and later.read_text() == text
    assert again.results.contacts.equals(whole.results.contacts) and len(whole.results.contacts)
