# SPDX-License-Identifier: GPL-2.0-or-later
"""A press before a run and after one made by hand: decks, stages, their checks and warnings; no engine runs."""

import math
import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from stored_runs import CASES
from test_press import COUNT, HEIGHT, RADIUS, SIDE, press, without

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines import scene_engine
from epdem.errors import CaseError
from epdem.scenes.judge import checks, summary
from epdem.scenes.judge.warnings import planned_warnings, press_warnings
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables import stages
from epdem.studies.sweep.table import numbers_of, unit


def of_length(factor):
    """The press with all lengths multiplied: a room that begins at z = 0 and ends at 1.05 of the height."""
    data = press(box=[f"{factor * SIDE} m"] * 2, height=f"{factor * HEIGHT} m", speed=f"{3 * factor} m/s")
    data["scene"]["particles"] = [{"material": "powder", "radius": f"{factor * RADIUS} m"}]
    return plan(parse(data))


def test_a_punch_that_liggghts_takes_for_an_empty_mesh_is_refused_in_a_sentence():
    """LIGGGHTS 3.8 refuses meshes whose largest and smallest coordinate differ by less than 1e-4 (m, here)."""
    smallest = 1e-4 / (HEIGHT + 0.5 * SIDE)  # the punch at the start reaches from x = -side/2 to z = height
    scene_engine("liggghts").check(of_length(1.01 * smallest))
    with pytest.raises(CaseError, match=r"scene.wall.punch: its coordinates span 9.9e-05 m, .* lengths 1000 times"):
        scene_engine("liggghts").check(of_length(0.99 * smallest))


def test_a_fast_press_and_spheres_behind_the_punch_are_told():
    """v/h d sqrt(rho/P) of the second stage by hand; a frame in which one of two spheres is above the punch."""
    p = plan(parse(without(press(periodic=True), "hold")))
    ends = [phase.end for phase in p.phases]
    stage = {"phase": ["stage2"], "step": [ends[1]], "pressure": [40e6], "height": [0.4e-3]}
    stage |= {"error": [0.004], "asked": [40e6], "reached": [40e6], "relative_density": [0.89]}
    spheres = {"step": [ends[1]] * 2, "x": [0.0] * 2, "y": [0.0] * 2, "z": [0.1e-3, 0.41e-3]}
    tables = {"stages": pd.DataFrame(stage), "particles": pd.DataFrame(spheres)}
    number = 3.0 / 0.4e-3 * 2 * RADIUS * math.sqrt(8960 / 40e6)
    fast, behind = press_warnings(p, tables)
    assert f"phase stage2: the inertial number v/h d sqrt(rho/P) is {number:.2g}, above 0.001" in fast
    assert f"{3.0 * 1e-3 / number:.2g} m/s is slow enough" in fast
    assert behind.startswith("1 spheres have passed wall punch")
    data = without(press(periodic=True), "hold")
    data["materials"]["heavy"] = data["materials"]["powder"] | {"density": "17920 kg/m^3"}
    data["scene"]["particles"] = [{"material": name, "radius": "50 um", "share": 0.5} for name in ("powder", "heavy")]
    both = stages.inertial_numbers(plan(parse(data)), tables["stages"])
    assert both.to_list() == pytest.approx([math.sqrt(2.0) * number], rel=1e-12)
    near = press_warnings(p, tables | {"stages": tables["stages"].assign(error=0.006, relative_density=0.91)})
    assert near[0].startswith("phase stage2: 40.24 MPa, +0.60% beside the 40 MPa asked for; press slower")
    assert near[1].startswith("phase stage2: the relative density is 0.91, and above 0.9 no contact law")
    slow = replace(p, phases=tuple(p.phases[:1]))
    assert press_warnings(slow, {"stages": tables["stages"].assign(phase="release1")}) == []


def test_walls_of_a_press_that_never_yield_beside_some_spheres_are_told():
    """A body does not yield beside one of less than 1.6/2.8 of its strength: the pressures of first and full yield."""
    data = press(walls="hard")
    both = [{"material": name, "radius": "50 um", "share": 0.5} for name in ("powder", "hard")]

    def said(strength, **scene):
        data["materials"]["hard"] = data["materials"]["powder"] | {"yield_stress": f"{strength} MPa"}
        return planned_warnings(plan(parse(data | {"scene": data["scene"] | scene})))

    for scene in ({}, {"particles": both}):
        (sentence,) = said(176, **scene)
        assert sentence.startswith("walls of 'hard' never yield beside spheres of 'powder'")
        assert "give the walls the material 'powder'" in sentence and said(174, **scene) == []
    assert said(176, particles=both, walls="powder") == []
    assert said(176, particles=[both[1] | {"share": 1.0}]) == []


VOID = "variable void equal "
BETWEEN = [{"eject": "0.1 mm"}, {"double_action": True}]


def evaluated(formula, ways):
    """The value of a formula of a deck where walls have gone these ways along z [m] from their places at the start."""
    for name, way in ways.items():
        formula = formula.replace(f"f_wall_{name}[9]", repr(way)).replace(f"v_wall_{name}_z", repr(way))
    return eval(formula, {"__builtins__": {}})


@pytest.mark.parametrize("more", BETWEEN, ids=["eject", "double_action"])
@pytest.mark.parametrize("engine", ["liggghts", "lammps"])
def test_the_void_of_a_deck_is_that_between_the_two_plates(engine, more):
    files = scene_engine(engine).files(plan(parse(press(stages=["40 MPa"], **more))))
    lines = [x.strip() for text in files.values() for x in text.splitlines() if x.strip().startswith(VOID)]
    assert lines
    solid = COUNT * 4 / 3 * math.pi * RADIUS**3 / SIDE**2
    for line in lines:
        formula = line.removeprefix(VOID).partition("  #")[0]
        found = evaluated(formula, {"punch": -0.5e-3, "floor": 0.3e-3})
        assert found == pytest.approx(HEIGHT - 0.8e-3 - solid, rel=1e-9)


@pytest.mark.parametrize("more", BETWEEN, ids=["eject", "double_action"])
def test_height_and_density_are_those_between_the_two_plates(more):
    """In an ejection the plates keep their distance; with double action each plate goes half of the way."""
    p = plan(parse(without(press(stages=["40 MPa"], **more), "hold")))
    steps = np.arange(0, p.steps + 1, p.every)
    tables = {"rows": pd.DataFrame({"step": steps})}
    found = stages.with_densities(p, tables).set_index("step")
    time = p.time_at(np.maximum(steps - 0.5 * p.every, 0))
    ends = p.phase_table["end_time"].to_numpy()
    away = 0.5 * (np.clip(time, ends[0], ends[1]) - ends[0])
    height = HEIGHT - 3.0 * np.minimum(time, ends[0]) + away
    assert found["height"].to_numpy() == pytest.approx(np.abs(height), rel=1e-6, abs=1e-12)
    volume = COUNT * 4 / 3 * math.pi * RADIUS**3
    assert found["relative_density"].to_numpy() == pytest.approx(volume / (SIDE**2 * np.abs(height)), rel=1e-6)


def test_a_stage_counts_once_the_opposite_plate_bears_a_twentieth_of_it():
    """The value that ends a stage is 0 before: a sphere that strikes the punch alone is no pressure."""
    asked = 40e6 * SIDE**2
    for engine in ("liggghts", "lammps"):
        files = scene_engine(engine).files(plan(parse(press(stages=["40 MPa"]))))
        words = "\n".join(files.values()).partition("variable awaited equal ")[2].partition("\n")[0]
        awaited = words.partition("  #")[0]
        names = dict.fromkeys(re.findall(r"[fvc]_\w+\[\d\]", awaited))
        punch, floor = names
        for share, counts in ((0.049, 0.0), (0.051, 1.0)):
            given = awaited.replace(punch, repr(-1.1 * asked)).replace(floor, repr(share * asked))
            found = eval(given, {"__builtins__": {}, "abs": abs})
            assert found == pytest.approx(counts * 1.1 * asked)


def test_a_stage_beside_its_pressure_is_told_above_half_a_percent_and_fails_above_two():
    p = plan(parse(without(press(periodic=True), "hold")))
    stage = {"phase": "stage2", "step": p.phases[1].end, "asked": 40e6, "pressure": 40e6, "height": 0.4e-3}

    def verdicts(error, density=0.8):
        table = pd.DataFrame([stage | {"error": error, "reached": 40e6 * (1 + error), "relative_density": density}])
        table["springback"] = math.nan
        told = any("asked for" in x for x in press_warnings(p, {"stages": table}))
        rows = pd.DataFrame({"particles": [COUNT]})
        found = checks.checks(p, {"rows": rows, "stages": table}).set_index("key")["passed"]
        assert summary.stages_shown(table)[0]["passed"].item() == (found["stage_pressure"] and found["density"])
        return told, bool(found["stage_pressure"]), bool(found["density"])

    assert verdicts(0.004) == (False, True, True)
    assert verdicts(-0.006) == verdicts(0.019) == (True, True, True)
    assert verdicts(0.021) == verdicts(-0.021) == (True, False, True)
    assert verdicts(0.0, density=0.999) == (False, True, True)
    assert verdicts(0.0, density=1.0) == (False, True, False)


def test_a_sweep_has_the_stages_of_a_press():
    """Measured densities at several pressures are targets of a fit."""
    stages = pd.DataFrame({"phase": ["stage1", "release1"], "time": [1.0, 2.0], "relative_density": [0.56, 0.54]})
    stages["springback"] = [math.nan, 0.02]
    rows = pd.DataFrame({"step": [0, 10], "time": [0.0, 2.0]})
    tables = {"rows": rows, "stages": stages, "checks": pd.DataFrame({"key": [], "value": []})}
    found = numbers_of(SimpleNamespace(tables=tables))
    assert found["stage1_relative_density"] == 0.56 and found["release1_springback"] == 0.02
    assert "stage1_springback" not in found
    data = read_toml(CASES / "press_tablet.toml")
    assert unit("stage1_radial_pressure", data) == "Pa" and unit("release1_springback", data) in (None, "", "1")


def test_a_stage_that_a_bed_without_void_ends_has_its_last_pressure_and_fails():
    p = plan(parse(without(press(periodic=True, double_action=False), "hold")))
    ended = replace(p.phases[0], end=p.every + 7, reached="no void", held=0, value=math.nan, opposite=math.nan)
    p = replace(p, phases=(ended, *(replace(phase, end=p.every + 7) for phase in p.phases[1:])))
    rows = pd.DataFrame({"step": [0, p.every], "pressure": [0.0, 6e6], "floor_pressure": [0.0, 5e6]})
    tables = {"rows": rows.assign(wall_power=0.0, particles=COUNT)}
    tables["stages"] = stages.table(p, tables)
    (stage,) = tables["stages"].to_dict("records")
    assert (stage["reached"], stage["opposite_pressure"], stage["error"]) == pytest.approx((6e6, 5e6, -0.4))
    assert not checks.checks(p, tables).set_index("key")["passed"]["stage_pressure"]
    (said,) = [x for x in press_warnings(p, tables) if "asked for" in x]
    assert said == "phase stage1: 6 MPa, -40.00% beside the 10 MPa asked for"


def test_the_time_step_of_a_press_does_not_follow_the_rows():
    """Loading and release end at their pressures, at a step that both numbers of rows have; no duration is missed."""
    found = []
    for rows in (100, 400):
        data = press()
        data["output"]["rows"] = rows
        p = plan(parse(data))
        found.append([phase.time_step for phase in p.phases if phase.case.condition])
        assert not [warning for warning in planned_warnings(p) if "its time_step is given" in warning]
    assert found[0] == found[1] and len({*found[0]}) == 1
