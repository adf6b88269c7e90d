# SPDX-License-Identifier: GPL-2.0-or-later
"""Adding a motion of walls takes a class, its name in the list of motions, and a line in the table of each host."""

import pytest
from workshop import PYTHON

RAMP = '''class RampMove(Motion):
    """A constant acceleration from rest."""

    kind: Literal["ramp"]
    acceleration: Annotated[list[Annotated[float, Quantity("m/s^2")]], Field(min_length=3, max_length=3)]
    duration: Annotated[float, Quantity("s", above=0.0)]

    @property
    def along(self) -> Sequence[float]:
        return self.acceleration

    def top_speed(self, reach: float) -> float:
        return self.duration * math.hypot(*self.acceleration)

    def point_at(self, t: npt.ArrayLike, x: FloatArray) -> FloatArray:
        return np.asarray(x + 0.5 * np.asarray(t) ** 2 * np.array(self.acceleration))


'''
OF_LAMMPS = """def _ramp(m: RampMove, id: str, dt: float) -> MotionWords:
    power = _force_times(id, [0.5 * dt * a for a in m.acceleration])
    return MotionWords(_along([0.5 * a for a in m.acceleration], "T*T"), f"f_{id}[7]+{power}")


"""
TESTS = """

import pytest
from parts_cases import parts

from epdem.case.scene import parse
from epdem.engines import scene_engine
from epdem.errors import CaseError
from epdem.scenes.plan.meshes import at_end
from epdem.scenes.plan.plan import plan

LID = {"name": "lid", "kind": "plate", "axis": "z", "center": ["0 mm", "0 mm", "39 mm"], "size": ["18 mm", "18 mm"]}


def ramp(acceleration):
    move = {"wall": "lid", "kind": "ramp", "acceleration": ["0 m/s^2", "0 m/s^2", acceleration], "duration": "20 ms"}
    floor = parts()["scene"]["wall"][0]
    phase = [{"name": "fall", "duration": "20 ms", "move": [move]}]
    return plan(parse(parts(wall=[floor, LID | {"material": "steel"}], phase=phase)))


def test_the_plan_knows_where_the_wall_ends_and_how_fast_it_is():
    p = ramp("-10 m/s^2")
    assert p.scene.drive == pytest.approx(0.2)
    (lid,) = at_end([(p.phases[0].moves, 0.02)], p.triangles).values()
    assert lid[..., 2] == pytest.approx(0.039 - 0.5 * 10 * 0.02**2)


def test_a_way_out_of_the_room_is_refused():
    with pytest.raises(CaseError, match="wall lid leaves scene.room"):
        ramp("10 m/s^2")


def test_the_host_with_words_has_a_deck_and_the_others_say_that_they_have_none():
    p = ramp("-10 m/s^2")
    deck = scene_engine("lammps").files(p)["in.scene"]
    assert "-5.0*T*T".replace("T", "(time-v_wall_lid_begin)") in deck
    for name in ("liggghts", "yade"):
        with pytest.raises(CaseError, match="has no words for the motion 'ramp'"):
            scene_engine(name).files(p)
"""


@pytest.mark.slow
def test_a_new_motion_is_planned_and_runs_where_a_host_has_words(copy, tests_of_copy):
    motions, walls = copy / PYTHON / "case/motions.py", copy / PYTHON / "engines/lammps/scene_walls.py"
    text, lammps = motions.read_text(), walls.read_text()
    assert text.count("Move = Annotated[") == 1 and lammps.count("MOTIONS: dict") == 1
    text = text.replace("Move = Annotated[", RAMP + "Move = Annotated[RampMove | ")
    motions.write_text(text)
    lammps = lammps.replace("import LinearMove, ", "import LinearMove, RampMove, ")
    lammps = lammps.replace("MOTIONS: dict", OF_LAMMPS + "MOTIONS: dict")
    walls.write_text(lammps.replace("    LinearMove: _linear,", "    LinearMove: _linear,\n    RampMove: _ramp,"))
    (copy / "tests/scenes/test_ramp.py").write_text(TESTS)
    done = tests_of_copy.run("tests/scenes/test_ramp.py")
    assert done.returncode == 0, done.stdout[-3000:]
    assert "3 passed" in done.stdout
