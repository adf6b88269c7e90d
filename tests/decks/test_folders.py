# SPDX-License-Identifier: GPL-2.0-or-later
"""A folder of results holds what runs have written; what is the user's is never removed nor overwritten unasked."""

import errno
import json
import os
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from epdem.base import files, processes
from epdem.base.files import LOCK, MARKER, TEMPORARY, atomic, claim
from epdem.errors import CaseError

HOLD = """
import sys, time
from pathlib import Path
from epdem.base.files import claim
with claim(Path(sys.argv[1])):
    (Path(sys.argv[1]) / "restart.1.bin").write_text("x")
    print("in", flush=True)
    time.sleep(60)
"""


def first_run(folder: Path) -> None:
    with claim(folder):
        (folder / "in.scene").write_text("deck")
        (folder / "restart.5.bin").write_text("five")
        (folder / "law/liggghts").mkdir(parents=True, exist_ok=True)
        (folder / "law/liggghts/in.impact").write_text("deck")


def test_files_of_an_earlier_run_are_replaced_and_removed_by_pattern(tmp_path):
    first_run(tmp_path / "out")
    with claim(tmp_path / "out") as results:
        results.remove("restart.*.bin")
        (tmp_path / "out/in.scene").write_text("another deck")
    assert not (tmp_path / "out/restart.5.bin").exists() and not (tmp_path / "out" / LOCK).exists()
    first_run(tmp_path / "out")


WRITTEN = ["restart.9.bin", "scene_1.vtk", "results.csv", "in.scene", "end.txt", "wall_lid.txt", "epdem_yade.so"]
WRITTEN += ["law/liggghts/in.impact", "epdem/yade/deck_modules/libepdem.so", "spheres_on.txt"]


@pytest.mark.parametrize("name", WRITTEN)
def test_a_file_of_the_user_stops_the_run_and_is_kept(name, tmp_path):
    first_run(tmp_path / "out")
    (tmp_path / "out" / name).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / "out" / name).write_text("mine")
    with pytest.raises(CaseError, match=name), claim(tmp_path / "out"):
        pass
    with claim(tmp_path / "out", force=True) as results:
        results.remove("*")
    assert (tmp_path / "out" / name).read_text() == "mine"
    with pytest.raises(CaseError, match=name), claim(tmp_path / "out"):  # being allowed once makes nothing ours
        pass


def test_a_note_beside_the_results_disturbs_nobody(tmp_path):
    first_run(tmp_path / "out")
    (tmp_path / "out/notes.md").write_text("mine")
    with claim(tmp_path / "out") as results:
        results.remove("*")
    assert [p.name for p in (tmp_path / "out").glob("*.*") if p.is_file() and p.name[0] != "."] == ["notes.md"]


def test_a_folder_with_other_files_is_refused_as_it_is(tmp_path):
    (tmp_path / "thesis.tex").write_text("mine")
    with pytest.raises(CaseError, match=r"thesis\.tex"), claim(tmp_path):
        pass
    assert [p.name for p in tmp_path.iterdir()] == ["thesis.tex"]


def test_two_runs_never_share_a_folder_and_a_killed_one_leaves_its_files_ours(tmp_path):
    holder = subprocess.Popen([sys.executable, "-c", HOLD, str(tmp_path / "out")], stdout=subprocess.PIPE, text=True)
    try:
        assert holder.stdout.readline() == "in\n"
        said = f"in use by process {holder.pid} since {time.strftime('%Y')}"
        with pytest.raises(CaseError, match=said), claim(tmp_path / "out"):
            pass
    finally:
        holder.kill()
        holder.wait()
    with claim(tmp_path / "out") as results:
        results.remove("restart.*")
    assert json.loads((tmp_path / "out" / MARKER).read_text())["foreign"] == []
    assert [p.name for p in (tmp_path / "out").iterdir()] == [MARKER]


def test_blocks_of_one_process_nest_and_keep_the_lists_of_inner_folders_apart(tmp_path):
    for _ in range(2):
        with claim(tmp_path / "out"), claim(tmp_path / "out"):
            first_run(tmp_path / "out/coarse")
    first_run(tmp_path / "out/coarse")
    with claim(tmp_path / "out") as results:
        assert results.foreign == frozenset()


def test_a_run_that_comes_to_nothing_leaves_no_folder(tmp_path):
    with pytest.raises(CaseError), claim(tmp_path / "new"):
        raise CaseError("a wrong law")
    (tmp_path / "old").mkdir()
    with claim(tmp_path / "old"):
        pass
    assert [p.name for p in tmp_path.rglob("*")] == ["old"]


def test_a_file_about_to_be_written_is_in_the_way_whatever_its_name(tmp_path):
    first_run(tmp_path / "out")
    (tmp_path / "out/mill").write_text("mine")
    with pytest.raises(CaseError, match="mill was not written by epdem"), claim(tmp_path / "out", files=["mill"]):
        pass
    with claim(tmp_path / "out", files=["drum"]):
        pass


def test_versions_are_kept_through_a_crash_until_another_run_notes_its_own(tmp_path):
    with pytest.raises(KeyboardInterrupt), claim(tmp_path / "out") as results:
        results.note({"engine": "1"})
        (tmp_path / "out/restart.1.bin").touch()
        raise KeyboardInterrupt
    with claim(tmp_path / "out") as results:
        assert results.versions == {"engine": "1"}
        results.note({"engine": "2"})
    with claim(tmp_path / "out") as results:
        assert results.versions == {"engine": "2"}


def full(*words, **options):
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("broken", ["mkdir", "lock", "block"])
def test_a_full_disk_is_named_and_leaves_no_folder(broken, tmp_path, monkeypatch):
    folder = tmp_path / "a/b"
    with monkeypatch.context() as disk, pytest.raises(OSError, match="No space left") as found:
        if broken == "mkdir":
            disk.setattr(Path, "mkdir", full)
        if broken == "lock":
            disk.setattr(files.os, "write", full)
        with claim(folder):
            full()
    assert Path(found.value.filename).is_relative_to(folder) and not (tmp_path / "a").exists()


@pytest.mark.parametrize(("umask", "mode"), [(0o077, 0o600), (0o022, 0o644), (0o002, 0o664)])
def test_new_files_have_the_mode_of_the_umask_and_others_keep_theirs(umask, mode, tmp_path):
    (tmp_path / "old").write_text("x")
    (tmp_path / "old").chmod(0o640)
    before = os.umask(umask)
    try:
        for name in ("new", "old"):
            with atomic(tmp_path / name) as temporary:
                temporary.write_text("y")
    finally:
        os.umask(before)
    assert [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("new", "old")] == [mode, 0o640]


WRITE = """
import sys, time
from pathlib import Path
from epdem.base.files import atomic
with atomic(Path(sys.argv[1])) as temporary:
    temporary.write_text("half")
    print("in", flush=True)
    time.sleep(60)
"""


def test_what_a_killed_process_was_writing_goes_with_the_next_run(tmp_path):
    first_run(tmp_path)
    (tmp_path / ".mine").write_text("of the user")
    places = [tmp_path / "results.h5", tmp_path / "law/liggghts/in.impact"]
    commands = [[sys.executable, "-c", WRITE, str(place)] for place in places]
    killed, alive = (subprocess.Popen(words, stdout=subprocess.PIPE) for words in commands)
    for process in (killed, alive):
        assert process.stdout.readline() == b"in\n"
    killed.kill()
    killed.wait()
    with claim(tmp_path):
        assert [p.parent for p in tmp_path.rglob(f"{TEMPORARY}*")] == [places[1].parent]
    alive.kill()
    alive.wait()
    with claim(tmp_path):
        assert not [*tmp_path.rglob(f"{TEMPORARY}*")]
    assert (tmp_path / ".mine").read_text() == "of the user" and places[1].read_text() == "deck"


@pytest.mark.parametrize("place", ["", "thornton/liggghts"])
def test_a_run_waits_for_the_engine_of_a_killed_one(place, tmp_path, monkeypatch):
    """The engine is a process that `call` starts; here in a child that is killed, as by kill -9."""
    own, out = tmp_path / "out" / place, tmp_path / "out"
    own.mkdir(parents=True)
    program = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(1, flush=True); time.sleep(3)"
    starts = f"from pathlib import Path\nfrom epdem.base.processes import call\ncall([{sys.executable!r}, '-c', "
    child = subprocess.Popen([sys.executable, "-c", f'{starts}"""{program}"""], Path({str(own)!r}), log="out.x")'])
    while not ((own / "out.x").exists() and (own / "out.x").read_text()):
        time.sleep(0.01)
    child.kill()
    child.wait()
    with monkeypatch.context() as soon:
        soon.setattr(files, "PATIENCE", 0.1)
        with pytest.raises(CaseError, match=r"out: process \d+ of an earlier run still writes here; wait for its end"):
            claim(out, force=True).__enter__()
    (out / "other").mkdir()
    with claim(out / "other"):
        assert processes.engines_in(out.resolve())
    with claim(out, force=True):
        assert not processes.engines_in(out.resolve())


def test_a_log_of_a_run_is_its_own_file(tmp_path):
    """A process that still writes the log of an earlier run writes no line of this one."""
    with (tmp_path / "out.x").open("w") as earlier:
        processes.call(["echo", "new"], tmp_path, log="out.x")
        earlier.write("old\n")
    assert (tmp_path / "out.x").read_text() == "new\n"
