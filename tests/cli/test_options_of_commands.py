# SPDX-License-Identifier: GPL-2.0-or-later
"""Every option of every command is obeyed or refused, for every kind of case; the options come from the command itself.

Obeyed: the output, the files or what reaches the library differ from those without it. Refused: exit code 2, a sentence
that names the option, nothing written. Long studies are replaced by a record of their arguments and a stored outcome.
"""

import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest
from calls import CASES, COMMANDS, call, make_sweep

from epdem.engines import engine
from epdem.errors import CaseError
from epdem.impacts import run as impacts_run
from epdem.report import pages
from epdem.scenes import run as scenes_run
from epdem.scenes.judge import summary
from epdem.studies import fit
from epdem.studies.sweep import run as sweep_run
from epdem.verification import contacts, cost, figures, stability
from epdem.verification import engine_comparison as crosscheck
from epdem.verification import measured_data as validate
from epdem.verification.motion import compare as motions

STEEL = (CASES / "steel_wall.toml").read_text()
FAST = STEEL[: STEEL.index("speeds =")] + 'speeds = ["1 m/s"]' + STEEL[STEEL.index("\n", STEEL.index("speeds =")) :]
TEMPLATE = "{{ deck.plan.time_step }} {{ a | default(0) }}\n"
HARDNESS = {"indentation": "curve.csv", "e_n": "0.6", "speed": "3 m/s", "hv": "200", "hb": "200", "dent_ratio": "0.5"}
HARDNESS |= {"target": "floor_load_mean=1 N", "free": "contact.friction=0.1..0.9", "tolerance": "0.1", "engine": "yade"}
HARDNESS |= {"measured": None, "uncertainty": "0.01", "ranks": "2", "jobs": "1", "out": "there", "force": None}
TARGET = ("--target", "floor_load_max=1 N", "--free", "contact.friction=0.1..0.5")
RUN = {"engine": "yade", "law": "cavity", "ranks": "2", "steps": "100", "out": "there", "fresh": None, "resume": None}
RUN |= {"error": "1e-2", "full": None, "pictures": "svg", "force": None}
DECK = {"out": "there", "engine": "yade", "law": "cavity", "case": "other.toml", "given": "a=1", "force": None}
DECK |= {"convert": None, "check": None, "reasons": None}
MY_DECK = """fix m all property/global youngsModulus peratomtype 1e7
pair_style gran model hertz
"""
HYPERCUBE = ("--latin-hypercube", "2")
SWEEP = {"given": "numerics.error=1e-2", "points": "points.csv", "latin_hypercube": "3", "seed": "2", "jobs": "1"}
SWEEP |= {"engine": "yade", "law": "cavity", "ranks": "2", "out": "there", "dry_run": None, "retry_failed": None}
SWEEP |= {"slurm": "partition=p", "only": "1", "force": None}
OUT = {"out": "there", "force": None}
CONVERT = ("deck", "my.in", "--convert", "--set", "yieldPressure=1", "-o", "d")
HOST = {"engine": "yade", "law": "cavity"} | OUT
PREDICT = {"law": "cavity", "error": "1e-2", "full": None}
ONE_IMPACT = {"material": "brass", "radius": "2 mm", "speed": "1 m/s", "adhesion": "0.1 J/m^2"}
KINDS = {  # words of a call without the option, and the value of every option
    "run impacts": (("run", "steel.toml"), RUN),
    "run a scene": (("run", "scene.toml"), RUN),
    "deck of impacts": (("deck", "steel.toml", "-o", "d"), DECK),
    "deck of a scene": (("deck", "scene.toml", "-o", "d"), DECK),
    "converted deck": (CONVERT, DECK | {"law": "johnson"}),
    "deck of an own template": (("deck", "own.j2", "-o", "d", "--case", "steel.toml"), DECK),
    "predict impacts": (("predict", "steel.toml"), PREDICT | ONE_IMPACT),
    "crosscheck impacts": (("verify crosscheck", "steel.toml"), HOST | {"engine": "embedded", "fresh": None}),
    "motion of impacts": (("verify motion", "steel.toml"), HOST | {"file": "other.toml"}),
    "contacts": (("verify contacts",), {"engine": "yade"} | OUT),
    "one impact": (("predict",), PREDICT | ONE_IMPACT),
    "figures": (("verify figures",), {"pictures": "svg"} | OUT),
    "cost of impacts": (
        ("verify cost", "steel.toml"),
        HOST | {"engine": "embedded", "repetitions": "2", "pictures": "svg"},
    ),
    "stability": (("verify stability",), HOST | {"group": "poisson", "every": "2", "steps": "1000"}),
    "view a scene": (("view", "scene.toml"), {"out": "there.png", "force": None}),
    "soften impacts": (("soften", "steel.toml", "-k", "10"), {"factor": "3", "out": "there.toml", "force": None}),
    "soften a scene": (("soften", "scene.toml", "-k", "10"), {"factor": "3", "out": "there.toml", "force": None}),
    "calibrate from e_n": (("calibrate", "steel.toml", "--e-n", "0.7", "--speed", "2 m/s"), HARDNESS),
    "calibrate from HV": (("calibrate", "steel.toml", "--hv", "300"), HARDNESS),
    "calibrate from HB": (("calibrate", "steel.toml", "--hb", "300"), HARDNESS),
    "calibrate from a scene": (("calibrate", "scene.toml", *TARGET), HARDNESS),
    "doctor": (("doctor",), {}),
    "cite for impacts": (("cite", "steel.toml"), {"engine": "yade", "law": "hertz", "bibtex": None}),
    "cite for a scene": (("cite", "scene.toml"), {"engine": "yade", "law": "hertz", "bibtex": None}),
    "export": (("export liggghts", "-o", "."), {"out": "there", "check": "tree"}),
    "export lammps": (("export lammps", "-o", "plugin"), {"out": "there"}),
    "export yade": (("export yade", "-o", "module"), {"out": "there"}),
    "sweep of impacts": (("sweep", "steel.toml", "--set", "impact.body.radius=1 mm..2 mm:2"), SWEEP),
    "sweep of a scene": (("sweep", "scene.toml", "--set", "scene.gravity=9.81 m/s^2,1.62 m/s^2"), SWEEP),
    "latin hypercube": (("sweep", "steel.toml", "--set", "impact.body.radius=1 mm..2 mm", *HYPERCUBE), SWEEP),
    "status": (("status", "swept"), {"table": None}),
    "rerun": (("verify rerun", "stored/results.h5"), {}),
    "validate": (("verify data",), {"sets": "leeb_G", "engine": "yade", "law": "hertz"} | OUT),
}
OTHERS = ["d/in.impact", "d/in.scene", "d/own", "d/my.in", "settle_glass.png", "runs/figures/figure_8_16.png"]
OTHERS += ["runs/steel_wall/cost/cost.csv", "runs/validate/measured.csv", "runs/stability/stability.csv"]
IMPACTS_ONLY = ("predict", "verify cost", "verify crosscheck", "verify motion", "calibrate")


def options(command: str) -> dict[str, str]:
    """Long names of a command's options by parameter, without --json and --help."""
    parameters = [p for p in COMMANDS[command].params if p.param_type_name == "option"]
    return {p.name: p.opts[0] for p in parameters if p.opts[0] not in ("--json", "--help")}


def test_the_table_names_every_command_and_every_option():
    assert {words[0] for words, _ in KINDS.values()} == set(COMMANDS)
    for kind, (words, values) in KINDS.items():
        assert set(options(words[0])) == set(values), kind


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """A small outcome of each study."""
    path = tmp_path_factory.mktemp("outcomes") / "steel.toml"
    path.write_text(FAST)
    many = FAST.replace('["1 m/s"]', '{ from = "0.1 m/s", to = "1 m/s", count = 12 }')
    twelve = path.with_name("twelve.toml")
    twelve.write_text(many)
    return {
        "run": impacts_run.run(twelve, engines=[engine("embedded")], out=path.parent / "run"),
        "cost": cost.run(path, engines=["embedded"], laws=[], steps=(30, 100), repetitions=1),
        "stability": stability.run(["embedded"], ["hertz"], groups=["poisson"]),
    }


@pytest.fixture
def library(tmp_path, monkeypatch, outcomes):
    """The arguments that reached a study or a run."""
    reached = []

    def record(module, name, result=None):
        def replacement(*words, progress=None, report=None, **named):
            reached.append((name, words, named))
            if result is None:
                raise CaseError("recorded")
            return result

        monkeypatch.setattr(module, name, replacement)

    record(impacts_run, "run", outcomes["run"])
    record(pages, "write_page", Path("page.html"))
    record(scenes_run, "run", SimpleNamespace(passed=True))
    record(summary, "shown", ())
    record(summary, "document", {})
    record(crosscheck, "crosscheck")
    record(motions, "compare")
    record(contacts, "compare")
    record(cost, "run", outcomes["cost"])
    record(stability, "run", outcomes["stability"])
    record(figures, "draw_all", [Path("drawn.png")])
    record(sweep_run, "run")
    record(fit, "fit")
    record(validate, "validate")
    return reached


def evidence(words, folder, library, capsys, monkeypatch, in_the_way=()):
    """All that a call does, begun in a folder with the same files; those `in_the_way` are the user's."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    monkeypatch.chdir(folder)
    (folder / "steel.toml").write_text(FAST)
    (folder / "other.toml").write_text(FAST.replace("10 mm", "20 mm"))
    (folder / "own.j2").write_text(TEMPLATE)
    (folder / "my.in").write_text(MY_DECK)
    (folder / "points.csv").write_text("impact.body.radius\n3 mm\n")
    if words[0] == "status":
        make_sweep("steel.toml", folder / "swept")
    for name in ("steel_soft10.toml", "scene_soft10.toml", *in_the_way):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("of the user")
    shutil.copy(CASES / "settle_glass.toml", folder / "scene.toml")
    library.clear()
    done = call(words, capsys, monkeypatch)
    return done, list(library)


@pytest.mark.parametrize("kind", KINDS)
def test_every_option_is_obeyed_or_refused(kind, tmp_path, library, capsys, monkeypatch):
    words, values = KINDS[kind]
    unforced = evidence(words, tmp_path / "x", library, capsys, monkeypatch)
    assert not values or unforced[0].code == 0 or unforced[1] or words[0] == "soften"
    for option, flag in options(words[0]).items():
        others = OTHERS if option == "force" else ()
        plain, reached = evidence(words, tmp_path / "x", library, capsys, monkeypatch, others) if others else unforced
        value = values[option]
        if value is None and flag in words:
            continue
        more = [*words, flag, *([] if value is None else [value])]
        done, now = evidence(more, tmp_path / "x", library, capsys, monkeypatch, others)
        if done.code == 2 and not now:
            named = flag in done.err or (option == "points" and value in done.err)
            *before, _ = done.err.splitlines()
            assert named and all(line.startswith("warning: ") for line in before), flag
            assert {name for name, _ in done.files} <= {name for name, _ in plain.files}, flag
        else:
            assert (done, now) != (plain, reached), f"{flag} changes nothing"


@pytest.mark.parametrize("command", IMPACTS_ONLY)
def test_a_command_for_impacts_says_that_it_takes_no_scene(command, tmp_path, library, capsys, monkeypatch):
    words = [command, "scene.toml", *(["--hv", "300"] if command == "calibrate" else [])]
    monkeypatch.undo()
    done, _ = evidence(words, tmp_path / "x", library, capsys, monkeypatch)
    assert done.code == 2 and "scene.toml is a bulk scene" in done.err and "take scenes" in done.err
