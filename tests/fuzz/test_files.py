# SPDX-License-Identifier: GPL-2.0-or-later
"""Logs, dumps, frames and results files that are damaged anywhere: read, or refused by one sentence; never a crash."""

import multiprocessing
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import CASES, damaged

sys.path.append(str(Path(__file__).parents[1] / "scenes"))
from stored_runs import RUNS, STORED, planned

from epdem.base.tables import same
from epdem.engines import engine, scene_engine
from epdem.errors import EpdemError
from epdem.impacts import store
from epdem.impacts.run import run
from epdem.scenes.tables import results as scene_store
from epdem.scenes.tables.results import SceneResults

stored_plan = cache(planned)
FRAMES = sorted(str(p.relative_to(STORED)) for p in STORED.rglob("*.*") if p.suffix != ".toml")


def of_file(name: str):
    return st.tuples(st.just(name), damaged((STORED / name).read_bytes()))


@given(st.sampled_from(FRAMES).flatmap(of_file))
def test_a_damaged_frame_or_log_is_read_or_named(change):
    name, raw = change
    kind, p = name.split("/")[0], stored_plan(name.split("/")[0])
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / kind
        shutil.copytree(STORED / kind, place)
        (Path(folder) / name).write_bytes(raw)
        try:
            tables = scene_engine(RUNS[kind][0]).read(p, place)
        except EpdemError as error:
            assert place.name in str(error) and "\n" not in str(error)
        else:
            assert {"rows", "particles", "contacts"} <= set(tables)


@pytest.fixture(scope="session")
def whole(tmp_path_factory):
    """results.h5 of impacts and of a scene, as bytes, with what reads each."""
    folder = tmp_path_factory.mktemp("whole")
    run(CASES / "two_materials.toml", engines=[engine("embedded")], out=folder / "impacts")
    p = stored_plan("settle")
    tables = scene_engine("liggghts").read(p, STORED / "settle")
    scene_store.write(folder / "scene.h5", p, SceneResults("x", {"case": "x"}, tables, {"in.scene": "run 1"}))
    return {
        "impacts": ((folder / "impacts/results.h5").read_bytes(), store.read),
        "scene": ((folder / "scene.h5").read_bytes(), scene_store.read),
    }


def _read(read, path, pipe, whole):
    """Sends "" if `path` is read as `whole` is, else what is said of it."""
    try:
        pipe.send("" if same(vars(read(path)), vars(read(whole))) else "other contents, without a word")
    except EpdemError as error:
        pipe.send(str(error))


def in_a_child(read, path: Path, whole: Path) -> tuple[int | None, str | None]:
    """(exit code, words of the error or '') of reading a file; a crash of HDF5 would end this process."""
    reader, writer = multiprocessing.Pipe(duplex=False)
    child = multiprocessing.get_context("fork").Process(target=_read, args=(read, path, writer, whole))
    child.start()
    writer.close()
    child.join(30)
    hangs = child.is_alive()
    child.kill()
    child.join()
    try:
        said = reader.recv()
    except EOFError:
        said = None
    return (None if hangs else child.exitcode), said


@given(st.data())
def test_a_damaged_results_file_is_read_or_refused(whole, data):
    raw, read = whole[data.draw(st.sampled_from(sorted(whole)))]
    changed = data.draw(damaged(raw))
    with tempfile.TemporaryDirectory() as folder:
        path, as_written = Path(folder) / "results.h5", Path(folder) / "whole.h5"
        path.write_bytes(changed)
        as_written.write_bytes(raw)
        code, said = in_a_child(read, path, as_written)
        assert code == 0 and said is not None, f"exit code {code}"
        assert said == "" or (str(path) in said and "\n" not in said), said
