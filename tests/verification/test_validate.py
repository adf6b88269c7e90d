# SPDX-License-Identifier: GPL-2.0-or-later
"""Measured sets against laws: numbers by closed forms, provenance, and what the summary says of known errors."""

import math

import numpy as np
import pandas as pd
import pytest

from epdem.base import paths
from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.verification import measured_data as validate
from epdem.verification.pages import of_validation
from scripts import DOCS

E_STAR = 1.0 / ((1 - 0.22**2) / 600e9 + (1 - 0.3**2) / 208e9)
P_M = 955 * 9.80665e6 * 2 / 1.8544  # of Vickers' hardness 955: load over the projection of the indentation


def contact_pressure():
    """p_y with which thornton has P_M at a/R* = tan 19.7 degrees in steel: p_m = p_y (1 - a_y^2/(3 a^2))."""
    a_y = math.pi * (1 - 0.3**2) / (2 * 208e9) / math.tan(math.radians(19.7))  # over p_y and a
    roots = np.roots([-(a_y**2) / 3, 0, 1, -P_M])
    return min(r.real for r in roots if abs(r.imag) < 1 and r.real > 0)


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
    v_y = (math.pi / (2 * E_STAR)) ** 2 * math.sqrt(8 * math.pi * radius**3 * contact_pressure() ** 5 / (15 * mass))
    error = thornton(v_y / 2.0) / 0.890 - 1
    assert point["error"] == pytest.approx(error, abs=1e-4)
    assert point["in_uncertainties"] == pytest.approx(error * 0.890 / 0.013, rel=0.01)


def test_the_folder_has_the_points_and_the_page_beside_them(tmp_path):
    found = validate.validate(sets=["leeb_C"], engines=["embedded"], chosen=["hertz"], out=tmp_path / "out")
    of_validation(found)
    table = pd.read_csv(tmp_path / "out/measured.csv", comment="#")
    assert table["in_uncertainties"].to_numpy() == pytest.approx(found.points["in_uncertainties"].to_numpy())


def test_a_dent_without_plasticity_is_hertzs_circle(tmp_path):
    found = validate.validate(sets=["leeb_C"], engines=["embedded"], chosen=["hertz"], out=tmp_path / "out").points
    radius, energy = 1.5e-3, 0.5 * 3.0e-3 * 1.342**2
    overlap = (energy * 15 / (8 * E_STAR * math.sqrt(radius))) ** 0.4  # W = 8/15 E* sqrt(R) alpha^(5/2)
    assert found["found"].to_numpy() == pytest.approx(2 * math.sqrt(radius * overlap), rel=1e-4)
    assert found["measured"].tolist() == [0.38e-3, 0.32e-3, 0.29e-3]


def test_every_printed_row_is_listed_and_rows_that_are_left_out_contradict_their_energy():
    """Table 3 of the manuals: widths [mm] and depths [um] at 300, 600 and 800 HV."""
    table = {"D": [(0.54, 24), (0.54, 17), (0.35, 10)], "C": [(0.38, 12), (0.32, 8), (0.35, 7)]}
    table |= {"G": [(1.03, 53), (0.90, 41)]}
    contradictions = []
    for device, dents in table.items():
        radius = 2.5e-3 if device == "G" else 1.5e-3
        found = validate.read(f"leeb_{device}")
        listed = set(found.points["value"]) | set(found.left_out["value"])
        assert all(round(width * 1e-3, 9) in listed for width, _ in dents) and (found.left_out["left out"] != "").all()
        contradictions += [width * 1e-3 / math.sqrt(8 * radius * depth * 1e-6) - 1 for width, depth in dents]
    rms = math.sqrt(sum(c**2 for c in contradictions) / len(contradictions))
    dents = pd.concat(validate.read(f"leeb_{d}").points for d in table).query("quantity == 'dent_width'")
    assert (dents["uncertainty"] / dents["value"]).round(2).eq(round(rms, 2)).all() and round(rms, 2) == 0.10


def test_the_summary_has_the_median_and_the_signed_largest_error():
    errors = pd.DataFrame(
        {"set": "s", "law": "l", "engine": "e", "quantity": ["a", "b", "c"], "error": [0.1, -0.4, 0.2]}
    ).assign(in_uncertainties=[1.0, -2.0, 2.0])
    (row,) = validate.summary(errors).to_dict("records")
    assert (row["points"], row["median"], row["largest"], row["signed"], row["where"]) == (3, 0.2, 0.4, -0.4, "b")
    assert row["rms_in_uncertainties"] == pytest.approx(math.sqrt(3))


def test_laws_that_lack_their_numbers_are_named_and_the_others_run(tmp_path):
    found = validate.validate(sets=["hutchings_1979"], engines=["embedded"], out=tmp_path / "out")
    reasons = {"jkr": "surface_energy", "thornton_ning": "surface_energy", "meyer": "hardening_exponent"}
    reasons["cavity_adhesive"] = "surface_energy"
    assert set(found.absent) == set(reasons) and all(reasons[law] in text for law, text in found.absent.items())
    assert set(found.points["law"]) == {"hertz", "thornton", "johnson", "cavity"}
    assert found.points.set_index("law")["found"]["cavity"] == pytest.approx(0.462, abs=5e-4)  # docs/laws.md


@pytest.mark.parametrize("name", validate.names())
def test_a_set_has_its_source_and_a_finite_number_in_every_point(name):
    found = validate.read(name)
    assert {"title", "source", "case", "material", "read"} <= set(found.head) and all(found.head.values())
    columns = {"quantity", "value", "uncertainty", "speed", "strength of", found.given}
    assert set(found.points) == columns and set(found.left_out) == {*columns, "left out"}
    assert len(found.points) and set(found.points["quantity"]) <= {"e_n", "dent_width"}
    for column in ("value", "uncertainty", "speed", found.given):
        numbers = found.points[column].to_numpy(float)
        assert np.all(np.isfinite(numbers)) and np.all(numbers > 0), column


def test_the_width_of_a_dent_is_asked_of_laws_without_adhesion():
    data = read_toml(paths.beside("cases") / "adhesion_thornton_1998.toml")
    with pytest.raises(CaseError, match="the width of a dent under adhesion is not computed"):
        validate._simulated(experiment(parse(data)), pd.DataFrame({"overlap_max": [1e-9]}), pd.Series(["dent_width"]))


def test_the_page_of_evidence_has_every_measured_e_n_and_the_rms_of_each_law():
    """The rms by hand, from the lines of the table on the page."""
    lines = (DOCS / "evidence.md").read_text().split("<!--restitution-->\n")[1].split("<!--/-->")[0].splitlines()
    head, *rows = ([cell.strip() for cell in line.split("|")[1:-1]] for line in lines if "---" not in line)
    points, (rms, scaled) = rows[:-2], rows[-2:]
    measured = [p for name in validate.names() for p in validate.read(name).points.to_dict("records")]
    assert sorted(float(row[2]) for row in points) == sorted(p["value"] for p in measured if p["quantity"] == "e_n")
    for column in range(4, len(head)):
        off = [float(row[column]) - float(row[2]) for row in points]
        over = [o / float(row[3]) for o, row in zip(off, points, strict=True)]
        for found, values in ((rms, off), (scaled, over)):
            assert float(found[column]) == pytest.approx(np.sqrt(np.mean(np.square(values))), abs=5e-4, rel=6e-2)
