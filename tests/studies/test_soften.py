# SPDX-License-Identifier: GPL-2.0-or-later
"""A softened twin keeps e_n at every speed."""

import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from epdem.base.declarations import declarations
from epdem.case import scene as scenes
from epdem.case.impact import load
from epdem.cli.main import app
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.prediction import predict
from epdem.scenes.plan.model import strengths
from epdem.studies.soften import soften
from epdem.theory.adhesion import sticking_speed

CASES = Path(__file__).parents[2] / "cases"
STEEL = CASES / "steel_wall.toml"


def with_law(tmp_path: Path, law: str, text: str | None = None) -> Path:
    """The steel case with another law at its default parameters."""
    gamma = 'work_of_adhesion = "3e3 J/m^2"\n' if declarations()[law].adheres else ""  # the sphere sticks up to 0.1 m/s
    text = re.sub(r"\[law\]\n(?:.+\n)+", f'[law]\nname = "{law}"\n{gamma}', text or STEEL.read_text())
    path = tmp_path / f"{law}.toml"
    path.write_text(text)
    return path


@pytest.mark.parametrize("law", sorted(declarations()))
@pytest.mark.parametrize("factor", [100.0, 1000.0])
def test_the_twin_keeps_e_n_of_every_speed_while_contacts_last_longer(law, factor, tmp_path):
    path = with_law(tmp_path, law)
    twin = soften(path, factor)
    soft = tmp_path / "soft.toml"
    soft.write_text(twin.text)
    hard, now = predict(experiment(load(path))), predict(experiment(load(soft)))
    # scaling is exact; what is left is rounding in the quadratures of theory
    loose = hard.e_n > 0
    assert np.array_equal(now.e_n > 0, loose) and loose.all() == (not declarations()[law].adheres)
    assert np.abs(now.e_n[loose] / hard.e_n[loose] - 1).max() < 1e-10
    assert np.allclose(now.contact_time[loose] / hard.contact_time[loose], factor**0.4, rtol=1e-9)
    assert np.allclose(now.strain / hard.strain, factor**0.2, rtol=1e-9)
    assert math.isclose(twin.time_step_factor, factor**0.4)


RATE = "[rate]\nsensitivity = 0.05\n"


def with_option(tmp_path, text):
    """The steel case with cavity and an option, and the same without it."""
    path = with_law(tmp_path, "cavity")
    plain = predict(experiment(load(path)))
    path.write_text(re.sub(r"\n+\[numerics\]", f"\n{text}\n[numerics]", path.read_text()))
    return path, plain


@pytest.mark.parametrize("text", [RATE, RATE + 'reference = "2 1/s"'])
def test_the_twin_keeps_e_n_where_the_strength_depends_on_the_rate(text, tmp_path):
    """The strain rate 0.2 v/a falls as k^-0.2."""
    path, plain = with_option(tmp_path, text)
    soft, twin = tmp_path / "soft.toml", soften(path, 10.0)
    soft.write_text(twin.text)
    hard, now = predict(experiment(load(path))), predict(experiment(load(soft)))
    assert np.abs(now.e_n / hard.e_n - 1).max() < 1e-10 and twin.e_n_change == 0.0
    assert np.abs(plain.e_n / hard.e_n - 1).max() > 1e-3


@pytest.mark.parametrize("c", [0.82, 0.5])
def test_the_twin_keeps_the_pressure_of_finite_strain_and_says_what_the_loss_of_area_does_to_e_n(c, tmp_path):
    """The pressure falls with w a/R*, which grows as k^0.2 and c with k^0.14; the area goes with h/R*, h: overlap.

    Far above yield a small loss of area 1 - q h, q = w^2/(2 R*), changes F by -q h, a by -q h/2, W = h^2/2 by -2/3 q h
    and so, at a given W, h by q h/3: e_n^2 = kappa F^2/(a E* W) by -q h, e_n by -w^2 h/(4 R*), and w = 1/2 here.
    """
    path, _ = with_option(tmp_path, f"finite_strain = {c}")
    soft, twin = tmp_path / "soft.toml", soften(path, 10.0)
    soft.write_text(twin.text)
    hard, now = predict(experiment(load(path))), predict(experiment(load(soft)))
    lost = 1 - now.e_n / hard.e_n
    assert np.abs(lost).max() == pytest.approx(twin.e_n_change, rel=1e-9)
    middle = (hard.speed > 20) & (hard.speed < 100)
    expected = (10**0.4 - 1) * 0.25 * hard.overlap_max / (4 * 0.01)
    assert lost[middle] == pytest.approx(expected[middle], rel=0.15)


def test_every_pressure_and_force_of_a_scene_is_scaled_and_what_is_kept_is_named(tmp_path):
    path = tmp_path / "press.toml"
    ends = PRESS.replace(
        'until = { wall = "lid", force = "0.2 kN" }', 'until = { kinetic_energy = "2 nJ", after = "1 us" }'
    )
    path.write_text(ends.replace("GRAVITY", "0"))
    twin = soften(path, 100.0)
    phase = tomllib.loads(twin.text)["scene"]["phase"][1]
    assert phase["until"] == {"kinetic_energy": "2 nJ", "after": "1 us"}
    assert float(phase["move"][0]["force"].split()[0]) == pytest.approx(80 / 100**0.8, rel=1e-12)
    (kept,) = [warning for warning in twin.warnings if "are kept" in warning]
    assert re.search(r"\((.*?)\)", kept)[1].split(", ") == [
        *("scene.phase.0.duration", "scene.phase.1.duration", "scene.phase.1.until.after"),
        *("scene.phase.1.move.0.highest_speed", "scene.phase.1.until.kinetic_energy"),
    ]
    assert "contacts last 6.31 times longer" in kept


ODD = """# a case in another order, with other quotes
law = { name = "thornton", 'yield_pressure' = '2.8 GPa' } # inline

[materials]
steel.young_modulus = "208 GPa"  # dotted
steel.poisson_ratio = 0.3
steel.density = "7850 kg/m^3"

[case]
title = '''name = "no name at all"'''
source = "none"
name = "odd"   # the last key

[impact]
kind = "sphere-wall"
body = { radius = "10 mm", material = "steel" }
target = { material = "steel" }
speeds = ["1 m/s"]
"""


def test_the_twin_of_a_case_in_any_order_and_style_of_toml_renames_the_case_and_nothing_else(tmp_path):
    """Values by hand: 208/10 GPa and 2.8/10^0.8 GPa; every comment and every other line stays."""
    path = tmp_path / "odd.toml"
    path.write_text(ODD)
    twin = soften(path, 10.0)
    text, data = twin.text, tomllib.loads(twin.text)
    assert {c.place for c in twin.changes} == {"law.yield_pressure", "materials.steel.young_modulus", "case.name"}
    assert data["case"]["name"] == "odd_soft10" and data["case"]["title"] == 'name = "no name at all"'
    assert data["law"]["name"] == "thornton"
    assert data["materials"]["steel"]["young_modulus"] == "20.8 GPa"
    assert float(data["law"]["yield_pressure"].removesuffix(" GPa")) == pytest.approx(2.8 / 10**0.8, rel=1e-14)
    lines = list(zip(ODD.splitlines(), text.splitlines(), strict=True))
    assert [n for n, (old, new) in enumerate(lines) if old != new] == [1, 4, 11]
    assert [old.partition("#")[2] for old, _ in lines] == [new.partition("#")[2] for _, new in lines]


def test_softening_replaces_a_file_only_when_asked(tmp_path):
    target = tmp_path / "mine.toml"
    target.write_text("mine")
    words = ["soften", str(STEEL), "--factor", "10", "--out", str(target)]
    refused = CliRunner().invoke(app, words)
    assert isinstance(refused.exception, CaseError) and "--force" in str(refused.exception)
    assert target.read_text() == "mine"
    assert CliRunner().invoke(app, [*words, "--force"]).exit_code == 0
    assert load(target).name == "steel_wall_soft10"


PRESS = """
case = { name = "pressed", title = "a plate presses spheres", source = "a test" }
law.name = "thornton"

[materials]
steel = { young_modulus = "208 GPa", poisson_ratio = 0.3, density = "7850 kg/m^3", yield_stress = "1 GPa" }

[scene]
kind = "parts"
gravity = "GRAVITY m/s^2"
room = { x = ["-5 mm", "5 mm"], y = ["-5 mm", "5 mm"], z = ["0 mm", "20 mm"] }
body = [{ name = "ball", material = "steel", radius = "1 mm", position = ["0 mm", "0 mm", "5 mm"] }]

[[scene.wall]]
name = "lid"
kind = "plate"
axis = "z"
center = ["0 mm", "0 mm", "15 mm"]
size = ["9 mm", "9 mm"]
material = "steel"

[[scene.phase]]
name = "rest"
duration = "1 ms"

[[scene.phase]]
name = "press"
duration = "1 ms"
until = { wall = "lid", force = "0.2 kN" }  # of the wall

[[scene.phase.move]]
wall = "lid"
kind = "press"
direction = [0, 0, -1]
force = "80 N"
highest_speed = "1 m/s"
"""


def yield_force(case, radius):
    """Thornton 1997: F_y = pi^3 R*^2 p_y^3/(6 E*^2) of two equal spheres."""
    m = case.materials["steel"]
    E_star = m.young_modulus / 2 / (1 - m.poisson_ratio**2)
    return math.pi**3 * (radius / 2) ** 2 * strengths(case)["steel"] ** 3 / (6 * E_star**2)


def test_prescribed_forces_of_a_twin_are_the_same_multiples_of_the_yield_force(tmp_path):
    path = tmp_path / "press.toml"
    path.write_text(PRESS.replace("GRAVITY", "9.81"))
    twin = soften(path, 100.0)
    hard, soft = scenes.load(path), scenes.parse(tomllib.loads(twin.text))
    for force in (lambda c: c.scene.phase[1].move[0].force, lambda c: c.scene.phase[1].until.force):
        multiples = [force(case) / yield_force(case, 1e-3) for case in (hard, soft)]
        assert math.isclose(*multiples, rel_tol=1e-12)
    assert {"scene.phase.1.move.0.force", "scene.phase.1.until.force"} <= {c.place for c in twin.changes}
    assert "# of the wall" in twin.text


@pytest.mark.parametrize("gravity", ["0", "9.81"])
def test_static_loads_of_every_kind_are_warned_of(gravity, tmp_path):
    path = tmp_path / "press.toml"
    path.write_text(PRESS.replace("GRAVITY", gravity))
    assert any("falls by a factor of 6.31 (k^0.4)" in w for w in soften(path, 100.0).warnings) == (gravity != "0")
    for name in ("settle_glass", "hopper_beads", "drum_beads", "impactor_bowl", "peening_steel"):
        weighs = scenes.load(CASES / f"{name}.toml").parts.gravity > 0
        assert any("static loads" in w for w in soften(CASES / f"{name}.toml", 2.0).warnings) == weighs


def test_a_time_step_that_is_given_does_not_grow_by_itself(tmp_path):
    path = tmp_path / "given.toml"
    path.write_text((CASES / "peening_steel.toml").read_text())
    assert not any("time_step" in w for w in soften(path, 32.0).warnings)
    path.write_text(re.sub(r"\[numerics\]\n", '[numerics]\ntime_step = "1e-9 s"\n', path.read_text()))
    twin = soften(path, 32.0)
    assert any("time_step is kept as given; it can be 4 times larger" in w for w in twin.warnings)
    assert tomllib.loads(twin.text)["numerics"]["time_step"] == "1e-9 s"


def test_a_twin_with_contacts_too_wide_is_warned_of(tmp_path):
    path = tmp_path / "slow.toml"
    path.write_text(STEEL.read_text().replace('"150 m/s"', '"0.2 m/s"'))
    gentle = soften(path, 5.0)
    assert gentle.strain[1] < 0.3 and not gentle.warnings
    hard = soften(path, 1e7)
    assert any("w a_max/R* reaches" in w for w in hard.warnings)


def test_the_sticking_speed_of_a_twin_is_that_of_the_case(tmp_path):
    """Also where the surface energies of the materials give the work of adhesion."""
    text = with_law(tmp_path, "jkr").read_text().replace('work_of_adhesion = "3e3 J/m^2"\n', "")
    path, soft = tmp_path / "case.toml", tmp_path / "soft.toml"
    path.write_text(text.replace("density", 'surface_energy = "1500 J/m^2"\ndensity'))
    soft.write_text(soften(path, 50.0).text)
    V_s = [float(sticking_speed(x.theory(), m_star=x.m_star)) for x in (experiment(load(p)) for p in (path, soft))]
    assert V_s[1] == pytest.approx(V_s[0], rel=1e-8) and V_s[0] > 0.05
    at = [predict(replace(experiment(load(p)), speed=np.array([1.0000001 * V_s[0]]))).e_n[0] for p in (path, soft)]
    assert at[1] == pytest.approx(at[0], rel=1e-8) and 0 < at[0] < 1e-3
