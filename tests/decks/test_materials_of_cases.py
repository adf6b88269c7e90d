# SPDX-License-Identifier: GPL-2.0-or-later
"""Materials of a case: taken from the materials file by name, and doubted where a unit is probably mistaken."""

import json
import math
import re
from pathlib import Path

import pytest

from epdem.case.impact import load, parse
from epdem.case.plausibility import case_warnings
from epdem.case.scene import parse as parse_scene
from epdem.case.toml import read_toml
from epdem.cli import main as cli
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict
from epdem.studies.soften import soften
from epdem.studies.sweep.run import plan

CASES = Path(__file__).parents[2] / "cases"
STEEL = read_toml(CASES / "steel_wall.toml")
BEADS = read_toml(CASES / "settle_glass.toml")
FILE = re.sub(r"(\[materials.steel\])\n(.+\n)+", r'\1\nfrom = "brass"\n', (CASES / "steel_wall.toml").read_text())


def impact(**material):
    return STEEL | {"materials": {"steel": material}}


def scene(**material):
    return BEADS | {"materials": {"glass": material}}


@pytest.mark.parametrize("read", [lambda **m: parse(impact(**m)), lambda **m: parse_scene(scene(**m))])
def test_a_material_of_the_file_is_taken_by_name_and_its_keys_can_be_replaced(read):
    """Brass of Kaye and Laby: 100.6 GPa, 0.35, 8500 kg/m^3; 300 MPa."""
    (brass,) = read(**{"from": "brass"}).materials.values()
    assert brass.young_modulus == pytest.approx(100.6e9) and brass.yield_stress == pytest.approx(300e6)
    assert (brass.poisson_ratio, brass.density) == (0.35, 8500.0)
    (hard,) = read(**{"from": "brass", "yield_stress": "0.5 GPa"}).materials.values()
    assert hard.yield_stress == pytest.approx(500e6) and hard.young_modulus == brass.young_modulus


@pytest.mark.parametrize("name", ["stell", 7, ["steel"]])
def test_a_material_that_is_not_in_the_file_is_named_with_those_that_are(name):
    with pytest.raises(CaseError, match=r"c.toml: materials.steel.from = .* there are steel, brass, aluminium"):
        parse(impact(**{"from": name}), "c.toml")


def test_a_softened_twin_and_a_sweep_take_such_a_material(tmp_path):
    path = tmp_path / "brass.toml"
    path.write_text(FILE)
    twin = soften(path, 10.0)
    assert {c.before for c in twin.changes} == {"100.6 GPa", "300 MPa", "steel_wall"}
    path.write_text(twin.text)
    assert load(path).materials["steel"].young_modulus == pytest.approx(10.06e9)
    assert load(path).materials["steel"].density == 8500.0
    path.write_text(FILE)
    points = plan(path, {"materials.steel.from": "brass,steel,alumina"}, engines=["embedded"]).points
    assert [p["materials.steel.from"] for p in points] == ["brass", "steel", "alumina"]


SOUND = {"young_modulus": "208 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3", "yield_stress": "1 GPa"}


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("young_modulus", "208 kPa", "young_modulus = 208000 Pa"),
        ("young_modulus", "90 kPa", "young_modulus = 90000 Pa, usually 100000 to 1.3e+12; is the unit right?"),
        ("young_modulus", "208 TPa", "young_modulus = 2.08e+14 Pa"),
        ("density", "7.85 kg/m^3", "density = 7.85 kg/m^3, usually 100 to 25000; is the unit right?"),
        ("density", "7850 g/cm^3", "density = 7.85e+06 kg/m^3"),
        ("yield_stress", "100 GPa", "yield_stress = 1e+11 Pa, usually 0 to 2.08e+10; is the unit right?"),
    ],
)
def test_a_value_that_is_probably_of_another_unit_is_doubted(key, value, said):
    material = SOUND | {key: value}
    if value == "208 kPa":  # plausible alone, but the yield stress is above it
        said = "yield_stress = 1e+09 Pa, usually 0 to 20800"
    assert any(f"materials.steel.{said}" in text for text in case_warnings(parse(impact(**material))))
    assert any(f"materials.glass.{said}" in text for text in case_warnings(parse_scene(scene(**material))))


def test_radii_above_a_metre_are_doubted():
    data = impact(**SOUND)
    data["impact"] = STEEL["impact"] | {"body": {"radius": "10 m", "material": "steel"}}
    assert case_warnings(parse(data)) == ["impact.body.radius = 10 m, usually 0 to 1; is the unit right?"]
    particles = [{"material": "glass", "radius": {"from": "0.5 m", "to": "1.5 m"}}]
    data = scene(**SOUND) | {"scene": BEADS["scene"] | {"particles": particles}}
    assert case_warnings(parse_scene(data)) == ["scene.particles.0.radius = 1.5 m, usually 0 to 1; is the unit right?"]


def test_a_friction_in_percent_is_doubted():
    data = scene(**SOUND) | {"contact": {"friction": 30, "pairs": [{"between": ["glass", "glass"], "friction": 5.1}]}}
    values = {"friction": 30, "pairs.0.friction": 5.1}
    said = [f"contact.{key} = {mu}, usually 0 to 5; percent?" for key, mu in values.items()]
    assert case_warnings(parse_scene(data)) == said


def test_no_case_of_ours_is_doubted_and_each_library_material_is_sound():
    for path in CASES.glob("*.toml"):
        data = read_toml(path)
        found = case_warnings((parse_scene if "scene" in data else parse)(data, path))
        # the ball of a Leeb device has the mass of the whole impact body
        assert [text.split(" = ")[0] for text in found] == ["materials.carbide.density"] * path.stem.startswith("leeb")
    for name in ("steel", "brass", "aluminium", "alumina", "glass"):
        assert case_warnings(parse(impact(**{"from": name}))) == []


@pytest.mark.parametrize("command", ["predict", "run", "deck"])
def test_doubts_reach_the_user(command, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text = (CASES / "steel_wall.toml").read_text()
    Path("odd.toml").write_text(re.sub('density = ".*"', 'density = "7.85 kg/m^3"', text))
    more = {"predict": ["--json"], "run": ["-e", "embedded"], "deck": ["-o", "d"]}[command]
    monkeypatch.setattr("sys.argv", ["epdem", command, "odd.toml", *more])
    monkeypatch.setattr("signal.signal", lambda *words: None)
    with pytest.raises(SystemExit):
        cli.main()
    said = capsys.readouterr()
    words = json.loads(said.out)["warnings"][0] if command == "predict" else said.out + said.err
    assert "materials.steel.density = 7.85 kg/m^3, usually 100 to 25000; is the unit right?" in words


MEYER = 2 / 1.8544 * 9.807e6  # Pa of mean pressure per HV: the pyramid's facets to their projection
# device, HV, p_m/Y under the pyramid, quantity, measured, deviation of `cavity`
MEASURED = [
    ("D", 300, 2.8, "width", 0.54e-3, 0.094),
    ("D", 600, 2.7175, "width", 0.452e-3, 0.099),
    ("D", 955, 2.3324, "e_n", 0.890, -0.010),
    ("C", 300, 2.8, "width", 0.38e-3, 0.095),
    ("C", 600, 2.7175, "width", 0.32e-3, 0.103),
    ("C", 800, 2.4790, "width", 0.29e-3, 0.127),
    ("G", 300, 2.8, "width", 1.03e-3, 0.102),
    ("G", 600, 2.7175, "width", 0.90e-3, 0.058),
    ("G", 675, 2.6199, "e_n", 0.750, 0.005),
]


def on_steel(device, hardness, constraint):
    data = read_toml(CASES / f"leeb_{device}.toml")
    data["materials"]["steel"]["yield_stress"] = f"{hardness * MEYER / constraint!r} Pa"
    return experiment(parse(data, device))


@pytest.mark.parametrize(("device", "hardness", "constraint", "quantity", "measured", "deviation"), MEASURED)
def test_leeb_devices_deviate_as_the_case_files_say(device, hardness, constraint, quantity, measured, deviation):
    x = on_steel(device, hardness, constraint)
    p = predict(x)
    found = {"width": 2 * p.radius_max, "e_n": p.e_n}[quantity][0]
    assert found / measured - 1 == pytest.approx(deviation, abs=0.001)
    head = (CASES / f"leeb_{device}.toml").read_text().split("[case]")[0]
    assert f"{hardness} HV" in head and f"({100 * (found / measured - 1):+.1f} %)" in head


@pytest.mark.parametrize(("device", "grams", "joule"), [("D", 5.5, 11e-3), ("C", 3.0, 2.7e-3), ("G", 20.0, 90e-3)])
def test_leeb_bodies_have_their_mass_and_energy(device, grams, joule):
    x = experiment(parse(read_toml(CASES / f"leeb_{device}.toml"), device))
    assert x.m_star == pytest.approx(grams * 1e-3, rel=1e-6)
    assert 0.5 * x.m_star * x.speed[0] ** 2 == pytest.approx(joule, rel=1e-3)
    assert x.law.parameters["yield_stress"] == pytest.approx(300 * MEYER / 2.8, rel=1e-4)


def test_the_ball_does_not_yield_and_the_impact_is_small():
    for device in "DCG":
        p = predict(experiment(parse(read_toml(CASES / f"leeb_{device}.toml"), device)))
        assert p.yield_speeds["carbide"] == math.inf
        assert p.yields == ("steel",)
        assert p.strain.max() < 0.3 and not any("0.3" in text for text in p.caveats)
