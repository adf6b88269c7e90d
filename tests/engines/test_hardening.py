# SPDX-License-Identifier: GPL-2.0-or-later
"""Law meyer in every engine: restitution for each exponent, the bits of thornton without hardening, the softer body."""

from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from hosts import EMBEDDED, LAMMPS, LIGGGHTS, prepared, run
from plugin_decks import DUMP, P_Y, RHO, Bodies, contact, good, head, materials
from test_plugin_physics import BOX, R, e_star, wall_impacts, yield_speed

from epdem.impacts.measurement import measure
from epdem.laws.library import Law

V_Y = 0.559430455498519  # [m/s] p_y = 2.8 GPa, table of the chapter


def e_n_exact(ratio, x):
    """e_n at v/v_y from the parametric form in q = a/a_y, of which W/W_y = (v/v_y)^2 is solved with 30 digits."""
    with mp.workdps(30):
        x, target = mp.mpf(x), mp.mpf(float(ratio)) ** 2
        if target <= 1:
            return 1.0

        def work(q):
            return 1 + mp.mpf(5) / 2 * ((1 - 3 / (2 + x)) * (q**2 - 1) + 6 / ((2 + x) * (4 + x)) * (q ** (4 + x) - 1))

        q = mp.findroot(lambda q: work(q) / target - 1, (1, 2 * target ** (1 / mp.mpf(4))), solver="anderson")
        force = 1 + 3 / (2 + x) * (q ** (2 + x) - 1)
        return float(mp.sqrt(force**2 / (q * target)))


@pytest.mark.parametrize("name", [EMBEDDED, LIGGGHTS])
@pytest.mark.parametrize("x", [0.0, 0.1, 0.3, 0.5])
def test_restitution_from_half_to_268_times_the_yield_speed_is_of_second_order(name, x, tmp_path):
    speed = np.geomspace(0.5 * V_Y, 268 * V_Y, 16)
    exact, errors = np.repeat([e_n_exact(v / V_Y, x) for v in speed], 8), []
    for steps, limit in ((100, 1e-3), (400, 1e-4)):
        p, _ = prepared(law={"name": "meyer", "hardening_exponent": x}, steps=steps, speed=speed)
        errors.append(np.abs(measure(p, run(name, p, tmp_path / str(steps))).e_n / exact - 1).max())
        assert errors[-1] <= limit
    assert np.log(errors[0] / errors[1]) / np.log(4) > 1.7


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
        m, p_y = RHO[t - 1] * 4 / 3 * np.pi * R**3, min(P_Y[t - 1], P_Y[1])
        v_y = yield_speed(p_y, e_star(t, 2), R, m)
        assert final[t - 1, 6] / speed == pytest.approx(e_n_exact(speed / v_y, x), rel=5e-4)


def test_a_stored_force_is_that_of_the_backbone_wherever_the_contact_turned():
    """Force on unloading from 2 steps against Hertz's branch of the printed F(q)."""
    E_star, R_star, p_y, x = 1.1e11, 0.01, 2.8e9, 0.4
    law = Law("meyer", E_star=E_star, yield_pressure=p_y, hardening_exponent=x)
    a_y = np.pi * R_star * p_y / (2 * E_star)
    q = np.geomspace(1.01, 60, 30)
    peak = (q * a_y) ** 2 / R_star
    F = 2 / 3 * np.pi * p_y * a_y**2 * (1 + 3 / (2 + x) * (q ** (2 + x) - 1))
    R_p = 4 * E_star * (q * a_y) ** 3 / (3 * F)
    dent = peak - (q * a_y) ** 2 / R_p
    here = dent + 0.3 * (peak - dent)
    found = law.step(R_star=R_star, delta_max=peak, delta=here)
    assert found[0] == pytest.approx(4 / 3 * E_star * np.sqrt(R_p) * (here - dent) ** 1.5, rel=1e-10)
    assert found[1] == pytest.approx(np.sqrt(R_p * (here - dent)), rel=1e-10)


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
