# SPDX-License-Identifier: GPL-2.0-or-later
"""Files that are no case, given to every command that reads one: one sentence, exit code 2, at once."""

import os
import sys
import time
from pathlib import Path

import pytest
from calls import CASES, call

sys.path.append(str(Path(__file__).parents[1] / "scenes"))
from parts_cases import parts
from scene_runs import write_case

SET = ("--set", "impact.body.radius=1 mm,2 mm")
COMMANDS = {
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


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_refuses_what_no_case_is(command, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe.toml")
    for name, (text, says) in FILES.items():
        Path(f"{name}.toml").write_text(text)
        assert says in said((command, f"{name}.toml", *COMMANDS[command]), capsys, monkeypatch)
    for special in ("/dev/zero", "pipe.toml", "."):
        assert f"{special}: not a regular file" in said((command, special, *COMMANDS[command]), capsys, monkeypatch)


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
