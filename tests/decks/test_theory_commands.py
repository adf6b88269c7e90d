# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands that need no engine: `epdem predict`, `epdem verify figures`, and the materials file behind them."""

import json
import tomllib
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from typer.testing import CliRunner

from epdem.case import toml
from epdem.engines.citations import of_laws
from epdem.verification.commands import app

pytestmark = pytest.mark.figures

CASES = Path(__file__).parents[2] / "cases"
FILE = tomllib.loads(Path(toml.__file__).with_name("materials.toml").read_text())


def run(*words):
    done = CliRunner().invoke(app, list(map(str, words)))
    assert done.exit_code == 0, done.output
    return done.stdout


def test_theory_prints_restitution_peaks_and_first_yield_of_every_law():
    """The reference sphere at 5 m/s: e_n 0.676326 and 0.716768, cavity's peak force 10265.3 N, to 6 digits printed."""
    text = run("predict", "--material", "steel", "--radius", "10 mm", "--speed", "5 m/s")
    for law, e_n in (("hertz", "1"), ("thornton", "0.676326"), ("johnson", "1"), ("cavity", "0.716768")):
        row = next(line for line in text.splitlines() if f" {law} " in line)
        assert f" {e_n} " in row
        assert ("10265.3" in row) == (law == "cavity")
    assert "thornton: yields: steel\nthornton: steel yields beneath its surface (1.60 Y) from 0.1381 m/s on" in text


def test_theory_in_json_is_the_same_in_si():
    document = json.loads(run("predict", "--radius", "1 cm", "--speed", "500 cm/s", "--json"))
    found = {law["law"]: law["rows"][0] for law in document}
    assert found["hertz"]["speed"] == 5.0
    energy = 0.5 * 0.032882003107573169 * 5.0**2  # 4/3 pi R^3 7850 kg/m^3
    assert found["hertz"]["work_in"] == pytest.approx(energy, rel=1e-12)
    assert found["thornton"]["e_n"] == pytest.approx(0.6763264338717, abs=1e-12)  # 13 printed digits
    assert found["cavity"]["force_max"] == pytest.approx(10265.34867, rel=1e-9)  # 10 printed digits


def changed_case(folder, case, *changes):
    text = (CASES / case).read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "case.toml").write_text(text)
    return folder / "case.toml"


def test_the_share_of_waves_is_estimated_and_warned_of_above_5_percent(tmp_path):
    """Elastic steel at 70 m/s, nu = 0.25: a share of 1.11 (v/c_0)^0.6 (Hunter 1957); the chapter's: about 3 %."""
    found = json.loads(run("predict", CASES / "benchmarks/mild_steel_hutchings_1979.toml", "--json"))
    assert 0.03 < found["rows"][0]["wave_share"] < 0.04 and not any("waves" in w for w in found["warnings"])
    changes = ('name = "cavity"', 'name = "hertz"'), ("poisson_ratio = 0.3", "poisson_ratio = 0.25")
    case = changed_case(tmp_path, "benchmarks/mild_steel_hutchings_1979.toml", *changes)
    found = json.loads(run("predict", case, "--json"))
    share = found["rows"][0]["wave_share"]
    assert share == pytest.approx(1.11 * (70 / (208e9 / 7850) ** 0.5) ** 0.6, rel=3e-3)
    (said,) = (w for w in found["warnings"] if "waves" in w)
    assert said.startswith(f"elastic waves take an estimated {100 * share:.2g} % of the kinetic energy, above 5 %")
    assert "wave_share" in run("predict", case, "--full") and "wave_share" not in run("predict", case)
    two = json.loads(run("predict", CASES / "benchmarks/spheres_chung_2011.toml", "--json"))
    assert {row["wave_share"] for row in two["rows"]} == {None}  # waves return from the surface of a sphere


def test_a_friction_above_0_3_names_the_pressure_at_which_the_surface_yields(tmp_path):
    """1.24257 Y for mu = 0.4, nu = 0.3 by point-load integration; the speed goes as the pressure to 5/2."""
    case = changed_case(tmp_path, "oblique_steel.toml", ("friction = 0.3", "friction = 0.4"))
    found = json.loads(run("predict", case, "--json"))
    (said,) = (w for w in found["warnings"] if "at its surface" in w)
    Y = 1e9
    assert f"from a peak pressure of {1.24257 * Y / 1e6:.4g} MPa (1.24 Y) on" in said
    speed = found["yield_speeds"]["steel"] * (1.24257 / 1.6) ** 2.5
    assert said.endswith(f"reach at {speed:.3g} m/s")
    assert not json.loads(run("predict", CASES / "oblique_steel.toml", "--json"))["warnings"]


def test_theory_refuses_a_material_that_is_not_there():
    done = CliRunner().invoke(app, ["predict", "--material", "unobtainium"])
    assert done.exit_code != 0 and "brass" in str(done.exception)


def test_figures_of_the_chapter_are_drawn_into_the_folder(tmp_path):
    names = [*(f"figure_8_{n}.png" for n in (16, 17, 18, 19)), "thornton_ning_1998.png"]
    expected = [str(tmp_path / f"{name.removesuffix('.png')}.{kind}") for name in names for kind in ("png", "csv")]
    assert run("verify", "figures", "--out", tmp_path).split() == expected
    for name in names:
        picture = matplotlib.image.imread(tmp_path / name)[..., :3]
        colours = np.unique(picture @ np.array([1.0, 256.0, 65536.0]))
        assert min(picture.shape[:2]) > 400 and len(colours) > 300  # axes alone have the grays only


def test_laws_with_adhesion_are_cited():
    assert "Powder Technol. 99 (1998) 154" in run("cite", CASES / "adhesion_thornton_1998.toml")
    assert "Proc. R. Soc. A 324 (1971) 301" in str(of_laws(["jkr"])["law jkr, Johnson, Kendall and Roberts 1971"])


@pytest.mark.parametrize("name", FILE)
def test_every_material_says_where_its_numbers_come_from(name):
    """Its source begins with a short name that the head of the file gives in full."""
    text = Path(toml.__file__).with_name("materials.toml").read_text()
    known = [line.split()[1] for line in text.splitlines() if line.startswith("#") and " = " in line]
    assert FILE[name]["source"].partition(":")[0] in known and "yield_stress" in FILE[name]
