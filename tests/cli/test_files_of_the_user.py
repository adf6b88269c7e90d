# SPDX-License-Identifier: GPL-2.0-or-later
"""No command that writes replaces a file of the user's without --force; with it, it does."""

import errno
import os
import re
import shutil
import time
from pathlib import Path

import pytest
from calls import CASES, call, quick_figures

from epdem.base.files import atomic
from epdem.verification import stability
from scenes.parts_cases import parts
from scenes.scene_runs import write_case

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


SET = ("--set", "impact.body.radius=1 mm,2 mm")
READERS = {
    "run": (),
    "predict": (),
    "deck": ("-o", "d"),
    "view": (),
    "soften": ("--factor", "100"),
    "verify cost": (),
    "verify crosscheck": (),
    "sweep": SET,
    "calibrate": ("--target", "height_last=1 mm", "--free", "contact.friction=0.1..0.5"),
}
NESTED = "nested more than 20 deep"
FILES = {
    "lists": ("a = " + "[" * 3000 + "]" * 3000, NESTED),
    "few_lists": ("a = " + "[" * 150 + "]" * 150, NESTED),
    "tables": ("a = " + "{b=" * 2000 + "1" + "}" * 2000, NESTED),
    "dots": ("a" + ".a" * 20_000 + " = 1", NESTED),
    "quoted_dots": ('"a b" ' + ". 'a' " * 20_000 + " = 1", NESTED),
    "head": ("[a" + ".a" * 20_000 + "]\nx = 1", NESTED),
    "inline_dots": ("x = { y = 1, a" + ".a" * 20_000 + " = 1 }", NESTED),
    "digits": ("[case]\nname = 'a'\nx = " + "9" * 4400, "a whole number has more than 4300 digits"),
    "large": ("#" * 1_000_001, "1000001 bytes, must be at most 1000000"),
}


def said(words, capsys, monkeypatch) -> str:
    begin = time.monotonic()
    done = call(words, capsys, monkeypatch)
    assert done.code == 2 and done.err.count("\n") == 1 and len(done.err) < 1000, (done.code, done.err[-500:])
    assert time.monotonic() - begin < 10
    return done.err


@pytest.mark.parametrize("command", READERS)
def test_a_command_refuses_what_no_case_is(command, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe.toml")
    for name, (text, says) in FILES.items():
        Path(f"{name}.toml").write_text(text)
        assert says in said((command, f"{name}.toml", *READERS[command]), capsys, monkeypatch)
    for special in ("/dev/zero", "pipe.toml", "."):
        assert f"{special}: not a regular file" in said((command, special, *READERS[command]), capsys, monkeypatch)


def test_large_fields_of_tables_are_refused(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    field = "1" * 140_000
    Path("spheres.csv").write_text(f"x,y,z,radius\n0,0,{field},0.001\n")
    Path("sieve.csv").write_text(f"opening [mm],retained [%]\n{field},0\n1,100\n")
    Path("points.csv").write_text(f"impact.body.radius\n{field}\n")
    table = {"name": "bed", "file": "spheres.csv", "material": "glass"}
    write_case(parts(fill=[table]), tmp_path, "table.toml")
    region = {"x": ["-9 mm", "9 mm"], "y": ["-9 mm", "9 mm"], "z": ["0 mm", "38 mm"]}
    sieved = {"name": "bed", "region": region, "count": 9}
    sieved["particles"] = [{"material": "glass", "radius": {"sieve": "sieve.csv"}}]
    write_case(parts(fill=[sieved]), tmp_path, "sieved.toml")
    assert "spheres.csv cannot be read (field larger" in said(("run", "table.toml"), capsys, monkeypatch)
    assert "sieve.csv cannot be read (field larger" in said(("run", "sieved.toml"), capsys, monkeypatch)
    steel = str(CASES / "steel_wall.toml")
    words = ("sweep", steel, "--points")
    assert "points.csv cannot be read (field larger" in said((*words, "points.csv"), capsys, monkeypatch)
    assert "/dev/zero: not a regular file" in said((*words, "/dev/zero"), capsys, monkeypatch)
    deep = "impact.body.radius=" + "[" * 5000
    assert "impact.body.radius" in said(("sweep", steel, "--set", deep), capsys, monkeypatch)
