# SPDX-License-Identifier: GPL-2.0-or-later
"""What a command says of options, files and folders that do not fit: sentences that no other test asks for."""

import re
from pathlib import Path

import pytest
from calls import CASES, call

CASE = ("--case", "steel.toml", "-o", "d")
SET = ("--set", "impact.body.radius=1 mm,2 mm")
SENTENCES = {
    ("run", "scene.toml", "--resume", "--fresh"): "--resume continues a run and --fresh begins it again; leave one out",
    ("run", "scene.toml", "-e", "embedded"): "--engine embedded: a scene runs on liggghts or yade",
    ("run", "steel.toml", "-e", "embedded", "--format", "gif"): "--format gif: not one of png, svg, pdf; choose one of",
    ("run", "steel.toml", "-e", "embedded", "-o", "mine"): "a.txt was there before; the folder is not ours; choose",
    ("run", "steel.toml", "-e", "embedded", "-o", "own.j2"): "own.j2",
    ("run", "steel.toml", "-e", "embedded", "-o", "/proc/here"): "/proc/here",
    ("run", "steel.toml", "-e", "liggghts-thornton_ning"): "'epdem verify crosscheck' runs models",
    ("run", "steel.toml", "-e", "embedded", "--ranks", "2"): "leave it out",
    ("deck", "steel.toml", "-e", "embedded", "-o", "d"): "reads no deck",
    ("deck", "steel.toml", "-l", "hertz", "-l", "cavity", "-o", "d"): "one deck for each",
    ("run", "many.toml", "-e", "embedded", "--steps", "100000"): "samples, at most",
    ("predict", "steel.toml", "-l", "jkr"): "law jkr needs law.work_of_adhesion (of all pairs), or",
    ("predict", "--speed", "0 m/s"): "impact.speeds.0 = '0 m/s', must lie in (0, inf)",
    ("predict", "--radius", "3 kg"): "impact.body.radius = '3 kg', the unit 'kg' has the wrong dimension",
    ("predict", "steel.toml", "--error", "1"): "'--error': must be less than or equal to 0.1; see epdem predict",
    ("run", "steel.toml", "--error", "1"): "'--error': must be less than or equal to 0.1; see epdem run --help",
    ("run", "steel.toml", "--error", "1e-3", "--steps", "9"): "--error: --steps gives the time step; leave it out",
    ("predict", "steel.toml", "--speed", "1 m/s"): "steel.toml: --speed: the case has its own numbers; leave it out",
    ("predict", "--law", "hertz"): "--law: it belongs to a case; leave it out",
    ("calibrate", "steel.toml", "--hv", "-o"): "'--hv': must be a number; see epdem calibrate --help",
    ("run", "steel.toml", "--ranks", "x"): "'--ranks': must be a whole number; see epdem run --help",
    ("predict", "--speed", "3"): "'3' has no unit; write \"3 m/s\" if that is what is meant",
    ("export liggghts",): "epdem export liggghts: name a folder by --out or --check",
    ("deck", "own.j2", *CASE, "--set", "1=2"): "must be key=value with a key of letters",
    ("deck", "own.j2", *CASE, "--set", "deck=2"): "this name holds the case's values",
    ("deck", "own.j2", *CASE, "--set", "a=1", "--set", "a=2"): "is given twice; keep",
    ("deck", "own.j2", *CASE, "--set", "b=1"): "own.j2 does not use it; check the",
    ("sweep", "steel.toml", "--set", "impact.body.radius"): "--set 'impact.body.radius': write it as --set impact",
    ("sweep", "steel.toml", *SET, *SET): "--set impact.body.radius: given twice; write all its values behind one",
    ("sweep", "steel.toml", *SET, "--points", "points.csv"): "impact.body.radius: the key is in points.csv too; keep",
    ("sweep", "steel.toml", "--points", "points.csv", "--latin-hypercube", "3"): "--latin-hypercube needs ranges; add",
    (
        "sweep",
        "steel.toml",
        *SET,
        "--slurm",
        "time=1",
        "--jobs",
        "2",
    ): "--jobs: give the jobs of a cluster by --slurm",
    ("calibrate", "hertz.toml", "--hv", "100"): "law hertz never yields; it has nothing to calibrate",
}


@pytest.mark.parametrize("words", SENTENCES, ids=" ".join)
def test_a_command_says_it_in_one_sentence(words, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    steel = (CASES / "steel_wall.toml").read_text()
    Path("steel.toml").write_text(steel)
    Path("many.toml").write_text(steel.replace("count = 32", "count = 512"))
    Path("hertz.toml").write_text(re.sub(r'"thornton"\n.*', '"hertz"', steel))
    Path("scene.toml").write_text((CASES / "settle_glass.toml").read_text())
    Path("points.csv").write_text("impact.body.radius\n3 mm\n")
    Path("own.j2").write_text("{{ a | default(0) }}\n")
    Path("mine").mkdir()
    Path("mine/a.txt").write_text("of the user")
    done = call(words, capsys, monkeypatch)
    assert done.code == 2 and SENTENCES[words] in done.err, done.err
    assert done.err.startswith("epdem: ") and done.err.count("\n") == 1
