# SPDX-License-Identifier: GPL-2.0-or-later
"""A folder of results holds what runs have written; what is the user's is never removed nor overwritten unasked."""

import json
import subprocess
import sys
import time
from pathlib import Path

import pytest

from epdem.base.folders import LOCK, MANIFEST, claim
from epdem.errors import CaseError

HOLD = """
import sys, time
from pathlib import Path
from epdem.base.folders import claim
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


@pytest.mark.parametrize("name", ["restart.9.bin", "scene_1.vtk", "results.csv", "in.scene", "law/liggghts/in.impact"])
def test_a_file_of_the_user_stops_the_run_and_is_kept(name, tmp_path):
    first_run(tmp_path / "out")
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
    assert json.loads((tmp_path / "out" / MANIFEST).read_text())["files"] == {}


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
