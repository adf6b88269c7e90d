# SPDX-License-Identifier: GPL-2.0-or-later
"""The decks of data/upstream, run with the unmodified liggghts: each shows the fault that docs/upstream.md tells."""

import re
from pathlib import Path

import numpy as np
import pytest
from plugin_decks import run

import oblique

pytestmark = pytest.mark.liggghts

ROOT = Path(__file__).resolve().parents[2]
DECKS = {path.stem: path.read_text() for path in (ROOT / "data/upstream").glob("*.in")}


def whole(name):
    """A deck with the lines that it includes."""
    return DECKS[name].replace("include head.in\n", DECKS["head"])


def result(folder, name, edit=lambda text: text):
    done = run(folder, edit(whole(name)), command="liggghts")
    found = re.findall(r"^RESULT (\S+)", done.text, re.M)
    assert found, done.error or done.text[-800:]
    return float(found[-1])


def test_every_deck_of_the_page_is_tested():
    named = re.findall(r"`data/upstream/(\w+)\.in`", (ROOT / "docs/upstream.md").read_text())
    assert set(DECKS) == {"head", *named}


@pytest.mark.parametrize("model", ["thornton_ning", "edinburgh"])
def test_momentum_is_made_at_a_periodic_face(tmp_path, model):
    def inside(text):  # the same impact away from the face
        return text.replace("single 0.0986", "single 0.0486").replace("single 0.0991", "single 0.0491")

    assert abs(result(tmp_path / "face", f"periodic_{model}")) > 1e-3
    assert abs(result(tmp_path / "inside", f"periodic_{model}", inside)) < 1e-12


def test_no_history_of_thornton_ning_pushes(tmp_path):
    assert result(tmp_path / "ning", "no_history") > 1.0
    assert result(tmp_path / "hertz", "no_history", lambda t: t.replace("thornton_ning", "hertz")) < 1.0


def test_cdt_is_without_effect_beside_thornton_ning(tmp_path):
    def off(text):
        return text.replace("rolling_friction cdt", "rolling_friction off")

    def hertz(text):
        return text.replace("thornton_ning", "hertz")

    assert result(tmp_path / "a", "rolling") == result(tmp_path / "b", "rolling", off)
    assert result(tmp_path / "c", "rolling", hertz) != result(tmp_path / "d", "rolling", lambda t: hertz(off(t)))


def test_shear_spring_outlives_its_contact(tmp_path):
    def every_step(text):
        return text.replace("neigh_modify delay 1000000 check no\n", "")

    old, new = result(tmp_path / "old", "shear"), result(tmp_path / "new", "shear", every_step)
    assert abs(old / new - 1) > 1e-4


def test_thornton_ning_rebounds_too_slowly_at_any_step(tmp_path):
    """Yield ratio 0.05 is a_y/R: v_y = sqrt(0.8 E* 0.05^5/(pi rho)); eq. 8.83 at 10 v_y gives 0.6019."""
    E_star = 1e8 / (2 * (1 - 0.3**2))
    speed = 10 * np.sqrt(0.8 * E_star * 0.05**5 / (np.pi * 2500))
    r = 0.1
    theory = np.sqrt(6 * np.sqrt(3) / 5) * np.sqrt(1 - r**2 / 6) * (r / (r + 2 * np.sqrt(6 / 5 - r**2 / 5))) ** 0.25
    for step in ("2e-7", "1e-7"):

        def edit(text, step=step):
            return text.replace("SPEED", repr(float(speed))).replace("timestep 2e-7", f"timestep {step}")

        e_n = result(tmp_path / step, "restitution", edit)
        assert -0.1 < e_n / theory - 1 < -0.04


def test_elastic_potential_of_a_primitive_wall_crashes(tmp_path):
    done = run(tmp_path, whole("segfault"), command="liggghts")
    assert done.code not in (0, 1) and "RESULT" not in done.text


def test_history_creates_energy_in_a_closed_cycle(tmp_path):
    """The stretch stays, the stiffness goes with the root of the overlap; sampling at the ends of steps leaves 1e-4."""
    assert result(tmp_path, "cycle") == pytest.approx(np.sqrt(1.6) - 1, abs=3e-4)


@pytest.mark.parametrize(("e", "printed"), [(0.9, 1.004), (0.7, 1.047), (0.5, 1.168), (0.2, 1.73), (0.999999, 1.0)])
def test_friction_of_a_sliding_impact_exceeds_mu_times_the_normal_impulse(e, printed, tmp_path):
    """Beside an integration of the same spring and dashpots."""

    def finer(text):
        text = text.replace("peratomtypepair 1 0.2\npair_style", f"peratomtypepair 1 {e}\npair_style")
        return text.replace("timestep 2e-7", "timestep 2e-8").replace("run 5000", "run 50000")

    found = result(tmp_path, "sliding", finer)
    E, G, m = 1e8 / (2 * 0.91), 1e8 / (2 * 1.3) / (2 * 1.7), 2500 * np.pi / 6 * 0.01**3
    more = {"mu": 0.5, "dt": 2e-8, "e_n": e, "e_t": e, "pulls": True}
    *_, ratio = oblique.one_spring([16.0], E_star=E, G_star=G, R=0.005, mass=m, **more)
    assert found == pytest.approx(printed, abs=5e-3 if e < 0.99 else 1e-4)
    assert found == pytest.approx(float(ratio[0]), rel=1e-2)
