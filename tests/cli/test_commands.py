# SPDX-License-Identifier: GPL-2.0-or-later
"""Every command, once for its JSON document and once for a mistake; text of the user is shown as it is."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest
from calls import CASES, COMMANDS, call, make_sweep, quick_figures

from epdem.base import paths, terminal
from epdem.base.declarations import declarations
from epdem.cli.options import answer
from epdem.engines import ENGINES
from epdem.engines.citations import of_laws
from epdem.scenes.judge import summary
from epdem.verification import engine_comparison as crosscheck

STEEL = (CASES / "steel_wall.toml").read_text()
SPEEDS = STEEL[STEEL.index("speeds =") : STEEL.index("\n", STEEL.index("speeds ="))]
ONE_SPEED = STEEL.replace(SPEEDS, 'speeds = ["5 m/s"]')
FEW_BEADS = (
    (CASES / "settle_glass.toml").read_text().replace("count = 1000", "count = 30").replace('"0.5 s"', '"0.1 s"')
)
FEW_BEADS = FEW_BEADS.replace("error = 1e-2", "time_step = '5e-5 s'")
TITLE = "[/y] [red]steel[/] :smile: $\\\\frac$ [mm]"


def licences(folder):
    return {f"{folder}/LICENSES/{name}.txt" for name in ("BSD-3-Clause", "GPL-2.0-or-later")}


CONTACTS = CASES.parent / "data/plastic_contacts"
DOCUMENTS = {  # words, and what the document must hold
    "run": ("steel.toml -e embedded", lambda d: d["passed"] and d["rows"][0]["speed"] == 5.0),
    "deck": ("steel.toml -o d", lambda d: d["files"][0] == "d/in.impact"),
    "predict": ("steel.toml", lambda d: abs(d["rows"][0]["e_n"] - 0.6763264338717) < 1e-12),
    "doctor": ("", lambda d: {"C library", "engine embedded", "engine lammps"} <= {f["part"] for f in d}),
    "verify crosscheck": ("steel.toml", lambda d: [r["model"] for r in d["rows"]] == ["theory", "embedded"]),
    "verify motion": (
        "steel.toml -e embedded",
        lambda d: d["passed"] and len(d["rows"]) == 6 and d["rows"][0]["force_max"] > 1e3,
    ),
    "verify contacts": (
        f"{CONTACTS}/3_ten_times_yield.yaml -e embedded",
        lambda d: d["passed"] and [row["quantity"] for row in d["rows"]] == ["force", "torque"],
    ),
    "verify figures": ("-o f", lambda d: len(d["files"]) == 10),
    "verify cost": (
        "steel.toml -e embedded --repetitions 1",
        lambda d: d["models"][0]["model"] == "embedded, thornton" and len(d["rows"]) == 11,
    ),
    "verify stability": ("-g poisson -l hertz --every 2", lambda d: d["passed"] and len(d["rows"]) == 1),
    "soften": ("steel.toml -k 32", lambda d: d["file"] == "steel_soft32.toml" and len(d["changes"]) == 3),
    "sweep": (
        "steel.toml -e embedded --set 'impact.body.radius=1 mm,2 mm' -j 1",
        lambda d: d["passed"] and d["done"] == 2,
    ),
    "verify rerun": ("stored/results.h5", lambda d: d["same"] and len(d["differences"]) == 1),
    "view": ("beads.toml", lambda d: d == {"file": "settle_glass.png", "spheres": 30, "drawn": 30}),
    "status": ("swept", lambda d: (d["points"], d["done"], d["waiting"]) == (2, 0, 2)),
    "cite": ("steel.toml", lambda d: "Thornton" in d["law thornton, Thornton 1997"] and "Kloss" in d["liggghts"]),
    "export liggghts": ("-o .", lambda d: d["files"][0] == "normal_model_ep.cpp" and not d["lacks"]),
    "export lammps": (
        "-o plugin",
        lambda d: {"plugin/cpp_contact/kernels/block.hpp", *licences("plugin")} <= {*d["files"]},
    ),
    "export yade": ("-o module", lambda d: {"module/epdem/laws.hpp", *licences("module")} <= {*d["files"]}),
    "verify data": (
        "-s leeb_G -e embedded -l hertz",
        lambda d: [round(row["error"], 4) for row in d["rows"] if row["quantity"] == "e_n"] == [0.3333],
    ),
    "calibrate": ("steel.toml --hv 100", lambda d: abs(d["value"] / 1057.81e6 - 1) < 1e-5),
}
CASE = ("--case", "steel.toml", "-o", "d")
SET = ("--set", "impact.body.radius=1 mm,2 mm")
MISTAKES = {  # words of a call, and what the sentence must hold
    ("run", "steel.toml", "-e", "abaqus"): "'abaqus' does not exist; there are embedded",
    ("deck", "steel.toml", "-o", "d", "-e", "embedded"): "reads no deck",
    ("predict", "steel.toml", "-l", "hook"): "steel.toml: law.name = 'hook' does not exist; there are hertz",
    ("doctor", "steel.toml"): "extra argument(s) (steel.toml); see epdem doctor --help",
    ("verify crosscheck", "steel.toml", "nowhere.toml"): "nowhere.toml: no such file",
    ("verify motion", "steel.toml", "-m", "bad.toml"): "bad.toml: no line of names that begins with t",
    ("verify contacts", "bad.toml"): "bad.toml: not a mapping with the keys variables, pair_style",
    ("verify figures", "-o", "steel.toml"): "steel.toml",
    ("verify cost", "steel.toml", "-l", "hook"): "steel.toml: law.name = 'hook' does not exist",
    ("verify stability", "-g", "modulu"): "--group 'modulu' does not exist; there are modulus",
    ("soften", "steel.toml", "-k", "-3"): "--factor -3, must lie in (0, 1e12)",
    ("calibrate", "steel.toml"): "give one measurement",
    ("view", "beads.toml", "-o", "beads.txt"): "--out beads.txt: no picture has this ending; name it beads.png",
    ("cite", "steel.toml", "-e", "abaqus"): "'abaqus' does not exist; there are embedded",
    ("export liggghts", "--check", "."): "contact_models.h is not there; name the folder src",
    ("export lammps", "-o", "."): "--out .: it has files; name a new folder",
    ("export yade", "-o", "."): "--out .: it has files; name a new folder",
    ("sweep", "steel.toml", "--set", "impact.body.radios=1 mm"): "the nearest: impact.body.radius",
    ("verify rerun", "steel.toml"): "steel.toml: not a results file of epdem, or damaged",
    ("status", "nowhere"): "nowhere: not a folder of a sweep",
    ("verify data", "-s", "leeb_X"): "--set 'leeb_X' does not exist; there are hutchings_1979, leeb_C",
    ("run", "beads.toml", "--resume", "--fresh"): "--resume continues a run and --fresh begins it again; leave one out",
    ("run", "beads.toml", "-e", "embedded"): "--engine embedded: a scene runs on liggghts or yade",
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
    ("deck", "own.j2", *CASE, "--set", "a=1", "--set", "a=2"): "--set a: given twice; write",
    ("deck", "own.j2", *CASE, "--set", "b=1"): "own.j2 does not use it; check the",
    ("sweep", "steel.toml", "--set", "impact.body.radius"): "--set 'impact.body.radius': write it as --set impact",
    ("sweep", "steel.toml", *SET, *SET): "--set impact.body.radius: given twice; write all its values behind one",
    ("sweep", "steel.toml", *SET, "--points", "points.csv"): "impact.body.radius: the key is in points.csv too; keep",
    ("sweep", "steel.toml", "--points", "points.csv", "--latin-hypercube", "3"): "--latin-hypercube needs ranges; add",
    ("sweep", "steel.toml", *SET, "--slurm", "time=1", "--jobs", "2"): "--jobs: give the jobs of a cluster by --slurm",
    ("calibrate", "hertz.toml", "--hv", "100"): "law hertz never yields; it has nothing to calibrate",
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    texts = {"steel.toml": ONE_SPEED, "bad.toml": "a = ", "beads.toml": FEW_BEADS, "mine/a.txt": "of the user"}
    texts |= {"many.toml": STEEL.replace("count = 32", "count = 512"), "own.j2": "{{ a | default(0) }}\n"}
    texts |= {"hertz.toml": re.sub(r'"thornton"\n.*', '"hertz"', STEEL), "points.csv": "impact.body.radius\n3 mm\n"}
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def test_the_tables_name_every_command():
    assert set(DOCUMENTS) == {words[0] for words in MISTAKES} == set(COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_prints_one_json_document_and_nothing_else(command, folder, capsys, monkeypatch):
    monkeypatch.setattr(crosscheck, "ENGINES", {"embedded": ENGINES["embedded"]})
    monkeypatch.setattr(crosscheck, "SAME_LAW", {})
    monkeypatch.setattr(crosscheck, "OWN_LAW", {})
    quick_figures(monkeypatch)
    if command == "status":
        make_sweep("steel.toml", folder / "swept")
    if command == "verify rerun":
        assert call(["run", "steel.toml", "-e", "embedded", "-o", "stored"], capsys, monkeypatch).code == 0
    words, holds = DOCUMENTS[command]
    done = call([command, *shlex.split(words), "--json"], capsys, monkeypatch)
    assert done.code == 0 or command == "doctor", done.err
    assert holds(json.loads(done.out, parse_constant=pytest.fail))
    assert done.err == ""


@pytest.mark.parametrize("words", MISTAKES, ids=" ".join)
def test_a_mistake_is_one_sentence_exit_code_2_and_no_file(words, folder, capsys, monkeypatch):
    before = {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    done = call(words, capsys, monkeypatch)
    assert (done.code, done.out) == (2, "") and MISTAKES[words] in done.err, done.err
    sentences = [line for line in done.err.splitlines() if not line.startswith("DeprecationWarning")]
    assert len(sentences) == 1 and sentences[0].startswith("epdem: ")
    assert {name for name, _ in done.files} == before


@pytest.mark.parametrize("command", ["run", "predict", "verify cost", "verify crosscheck"])
def test_titles_and_paths_that_look_like_markup_are_shown_as_they_are(command, folder, capsys, monkeypatch):
    (folder / "[b]").mkdir()
    (folder / "[b]/steel.toml").write_text(ONE_SPEED.replace("Steel sphere on a steel wall", TITLE))
    for name in ("SAME_LAW", "OWN_LAW"):
        monkeypatch.setattr(crosscheck, name, {})
    monkeypatch.setattr(crosscheck, "ENGINES", {"embedded": ENGINES["embedded"]})
    words = [] if command in ("predict", "verify crosscheck") else ["-e", "embedded"]
    words += [] if command == "predict" else ["-o", "[b]/out"]
    done = call([command, "[b]/steel.toml", *words], capsys, monkeypatch)
    assert done.code == 0, done.err
    assert TITLE.replace("\\\\", "\\") in done.out
    assert command == "predict" or "[b]/out/" in done.out


def test_a_terminal_without_utf8_shows_any_title(folder):
    (folder / "steel.toml").write_text(ONE_SPEED.replace("Steel sphere on a steel wall", "\u00d8 \u2192 \u4e2d"))
    words = [sys.executable, "-m", "epdem", "predict", "steel.toml"]
    done = subprocess.run(words, capture_output=True, env=os.environ | {"PYTHONIOENCODING": "latin-1"})
    assert done.returncode == 0, done.stderr
    assert "\u00d8 \\u2192 \\u4e2d" in done.stdout.decode("latin-1")


def test_long_values_are_cut_at_80_characters(folder, capsys, monkeypatch):
    for words in (["run", "steel.toml", "-e", "x" * 500], ["predict", "steel.toml", "-l", "x" * 500]):
        err = call(words, capsys, monkeypatch).err
        assert f"'{'x' * 77}...'" in err and len(err) < 250


def test_two_cases_of_one_file_name_do_not_share_a_folder(folder, capsys, monkeypatch):
    for name in ("ENGINES", "SAME_LAW", "OWN_LAW"):
        monkeypatch.setattr(crosscheck, name, {"embedded": ENGINES["embedded"]} if name == "ENGINES" else {})
    (folder / "b").mkdir()
    shutil.copy("steel.toml", "b/steel.toml")
    done = call(["verify", "crosscheck", "steel.toml", "b/steel.toml", "-o", "out"], capsys, monkeypatch)
    assert done.code == 2 and "--out out: two of the cases have one file name" in done.err and not Path("out").exists()


def test_title_and_folder_of_a_scene_are_shown_as_they_are(capsys):
    check = {"key": "y", "check": "[y]", "value": 1.0, "expected": 1.0, "error": 0.0, "tolerance": 1e-3}
    check |= {"unit": "N", "passed": True}
    tables = {"checks": pd.DataFrame([check]), "rows": pd.DataFrame({"particles": [1]})}
    outcome = SimpleNamespace(
        case=SimpleNamespace(name="s", case=SimpleNamespace(title=TITLE)),
        results=SimpleNamespace(tables=tables),
        warnings=["[/y]"],
        deck=SimpleNamespace(steps=1, time_step=1e-6),
        plan=SimpleNamespace(
            steps=1, time_step=1e-6, case=SimpleNamespace(measured=None), scene=SimpleNamespace(stages=None, measure=[])
        ),
        seconds=1.0,
        reused=False,
        resumed_from=None,
        folder="[b]",
    )
    answer(None, summary.shown(outcome), as_json=False)
    out = capsys.readouterr().out
    assert TITLE in out and "[y]" in out and "warning: [/y]" in out and "see [b]/" in out


def test_progress_shows_any_text_and_leaves_none_behind(capsys):
    with terminal.status() as progress:
        progress("[/y]")
    with terminal.bar("[/y]", "points") as progress:
        progress(1, 2)
    assert capsys.readouterr() == ("", "")


def test_progress_in_a_log_is_a_line_a_minute_with_place_time_and_rate(capsys, monkeypatch):
    clock = iter([0.0, 10.0, 60.0, 61.0, 125.0])
    monkeypatch.setattr(terminal.time, "monotonic", lambda: next(clock))
    with terminal.bar("bed", "steps") as progress:
        for done in (1000, 7000, 7100, 13500):
            progress(done, 26000, "phase pour")
    assert capsys.readouterr().err.splitlines() == [
        "bed: 7000 of 26000 steps, phase pour, 1 min, 100 steps/s, 3 min left",
        "bed: 13500 of 26000 steps, phase pour, 2 min, 100 steps/s, 2 min left",
    ]


def test_no_progress_line_stands_above_the_error_of_a_scene(folder, capsys, monkeypatch):
    shutil.copy(CASES / "settle_glass.toml", folder / "scene.toml")
    monkeypatch.setattr(paths, "launcher", lambda: Path("/bin/false"))
    done = call(["run", "scene.toml"], capsys, monkeypatch)
    assert done.code == 3 and done.err.startswith("epdem: ")


def test_the_message_for_a_name_that_begins_with_a_dash_says_how_to_write_it(folder, capsys, monkeypatch):
    (folder / "-x.toml").write_text(ONE_SPEED)
    assert "write the file as ./-x.toml" in call(["predict", "-x.toml"], capsys, monkeypatch).err
    assert call(["predict", "./-x.toml"], capsys, monkeypatch).code == 0


def test_every_law_has_a_source_to_cite():
    for law in declarations():
        assert any(what.startswith(f"law {law}, ") for what in of_laws([law]))
