# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene in LAMMPS whose walls vibrate, press, turn and stop continues to the bit from every restart file."""

import numpy as np
import pytest
from parts_cases import BED, FLOOR, parts
from scene_runs import restart_steps, run, write_case
from test_parts_motions import BOX, PLATE

from engines.lammps_decks import needs_lammps
from epdem.case.scene import parse
from epdem.engines import log, scene_engine
from epdem.engines.frames import Frames
from epdem.engines.lammps import launcher, resume
from epdem.engines.lammps import tables as tables
from epdem.errors import CaseError
from epdem.jobs.engine import check
from epdem.jobs.stage import write_deck
from epdem.scenes.plan.plan import plan

pytestmark = needs_lammps
SHAKE = {"wall": "table", "kind": "vibrate", "amplitude": ["0.2 mm", "0 m", "0.5 mm"], "frequency": "60 Hz"}
PRESS = {"wall": "lid", "kind": "press", "direction": [0.0, 0.0, -1.0], "force": "0.2 N", "highest_speed": "0.1 m/s"}
LIFT = {"wall": "table", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "0.02 m/s"]}
TURN = {"wall": "stirrer", "kind": "rotate", "axis": [0.0, 0.0, 1.0], "origin": ["0 m"] * 3, "rate": "40 rad/s"}
STIR = [PRESS, TURN]


def moving(**output) -> dict:
    """A bed on a table that shakes, is lifted and stops, under a plate that a force drives, around a stirrer; a plane
    that is there in two phases, spheres that come with others, two phases that a condition ends, one without frames."""
    table = PLATE | {"name": "table", "center": ["0 mm", "0 mm", "2 mm"], "size": ["16 mm", "17 mm"]}
    lid = PLATE | {"center": ["0 mm", "0 mm", "36 mm"], "wear": "1e-9 m^2/N"}
    stirrer = PLATE | {"name": "stirrer", "axis": "x", "center": ["0 mm", "0 mm", "6 mm"], "size": ["8 mm", "5 mm"]}
    gate = FLOOR | {"name": "gate", "at": "1 mm", "phases": ["shake", "press"]}
    bed = BED | {"region": BED["region"] | {"z": ["10 mm", "34 mm"]}}
    ball = {"name": "ball", "material": "steel", "radius": "1.5 mm", "position": ["0 m", "0 m", "33 mm"]}
    phases = [
        {"name": "shake", "duration": "0.4 s", "until": {"kinetic_energy": "2 uJ", "after": "30 ms"}, "move": [SHAKE]},
        {
            "name": "press",
            "duration": "0.4 s",
            "until": {"wall": "lid", "force": "0.1 N"},
            "move": [SHAKE, PRESS, TURN],
        },
        {"name": "hold", "duration": "20 ms", "move": STIR, "record": False, "time_step": "8e-6 s"},
        {"name": "lift", "duration": "20 ms", "move": [LIFT]},
        {"name": "rest", "duration": "15 ms", "move": [TURN]},
    ]
    found = parts(wall=[BOX, table, lid, stirrer, gate], fill=[bed], body=[ball | {"phase": "lift"}], phase=phases)
    return found | {"viscous": {"restitution": 0.9}, "output": {"rows": 60, "particles": 60, "loads": True} | output}


def test_a_run_with_moving_walls_goes_on_bitwise(tmp_path):
    tool, p = scene_engine("lammps"), plan(parse(moving(restarts=60)))
    write_deck(tool, p, tmp_path)
    launcher.run("in.scene", tmp_path)
    out = tmp_path / launcher.OUT
    ends = log.ends(out)
    assert not log.not_reached(out) and [*ends] == [phase.name for phase in p.phases]
    ended = p.with_ends(ends)
    whole = [read(Frames(ended, tmp_path, tables.kinds(ended))) for read in (tables.particles, tables.wall_table)]
    rows = tables.rows(ended, out)
    assert (rows["lid_force_z"] > 0.1).any() and whole[1]["wear"].any()
    steps = restart_steps(tmp_path)[:-1]
    # a phase that its condition ends between two restart files has none at its end
    at_ends = {ends[name] for name in ("shake", "press", "hold", "lift")} & {*steps}
    assert len(steps) > 30 and len(at_ends) >= 2
    for step in sorted({*steps[3::18]} | at_ends):
        resume.write_resume(p, tmp_path, step)
        launcher.run("in.resume", tmp_path, append=True)
        assert log.ends(out) == ends, step
        frames = Frames(ended, tmp_path, tables.kinds(ended))
        assert tables.particles(frames).equals(whole[0]) and tables.wall_table(frames).equals(whole[1]), step
        np.testing.assert_array_equal(tables.rows(ended, out), rows, err_msg=str(step))


def test_motions_that_liggghts_cannot_continue_are_refused_there():
    with pytest.raises(CaseError, match=r"output.restarts: in LIGGGHTS only walls with linear motions .* lammps"):
        check(scene_engine("liggghts"), plan(parse(moving(restarts=5))))


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
