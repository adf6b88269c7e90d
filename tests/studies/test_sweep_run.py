# SPDX-License-Identifier: GPL-2.0-or-later
"""A sweep runs, stores, resumes and fails point by point; what is finished never runs again."""

import functools
import json
import os
import random
import re
import signal
import subprocess
import sys
import time
from collections import deque
from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

from epdem.base.files import running
from epdem.case.impact import load
from epdem.cli.main import app
from epdem.engines import engine
from epdem.errors import CaseError, Stopped
from epdem.impacts.run import run as run_case
from epdem.report import sweeps
from epdem.studies.sweep import folder, points, run

ROOT = Path(__file__).parents[2]
EPDEM = str(Path(sys.executable).parent / "epdem")
RADII = {"impact.body.radius": "1 mm,2 mm,5 mm"}


def ball(folder: Path, speeds: str) -> Path:
    """The steel wall at these speeds."""
    path = folder / "ball.toml"
    text = (ROOT / "cases/steel_wall.toml").read_text()
    path.write_text(text.replace('{ from = "0.05 m/s", to = "150 m/s", count = 32 }', speeds))
    return path


@pytest.fixture
def case(tmp_path):
    return ball(tmp_path, '["0.1 m/s", "5 m/s"]')


def sweep(case: Path, out: Path, settings=RADII, jobs=2, **options):
    words = {k: options.pop(k) for k in ("engines", "laws", "ranks", "latin_hypercube", "seed") if k in options}
    return run.run(run.plan(case, settings, **({"engines": ["embedded"]} | words)), out, jobs=jobs, **options)


def said_by(*words: str) -> dict:
    """The JSON document of a command, called in this process."""
    done = CliRunner().invoke(app, [*words, "--json"])
    if done.exception and not isinstance(done.exception, SystemExit):
        raise done.exception
    return json.loads(done.stdout)


def finished(out: Path) -> dict[str, bytes]:
    return {str(p): p.read_bytes() for p in out.glob("points/*/point.json")}


def test_a_point_gives_what_its_case_gives_by_itself(case, tmp_path):
    found = sweep(case, tmp_path / "out", {"law.yield_pressure": "1 GPa,3 GPa"}, laws=[])
    assert found.passed and found.ran == 2 and found.table["speed"].tolist() == [0.1, 5.0] * 2
    rows = found.table[found.table["law.yield_pressure"] == 3e9]
    point = tmp_path / "out" / rows["folder"].iloc[0] / "case.toml"
    assert load(point).law.parameters() == {"yield_pressure": "3 GPa"}
    alone = run_case(point, engines=[engine("embedded")], out=tmp_path / "alone").results.comparison
    pd.testing.assert_frame_equal(rows[alone.columns].reset_index(drop=True), alone, check_dtype=False)


def test_the_table_is_written_in_si_and_has_units(case, tmp_path):
    found = sweep(case, tmp_path / "out").table
    assert found.attrs["units"]["impact.body.radius"] == "m" and found.attrs["units"]["contact_time_theory"] == "s"
    assert found["impact.body.radius"].unique().tolist() == [0.001, 0.002, 0.005]
    written = pd.read_csv(tmp_path / "out/sweep.csv", keep_default_na=False)
    pd.testing.assert_frame_equal(written, pd.DataFrame(found), check_dtype=False)


def test_the_same_sweep_again_runs_nothing_and_a_larger_one_what_is_new(case, tmp_path):
    out = tmp_path / "out"
    assert sweep(case, out).ran == 3
    before = finished(out)
    assert sweep(case, out).ran == 0 and finished(out) == before
    assert sweep(case, out, {"impact.body.radius": "0.5 mm,1 mm,2 mm,5 mm,7 mm"}).ran == 2
    assert {k: v for k, v in finished(out).items() if k in before} == before
    assert pd.read_csv(out / "sweep.csv")["point"].tolist() == [1, 1, 2, 2, 3, 3, 4, 4, 5, 5]
    case.write_text(case.read_text().replace("= 2.8", "= 2.7"))
    assert sweep(case, out).ran == 3
    assert sweep(case, out, laws=["cavity", "johnson"]).ran == 3


def test_another_version_of_the_product_runs_all_again(case, tmp_path, monkeypatch):
    assert sweep(case, tmp_path / "out").ran == 3
    monkeypatch.setattr("epdem.base.paths.product_hash", lambda **_: "another")
    assert sweep(case, tmp_path / "out").ran == 3


def test_points_that_are_alike_run_once(case, tmp_path):
    found = sweep(case, tmp_path / "out", {"impact.body.radius": ["1 mm", "1 mm"]})
    assert found.ran == 1 and found.table["point"].tolist() == [1, 1, 2, 2]


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"impact.radius": "1 mm"}, "the nearest: impact.body.radius"),
        ({"materials.steel.poisson_ratio": "0.2..30:3"}, r"point 2 .*poisson_ratio = 15.1, must lie in \[-0.99, 0.5\]"),
        ({"impact.body.radius": "1 mm,2"}, "point 2 .*expected a quantity with a unit"),
        ({"impact.speeds": '["1 m/s"],{from="3 m/s", to="1 m/s", count=3}'}, "must exceed"),
        ({"law.name": "thornton,nobody"}, "nobody"),
        ({}, "a sweep needs points"),
    ],
)
def test_what_is_wrong_is_refused_before_anything_is_written(settings, words, case, tmp_path):
    with pytest.raises(CaseError, match=words):
        sweep(case, tmp_path / "out", settings)
    assert not (tmp_path / "out").exists()


@pytest.mark.liggghts
def test_a_dry_run_refuses_the_points_that_cannot_run(case, tmp_path):
    def dry(case, *settings):
        sets = [word for setting in settings for word in ("--set", setting)]
        refused = CliRunner().invoke(app, ["sweep", str(case), "-e", "liggghts", *sets, "--dry-run"]).exception
        assert isinstance(refused, CaseError) and "case.toml" not in str(refused)
        return str(refused)

    slow = dry(case, "impact.body.radius=1 mm,100 m", 'impact.speeds=["1e-12 m/s"]')
    assert "point 1 (impact.body.radius = 1 mm, impact.speeds" in slow and "not representable by positions" in slow
    press = tmp_path / "press.toml"
    text = (ROOT / "cases/compaction_powder.toml").read_text()
    law = '[law]\nname = "cavity"\ncompaction = true\n'
    press.write_text(re.sub(r"\[law\]\n(?:.+\n)+", law, text))
    said = dry(press, "law.name=cavity,meyer")
    assert (
        "point 2 (law.name = meyer): law.compaction: law meyer has none; take law.name = 'cavity' or 'cavity_adhesive'"
        in said
    )
    assert dry(press, "scene.height=1 mm,0.1 um").startswith("point 2 (scene.height = 0.1 um): ")


@pytest.mark.liggghts
def test_the_reason_of_a_failed_scene_names_no_file_that_the_user_did_not_write(tmp_path):
    press = ROOT / "cases/compaction_powder.toml"
    found = sweep(press, tmp_path / "out", {"scene.height": "0.1 um"}, engines=["liggghts"])
    assert found.table["reason"].item().startswith("scene.height = ")


def test_a_point_that_fails_is_a_row_with_its_reason_and_runs_again_when_asked(case, tmp_path, monkeypatch):
    from epdem.engines.embedded import Embedded
    from epdem.errors import EngineError

    real = Embedded.run

    def fails(self, plan, at, **how):
        if plan.experiment.body.radius == 0.002:
            raise EngineError(f"{at}/log: out of steel")
        return real(self, plan, at, **how)

    out = tmp_path / "out"
    monkeypatch.setattr(Embedded, "run", fails)
    found = sweep(case, out)
    assert not found.passed and (found.count("done"), found.count("failed")) == (2, 1)
    row = found.table[found.table["point"] == 2]
    assert row["reason"].tolist() == ["thornton/embedded/log: out of steel"] and row["passed"].tolist() == [False]
    assert row[["e_n", "speed"]].isna().all(axis=None)
    assert pd.read_csv(out / "sweep.csv")["status"].tolist() == found.table["status"].tolist()
    assert folder.status(out)["failures"][0]["reason"] == "thornton/embedded/log: out of steel"
    assert sweep(case, out).ran == 0  # it failed: once is enough
    monkeypatch.setattr(Embedded, "run", real)
    found = sweep(case, out, retry_failed=True)
    assert found.ran == 1 and found.passed
    assert found.table.equals(sweep(case, tmp_path / "other").table)


def _die(number: int) -> int:
    if number == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return -number


def test_a_process_that_dies_takes_no_other_item_with_it():
    found = dict(run.each(_die, deque(range(1, 8)), jobs=2))
    assert "signal 9" in str(found.pop(3)) and found == {n: -n for n in (1, 2, 4, 5, 6, 7)}


def test_a_process_that_gets_a_signal_stops_all_and_leaves_no_result(case, tmp_path, monkeypatch):
    from epdem.engines.embedded import Embedded

    monkeypatch.setattr(Embedded, "run", lambda *a, **k: os.kill(os.getpid(), signal.SIGTERM))
    with pytest.raises(Stopped):
        sweep(case, tmp_path / "out")
    assert not finished(tmp_path / "out")


def test_a_point_whose_process_dies_is_a_row_too(case, tmp_path, monkeypatch):
    from epdem.engines.embedded import Embedded

    monkeypatch.setattr(Embedded, "run", lambda *a, **k: os._exit(7))
    found = sweep(case, tmp_path / "out", {"impact.body.radius": "1 mm,2 mm"})
    assert found.table["reason"].tolist() == ["its process ended with exit code 7"] * 2


def test_a_process_that_dies_leaves_the_other_points_of_its_share(case, tmp_path, monkeypatch):
    """One share of five points, whose third ends its process: the last two run in another one."""
    from epdem.engines.embedded import Embedded

    real = Embedded.run

    def third_dies(self, p, *words, **options):
        return os._exit(7) if p.experiment.body.radius == 0.003 else real(self, p, *words, **options)

    monkeypatch.setattr(run, "SHARES", 1)
    monkeypatch.setattr(Embedded, "run", third_dies)
    counted = []
    radii = {"impact.body.radius": [0.001 * n for n in range(1, 6)]}
    found = sweep(case, tmp_path / "out", radii, jobs=1, report=lambda done, total: counted.append((done, total)))
    states = found.table.groupby("point")["status"].first().tolist()
    assert states == ["done", "done", "failed", "done", "done"] and counted == [(0, 5), (3, 5), (5, 5)]


def test_a_full_disk_stops_the_sweep_and_the_next_one_goes_on(case, tmp_path, monkeypatch):
    out, real = tmp_path / "out", folder.write_text
    one = sweep(case, tmp_path / "whole").table

    def full(path, text, **options):
        if len(list(out.glob("points/*/point.json"))) >= 2:
            raise OSError(28, "No space left on device", str(path))
        return real(path, text, **options)

    monkeypatch.setattr(folder, "write_text", full)
    with pytest.raises(OSError, match="No space left"):
        sweep(case, out, jobs=1)
    monkeypatch.setattr(folder, "write_text", real)
    found = sweep(case, out, jobs=1)
    assert found.ran == 1 and found.table.equals(one)


def test_a_failure_for_want_of_space_is_no_result(case, tmp_path, monkeypatch):
    from epdem.engines.embedded import Embedded

    monkeypatch.setattr(Embedded, "run", lambda *a, **k: 1 / 0)
    monkeypatch.setattr(run, "FULL", 1 << 60)  # all disks are full
    with pytest.raises(OSError, match="no space left"):
        sweep(case, tmp_path / "out")
    assert not finished(tmp_path / "out")


RANGES = {"impact.body.radius": "1 mm..10 mm:6", "law.yield_pressure": "1 GPa..2.5 GPa:4"}


def command(case: Path, out: Path) -> list[str]:
    ranges = [word for key, text in RANGES.items() for word in ("--set", f"{key}={text}")]
    return ["sweep", str(case), "-e", "embedded", *ranges, "-o", str(out), "-j", "2"]


@pytest.mark.slow
def test_24_points_killed_three_times_give_the_same_table_and_no_finished_point_runs_twice(case, tmp_path):
    out, chance, before = tmp_path / "out", random.Random(5), {}
    for kill in range(3):
        process = subprocess.Popen([EPDEM, *command(case, out)], stdout=subprocess.DEVNULL, start_new_session=True)
        count, end = len(before) + chance.randint(2, 5), time.monotonic() + 120
        while process.poll() is None and time.monotonic() < end and len(finished(out)) < count:
            time.sleep(0.005)
        assert process.poll() is None
        process.send_signal(signal.SIGKILL if kill % 2 == 0 else signal.SIGINT)
        process.wait()
        end = time.monotonic() + 30
        while running(out) and time.monotonic() < end:  # its processes end after it
            time.sleep(0.01)
        assert not running(out)
        now = finished(out)
        assert {k: v for k, v in now.items() if k in before} == before and len(now) > len(before)
        before = now
        assert folder.status(out)["waiting"] == 24 - len(now)
    done = sweep(case, out, RANGES)
    assert done.ran == 24 - len(before) and done.count("done") == 24
    assert {k: v for k, v in finished(out).items() if k in before} == before
    sweep(case, tmp_path / "whole", RANGES)
    assert (out / "sweep.csv").read_bytes() == (tmp_path / "whole/sweep.csv").read_bytes()


@pytest.mark.slow
def test_calls_for_some_points_work_side_by_side_and_a_whole_call_finds_them_done(case, tmp_path):
    """Three at once in a new folder, as tasks of an array: each says by its exit code how its points ended."""
    out, radii = tmp_path / "out", "1 mm,2 mm,4 mm,5 mm"
    words = ["sweep", str(case), "-e", "embedded", "-o", str(out), "--set", f"impact.body.radius={radii}", "--json"]
    begin = functools.partial(subprocess.Popen, stdout=subprocess.PIPE)
    calls = {only: begin([EPDEM, *words, "--only", only]) for only in ("2", "3-4,3", "1")}
    said = {only: json.loads(process.communicate(timeout=120)[0]) for only, process in calls.items()}
    assert {only: (x["ran"], x["done"], x["failed"]) for only, x in said.items()} == {
        "1": (1, 1, 0),
        "2": (1, 1, 0),
        "3-4,3": (2, 2, 0),
    }
    assert all(process.returncode == 0 for process in calls.values()) and not (out / "sweep.csv").exists()
    before = finished(out)
    assert said_by("status", str(out), "--table")["done"] == 4
    assert said_by(*words)["ran"] == 0 and finished(out) == before
    alone = sweep(case, tmp_path / "alone", {"impact.body.radius": radii})
    assert (out / "sweep.csv").read_bytes() == (tmp_path / "alone/sweep.csv").read_bytes() and alone.ran == 4


def test_a_point_runs_as_long_as_its_process_whatever_began_it(case, tmp_path):
    """One that a call for some points began, which does not hold the folder; then a process that is dead."""
    planned, out = run.plan(case, {"impact.body.radius": "1 mm,2 mm"}), tmp_path / "out"
    folder.write(planned, out)
    about = folder.begin(planned, out, 2)
    assert (folder.status(out)["running"], folder.status(out)["waiting"]) == (1, 1)
    started = folder.point_folder(planned, out, 2) / folder.STARTED
    dead = subprocess.Popen(["true"])
    dead.wait()
    for other, runs in (({"pid": dead.pid}, 0), ({"begin": about["begin"] - 1e6}, 0), ({"host": "elsewhere"}, 1)):
        started.write_text(json.dumps(about | other))
        assert (folder.status(out)["running"], folder.status(out)["waiting"]) == (runs, 2 - runs), other


def test_points_of_a_call_are_those_of_the_sweep(case, tmp_path):
    """One that is outside of its tolerance has not passed, whatever the others do."""
    assert points.numbers("7, 9-12,9", 12) == [7, 9, 10, 11, 12]
    for wrong in ("", "0", "13", "3-2", "1,,2", "-2", "1-", "x", "1.0"):
        with pytest.raises(CaseError, match=r"--only .*: must be points from 1 to 12, as 7,9-12; --dry-run lists them"):
            points.numbers(wrong, 12)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/note.txt").write_text("of the user")
    with pytest.raises(CaseError, match=r"mine: note.txt was there before"):
        sweep(case, tmp_path / "mine", only=[1])
    case.write_text(case.read_text().replace("e_n = 1e-4", "e_n = 1e-12"))
    found = sweep(case, tmp_path / "out", only=[2])
    assert not found.passed and found.ran == 1 and set(found.table["point"]) == {2}


def test_the_commands_say_what_they_do(case, tmp_path):
    out = tmp_path / "out"
    dry = said_by(*command(case, out), "--dry-run")
    assert len(dry["points"]) == 24 and not out.exists()
    assert dry["points"][6] == {"impact.body.radius": "2.8 mm", "law.yield_pressure": "2 GPa"}
    sweep(case, out)
    assert said_by("status", str(out))["done"] == 3
    with pytest.raises(CaseError, match="not a folder of a sweep"):
        said_by("status", str(tmp_path))


@pytest.mark.liggghts
def test_points_on_liggghts_agree_with_the_embedded_engine(case, tmp_path):
    found = sweep(case, tmp_path / "out", engines=["embedded", "liggghts"]).table
    assert found["passed"].all() and len(found) == 12
    tools = dict(tuple(found.groupby("engine")))
    assert tools["liggghts"]["e_n"].to_numpy() == pytest.approx(tools["embedded"]["e_n"].to_numpy(), rel=1e-8)
    assert (tmp_path / "out" / found["folder"][0] / "thornton/liggghts/in.impact").exists()


def restitution(found):
    """The figures of the page of a sweep whose points are all done."""
    return sweeps._restitution(found.table, [*found.sweep.points[0]], found.table.attrs["units"])


@pytest.mark.figures
def test_the_page_shows_e_n_over_the_keys_that_were_swept(tmp_path):
    """At one speed no figure is over it; a curve for each value of the other keys, and no two look the same."""
    case = ball(tmp_path, '["5 m/s"]')
    found = sweep(
        case,
        tmp_path / "out",
        {"law.yield_pressure": "1 GPa..3 GPa:3"} | {"materials.steel.density": "7000 kg/m^3,8000 kg/m^3"},
    )
    over_pressure, over_density = restitution(found)
    axes = [str(chart.panels[0].x) for chart in (over_pressure, over_density)]
    assert axes == ["yield_pressure [Pa]", "density [kg/m^3]"]
    lines = [s for s in over_pressure.panels[0].series if s.dash]
    points = [s for s in over_pressure.panels[0].series if not s.dash]
    assert len(lines) == len(points) == 2 and len({(s.colour, s.dash) for s in lines}) == 2
    assert [s.name.partition(": ")[2] for s in points] == ["density = 7000 kg/m^3", "density = 8000 kg/m^3"]
    table = found.table[found.table["materials.steel.density"] == 8000]
    assert list(points[1].x) == table["law.yield_pressure"].to_list() == [1e9, 2e9, 3e9]
    assert list(points[1].y) == table["e_n"].to_list() and list(lines[1].y) == table["e_n_theory"].to_list()
    assert (over_pressure.readable().panels[0].series[0].x == [1000, 2000, 3000]).all()
    text = found.report().read_text()
    assert "yield_pressure [MPa]" in text and 'data-chart="sweep"' in text

    ranges = {"law.yield_pressure": "1 GPa..3 GPa", "materials.steel.density": "7000 kg/m^3..8000 kg/m^3"}
    random = sweep(case, tmp_path / "random", ranges, latin_hypercube=9)
    (series,) = restitution(random)[0].panels[0].series
    assert len(series.x) == 9 and series.dash is None

    several = sweep(ball(tmp_path, '["0.1 m/s", "5 m/s"]'), tmp_path / "several", {"law.yield_pressure": "1 GPa,3 GPa"})
    charts = restitution(several)
    assert [chart.panels[0].x.label for chart in charts] == ["yield_pressure", "speed"]
