# SPDX-License-Identifier: GPL-2.0-or-later
"""No command that writes replaces a file of the user's without --force; with it, it does."""

import errno
import re
import shutil
from pathlib import Path

import pytest
from calls import CASES, call, quick_figures

from epdem.base.files import atomic
from epdem.verification import stability

WRITERS = {  # words of a command that writes, and a file of the user's in its way
    "deck of impacts": (["deck", "steel.toml", "-o", "d"], "d/in.impact"),
    "deck of a scene": (["deck", "scene.toml", "-o", "d"], "d/setup.in"),
    "deck for YADE": (["deck", "steel.toml", "-o", "d", "-e", "yade"], "d/impact.py"),
    "own template": (["deck", "mill.j2", "--case", "steel.toml", "-o", "d"], "d/mill"),
    "figures": (["verify", "figures", "-o", "d"], "d/figure_8_17.png"),
    "cost": (["verify", "cost", "steel.toml", "-e", "embedded", "--repetitions", "1", "-o", "d"], "d/cost.png"),
    "motion": (["verify", "motion", "steel.toml", "-e", "embedded", "-o", "d"], "d/motions.csv"),
    "stability": (
        ["verify", "stability", "-g", "poisson", "-l", "hertz", "--every", "2", "-o", "d"],
        "d/stability.csv",
    ),
    "soften": (["soften", "steel.toml", "-k", "10", "-o", "d/soft.toml"], "d/soft.toml"),
}


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    quick_figures(monkeypatch)


@pytest.mark.parametrize("kind", WRITERS)
def test_a_file_of_the_user_is_kept_until_force_is_given(kind, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words, name = WRITERS[kind]
    steel = (CASES / "steel_wall.toml").read_text()
    (tmp_path / "steel.toml").write_text(re.sub("speeds = .*", 'speeds = ["5 m/s"]', steel))
    (tmp_path / "mill.j2").write_text("{{ deck.plan.time_step }}\n")
    shutil.copy(CASES / "settle_glass.toml", tmp_path / "scene.toml")
    (tmp_path / name).parent.mkdir()
    (tmp_path / name).write_text("of the user")
    done = call(words, capsys, monkeypatch)
    *before, problem = done.err.splitlines()
    assert done.code == 2 and name.split("/")[-1] in problem and "--force" in problem
    assert all(line.startswith("warning: ") for line in before)
    assert (tmp_path / name).read_text() == "of the user" and not (tmp_path / "s").exists()
    done = call([*words, "--force"], capsys, monkeypatch)
    assert done.code == 0, done.err
    assert (tmp_path / name).read_text(errors="replace") != "of the user"


@pytest.mark.parametrize("kind", ["deck of a scene", "own template", "figures"])
def test_what_a_command_wrote_it_replaces_without_force(kind, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(CASES / "settle_glass.toml", tmp_path / "scene.toml")
    shutil.copy(CASES / "steel_wall.toml", tmp_path / "steel.toml")
    (tmp_path / "mill.j2").write_text("{{ deck.plan.time_step }}\n")
    words, name = WRITERS[kind]
    for _ in range(2):
        assert call(words, capsys, monkeypatch).code == 0
    (tmp_path / name).write_text("changed by the user")
    assert call(words, capsys, monkeypatch).code == 2


def test_a_place_that_cannot_be_written_to_is_said_before_the_work_and_by_its_name(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(stability, "run", lambda *words, **options: pytest.fail("it ran"))
    (tmp_path / "d").write_text("a file")
    done = call(WRITERS["stability"][0], capsys, monkeypatch)
    assert done.code == 2 and done.err.startswith("epdem: d: ")
    shutil.copy(CASES / "steel_wall.toml", tmp_path / "steel.toml")
    done = call(WRITERS["soften"][0], capsys, monkeypatch)
    assert done.code == 2 and f"{tmp_path}/d is not a folder that can be written to" in done.err
    long = tmp_path / ("x" * 256)
    with pytest.raises(OSError, match="File name too long") as found, atomic(long):
        pass
    assert found.value.filename == str(long)


def test_a_full_disk_is_said_with_its_free_bytes_though_the_folder_has_gone(tmp_path, capsys, monkeypatch):
    def full(*words, **options):
        raise OSError(errno.ENOSPC, "No space left on device", "out/law/in.impact")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(Path, "mkdir", full)
    done = call(("run", CASES / "steel_wall.toml", "-e", "embedded", "-o", "out"), capsys, monkeypatch)
    assert done.code == 2 and done.err.startswith("epdem: out/law/in.impact: No space left on device (")
    assert "bytes are free); choose another folder by --out" in done.err
