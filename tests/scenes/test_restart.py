# SPDX-License-Identifier: GPL-2.0-or-later
"""An interrupted bulk run goes on from its last restart file, also while it pours; Ctrl-C leaves no process behind."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from parts_cases import BED, mm, mps, parts, timed
from scene_runs import restart_steps, run, write_case, write_deck
from test_lean import CASES, small

from epdem.base.files import MARKER
from epdem.case.scene import is_scene, load, parse
from epdem.case.toml import read_toml
from epdem.engines import frames
from epdem.engines.frames import Frames
from epdem.engines.liggghts import deck, launcher
from epdem.engines.liggghts import tables as tables
from epdem.errors import CaseError
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables import results
from marks import thorough

pytestmark = pytest.mark.liggghts
SCENES = [p for p in CASES if is_scene(read_toml(p)) and p.stem != "screw"]  # LIGGGHTS refuses triangles that turn


INTERRUPTED = """
import signal, sys
from pathlib import Path
from epdem.engines import scene_engine
from epdem.scenes.run import run
signal.signal(signal.SIGINT, signal.default_int_handler)  # the tests may run where Ctrl-C is ignored
print("started", flush=True)
tool = scene_engine("liggghts")
run(Path(sys.argv[1]), tool, out=Path(sys.argv[2]), ranks=int(sys.argv[3]), report=lambda s, n: print(s, flush=True))
"""


def long_case(folder: Path) -> Path:
    """A case that runs for some ten seconds, in which it is certainly interrupted."""
    text = next(p for p in SCENES if p.stem.startswith("settle")).read_text()
    text = text.replace("[output]", "[output]\nrows = 1000\nrestarts = 500")
    text = re.sub(r"particles = 5", "particles = 10", text)
    path = folder / "case.toml"
    path.write_text(text)
    return path


def children(mark: str) -> list[int]:
    """Processes whose command line or working folder holds `mark`."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if mark in str((entry / "cwd").readlink()):
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


@pytest.mark.parametrize("ranks", [1, 2])
def test_ctrl_c_stops_liggghts_with_all_its_ranks_and_the_run_can_be_continued(ranks, tmp_path):
    case, out = long_case(tmp_path), tmp_path / "out"
    process = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED, str(case), str(out), str(ranks)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        for line in process.stdout:
            if line.strip().isdigit() and int(line) >= 240:
                break
        assert children(str(out)), "LIGGGHTS runs in its folder"
        os.kill(process.pid, signal.SIGINT)
        process.wait(timeout=60)
    finally:
        process.kill()
    end = time.monotonic() + 60
    while children(str(out)) and time.monotonic() < end:  # the kernel needs a moment to take the ended processes away
        time.sleep(0.1)
    assert not children(str(out))
    assert process.returncode != 0
    assert not (out / "results.h5").exists()
    assert frames.whole_restarts(out, out / launcher.OUT)[-1] > 0


class Enough(Exception):
    """The moment at which a test stops a run."""


def stopped_run(path: Path, out: Path, steps: int | None = None, engine: str = "liggghts") -> None:
    """Run a case until 0.6 of its steps are done. steps: of the whole run, where phases end before their plan does."""

    def stop(step, planned):
        if step > 0.6 * (steps or planned):
            raise Enough

    with pytest.raises(Enough):
        run(path, engine, out=out, report=stop)
    assert not children(str(out))


# forces in scenes of parts that stay zero: of a wall that nothing reaches, and along smooth ones
EMPTY = {
    "impactor_bowl": {f"tube_{what}_{axis}" for what in ("force", "torque") for axis in "xyz"},
    "hopper_stl": {f"tray_{what}_{axis}" for what in ("force", "torque") for axis in "xyz"},
    "tablet_strength": {"right_force_y", "right_force_z", "right_torque_x"},  # jaws without friction
    "sieve_cylinder": {"floor_force_x", "floor_force_y", "cylinder_force_z"},
}


@pytest.mark.parametrize(
    ("case", "engine"),
    [
        thorough(path, "liggghts", unless=path.stem in ("hopper_beads", "impactor_bowl", "press_tablet"), id=path.stem)
        for path in SCENES
        if path.stem != "press_layer"  # ends before it can be stopped
    ]
    + [
        thorough(
            path, "lammps", unless=path.stem == "adhesive_powder", marks=[pytest.mark.lammps], id=f"{path.stem}-lammps"
        )
        for path in SCENES
        if path.stem in ("adhesive_powder", "drum_beads", "hopper_beads", "press_tablet")
    ],
)
def test_every_table_of_a_continued_run_is_that_of_the_uninterrupted_one(case, engine, tmp_path):
    data = read_toml(case)
    output = {"rows": 40, "particles": 20, "restarts": 20, "energy": True, "loads": True}
    shutil.copytree(case.parent / "parts", tmp_path / "case/parts")  # files that a case names
    path = write_case(small(data) | {"output": output}, tmp_path / "case")
    whole = run(path, engine, out=tmp_path / "whole")
    stopped_run(path, tmp_path / "parts", whole.plan.steps, engine)
    again = run(path, engine, out=tmp_path / "parts", resume=True)
    assert 0 < again.resumed_from < again.plan.steps
    a, b = (results.read(tmp_path / name / "results.h5") for name in ("whole", "parts"))
    assert set(a.tables) == set(b.tables)
    stages = {"stages"} if whole.plan.scene.stages else set()
    measured = {"measures", "histograms"} if whole.plan.scene.measure else set()
    assert set(a.tables) == {"rows", "particles", "contacts", "energy_balance", "checks", "phases"} | stages | measured
    for name, table in a.tables.items():
        for column in table:
            other = b.tables[name][column]
            if name == "particles" and column in ("x", "y") and whole.plan.scene.periodic:
                low, high = np.reshape(whole.plan.box, (3, 2))["xyz".index(column)]
                beyond = abs(abs(table[column] - other) - (high - low)) < 1e-12  # one frame before, one after the move
                other = other.mask(beyond, table[column])
            assert table[column].equals(other), f"{name}.{column} differs"
    rows = a.rows.drop(columns=["step", "time"])
    empty = {name for name in rows if not rows[name].any()}
    assert empty == EMPTY.get(case.stem, set()), "columns of the rows without a number"
    assert whole.passed == again.passed


@pytest.fixture(scope="module")
def hopper(tmp_path_factory) -> tuple[dict, Path]:
    """(TOML data of a small hopper with a flat bottom, folder with its interrupted run)."""
    folder = tmp_path_factory.mktemp("hopper")
    data = small(read_toml(next(p for p in SCENES if p.stem.startswith("hopper"))))
    data |= {"output": {"rows": 40, "particles": 20, "restarts": 20}}
    data["scene"] |= {"half_angle": "90 deg"}
    stopped_run(write_case(data, folder), folder / "out")
    return data, folder


def test_a_hopper_with_another_outlet_is_not_continued(hopper, tmp_path):
    data, folder = hopper
    other = write_case(data | {"scene": data["scene"] | {"outlet": "11 mm"}}, tmp_path)
    write_deck(load(other), tmp_path / "deck")
    for name in ("in.scene", "setup.in"):  # the outlet of a flat bottom is in its triangles alone
        assert (tmp_path / "deck" / name).read_text() == (folder / "out" / name).read_text()
    with pytest.raises(CaseError, match="the case has changed"):
        run(other, out=folder / "out", resume=True)


@pytest.mark.parametrize("program", ["liggghts", "epdem", None])
def test_a_run_that_other_programs_began_is_not_continued(program, hopper, tmp_path):
    shutil.copytree(hopper[1], tmp_path, dirs_exist_ok=True)
    marker = tmp_path / "out" / MARKER
    known = json.loads(marker.read_text())
    assert set(known["versions"]) == {"liggghts", "epdem"}
    known["versions"] = known["versions"] | {program: "0.0.9"} if program else {}
    marker.write_text(json.dumps(known))
    said = f"begun by .*{program} 0.0.9" if program else "programs of unknown versions"
    with pytest.raises(CaseError, match=said):
        run(tmp_path / "case.toml", out=tmp_path / "out", resume=True)


def test_without_a_restart_file_nothing_is_continued(tmp_path):
    path = long_case(tmp_path)
    with pytest.raises(CaseError, match="no such folder"):
        run(path, out=tmp_path / "out", resume=True)
    assert not (tmp_path / "out").exists()
    p = write_deck(load(path), tmp_path / "empty")
    with pytest.raises(CaseError, match="no restart file"):
        frames.choose(Frames(p, tmp_path / "empty", tables.kinds(p)), tmp_path / "empty" / launcher.OUT)


def steps_of(folder: Path, pattern: str) -> list[int]:
    return sorted(int(re.search(r"\d+", p.name).group()) for p in folder.glob(pattern))


@pytest.mark.parametrize("damage", ["truncated", "missing"])
@pytest.mark.parametrize("place", ["before the restart files", "after one of them"])
def test_a_damaged_frame_is_written_again_where_it_can_be_or_named_and_left_out(damage, place, hopper, tmp_path):
    _, folder = hopper
    path, out = tmp_path / "case.toml", tmp_path / "out"
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    p, newest = plan(load(path)), frames.whole_restarts(out, out / launcher.OUT)[-1]
    lost = max(step for step in steps_of(out, "particles.*.bin") if step < newest and step % p.frames == 0)
    older = newest - p.frames  # a phase counts the steps between restart files from its begin
    for step in steps_of(out, "restart.*.bin"):
        if step != newest:
            (out / f"restart.{step}.bin").unlink()
    if place.startswith("after"):
        shutil.copy(out / f"restart.{newest}.bin", out / f"restart.{older}.bin")
    frame = out / f"particles.{lost}.bin"
    if damage == "missing":
        frame.unlink()
    else:
        frame.write_bytes(frame.read_bytes()[:-100])
    if place.startswith("after"):
        assert frames.choose(Frames(p, out, tables.kinds(p)), out / launcher.OUT) == (older, [])
        return
    outcome = run(path, out=out, resume=True, force=True)  # a file that was changed may be the user's
    assert [w for w in outcome.warnings if f"frames of step {lost} are missing or not whole" in w]
    ends = {phase.end for phase in p.phases}
    expected = {*range(p.frames, p.steps + 1, p.frames), *ends} - {lost}  # at step 0 nothing is there yet
    assert set(outcome.results.particles["step"]) == expected
    assert list(outcome.results.rows["step"]) == list(range(0, p.steps + 1, p.every)), "rows are whole"


def test_restart_files_are_kept_until_the_engine_has_gone_on_after_a_later_one(tmp_path):
    """The log may be far behind the engine: what it does not tell of yet is no reason to remove anything."""
    for step in (100, 200, 300, 400):
        (tmp_path / f"restart.{step}.bin").touch()
    for step, kept in ((100, [100, 200, 300, 400]), (250, [200, 300, 400]), (300, [200, 300, 400]), (900, [400])):
        frames.prune(tmp_path, step)
        assert steps_of(tmp_path, "restart.*.bin") == kept


COUNT = 100


@pytest.fixture(scope="module")
def poured(tmp_path_factory):
    """(plan, folder with its restart files, particles): beads poured in three lots in the first quarter of the run."""
    folder = tmp_path_factory.mktemp("poured")
    data = read_toml(Path(__file__).parents[2] / "cases/settle_glass.toml")
    scene = {
        "box": mm(16, 16, 40),
        "count": COUNT,
        "rate": "1000 Hz",
        "duration": "0.4 s",
        "particles": [{"material": "glass", "radius": "1.5 mm"}],
    }
    output = {"rows": 20, "particles": 20, "restarts": 20}
    case = parse(data | {"scene": data["scene"] | scene, "output": output, "numerics": {"error": 0.1}})
    p = write_deck(case, folder)
    launcher.run("in.scene", folder)
    return p, folder, Frames(p, folder, tables.kinds(p)).spheres()


def continued(poured, begin: int, tmp_path):
    """Particles of the frames after step `begin` of a run continued from there, in a folder of its own."""
    p, folder, _ = poured
    for path in (folder / "setup.in", folder / launcher.OUT, folder / f"restart.{begin}.bin", *folder.glob("*.data")):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    deck.write_resume(p, tmp_path, begin)
    launcher.run("in.resume", tmp_path)
    return Frames(p, tmp_path, tables.kinds(p), range(begin + 1)).spheres()


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
    stream = BED | {"count": 10, "rate": "1 kHz", "velocity": mps(0, 0, -1)}
    ball = {"material": "steel", "radius": "0.4 mm", "velocity": mps(0, 0, -0.5), "phase": "rain"}
    place = [(x, y) for x in range(-7, 9, 2) for y in range(-4, 6, 2)]
    balls = [ball | {"name": f"b{n}", "position": mm(x, y, 39)} for n, (x, y) in enumerate(place)]
    phases = [timed("pour", "60 ms"), timed("rain", "10 ms")]
    data = parts(fill=[stream], body=balls, phase=phases, periodic=True)
    data |= {"output": {"rows": 28, "particles": 28, "restarts": 28}, "numerics": {"time_step": "1e-5 s"}}
    p = write_deck(parse(data), tmp_path)
    launcher.run("in.scene", tmp_path)
    whole = Frames(p, tmp_path, tables.kinds(p)).spheres()
    counts = whole.groupby("step")["id"].count()
    begin = next(s for s in restart_steps(tmp_path) if counts.get(s) == 10)
    (tmp_path / "again").mkdir()
    again = continued((p, tmp_path, whole), begin, tmp_path / "again")
    assert begin < p.phases[0].end and counts.iloc[-1] == 50
    assert again.equals(whole[whole["step"] > begin].reset_index(drop=True))
