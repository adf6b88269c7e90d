# SPDX-License-Identifier: GPL-2.0-or-later
"""Presses whose height only the run tells: the run ends with a frame in the row in which the bed has no void."""

import math

import numpy as np
import pytest
from parts_cases import BED, FLOOR, flat, mm, mps, parts, timed
from scene_runs import assert_goes_on, run, write_case

from epdem.case.scene import parse
from epdem.scenes.plan.plan import plan

SIDES = {"name": "sides", "kind": "box", "x": mm(-10, 10), "y": mm(-10, 10), "z": mm(0, 20)}
SIDES |= {"open": ["+z", "-z"], "material": "steel"}
LID = flat("lid", mm(0, 0, 12), mm(20, 20))
SOLID = 40 * 4 / 3 * np.pi * 1.5e-3**3 / 0.02**2  # height without void [m]
MOVES = {
    "linear": {"kind": "linear", "velocity": mps(0, 0, -2)},
    "press": {"kind": "press", "direction": [0.0, 0.0, -1.0], "force": "1 GN", "highest_speed": "2 m/s"},
}
HOLD = timed("hold", "1 ms")


def pressed(kind, until=None, **output):
    """Forty spheres under a lid that moves at 2 m/s, which it does under a force that no bed reaches, too."""
    press = timed("press", "10 ms", move=[{"wall": "lid"} | MOVES[kind]])
    if until:
        press["until"] = until
    bed = BED | {"region": BED["region"] | {"z": mm(0, 11)}}
    data = parts(wall=[FLOOR, SIDES, LID], fill=[bed], phase=[press, HOLD])
    return data | {"output": {"rows": 50, "particles": 4, "loads": True} | output}


FORCE = {"wall": "lid", "force": "0.9 GN", "after": "1 ms"}


def expected_end(p, looks=1):
    """The first row in which the lid, whose way is known, is as low as the spheres without void; looks: steps between
    two looks where the lid slows near a force, after which it rests until the row ends."""
    steps = np.arange(p.every, p.steps, max(p.every, looks))
    steps = steps if looks == 1 else steps // looks * looks
    return p.every * math.ceil(steps[0.012 - 2.0 * p.time_step * steps <= SOLID][0] / p.every)


ENGINES = {"liggghts": pytest.mark.liggghts, "lammps": pytest.mark.lammps, "yade": pytest.mark.yade("module")}
PRESSES = [("liggghts", "linear", FORCE), ("liggghts", "press", FORCE), ("liggghts", "press", None)]
PRESSES += [
    (engine, kind, until) for engine in ("lammps", "yade") for kind, until in (("linear", FORCE), ("press", None))
]


@pytest.mark.parametrize(("engine", "kind", "until"), [pytest.param(*x, marks=ENGINES[x[0]]) for x in PRESSES])
def test_a_run_ends_with_a_frame_where_a_pressed_bed_has_no_void(tmp_path, engine, kind, until):
    path = write_case(pressed(kind, until, contacts=2), tmp_path)
    for _ in range(2):  # and as it is read again
        outcome = run(path, engine=engine, out=tmp_path / "out")
        looks = 100 if kind == "linear" and engine != "yade" else 1
        r, end = outcome.results, expected_end(plan(parse(pressed(kind, until))), looks)
        assert r.phases["until"].to_list() == ["no void", "no void"] and r.phases["end"].to_list() == [end, end]
        assert r.rows["step"].iloc[-1] == r.particles["step"].iloc[-1] == r.contacts["step"].iloc[-1] == end
        checks = r.tables["checks"].set_index("key")
        assert not outcome.passed and not checks.loc["void", "passed"]
        (said,) = [x for x in outcome.warnings if "no void" in x]
        assert said.startswith(
            f"scene.phase.press: the run ended after step {end}, because the pressed bed has no void"
        )
    assert outcome.reused


@pytest.mark.liggghts
def test_a_continued_press_ends_in_the_same_row(tmp_path):
    p = plan(parse(pressed("linear", FORCE, restarts=50, particles=50)))
    whole, _ = assert_goes_on(p, tmp_path, of=slice(-3, None))
    assert whole["phases"]["end"].iloc[0] == expected_end(p)


def test_a_bed_is_looked_at_only_where_the_run_tells_its_height():
    """Not where the way of the lid is known, as with `travel`, and not where spheres pass beside the lid."""
    travel = {"wall": "lid", "travel": "1 mm"}
    for kind, until, looked in (("linear", None, 0), ("linear", travel, 0), ("linear", FORCE, 1), ("press", None, 1)):
        data = pressed(kind, until)
        data["scene"]["phase"][0]["duration"] = "1 ms" if kind == "linear" else "10 ms"
        if until:
            data["scene"]["phase"][0]["until"] = until | ({"after": "0.1 ms"} if "force" in until else {})
        assert len(plan(parse(data)).pressed) == looked, (kind, until)
    small = pressed("press")
    small["scene"]["wall"] = [FLOOR, SIDES, LID | {"size": mm(18, 18)}]
    assert not plan(parse(small)).pressed
