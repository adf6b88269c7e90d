# SPDX-License-Identifier: GPL-2.0-or-later
"""What is said of runs that left nothing, or something damaged, and of programs that are not there."""

import os
import shutil
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pandas as pd
import pytest
from stored_runs import STORED, planned

from epdem.base import files, paths, processes
from epdem.case import impact
from epdem.case.toml import read_toml
from epdem.engines import engine, log, scene_engine
from epdem.engines.frames import Frames
from epdem.engines.lammps import launcher as lammps_launcher
from epdem.engines.lammps.engine import Lammps
from epdem.engines.liggghts import dump, launcher
from epdem.engines.liggghts import tables as scene_tables
from epdem.engines.liggghts.engine import Liggghts
from epdem.engines.liggghts.launcher import OUT
from epdem.engines.yade import tables as yade_tables
from epdem.errors import CaseError, EngineError
from epdem.impacts.engine import Trajectory
from epdem.impacts.experiment import experiment
from epdem.impacts.measurement import measure
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.jobs.stage import Inputs
from epdem.scenes import run
from epdem.scenes.plan import meshes
from epdem.scenes.tables import columns
from epdem.studies.sweep import slurm
from epdem.tools import own_decks
from epdem.verification.stability import kinds
from epdem.verification.stability.running import Bench

CASES = Path(__file__).parents[2] / "cases"


def steel(**changes):
    data = read_toml(CASES / "steel_wall.toml") | changes
    data["impact"]["speeds"] = ["1 m/s"]
    x = experiment(impact.parse(data))
    return plan(x, predict(x))


def says(words: str, error: type[Exception] = EngineError):
    return pytest.raises(error, match=words)


def test_impacts_that_never_touch_or_never_end():
    p = steel()
    flat = np.zeros((p.n, 4))
    with says("never touched; the run is too short or went wrong"):
        measure(p, Trajectory(p.time_step, flat, flat, flat, {}))
    with says("was still in contact at the end; the run is too short or went wrong"):
        measure(p, Trajectory(p.time_step, flat + 1e-6, flat + 1.0, flat, {}))
    sticky = steel(law={"name": "jkr", "work_of_adhesion": "1 J/m^2"})
    flat = np.zeros((sticky.n, 4))
    with says("never touched; the run is too short or went wrong"):
        measure(sticky, Trajectory(sticky.time_step, flat, flat, flat, {}))


def test_dumps_of_impacts(tmp_path, monkeypatch):
    p, path = steel(), tmp_path / "path.bin"
    with says("path.bin: the dump cannot be read .*; see the log beside it"):
        dump.frames(path)
    path.write_bytes(b"\0" * 9)
    with says(r"frame 0 is incomplete \(.*\); the run was stopped there"):
        dump.frames(path)
    monkeypatch.setattr(dump, "series", lambda path: np.zeros((3, 2, 3)))
    with says(r"the run left an incomplete dump \(3 frames of 2 bodies, expected .*see out.liggghts beside it"):
        scene_tables.trajectory(p, tmp_path, {})
    monkeypatch.setattr(lammps_launcher, "run", lambda *words, **named: 1.0)
    with says("path.txt: the run left an incomplete dump .*; see out.lammps beside it"):
        Lammps().run(p, tmp_path)


def test_frames_and_rows_of_scenes(tmp_path):
    p, q = planned("settle"), planned("yade_settle")
    out = tmp_path / OUT
    out.write_text("")
    with says("no rows; the run ended before its first step"):
        log.scene_rows(p, out)
    with says("no rows; the run ended before its first step"):
        yade_tables.rows(q, out)
    out.write_text("Step a\n7 x\n")
    with says("no rows; the run ended before its first step"):
        yade_tables.rows(q, out)
    out.write_text("Step particles\n0 1\n7 1\n8 x\n")
    with says(f"the rows end at step 7 of {q.steps}; run the case again"):
        yade_tables.rows(q, out)
    with says(r"particles.0.npy: incomplete \(.*\); run the case again"):
        Frames(q, tmp_path, yade_tables.kinds(q)).spheres()
    shutil.copytree(STORED / "settle", tmp_path / "run")
    whole = Frames(p, tmp_path / "run", scene_tables.kinds(p)).spheres()
    with says("the frame of step 1250 is damaged; run the case again"):
        columns.whole(p, whole.assign(radius=-1.0), tmp_path)
    numbers = {"step": 1250, "i": 99, "j": 98, "overlap": 1e-6, "delta_max": 1e-6}
    raw = pd.DataFrame([numbers | {"wall": ""} | dict.fromkeys(columns.FORCE, 0.0)])
    with says("the contacts of step 1250 are damaged: no such spheres; run the case again"):
        columns.complete(p, raw, whole, tmp_path)
    twice = tmp_path / "run/particles.1250.bin"
    twice.write_bytes(2 * twice.read_bytes())
    with says(r"particles.1250.bin: incomplete \(.*\); run the case again"):
        Frames(p, tmp_path / "run", scene_tables.kinds(p)).spheres()


@pytest.mark.parametrize("name", ["compaction", "yade_compaction"])
@pytest.mark.parametrize("damage", ["a word", "a number less", "nan", "no row"])
def test_a_damaged_row_is_named_and_no_row_behind_it_is_lost(name, damage, tmp_path):
    """Of 58 rows that of step 250, in the first of three phases."""
    shutil.copytree(STORED / name, tmp_path / "run")
    (out,) = (tmp_path / "run").glob("out.*")
    lines, own = out.read_text().splitlines(), yade_tables if "yade" in name else scene_tables
    (at,) = (k for k, line in enumerate(lines) if line.split()[:1] == ["250"])
    words = lines[at].split()
    changed = {"a word": [*words[:-1], "x"], "a number less": words[:-1], "nan": [*words[:-1], "nan"], "no row": []}
    assert len(own.rows(planned(name), out)) == 58
    lines[at] = " ".join(changed[damage])
    out.write_text("\n".join(lines))
    with says("the row of step 250 is missing or damaged; run the case again"):
        own.rows(planned(name), out)
    assert len(log.rows(out)["Step"].unique()) == 57 + (damage == "nan")


@pytest.mark.parametrize(
    ("name", "file"), [("compaction", "contacts.2850.txt"), ("yade_compaction", "contacts.2100.npy")]
)
def test_a_contact_without_a_number_is_no_contact_that_is_left_out(name, file, tmp_path):
    shutil.copytree(STORED / name, tmp_path / "run")
    path, own = tmp_path / "run" / file, yade_tables if "yade" in name else scene_tables
    if path.suffix == ".npy":
        values = np.load(path)
        values[0, 2] = np.nan
        np.save(path, values)
    else:
        lines = path.read_text().split("\n")
        lines[9] = " ".join([*lines[9].split()[:-1], "nan"])
        path.write_text("\n".join(lines))
    with says(rf"{file}: incomplete \(row 1 lacks a number\)"):
        Frames(planned(name), tmp_path / "run", own.kinds(planned(name))).table("contacts")


@pytest.mark.liggghts
def test_a_stored_table_of_a_scene_that_cannot_be_read_is_an_error_and_stays(tmp_path, monkeypatch):
    tool = scene_engine("liggghts")
    tables = tool.read(planned("settle"), STORED / "settle")
    monkeypatch.setattr(Liggghts, "run", lambda *words, **named: dict(tables))
    case, out = STORED / "settle/case.toml", tmp_path / "out"
    run.run(case, tool, out=out)
    stored = (out / "results.h5").stat().st_mtime_ns
    assert run.run(case, tool, out=out).reused and (out / "results.h5").stat().st_mtime_ns == stored
    with h5py.File(out / "results.h5", "r+") as file:
        del file["particles"].attrs["columns"]
    damaged = (out / "results.h5").read_bytes()
    os.utime(out / "results.h5", (0, 0))  # damage of a disk leaves the time of a file
    with says(r"results.h5: .*damaged \(table /particles: .*run the case anew \(--fresh\)", CaseError):
        run.run(case, tool, out=out)
    assert (out / "results.h5").read_bytes() == damaged
    run.run(case, tool, out=out, fresh=True)
    assert run.run(case, tool, out=out).reused


def test_programs_that_are_not_there(tmp_path, monkeypatch):
    with says("/no/program: cannot be started"):
        processes.call(["/no/program"], tmp_path, log="out", seconds=9)
    monkeypatch.setattr(launcher, "command", lambda *words: ["/no/program"])
    monkeypatch.setattr(paths, "_first", lambda *candidates: None)
    with says("templates not found beside the package; install epdem again"):
        paths.beside.__wrapped__("templates")


def test_jobs_that_slurm_does_not_take(tmp_path, monkeypatch):
    def refuses(**named):
        raise RuntimeError("no partition")

    monkeypatch.setattr("submitit.SlurmExecutor", refuses)
    with says("--slurm: the jobs were not taken: no partition"):
        slurm._submit(SimpleNamespace(name="x"), tmp_path, [1], {})


def test_scenes_that_cannot_go_on(tmp_path):
    p = planned("settle")
    place = SimpleNamespace(folder=tmp_path, versions={"liggghts": "1"})
    with says("begun by liggghts 1, and here is liggghts 2; run it anew .--fresh", CaseError):
        run._refuse_resume(place, Inputs({}, ""), {"liggghts": "2"})
    empty = {"particles": pd.DataFrame({"step": []})}
    with says("no frame holds a sphere; all have left the room, see"):
        run._judge(p, empty, tmp_path)


def test_decks_and_studies(tmp_path):
    deck = tmp_path / "deck"
    deck.write_text("run 1\nrun 2\n")
    with says("2 lines start with 'run', expected 1"):
        kinds.edit(deck, kinds.Edit("run", ()))
    with says("deck cannot be made into this set-up; take liggghts or yade", CaseError):
        kinds.edits(Bench(engine("embedded"), tmp_path))
    with says(r"a template's name ends in \.j2; the deck is written without it", CaseError):
        own_decks.write(Path(".j2"), CASES / "steel_wall.toml", {}, tmp_path)


def test_folders_and_files_of_a_user(tmp_path):
    with (tmp_path / "lock").open("w+") as lock, says("another run has just ended here; run the command", CaseError):
        files._lock(tmp_path, lock)
    (tmp_path / "x.stl").write_bytes(b"\0" * 84)
    with says("no triangles, or a text without 'endsolid' at its end; export it anew", CaseError):
        meshes._read(tmp_path / "x.stl", "scene.wall.x.file")
