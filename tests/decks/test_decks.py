# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks are words around numbers that Python decided: stored renderings, full precision, nothing undefined."""

from dataclasses import replace
from pathlib import Path

import jinja2
import pytest

from epdem import __version__
from epdem.base import rendering as deck
from epdem.case.impact import parse
from epdem.case.scene import is_scene
from epdem.case.scene import load as load_scene
from epdem.case.scene import parse as parse_scene
from epdem.case.toml import read_toml
from epdem.engines.lammps import deck as lammps_scene
from epdem.engines.liggghts import deck as scene_deck
from epdem.engines.liggghts.engine import Liggghts
from epdem.engines.yade import deck as yade_scene
from epdem.engines.yade.engine import Yade
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.jobs.engine import check
from epdem.scenes.plan.plan import plan as scene_plan
from stored_decks import CASES, SPHERE, compare, planned

HERE = Path(__file__).parent
SCENES = [p for p in sorted(CASES.glob("*.toml")) if is_scene(read_toml(p))]
VARIANTS = {
    "wall_thornton": ({}, None),
    "wall_hertz": ({}, "hertz"),
    "wall_cavity": ({}, "cavity"),
    "rigid_wall": ({"target": {"material": "rigid"}}, None),
    "unequal_spheres": (SPHERE, None),
}
PARTS = ("header.j2", "macros.j2", "scene_macros.j2")  # of other templates


@pytest.mark.parametrize("name", VARIANTS)
def test_the_deck_is_as_stored(name, tmp_path):
    Liggghts().write(planned(*VARIANTS[name]), tmp_path)
    compare(HERE, name, (tmp_path / "in.impact").read_text())


def test_the_deck_of_impacts_in_yade_is_as_stored(tmp_path):
    Yade().write(planned({}), tmp_path)
    compare(HERE, "yade_wall", (tmp_path / "impact.py").read_text())


@pytest.mark.parametrize("name", ["settle_glass", "compaction_powder"])
def test_the_deck_of_a_scene_in_yade_is_as_stored(name):
    compare(HERE, f"yade_{name}", yade_scene.files(scene_plan(load_scene(CASES / f"{name}.toml")))["scene.py"])


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_the_deck_of_a_scene_is_as_stored(path):
    texts = scene_deck.files(scene_plan(load_scene(path)))
    compare(HERE, path.stem, texts["in.scene"] + texts["setup.in"])


@pytest.mark.parametrize("name", ["drum_beads", "hopper_beads", "compaction_powder"])
def test_the_deck_of_a_scene_in_lammps_is_as_stored(name):
    compare(HERE, f"lammps_{name}", lammps_scene.files(scene_plan(load_scene(CASES / f"{name}.toml")))["in.scene"])


def test_the_deck_of_a_scene_of_parts_in_yade_is_as_stored():
    """Facets, motions of each kind, a phase of another time step that a condition ends, a late fill, loads, power."""
    data = read_toml(CASES / "sieve_cylinder.toml")
    scene, sides = data["scene"], {"kind": "plate", "axis": "z", "size": ["9 mm", "9 mm"], "material": "steel"}
    del data["viscous"]
    scene["wall"] += [sides | {"name": name, "center": ["0 mm", "0 mm", "58 mm"]} for name in ("lid", "sieve")]
    shake = {"wall": "sieve", "kind": "vibrate", "amplitude": ["0 m", "0 m", "1 mm"], "frequency": "50 Hz"}
    down = {"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "-0.01 m/s"]}
    turn = {"wall": "cylinder", "kind": "rotate", "axis": [0.0, 0.0, 1.0], "rate": "-2 rad/s"}
    work = {"name": "work", "duration": "1 ms", "time_step": "1e-6 s", "until": {"kinetic_energy": "1 nJ"}}
    scene["phase"] += [work | {"move": [shake, down, turn]}]
    scene["fill"] += [scene["fill"][0] | {"name": "more", "count": 3, "phase": "work"}]
    scene["fill"][-1].pop("mass", None)
    texts = yade_scene.files(scene_plan(parse_scene(data, CASES / "sieve_cylinder.toml")))
    compare(HERE, "yade_moving_parts", texts["scene.py"])


def test_the_deck_of_a_scene_of_moving_parts_is_as_stored():
    """Spheres of a table, one that comes later, a gate, motions of each kind, a phase that ends by a condition."""
    path = CASES / "impactor_bowl.toml"
    data = read_toml(path)
    scene, plate = data["scene"], {"kind": "plate", "axis": "z", "size": ["9 mm", "9 mm"], "material": "steel"}
    held = {"name": "held", "phase": "pour", "velocity": ["0 m/s"] * 3, "frozen": True}
    scene["body"].append(scene["body"][0] | held)
    del scene["body"][1]["phase"]
    scene["wall"] += [plate | {"name": name, "center": ["0 mm", "0 mm", "25 mm"]} for name in ("lid", "press")]
    scene["wall"].append({"name": "gate", "kind": "plane", "axis": "z", "at": "-9 mm", "material": "steel"})
    scene["wall"][-1]["phases"] = ["pour"]
    shake = {"wall": "lid", "kind": "vibrate", "amplitude": ["0 m", "0 m", "1 mm"], "frequency": "50 Hz"}
    turn = {"wall": "bowl", "kind": "rotate", "axis": [0.0, 0.0, 1.0], "rate": "-2 rad/s"}
    down = {"wall": "tube", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "0.01 m/s"]}
    hold = {"wall": "press", "kind": "press", "direction": [0.0, 0.0, -1.0], "force": "1 N", "highest_speed": "1 cm/s"}
    scene["phase"][0] |= {"until": {"kinetic_energy": "1 nJ"}, "move": [shake, turn]}
    scene["phase"][1] |= {"time_step": "1e-5 s", "move": [down, hold]}
    data["output"] |= {"energy": False}
    texts = scene_deck.files(scene_plan(parse_scene(data, path)))
    compare(HERE, "moving_parts", texts["in.scene"] + texts["setup.in"])


def test_the_spheres_of_a_file_are_as_stored(tmp_path):
    rows = "x,y,z,radius,material,vz\n0,0,0.02,0.001,powder,-1\n0.004,0,0.01,0.0015,powder,0\n"
    (tmp_path / "spheres.csv").write_text(rows)
    data = read_toml(CASES / "sieve_cylinder.toml")
    data["scene"]["fill"] = [{"name": "table", "file": str(tmp_path / "spheres.csv")}]
    texts = scene_deck.files(scene_plan(parse_scene(data, CASES / "sieve_cylinder.toml")))
    compare(HERE, "spheres_of_a_file", texts["spheres.data"])


def test_the_deck_of_a_continued_scene_is_as_stored():
    d = scene_deck.deck(scene_plan(load_scene(CASES / "compaction_powder.toml")))
    d = replace(d, from_restart="restart.31200.bin", resumed_phase=1)
    compare(HERE, "compaction_powder_resumed", deck.render("liggghts/scene_resume.in.j2", deck=d))


def test_every_template_has_a_stored_rendering():
    """Known by its longest line without a name or a condition."""
    stored = [path.read_text() for path in HERE.parent.rglob("stored/*.in")]
    templates = [p for p in (HERE.parents[1] / "templates").rglob("*.j2") if p.name not in PARTS]
    templates = [p for p in templates if p.parent.name not in ("report", "kinds")]
    assert len(templates) >= 10
    for path in templates:
        longest = max((line for line in path.read_text().splitlines() if "{" not in line), key=len)
        assert any(longest in text for text in stored), path


def test_a_title_cannot_add_a_line_to_a_deck(tmp_path):
    p = planned({})
    x = replace(p.experiment, title="two\nshell touch pwned", source="joined &")
    Liggghts().write(replace(p, experiment=x), tmp_path)
    lines = (tmp_path / "in.impact").read_text().splitlines()
    assert lines[:2] == ["# two shell touch pwned", "# joined"]
    assert (tmp_path / "impact.data").read_text().splitlines()[1] == ""
    assert f"# epdem {__version__}; by hand" in lines[3]
    Yade().write(replace(p, experiment=replace(x, source="shell\rtouch pwned")), tmp_path)
    head = (tmp_path / "impact.py").read_text().split("\n")
    assert head[:2] == ["# two shell touch pwned", "# shell touch pwned"]
    assert head[3].startswith(f"# epdem {__version__}; by hand, in this folder: ")


def test_numbers_keep_all_their_digits(tmp_path):
    p = planned({})
    Liggghts().write(p, tmp_path)
    words = (tmp_path / "in.impact").read_text().split()
    assert float(words[words.index("timestep") + 1]) == p.time_step
    rows = (tmp_path / "impact.data").read_text().split("Velocities\n\n")
    assert [-float(r.split()[3]) for r in rows[1].splitlines()] == list(p.speed)
    z = [float(r.split()[6]) for r in rows[0].split("Atoms\n\n")[1].splitlines() if r]
    assert z == [0.01 + g for g in p.gap]


def test_the_centre_of_mass_of_two_spheres_rests(tmp_path):
    p = planned(SPHERE)
    Liggghts().write(p, tmp_path)
    v = [float(r.split()[3]) for r in (tmp_path / "impact.data").read_text().split("Velocities\n\n")[1].splitlines()]
    x = p.experiment
    for body, target, speed in zip(v[: p.n], v[p.n :], p.speed, strict=True):
        assert body * x.body.mass + target * x.target.mass == pytest.approx(0, abs=1e-15 * abs(body) * x.body.mass)
        assert target - body == pytest.approx(speed, rel=1e-15)


def test_an_undefined_name_in_a_template_stops_with_its_name(tmp_path, monkeypatch):
    (tmp_path / "bad.j2").write_text("timestep {{ deck.tmestep }}\n")
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(tmp_path), undefined=jinja2.StrictUndefined)
    monkeypatch.setattr(deck, "environment", lambda **words: environment)
    with pytest.raises(CaseError, match=r"bad\.j2.*tmestep"):
        deck.render("bad.j2", deck={})


def test_a_negative_poisson_ratio_is_refused_for_liggghts_only():
    data = read_toml(CASES / "steel_wall.toml")
    data["materials"]["steel"]["poisson_ratio"] = -0.2
    x = experiment(parse(data, "test"))
    with pytest.raises(CaseError, match="use --engine embedded or yade or lammps"):
        check(Liggghts(), plan(x, predict(x)))


def test_templates_hold_no_arithmetic():
    """But kinds of scenes, which are formulas of their keys."""
    templates = [p for p in (HERE.parents[1] / "templates").rglob("*.j2") if p.parent.name != "kinds"]
    assert len(templates) >= 6
    for path in templates:
        for expression in path.read_text().split("{{")[1:]:
            inside = expression.split("}}")[0]
            assert not set(inside.split('"')[0]) & set("*/+"), f"{path.name}: {{{{{inside}}}}}"
