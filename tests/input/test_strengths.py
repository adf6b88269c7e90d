# SPDX-License-Identifier: GPL-2.0-or-later
"""The strength of a material as users know it: a hardness or the overlap at first yield."""

import math
from pathlib import Path

import numpy as np
import pytest

from epdem.base.declarations import declarations
from epdem.case import impact, scene
from epdem.case.keys import keys_of
from epdem.case.plausibility import case_warnings
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict
from epdem.scenes.plan.model import strengths
from epdem.studies.soften import soften
from epdem.studies.sweep import points

CASES = Path(__file__).parents[2] / "cases"
STEEL = CASES / "steel_wall.toml"
E, NU, R = 208e9, 0.3, 0.01
LIKE = E / (2 * (1 - NU**2))  # E* of two like bodies


def data_with(strength, law):
    """The steel case with these keys of its strength."""
    data = read_toml(STEEL)
    material = {key: value for key, value in data["materials"]["steel"].items() if key != "yield_stress"}
    return data | {"materials": {"steel": material | strength}, "law": {"name": law}}


def strength_of(strength, law):
    return experiment(impact.parse(data_with(strength, law))).law.strengths[0]


def test_a_material_of_impacts_has_the_strength_of_the_law_as_in_scenes():
    data = data_with({"yield_pressure": "2.5 GPa"}, "thornton")
    case = impact.parse(data)
    assert experiment(case).law.strengths[0] == 2.5e9 and experiment(case, "hertz").law.strengths[0] == math.inf
    with pytest.raises(CaseError, match="law johnson needs the yield_stress"):
        experiment(case, "johnson")
    with pytest.raises(CaseError, match="yield_presure = '1 Pa', unknown key with law thornton; the nearest: yield"):
        impact.parse(data_with({"yield_presure": "1 Pa"}, "thornton"))
    assert "materials.steel.yield_pressure" in keys_of(data) and "materials.steel.hardening" not in keys_of(data)


@pytest.mark.parametrize("law", ["thornton", "cavity"])
def test_a_material_that_never_yields_needs_no_number(law):
    """Its strain is that of the other body alone; as with a strength that no pressure reaches."""
    data = data_with({"yield_stress": "1 GPa"}, law)
    for name, strength in (("hard", "inf Pa"), ("strong", "1e15 Pa")):
        data["materials"][name] = data["materials"]["steel"] | {"yield_stress": strength}
    x, other = (
        experiment(impact.parse(data | {"impact": data["impact"] | {"target": {"material": name}}}))
        for name in ("hard", "strong")
    )
    assert x.law.strengths[1] == math.inf and x.law.share == pytest.approx(1.0) == other.law.share
    assert predict(x).e_n == pytest.approx(predict(other).e_n, rel=1e-9)
    assert case_warnings(impact.parse(data)) == [] or "hard" not in case_warnings(impact.parse(data))[0]


def pressure_in_the_middle(overlap):
    """The largest pressure [Pa] of Hertz's contact of two steel spheres at an overlap [m]: 2 E* a/(pi R*)."""
    return 2 * LIKE * math.sqrt(R / 2 * overlap) / (math.pi * R / 2)


@pytest.mark.parametrize(
    ("law", "expected"),
    [
        ("thornton", lambda overlap: pressure_in_the_middle(overlap)),
        ("meyer", lambda overlap: pressure_in_the_middle(overlap)),
        ("thornton_ning", lambda overlap: pressure_in_the_middle(overlap)),
        ("johnson", lambda overlap: pressure_in_the_middle(overlap) / 3),  # half of the mean pressure: the area doubles
        ("cavity", lambda overlap: pressure_in_the_middle(overlap) / 1.6),
        ("cavity_adhesive", lambda overlap: pressure_in_the_middle(overlap) / 1.6),
    ],
)
def test_two_spheres_first_yield_at_the_overlap_of_the_yield_ratio_times_their_diameter(law, expected):
    data = data_with({"yield_ratio": 1e-4}, law)
    if law in ("thornton_ning", "cavity_adhesive"):
        data["law"]["work_of_adhesion"] = "0 J/m^2"
    found = experiment(impact.parse(data)).law.strengths[0]
    assert found == pytest.approx(expected(1e-4 * 2 * R), rel=1e-12)


def test_the_hardness_of_nanoindentation_is_the_mean_pressure_of_the_law_in_that_test():
    """thornton: F = pi a^2 p_y - pi a_y^2 p_y/3 at a/R = tan 19.7 degrees, the cone of a pyramid."""
    p_y = strength_of({"hardness": "3 GPa"}, "thornton")
    a_y = math.pi * p_y / (2 * E / (1 - NU**2))  # of R* = 1, rigid indenter
    assert p_y * (1 - (a_y / math.tan(math.radians(19.7))) ** 2 / 3) == pytest.approx(3e9, rel=1e-9)
    assert strength_of({"hardness": "3 GPa"}, "johnson") == pytest.approx(3e9, rel=1e-12)
    assert strength_of({"hardness": "3 GPa"}, "cavity") == pytest.approx(3e9 / 2.8, rel=1e-9)  # below E/101


def test_vickers_number_is_load_over_facets_and_the_pressure_load_over_projection():
    slant_height = 0.5 / math.sin(math.radians(136 / 2))  # of the facets of an indentation with a square of edge 1
    pressure = 180 * 9.80665e6 * 4 * slant_height / 2
    assert strength_of({"hardness": "180 HV"}, "johnson") == pytest.approx(pressure, rel=2e-5)  # 1.8544: five digits


@pytest.mark.parametrize("law", sorted(n for n, law in declarations().items() if law.strength and not law.adheres))
@pytest.mark.parametrize("strength", [{"hardness": "6 GPa"}, {"yield_ratio": 2e-4}])
def test_the_softened_twin_keeps_e_n(law, strength, tmp_path):
    path, soft = tmp_path / "case.toml", tmp_path / "soft.toml"
    text = STEEL.read_text().replace('yield_stress = "1.0 GPa"', "\n".join(f"{k} = {v!r}" for k, v in strength.items()))
    path.write_text(text.split("[law]")[0] + f'[law]\nname = "{law}"\n')
    soft.write_text(soften(path, 100.0).text)
    hard, now = (predict(experiment(impact.load(p))).e_n for p in (path, soft))
    assert np.abs(now / hard - 1).max() < 1e-9 and hard.min() < 0.9


def test_materials_of_scenes_have_these_keys_and_the_materials_file_gives_way():
    data = read_toml(CASES / "settle_glass.toml")
    data["materials"]["glass"] = {"from": "glass", "hardness": "5 GPa"}
    data["law"] = {"name": "johnson"}
    assert strengths(scene.parse(data))["glass"] == pytest.approx(5e9, rel=1e-12)


def test_a_sweep_sets_a_hardness_in_place_of_the_yield_stress():
    data = read_toml(STEEL)
    keys = keys_of(data)
    values = points.axes({"materials.steel.hardness": "2 GPa..3 GPa:2"}, keys)["materials.steel.hardness"].values()
    points.assign(data, "materials.steel.hardness", values[1])
    assert data["materials"]["steel"]["hardness"] == "3 GPa" and "yield_stress" not in data["materials"]["steel"]
    assert experiment(impact.parse(data)).law.strengths[0] == pytest.approx(
        strength_of({"hardness": "3 GPa"}, "thornton")
    )
