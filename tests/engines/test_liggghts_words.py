# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS's own files and processes: dumps, logs, meshes, ranks; whoever dies leaves no engine behind."""

import os
import signal
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from test_stopping import alive, until

from cli.calls import call as epdem
from epdem.base.processes import call
from epdem.engines import log
from epdem.engines.frames import text_frame
from epdem.engines.liggghts import dump
from epdem.errors import EngineError
from epdem.scenes.plan.meshes import stl_text

CASE = Path(__file__).parents[2] / "cases/steel_wall.toml"


def frame(step: int, blocks: list[np.ndarray]) -> bytes:
    """One frame of a binary dump, written down from LIGGGHTS's manual: every block is one rank's."""
    columns = blocks[0].shape[1]
    head = struct.pack("<qqi6i6dii", step, sum(map(len, blocks)), 0, *[1] * 6, *[0.0, 1.0] * 3, columns, len(blocks))
    return head + b"".join(struct.pack("<i", b.size) + b.astype("<f8").tobytes() for b in blocks)


def test_a_binary_dump_is_read_over_ranks_and_sorted_by_id(tmp_path):
    path = tmp_path / "a.bin"
    path.write_bytes(frame(0, [np.array([[2.0, 20.0]]), np.array([[1.0, 10.0]])]) + frame(7, [np.array([[1.0, 3.0]])]))
    (first, rows), (last, single) = dump.frames(path)
    assert (first, last) == (0, 7)
    assert rows.tolist() == [[1.0, 10.0], [2.0, 20.0]] and single.tolist() == [[1.0, 3.0]]


def test_a_dump_that_was_cut_anywhere_is_refused(tmp_path):
    path, whole = tmp_path / "a.bin", frame(0, [np.arange(6.0).reshape(2, 3)])
    for size in range(1, len(whole)):
        path.write_bytes(whole[:size])
        with pytest.raises(EngineError, match=r"a\.bin: frame 0 is incomplete"):
            dump.frames(path)


LOCAL = (
    "ITEM: TIMESTEP\n3\nITEM: NUMBER OF ENTRIES\n{n}\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ENTRIES c[1] \n"
)


def test_a_text_dump_knows_how_many_rows_it_has(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text(LOCAL.format(n=2) + "1 2.5\n3 4e-9\n")
    assert text_frame(path, ["a", "b"]).to_numpy().tolist() == [[1.0, 2.5], [3.0, 4e-9]]
    path.write_text(LOCAL.format(n=0))
    assert text_frame(path, ["a", "b"]).shape == (0, 2)
    path.write_text(LOCAL.format(n=2) + "1 2.5\n")
    with pytest.raises(ValueError, match="1 lines of 2"):
        text_frame(path, ["a", "b"])


def test_thermo_rows_of_several_runs_are_read_in_order(tmp_path):
    text = "Step Atoms KinEng CPU \n     0   2  1.5  0\n    10   2  0.5  1\nLoop time of 0.25 on 2 procs for 10 steps\n"
    (tmp_path / "log").write_text(
        "words 1 2\n" + text + text.replace("    10 ", "    20 ").replace("     0 ", "    10 ")
    )
    rows = log.rows(tmp_path / "log")
    assert list(rows["run"]) == [0, 0, 1, 1]
    assert list(rows["Step"]) == [0, 10, 10, 20] and list(rows["KinEng"]) == [1.5, 0.5, 1.5, 0.5]
    assert log.loops(tmp_path / "log") == [(0.25, 10)] * 2 and log.loop_seconds(tmp_path / "log") == 0.25
    assert log.rows(tmp_path / "nothing").empty and np.isnan(log.loop_seconds(tmp_path / "nothing"))


def test_normals_of_a_mesh_follow_the_right_hand():
    triangle = np.array([[[0.0, 0, 2], [3, 0, 2], [0, 1, 2]]])
    lines = stl_text("plate", triangle).split("\n")
    assert [float(x) for x in lines[1].split()[2:]] == [0.0, 0.0, 1.0]
    assert [[float(x) for x in line.split()[1:]] for line in lines if "vertex" in line] == triangle[0].tolist()


def test_more_ranks_than_cores_are_refused_before_anything_is_written(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "epdem", "run", str(CASE), "-e", "liggghts", "--ranks", "999", "--out", "out"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    most = max(2, len(os.sched_getaffinity(0)))
    assert done.returncode == 2 and f"--ranks 999: engine liggghts runs on at most {most} ranks here" in done.stderr
    assert list(tmp_path.iterdir()) == []


STARTER = """
import sys
from pathlib import Path
from epdem.base.processes import call
call(sys.argv[2:], Path(sys.argv[1]), log="out")
"""


def members(folder: Path) -> list[int]:
    """The living processes that work in a folder."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and (entry / "cwd").readlink() == folder and alive(int(entry.name)):
                found.append(int(entry.name))
        except OSError:
            continue
    return found


MPI = ["mpirun", "-np", "2", "--oversubscribe", *(["--allow-run-as-root"] if os.geteuid() == 0 else [])]


@pytest.mark.liggghts
@pytest.mark.parametrize("command", [["sleep", "61"], [*MPI, "sleep", "61"]], ids=["alone", "2 ranks"])
def test_when_we_are_killed_the_engine_and_its_ranks_end(command, tmp_path):
    run = subprocess.Popen([sys.executable, "-c", STARTER, str(tmp_path), *command])
    sleeping = 2 if command[0] == "mpirun" else 1
    try:
        assert until(lambda: len([p for p in members(tmp_path) if comm(p) == "sleep"]) == sleeping)
    finally:
        run.send_signal(signal.SIGKILL)
        run.wait()
    assert until(lambda: not members(tmp_path), 30.0)


def comm(process: int) -> str:
    """The name of a process."""
    try:
        return Path(f"/proc/{process}/comm").read_text().strip()
    except OSError:
        return ""


DEAF = "trap '' TERM; (trap '' TERM; sleep 62) & echo $$ > pid; while true; do sleep 0.01; done"


def test_a_program_that_is_deaf_to_sigterm_is_ended_with_all_that_it_started(tmp_path, monkeypatch):
    monkeypatch.setattr("epdem.base.processes.PATIENCE", 0.3)
    with pytest.raises(EngineError, match=r"setsid did not end within 1 s|sh did not end within 1 s"):
        call(["sh", "-c", DEAF], tmp_path, log="out", seconds=1.0)
    assert (tmp_path / "pid").exists() and members(tmp_path) == []


def test_rows_are_reported_while_the_program_runs_and_an_exception_stops_it(tmp_path):
    class EnoughError(Exception):
        pass

    reported = []

    def report(step: int) -> None:
        reported.append(step)
        if step == 20:
            raise EnoughError

    with pytest.raises(EnoughError):
        call(["sh", "-c", "printf 'words\\n 10 1.5\\n 20 -1e-3\\n'; sleep 63"], tmp_path, log="out", report=report)
    assert reported == [10, 20] and members(tmp_path) == []
    assert (tmp_path / "out").read_text() == "words\n 10 1.5\n 20 -1e-3\n"


@pytest.mark.liggghts
def test_nothing_is_written_outside_the_output_folder(tmp_path, monkeypatch, capsys):
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    (here / "log.liggghts").write_text("the user's own")
    short = ["--engine", "liggghts", "--law", "hertz", "--steps", "20", "--out", str(tmp_path / "out")]
    for words in (["doctor"], ["run", str(CASE), *short], ["deck", str(CASE), "--out", str(tmp_path / "deck")]):
        done = epdem(words, capsys, monkeypatch)
        assert done.code in (0, 1), done.err
    assert [p.name for p in here.iterdir()] == ["log.liggghts"]
    assert (here / "log.liggghts").read_text() == "the user's own"
    assert (tmp_path / "out/results.h5").exists()
