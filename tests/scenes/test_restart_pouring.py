# SPDX-License-Identifier: GPL-2.0-or-later
"""A run that is interrupted while spheres are still poured in, or after the last one."""

import re
from pathlib import Path

import pytest
from scene_runs import write_deck

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.liggghts import launcher, resume
from epdem.liggghts import scene_tables as tables

pytestmark = pytest.mark.liggghts
COUNT = 100


@pytest.fixture(scope="module")
def poured(tmp_path_factory):
    """(plan, folder with its restart files, particles): beads poured in three lots in the first 40 % of the run."""
    folder = tmp_path_factory.mktemp("poured")
    data = read_toml(Path(__file__).parents[2] / "cases/settle_glass.toml")
    scene = {
        "box": ["16 mm", "16 mm", "40 mm"],
        "count": COUNT,
        "rate": "1000 Hz",
        "duration": "0.25 s",
        "particles": [{"material": "glass", "radius": "1.5 mm"}],
    }
    output = {"rows": 20, "particles": 20, "restarts": 20}
    case = parse(data | {"scene": data["scene"] | scene, "output": output, "numerics": {"error": 0.1}})
    p = write_deck(case, folder)
    launcher.run("in.scene", folder)
    return p, folder, tables.particles(p, folder)


def continued(poured, begin: int, tmp_path):
    """Particles of the frames after step `begin` of a run continued from there, in a folder of its own."""
    p, folder, _ = poured
    for name in ("setup.in", launcher.OUT, f"restart.{begin}.bin"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    resume.write_resume(p, tmp_path, begin)
    launcher.run("in.resume", tmp_path)
    return tables.particles(p, tmp_path, without=range(begin + 1))


def restarts(folder: Path) -> list[int]:
    return sorted(int(re.search(r"\d+", p.name).group()) for p in folder.glob("restart.*.bin"))


def test_a_run_interrupted_while_it_pours_ends_with_all_its_spheres(poured, tmp_path):
    _, folder, whole = poured
    counts = whole.groupby("step")["id"].count()
    begin = next(s for s in restarts(folder) if counts[s] == counts[counts < COUNT].max())
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
    begin = next(s for s in restarts(folder) if counts[s] == COUNT)
    again = continued(poured, begin, tmp_path)
    assert again.equals(whole[whole["step"] > begin].reset_index(drop=True))
