# SPDX-License-Identifier: GPL-2.0-or-later
"""Law meyer in every engine: the bits of thornton without hardening, the softer body, digits of the power."""

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hosts import EMBEDDED, LAMMPS, LIGGGHTS, prepared, run
from plugin_decks import DUMP, P_Y, RHO, Bodies, contact, good, head, materials
from test_plugin_physics import BOX, R, e_star, wall_impacts

from epdem.laws.library import Law
from epdem.theory import restitution
from epdem.theory.meyer import Meyer


@pytest.mark.parametrize("name", [EMBEDDED, LIGGGHTS, LAMMPS])
def test_without_hardening_every_bit_is_thorntons(name, tmp_path):
    speed = np.array([0.05, 0.7, 3.0, 30.0, 150.0])
    laws = {"name": "meyer", "hardening_exponent": 0.0}, {"name": "thornton"}
    (p, _), (other, _) = (prepared(law=law, steps=60, speed=speed) for law in laws)
    same = replace(p, experiment=replace(p.experiment, law=other.experiment.law))  # the time step is the same, too
    ours, thornton = run(name, p, tmp_path / "meyer"), run(name, same, tmp_path / "thornton")
    for quantity in ("overlap", "force", "velocity"):
        assert np.array_equal(getattr(ours, quantity), getattr(thornton, quantity), equal_nan=True)


@pytest.mark.liggghts
@pytest.mark.parametrize("loop", ["", "generic"])
def test_without_hardening_energies_friction_and_dashpot_are_thorntons_in_liggghts(loop, tmp_path):
    """Pairs and walls with partial slip, both loops."""
    x = np.array([[0, 0, 5.1e-3], [0.03, 0, 5.1e-3], [0.03, 0, 0.0153]])
    scene = Bodies(np.array([1, 2, 3]), np.full(3, 5e-3), x, np.array([[1, 0, -3.0], [0, 1, -20.0], [0, 0, -40.0]]))
    properties = materials("ep/any").replace("0.1 0.3 0.5", "0 0 0")
    properties += "fix e all property/global coefficientRestitution peratomtypepair 3" + " 0.9" * 9 + "\n"

    def end(law):
        words = {"tangential": "ep/partial_slip", "settings": "viscous on computePlasticWork on"}
        text = head() + "read_data box.data\nneighbor 1e-3 bin\n" + properties
        text += contact(f"ep/{law}", wall="primitive", **words) + "timestep 1e-7\nfix move all nve/sphere\n"
        dump = DUMP.format(every=50).replace("id ", "id f_plasticWork f_elasticEnergy f_frictionWork ", 1)
        text += dump + "run 800\n"
        env = {"EPDEM_LOOP": loop} if loop else {}
        return good(tmp_path / law, text, files={"box.data": scene.data(BOX)}, env=env).frames()[1]

    found = end("meyer")
    assert np.array_equal(found, end("thornton")) and found[-1, :, 1].min() > 0


@pytest.mark.liggghts
def test_a_pair_hardens_as_the_body_with_the_lower_strength(tmp_path):
    """Spheres of three materials on steel (type 2): aluminium and polymer yield first, and their exponents count."""
    speed = 5.0
    final = wall_impacts(tmp_path, "ep/meyer", [1, 2, 3], np.array([(0, 0, -speed)] * 3), steps=12000).last
    for t, x in ((1, 0.1), (2, 0.3), (3, 0.5)):
        law = Meyer(E_star=e_star(t, 2), R_star=R, p_y=min(P_Y[t - 1], P_Y[1]), x=x)
        e_n = restitution.e_n(law, m_star=RHO[t - 1] * 4 / 3 * np.pi * R**3, speed=speed)
        assert final[t - 1, 6] / speed == pytest.approx(float(e_n), rel=5e-4)


def test_the_power_of_the_force_keeps_its_digits_over_twelve_decades():
    """F = F_y [1 + 3/(2+x) (q^(2+x) - 1)] with 30 digits; the power loses a rounding for each factor e of q."""
    E_star, R_star, p_y = 1.1e11, 0.01, 2.8e9
    for x in (0.05, 0.3, 0.6, 0.99):
        law = Law("meyer", E_star=E_star, yield_pressure=p_y, hardening_exponent=x)
        delta = R_star * (np.pi * p_y / (2 * E_star)) ** 2 * np.geomspace(1 + 1e-9, 1e12, 200)
        with mp.workdps(30):
            a_y, n = mp.pi * R_star * p_y / (2 * mp.mpf(E_star)), 2 + mp.mpf(x)
            q = [mp.sqrt(R_star * mp.mpf(d)) / a_y for d in delta.tolist()]
            exact = np.array([float(2 * mp.pi / 3 * p_y * a_y**2 * (1 + 3 / n * (s**n - 1))) for s in q])
        found = law.step(R_star=R_star, delta_max=0.0, delta=delta)[0]
        assert np.all(np.abs(found / exact - 1) <= 1e-15 * (2 + np.log(delta / delta[0])))
