# SPDX-License-Identifier: GPL-2.0-or-later
"""Nothing stands in a deck that its scene does not need: each line of every case's deck is removed in turn."""

import re
from pathlib import Path

import jinja2
import pytest
from parts_cases import mm
from removals import removals
from scene_runs import write_deck

from epdem.base import rendering
from epdem.base.declarations import declarations
from epdem.case import impact as impacts
from epdem.case.scene import is_scene, parse
from epdem.case.toml import read_toml
from epdem.engines import engine
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.scenes.plan.plan import plan as scene_plan
from marks import thorough
from stored_decks import reasons

CASES = sorted((Path(__file__).parents[2] / "cases").glob("*.toml"))
SCENES = [path for path in CASES if is_scene(read_toml(path))]  # of impacts: tests/decks/test_lean_impacts.py
STRAIGHT = [path for path in SCENES if "stages" not in read_toml(path)["scene"]]  # a run takes one way through `until`

# The same decks with few spheres and steps; every wall is still touched.
SMALL = {
    "settle": {"box": mm(12, 12, 30), "count": 70, "duration": "0.08 s"},
    "compaction": {
        "box": mm(0.5, 0.5, 0.8),
        "count": 60,
        "height": "0.3 mm",
        "speed": "3 m/s",  # and a tenth of it back: at 3 m/s the bed, which is slower, gives no force
    },
    "hopper": {
        "count": 150,
        "bin_height": "20 mm",
        "bin_diameter": "20 mm",
        "outlet": "12 mm",
        "fill_time": "0.03 s",
        "outlet_height": "5 mm",
        "duration": "0.05 s",
    },
    "drum": {"count": 60, "diameter": "30 mm", "length": "5 mm", "duration": "0.12 s"},
    "press": {
        "diameter": "0.5 mm",
        "height": "0.8 mm",
        "count": 70,
        "stages": ["5 MPa", "10 MPa"],
        "speed": "4 m/s",
        "unload_speed": "4 m/s",
    },
    "brazilian": {
        "diameter": "0.5 mm",
        "height": "0.8 mm",
        "thickness": "0.24 mm",
        "count": 60,
        "speed": "4 m/s",
        "unload_speed": "2 m/s",
        "test_speed": "2 m/s",
    },
    "peening": {"count": 40, "width": "4 mm", "duration": "0.5 ms"},
    "parts": {},
}


def small(data: dict) -> dict:
    """The TOML data of a scene with the numbers of SMALL, and a coarse time step: what the lines do, not how well."""
    few = {"output": data.get("output", {}) | {"rows": 20, "particles": 5}, "numerics": {"error": 0.1}}
    scene = data["scene"] | SMALL[data["scene"]["kind"]]
    if "diameter" in scene and "box" in scene:  # a layer of larger spheres, in place of a round die
        del scene["diameter"]
        scene |= {"box": mm(4, 4), "height": "8 mm", "count": 60, "stages": ["20 MPa", "50 MPa"]}
    if "settle_time" in scene:  # finer spheres, which the plate of a wide box would not meet
        scene |= {"settle_time": "1 ms", "box": mm(0.13, 0.13, 0.8), "count": 46, "height": "0.3 mm"}
    if "phase" in scene:
        duration = f"{0.03 / len(scene['phase'])} s"
        scene |= {"phase": [phase | {"duration": duration} for phase in scene["phase"]]}
        few["numerics"] = {"time_step": "1.5e-5 s"}  # the search of a step takes seconds with a dashpot
    return data | {"scene": scene} | few


def decks_of(path: Path, folder: Path) -> tuple[str, list[str]]:
    """Write a case's deck: (file to run, files whose lines are removed)."""
    data = read_toml(path)
    if is_scene(data):
        write_deck(parse(small(data), path), folder)
        return "in.scene", ["in.scene", "setup.in"]
    data = data | {"numerics": {"steps_in_contact": 40, "phases": 2}}  # the same lines, in a tenth of the time
    x = experiment(impacts.parse(data))
    engine("liggghts").write(plan(x, predict(x)), folder)
    return "in.impact", ["in.impact"]


@pytest.mark.liggghts
@pytest.mark.parametrize(
    "path", [thorough(p, unless=p.stem == "peening_steel") for p in STRAIGHT], ids=lambda p: p.stem
)
def test_removing_any_line_of_a_deck_breaks_the_run_or_changes_what_it_puts_out(path, tmp_path):
    run, files = decks_of(path, tmp_path / "deck")
    found = removals(tmp_path / "deck", tmp_path / "without", run, files)
    # no sphere meets a shutter or the screw in this short run; a phase at rest says again that walls have no power
    idle = r"(variable (history|force)\d_|unfix )wall_shutter\b|dump_modify wall_contacts |variable power equal 0.0$"
    # walls have neither bonds nor friction there, and no sphere follows the punch when it leaves
    leaves = r"variable (history26|force[12])_wall_floor |variable power equal -\(f_wall_punch|unfix move_punch$"
    idle += f"|{leaves}" if path.stem == "tablet_strength" else ""
    useless = [r.line for r in found if r.effect == "nothing" and not re.match(idle, r.line)]
    assert not useless, f"{path.name}: lines that do nothing: {useless}"
    assert sum(r.effect == "guard" for r in found) <= 6  # three of them for a body that comes later
    assert len(found) > 8


@pytest.mark.liggghts
def test_a_line_that_does_nothing_is_found(tmp_path):
    run, files = decks_of(next(p for p in CASES if p.stem.startswith("settle")), tmp_path / "deck")
    text = (tmp_path / "deck/setup.in").read_text()
    (tmp_path / "deck/setup.in").write_text(text + "compute idle all ke\n")
    found = removals(tmp_path / "deck", tmp_path / "without", run, ["setup.in"])
    assert [r.line for r in found if r.effect == "nothing"] == ["compute idle all ke"]


def job_of(path: Path):
    """The plan of the deck that `decks_of` writes."""
    data = read_toml(path)
    if is_scene(data):
        return scene_plan(parse(small(data), path))
    x = experiment(impacts.parse(data | {"numerics": {"steps_in_contact": 40, "phases": 2}}))
    return plan(x, predict(x))


@pytest.mark.parametrize("path", CASES, ids=lambda p: p.stem)
def test_every_line_of_a_deck_has_a_reason(path, tmp_path):
    _, files = decks_of(path, tmp_path)
    lines = reasons(job_of(path))
    assert [line for _, line, reason in lines if not reason] == []
    for name in files:  # but for comments it is the deck that is written
        written = [
            x.split("  # ")[0].rstrip() for x in (tmp_path / name).read_text().split("\n") if x[:1] not in ("", "#")
        ]
        assert [line for file, line, _ in lines if file == name] == written
    assert len(lines) > 8


@pytest.mark.parametrize("law", declarations())
def test_every_line_of_a_deck_with_any_law_has_a_reason(law):
    """Walls of another material and parameters of the law that are not its defaults."""
    data = read_toml(CASES[0].parent / "steel_wall.toml")
    parameters = {p.name: 1.1 * p.default or 0.1 for p in declarations()[law].parameters if p.default is not None}
    parameters |= {"work_of_adhesion": "0.5 J/m^2"} if declarations()[law].adheres else {}
    x = experiment(impacts.parse(data | {"law": {"name": law} | parameters}))
    found = reasons(plan(x, predict(x)))
    assert sum("property/global" in line for _, line, _ in found) == 2 + len(declarations()[law].parameters)
    assert [line for _, line, reason in found if not reason] == []


def test_reasons_follow_the_comments_of_a_line_and_a_line_without_one_stays(tmp_path, monkeypatch):
    lines = 'units si  # guard: said\nfix a all nve{{ why("moves") }}\ndump 1  # raw{{ why("read") }}\nrun 3\n'
    (tmp_path / "own.j2").write_text(lines)
    own = jinja2.Environment(loader=jinja2.FileSystemLoader(tmp_path), **rendering.OPTIONS)
    monkeypatch.setattr(rendering, "environment", lambda: rendering.prepare(own))
    assert rendering.render("own.j2") == "units si  # guard: said\nfix a all nve\ndump 1  # raw\nrun 3\n"
    with rendering.with_reasons():
        found = rendering.render("own.j2")
    assert found == "units si  # guard: said\nfix a all nve  # moves\ndump 1  # raw; read\nrun 3\n"
