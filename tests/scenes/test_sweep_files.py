# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps over keys that name files: names count from the case file, and an edited file runs again."""

import pytest
from parts_cases import BED, parts, timed
from scene_runs import write_case

from epdem.errors import CaseError
from epdem.studies.sweep import folder as store
from epdem.studies.sweep import run as study

pytestmark = pytest.mark.liggghts
SIEVE = "opening [mm],retained [%]\n3,0\n2,100\n"
TABLE = "x,y,z,radius\n0,0,0.01,0.001\n"


@pytest.fixture
def case(tmp_path):
    """A case with a table of one sphere, in a folder with another table and two sieves."""
    data = parts(fill=[{"name": "table", "file": "one.csv", "material": "glass"}, BED])
    data["scene"]["phase"] = [timed("fall", "1 ms")]
    data["output"] = {"rows": 1}
    folder = tmp_path / "case"
    path = write_case(data, folder)
    (folder / "one.csv").write_text(TABLE)
    (folder / "two.csv").write_text(TABLE + "0.004,0,0.01,0.001\n")
    (folder / "coarse.csv").write_text(SIEVE)
    (folder / "fine.csv").write_text(SIEVE.replace("2,100", "2,10\n1,90"))
    return path


def sieved(name):
    return [{"material": "glass", "radius": {"sieve": name}}]


def tables(tmp_path):
    points = tmp_path / "points.csv"
    points.write_text("scene.fill.0.file\none.csv\ntwo.csv\n")
    return {"settings": {}, "table": points}


@pytest.mark.parametrize(
    ("key", "values", "file"),
    [
        ("scene.fill.0.file", ["one.csv", "two.csv"], "two.csv"),
        ("scene.fill.1.particles", [sieved("coarse.csv"), sieved("fine.csv")], "fine.csv"),
        ("--points", None, "two.csv"),
    ],
)
def test_a_swept_file_is_found_beside_the_case_and_read_again_when_it_changes(key, values, file, case, tmp_path):
    options = {"settings": {key: values}} if values else tables(tmp_path)
    sweep = study.plan(case, **options)
    study.check_points(sweep, [1, 2], jobs=1)
    before = [sweep.inputs(n) for n in (1, 2)]
    assert [study.plan(case, **options).inputs(n) for n in (1, 2)] == before
    with (case.parent / file).open("a") as stream:
        stream.write("# another line\n")
    after = [study.plan(case, **options).inputs(n) for n in (1, 2)]
    assert after[0] == before[0] and after[1] != before[1]


def test_an_edited_file_of_a_point_runs_that_point_alone(case, tmp_path):
    settings = {"scene.fill.0.file": "one.csv,two.csv"}
    first = study.run(study.plan(case, settings), tmp_path / "out", jobs=1)
    assert first.ran == 2 and first.table["particles_last"].to_list() == [41.0, 42.0]
    (case.parent / "two.csv").write_text(TABLE + "0.004,0,0.01,0.001\n0.008,0,0.01,0.001\n")
    second = study.plan(case, settings)
    assert store.to_do(second, tmp_path / "out", retry_failed=False) == [2]
    assert study.run(second, tmp_path / "out", jobs=1).table["particles_last"].to_list() == [41.0, 43.0]


def test_a_file_that_is_not_there_is_named_with_its_key(case):
    with pytest.raises(CaseError, match=r"scene.fill.0.file = 'none.csv': no such file.*count from the folder"):
        study.plan(case, {"scene.fill.0.file": ["one.csv", "none.csv"]})
