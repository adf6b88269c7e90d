# SPDX-License-Identifier: GPL-2.0-or-later
"""The largest strain of the contacts of a scene, w a/R* and w overlap/R*: in rows, warnings and on the page."""

import pytest
from parts_cases import CASES, FLOOR, parts
from scene_runs import run, write_case

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.impacts.prediction import predict
from epdem.report.pages import scene_sentences as sentences
from epdem.scenes.plan.quantities import STRAINS
from epdem.scenes.plan.timestep import impact

ENGINES = [pytest.param("liggghts", marks=pytest.mark.liggghts), pytest.param("yade", marks=pytest.mark.yade("module"))]


def one_impact(law: str, speed: float) -> dict:
    """A sphere of glass that hits the floor after 1 ms; the contact lasts less than the only row after it."""
    ball = {"name": "ball", "material": "glass", "radius": "2 mm", "velocity": ["0 m/s", "0 m/s", f"-{speed} m/s"]}
    ball |= {"position": ["0 mm", "0 mm", f"{2 + speed} mm"]}
    data = parts(wall=[FLOOR], fill=[], body=[ball], gravity="0 m/s^2", phase=[{"name": "hit", "duration": "8 ms"}])
    return data | {"law": {"name": law}, "output": {"rows": 1, "particles": 1}, "numerics": {"time_step": "1e-6 s"}}


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("law", "speed"), [("hertz", 2), ("thornton", 2), ("johnson", 0.5), ("cavity", 2)])
def test_an_impact_between_two_rows_has_the_largest_strain_of_theory(tmp_path, engine, law, speed):
    data = one_impact(law, speed)
    outcome = run(write_case(data, tmp_path), engine, out=tmp_path / "out")
    hit = predict(impact(parse(data), "glass", 2e-3, "steel", float(speed)))
    rows, share = outcome.results.rows, 0.5 if law == "hertz" else 1.0  # the floor is 20 times as strong
    assert rows[STRAINS[0]].to_list() == pytest.approx([0.0, hit.strain[-1]], rel=2e-3)
    assert rows[STRAINS[1]].to_list() == pytest.approx([0.0, share * hit.overlap_max[-1] / 2e-3], rel=4e-3)
    said = [warning for warning in outcome.warnings if "the strain w a/R*" in warning]
    assert len(said) == (hit.strain[-1] > 0.2)
    assert f"a strain w a/R* of {rows[STRAINS[0]].iloc[-1]:.3g}" in " ".join(sentences(outcome))


@pytest.mark.liggghts
def test_a_press_that_goes_beyond_small_strain_says_so_however_slow_it_is(tmp_path):
    data = read_toml(CASES / "compaction_powder.toml")
    data["scene"] |= {"box": ["0.5 mm", "0.5 mm", "0.8 mm"], "count": 80, "height": "0.21 mm", "speed": "1 m/s"}
    data["output"] |= {"rows": 20, "particles": 10}
    outcome = run(write_case(data, tmp_path), out=tmp_path / "out")
    (said,) = [warning for warning in outcome.warnings if "the strain w a/R*" in warning]
    largest = outcome.results.rows[STRAINS[0]].iloc[-1]
    assert largest > 0.3 and f" reaches {largest:.2f}, above 0.3 in up to " in said
    assert said.endswith("pressures and springback deviate from finite elements (docs/press.md)")
    contacts, spheres = outcome.results.contacts, outcome.results.particles
    R_star = spheres["radius"].iloc[0] / (1.0 + (contacts["wall"] == ""))
    digits = 1 + 1e-4  # while a contact unloads, its spheres grow by their other contacts
    assert (0.5 * contacts["dent_radius"] / R_star).max() <= largest * digits  # one material: w = 1/2
    assert (0.5 * contacts["delta_max"] / R_star).max() <= outcome.results.rows[STRAINS[1]].iloc[-1] * digits
