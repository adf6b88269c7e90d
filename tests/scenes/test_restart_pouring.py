# SPDX-License-Identifier: GPL-2.0-or-later
"""A run that is interrupted while spheres are still poured in, or after the last one."""

from pathlib import Path

import pytest
from parts_cases import BED, parts
from scene_runs import restart_steps, write_deck

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines.frames import Frames
from epdem.engines.liggghts import launcher, resume
from epdem.engines.liggghts import tables as tables

pytestmark = pytest.mark.liggghts
COUNT = 100


@pytest.fixture(scope="module")
def poured(tmp_path_factory):
    """(plan, folder with its restart files, particles): beads poured in three lots in the first quarter of the run."""
    folder = tmp_path_factory.mktemp("poured")
    data = read_toml(Path(__file__).parents[2] / "cases/settle_glass.toml")
    scene = {
        "box": ["16 mm", "16 mm", "40 mm"],
        "count": COUNT,
        "rate": "1000 Hz",
        "duration": "0.4 s",
        "particles": [{"material": "glass", "radius": "1.5 mm"}],
    }
    output = {"rows": 20, "particles": 20, "restarts": 20}
    case = parse(data | {"scene": data["scene"] | scene, "output": output, "numerics": {"error": 0.1}})
    p = write_deck(case, folder)
    launcher.run("in.scene", folder)
    return p, folder, tables.particles(Frames(p, folder, tables.kinds(p)))


def continued(poured, begin: int, tmp_path):
    """Particles of the frames after step `begin` of a run continued from there, in a folder of its own."""
    p, folder, _ = poured
    for path in (folder / "setup.in", folder / launcher.OUT, folder / f"restart.{begin}.bin", *folder.glob("*.data")):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    resume.write_resume(p, tmp_path, begin)
    launcher.run("in.resume", tmp_path)
    return tables.particles(Frames(p, tmp_path, tables.kinds(p), range(begin + 1)))


def test_a_run_interrupted_while_it_pours_ends_with_all_its_spheres(poured, tmp_path):
    _, folder, whole = poured
    counts = whole.groupby("step")["id"].count()
    begin = next(s for s in restart_steps(folder) if counts[s] == counts[counts < COUNT].max())
    again = continued(poured, begin, tmp_path)
    assert 0 < counts[begin] < COUNT
    last = again[again["step"] == whole["step"].max()]
    assert sorted(last["id"]) == list(range(1, COUNT + 1))
    assert last["mass"].sum() == pytest.approx(whole[whole["step"] == whole["step"].max()]["mass"].sum(), rel=1e-12)
    # a sphere that fell into another one would still be in flight, or would have left the box
    assert last["z"].between(0, 0.04).all()
    assert (last[["vx", "vy", "vz"]] ** 2).sum(axis=1).max() < 0.1**2

    # what was there goes on bit by bit up to the next lot, which LIGGGHTS puts to other places than it would have done
    before = again[again["step"].map(counts) == counts[begin]]
    assert len(before) and before.equals(whole[whole["step"].isin(before["step"])].reset_index(drop=True))
    fresh = last["id"] > counts[begin]
    assert (
        not last[fresh]
        .reset_index(drop=True)
        .equals(whole[(whole["step"] == whole["step"].max()) & (whole["id"] > counts[begin])].reset_index(drop=True))
    )


def test_a_run_interrupted_after_the_last_sphere_was_poured_ends_bitwise_the_same(poured, tmp_path):
    _, folder, whole = poured
    counts = whole.groupby("step")["id"].count()
    begin = next(s for s in restart_steps(folder) if counts[s] == COUNT)
    again = continued(poured, begin, tmp_path)
    assert again.equals(whole[whole["step"] > begin].reset_index(drop=True))


def test_a_stream_that_has_ended_does_not_begin_again_where_spheres_are_still_to_come(tmp_path):
    """Forty single ones, each with a velocity of its own: more than LIGGGHTS has groups."""
    stream = BED | {"count": 10, "rate": "1 kHz", "velocity": ["0 m/s", "0 m/s", "-1 m/s"]}
    ball = {"material": "steel", "radius": "0.4 mm", "velocity": ["0 m/s", "0 m/s", "-0.5 m/s"], "phase": "rain"}
    place = [(x, y) for x in range(-7, 9, 2) for y in range(-4, 6, 2)]
    balls = [ball | {"name": f"b{n}", "position": [f"{x} mm", f"{y} mm", "39 mm"]} for n, (x, y) in enumerate(place)]
    phases = [{"name": "pour", "duration": "60 ms"}, {"name": "rain", "duration": "10 ms"}]
    data = parts(fill=[stream], body=balls, phase=phases, periodic=True)
    data |= {"output": {"rows": 28, "particles": 28, "restarts": 28}, "numerics": {"time_step": "1e-5 s"}}
    p = write_deck(parse(data), tmp_path)
    launcher.run("in.scene", tmp_path)
    whole = tables.particles(Frames(p, tmp_path, tables.kinds(p)))
    counts = whole.groupby("step")["id"].count()
    begin = next(s for s in restart_steps(tmp_path) if counts.get(s) == 10)
    (tmp_path / "again").mkdir()
    again = continued((p, tmp_path, whole), begin, tmp_path / "again")
    assert begin < p.phases[0].end and counts.iloc[-1] == 50
    assert again.equals(whole[whole["step"] > begin].reset_index(drop=True))
