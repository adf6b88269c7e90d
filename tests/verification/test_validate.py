# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured sets against laws: numbers by closed forms, provenance, and what the summary says of known errors."""

import math

import pandas as pd
import pytest

from epdem.base import paths
from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.verification import measured_data as validate

E_STAR = 1.0 / ((1 - 0.22**2) / 600e9 + (1 - 0.3**2) / 208e9)
P_Y = 955 * 9.80665e6 * 2 / 1.8544  # of Vickers' hardness 955: load over the projection of the indentation


def thornton(ratio):
    """e_n at r = v_y/v (eq. 8.83)."""
    r = ratio
    head = math.sqrt(6 * math.sqrt(3) / 5) * math.sqrt(1 - r**2 / 6)
    return head * (r / (r + 2 * math.sqrt(6 / 5 - r**2 / 5))) ** 0.25


@pytest.mark.parametrize("tool", ["embedded", pytest.param("liggghts", marks=pytest.mark.liggghts)])
def test_the_error_of_a_set_is_that_of_the_closed_form(tool, tmp_path):
    found = validate.validate(sets=["leeb_D"], engines=[tool], chosen=["thornton"], out=tmp_path / "out").points
    point = found[found["quantity"] == "e_n"].iloc[0]
    radius, mass = 1.5e-3, 5.5e-3
    v_y = (math.pi / (2 * E_STAR)) ** 2 * math.sqrt(8 * math.pi * radius**3 * P_Y**5 / (15 * mass))
    assert point["error"] == pytest.approx(thornton(v_y / 2.0) / 0.890 - 1, abs=1e-4)


def test_a_dent_without_plasticity_is_hertzs_circle(tmp_path):
    found = validate.validate(sets=["leeb_C"], engines=["embedded"], chosen=["hertz"], out=tmp_path / "out").points
    radius, energy = 1.5e-3, 0.5 * 3.0e-3 * 1.342**2
    overlap = (energy * 15 / (8 * E_STAR * math.sqrt(radius))) ** 0.4  # W = 8/15 E* sqrt(R) alpha^(5/2)
    assert found["found"].to_numpy() == pytest.approx(2 * math.sqrt(radius * overlap), rel=1e-4)
    assert found["measured"].tolist() == [0.38e-3, 0.32e-3]


def test_the_summary_has_the_median_and_the_signed_largest_error():
    errors = pd.DataFrame(
        {"set": "s", "law": "l", "engine": "e", "quantity": ["a", "b", "c"], "error": [0.1, -0.4, 0.2]}
    )
    (row,) = validate.summary(errors).to_dict("records")
    assert (row["points"], row["median"], row["largest"], row["signed"], row["where"]) == (3, 0.2, 0.4, -0.4, "b")
    assert validate.shown(pd.DataFrame([row]))["largest error"][0] == "-40.0% (b)"


def test_laws_that_lack_their_numbers_are_named_and_the_others_run(tmp_path):
    found = validate.validate(sets=["hutchings_1979"], engines=["embedded"], out=tmp_path / "out")
    assert set(found.absent) == {"jkr", "thornton_ning"} and all("surface_energy" in r for r in found.absent.values())
    assert set(found.points["law"]) == {"hertz", "thornton", "johnson", "cavity"}
    assert found.points.set_index("law")["found"]["cavity"] == pytest.approx(0.462, abs=5e-4)  # docs/laws.md


def test_a_set_without_its_source_is_refused(tmp_path, monkeypatch):
    text = (paths.data() / "restitution/leeb_D.csv").read_text()
    (tmp_path / "restitution").mkdir()
    (tmp_path / "restitution/bare.csv").write_text("".join(x for x in text.splitlines(True) if "# source" not in x))
    monkeypatch.setattr(paths, "data", lambda: tmp_path)
    with pytest.raises(CaseError, match=r"bare\.csv: the head lacks source"):
        validate.read("bare")
    (tmp_path / "restitution/odd.csv").write_text(text.replace("e_n,0.890", "e_t,0.890"))
    with pytest.raises(CaseError, match=r"odd\.csv: unknown column or quantity"):
        validate.read("odd")


def test_the_width_of_a_dent_is_asked_of_laws_without_adhesion():
    data = read_toml(paths.cases() / "adhesion_thornton_1998.toml")
    with pytest.raises(CaseError, match="the width of a dent under adhesion is not computed"):
        validate._simulated(experiment(parse(data)), pd.Series({"overlap_max": 1e-9}), "dent")
