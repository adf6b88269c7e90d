# SPDX-License-Identifier: GPL-2.0-or-later
"""What yields is named by what decides the strength of a pair: a material, or the law's strength of all bodies."""

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from epdem.base.declarations import declarations
from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict
from epdem.impacts.prediction_report import yielding

STEEL = Path(__file__).parents[2] / "cases/steel_wall.toml"
STRENGTHS = {name: law.strength for name, law in declarations().items() if law.strength and not law.adheres}


def said(law, stresses, absolute=None, **tables):
    """The sentence of fast impacts of a ball on a plate, of these yield stresses [MPa]."""
    data = read_toml(STEEL)
    steel = data["materials"]["steel"]
    names = [n for n in ("ball", "plate") if n in stresses]
    data["materials"] = {n: steel | {"yield_stress": f"{stresses[n]} MPa"} for n in names}
    target = {"material": "plate" if "plate" in stresses else "ball"}
    data["impact"] |= {"body": {"radius": "10 mm", "material": "ball"}, "target": target, "speeds": ["20 m/s"]}
    data["law"] = {"name": law} | ({STRENGTHS[law]: f"{absolute} MPa"} if absolute else {})
    return yielding(predict(experiment(parse(data | tables, "test"))))


@given(
    law=st.sampled_from(sorted(STRENGTHS)),
    stresses=st.fixed_dictionaries({"ball": st.integers(100, 1000), "plate": st.integers(100, 1000)}),
    absolute=st.none() | st.integers(100, 1000),
    rated=st.booleans(),
)
def test_what_yields_is_what_decides_the_strength(law, stresses, absolute, rated):
    tables = {"rate": {"sensitivity": 0.01}} if rated else {}
    least = [name for name in ("ball", "plate") if stresses[name] == min(stresses.values())]
    expected = f"the pair yields at law.{STRENGTHS[law]}" if absolute else f"yields: {', '.join(least)}"
    assert said(law, stresses, absolute, **tables) == expected


def test_one_material_is_named_once():
    assert said("thornton", {"ball": 300}) == "yields: ball"
