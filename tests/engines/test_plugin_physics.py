# SPDX-License-Identifier: GPL-2.0-or-later
"""Impacts in LIGGGHTS against closed forms: restitution, friction, tangential spring, softer body."""

import numpy as np
import pytest
from plugin_decks import DUMP, LAWS, NU, P_Y, RHO, Bodies, E, Y, contact, good, head, materials, per_pair

pytestmark = pytest.mark.liggghts

BOX = ((-0.02, 1.0), (-0.02, 0.02), (-0.001, 0.2))
R = 5e-3


def e_star(i, j):
    return 1 / ((1 - NU[i - 1] ** 2) / E[i - 1] + (1 - NU[j - 1] ** 2) / E[j - 1])


def g_star(i, j):
    return 1 / sum((2 - NU[k - 1]) * 2 * (1 + NU[k - 1]) / E[k - 1] for k in (i, j))


def thornton_restitution(v, v_y):
    """Eq. 8.83."""
    r = np.minimum(v_y / v, 1.0)
    return np.where(
        r < 1,
        np.sqrt(6 * np.sqrt(3) / 5) * np.sqrt(1 - r**2 / 6) * (r / (r + 2 * np.sqrt(6 / 5 - r**2 / 5))) ** 0.25,
        1.0,
    )


def yield_speed(p_y, E_s, R_s, m_s):
    """Eq. 8.84."""
    return (np.pi / (2 * E_s)) ** 2 * np.sqrt(8 * np.pi * R_s**3 * p_y**5 / (15 * m_s))


def wall_impacts(
    folder,
    model,
    types,
    v,
    w=None,
    *,
    dt=2e-8,
    steps=8000,
    friction=0.0,
    dump="",
    properties=None,
    tangential="history",
):
    """Spheres of radius R on the wall of type 2; final frame with columns id x y z v w."""
    n = len(types)
    x = np.array([[0.012 * k, 0.0, R + 0.5 * dt * abs(v[k][2])] for k in range(n)])
    bodies = Bodies(np.array(types), np.full(n, R), x, np.asarray(v, float), w)
    text = (
        head()
        + "read_data box.data\nneighbor 1e-3 bin\nneigh_modify delay 0\n"
        + (properties or materials(model, friction=friction))
        + contact(model, wall="primitive", tangential=tangential)
        + f"timestep {dt!r}\nfix move all nve/sphere\n"
        + "thermo_modify lost error norm no\n"
        + dump
        + f"run {steps}\n"
        + DUMP.format(every=1)
        + "run 0\n"
    )
    return good(folder, text, files={"box.data": bodies.data(BOX)})


def test_thornton_restitution_of_three_materials_over_three_decades(tmp_path):
    speeds = np.geomspace(0.05, 50, 12)
    types = np.repeat([1, 2, 3], len(speeds))
    v = np.array([(0, 0, -s) for s in np.tile(speeds, 3)])
    final = wall_impacts(tmp_path, "ep/thornton", types, v, steps=12000).last
    for t in (1, 2, 3):
        v_y = yield_speed(min(P_Y[t - 1], P_Y[1]), e_star(t, 2), R, RHO[t - 1] * 4 / 3 * np.pi * R**3)
        got = final[types == t, 6] / speeds
        parted = final[types == t, 3] > R
        assert parted.sum() >= 9
        assert np.allclose(got[parted], thornton_restitution(speeds, v_y)[parted], rtol=5e-4, atol=0)


def test_cavity_and_johnson_against_the_reference_table(tmp_path):
    """Sphere of 10 mm on a plane, both E = 208 GPa, nu = 0.3, Y = 1 GPa, rho = 7850."""
    table = {  # v: cavity, johnson (p_m = 3Y); e_n from 30-digit quadrature
        0.2: (0.9835348647963, 1.0),
        1.0: (0.8593720083638, 1.0),
        5.0: (0.7167680993893, 1.0),
        20.0: (0.6001427773615, 0.6723365058094),
        50.0: (0.4837161666937, 0.5239170209996),
    }
    v = np.array([(0, 0, -s) for s in table])
    x = np.array([[0.03 * k, 0, 0.01] for k in range(len(v))])
    for column, law in enumerate(("cavity", "johnson")):
        bodies = Bodies(np.full(len(v), 2), np.full(len(v), 0.01), x, v)
        bodies.type[0] = 1  # LIGGGHTS wants every type below the largest in use: here all are the same material
        same = (
            "\n".join(
                f"fix m{k} all property/global {name} peratomtype {value} {value}"
                for k, (name, value) in enumerate(
                    {"youngsModulus": 208e9, "poissonsRatio": 0.3, "yieldStress": 1e9, "yieldPressure": 3e9}.items()
                )
            )
            + "\n"
        )
        bodies_text = bodies.data(((-0.02, 0.2), (-0.02, 0.02), (-0.001, 0.2)), types=2)
        steel = f"1 1 0.02 {float(RHO[0])!r}"
        bodies_text = bodies_text.replace(steel, "1 1 0.02 7850.0")
        text = (
            head()
            + "read_data box.data\nneighbor 1e-3 bin\n"
            + same
            + contact(f"ep/{law}", wall="primitive", tangential="off")
            + "timestep 2e-8\nfix move all nve/sphere\nthermo_modify lost error norm no\nrun 10000\n"
            + DUMP.format(every=1)
            + "run 0\n"
        )
        got = good(tmp_path / law, text, files={"box.data": bodies_text}).last[:, 6] / -v[:, 2]
        assert np.allclose(got, [row[column] for row in table.values()], rtol=2e-4, atol=0), law


@pytest.mark.parametrize("law", LAWS)
def test_sliding_impact_follows_the_impulse_ratio(tmp_path, law):
    """Beyond mu (7/2)(1 + e_n) a sphere slides throughout, so f = mu: e_t, spin and rebound of the contact patch."""
    mu, v_n = 0.2, 0.3
    tangents = mu * 3.5 * 2 * np.array([1.0, 1.3, 2.0, 4.0])
    v = np.array([(v_n * t, 0, -v_n) for t in np.tile(tangents, 2)])
    types = np.repeat([1, 2], len(tangents))
    final = wall_impacts(tmp_path, f"ep/{law}", types, v, friction=mu, steps=6000).last
    e_n = final[:, 6] / v_n
    assert (final[:, 3] > R).all() and (e_n <= 1 + 1e-6).all()
    tan = v[:, 0] / v_n
    assert np.allclose(final[:, 4] / v[:, 0], 1 - mu * (1 + e_n) / tan, rtol=1e-3)
    assert np.allclose(final[:, 8], 2.5 * mu * (1 + e_n) * v_n / R, rtol=1e-3)
    patch = (final[:, 4] - final[:, 8] * R) / v_n
    assert np.allclose(patch, tan - 3.5 * mu * (1 + e_n), atol=1e-3 * 3.5 * mu * 2)


@pytest.mark.parametrize("law", LAWS)
def test_friction_never_exceeds_its_limit_and_the_normal_force_never_pulls(tmp_path, law):
    mu = 0.3
    v = np.array([(s * t, 0.2 * s, -s) for s in (0.3, 3.0, 30.0) for t in (0.1, 0.5, 1.0, 3.0)])
    types = [1, 2, 3] * 4
    dump = "dump f all custom 1 f.bin id z fx fy fz\n"
    run = wall_impacts(tmp_path, f"ep/{law}", types, v, friction=mu, steps=6000, dump=dump)
    frames = run.frames("f.bin")[1]
    sideways, normal = np.hypot(frames[:, :, 2], frames[:, :, 3]), frames[:, :, 4]
    assert (normal >= 0).all() and normal.max() > 0
    assert (sideways <= mu * normal * (1 + 1e-12)).all()
    assert (sideways > 0.999 * mu * normal)[normal > 0].any() and (sideways < 0.5 * mu * normal)[normal > 0].any()


def press(folder, law, *, depth=2e-4, back=1e-5, side=1e-6):
    """A steel sphere is pressed in, lifted by `back`, moved sideways: (F_n, F_t) at depth, and after each move."""
    move = "fix move all move linear {} 0 {}\nrun {}\nunfix move\n"
    text = (
        head()
        + "read_data box.data\nneighbor 1e-3 bin\nneigh_modify delay 0\n"
        + materials(f"ep/{law}", friction=50.0)
        + contact(f"ep/{law}", wall="primitive")
        + "timestep 1e-7\nthermo_modify lost error norm no\n"
        + "dump out all custom 1000 f.bin id x y z fx fy fz\n"
        + move.format(0, repr(-depth / 1e-4), 1000)
        + move.format(0, repr(back / 1e-4), 1000)
        + move.format(repr(side / 1e-4), 0, 1000)
    )
    x = np.array([[0.0, 0, R], [0.1, 0, 0.1]])
    bodies = Bodies(np.array([2, 1]), np.full(2, R), x, np.zeros((2, 3)))
    frames = good(folder, text, files={"box.data": bodies.data(BOX)}).frames("f.bin")[1]
    return frames[1:, 0, 4:]  # rows: pressed, lifted, moved; columns: fx fy fz


@pytest.mark.parametrize("law", LAWS)
def test_tangential_spring_follows_the_contact_radius_on_unloading(tmp_path, law):
    """k_t = 8 G* a, and dF/d alpha = 2 E* a on the elastic branch: the two stiffnesses share one radius."""
    lifted = press(tmp_path / "a", law)
    step = 1e-9
    higher = press(tmp_path / "b", law, back=1e-5 + step)
    k_n = (lifted[1, 2] - higher[1, 2]) / step
    k_t = -lifted[2, 0] / 1e-6
    assert lifted[0, 2] > lifted[1, 2] > 0
    assert k_t / k_n == pytest.approx(8 * g_star(2, 2) / (2 * e_star(2, 2)), rel=2e-4)


def test_softer_body_decides_per_type_and_a_pair_value_wins(tmp_path):
    """Aluminium on steel yields like aluminium; given per pair, the pair's value counts."""
    v = [(0, 0, -5.0), (0, 0, -5.0), (0, 0, -5.0)]
    base = materials("ep/thornton", friction=0.0)
    softer = wall_impacts(tmp_path / "a", "ep/thornton", [1, 2, 3], v, properties=base).last[:, 6]
    hard_wall = base.replace(repr(float(P_Y[1])), "1e30")
    same = wall_impacts(tmp_path / "b", "ep/thornton", [1, 2, 3], v, properties=hard_wall).last[:, 6]
    assert same[0] == softer[0] and same[2] == softer[2] and same[1] > softer[1]
    weakest = np.minimum.outer(P_Y, P_Y).ravel()
    pairs = "\n".join(line for line in base.splitlines() if "yieldPressure" not in line) + (
        "\nfix p9 all property/global yieldPressure peratomtypepair 3 " + " ".join(map(repr, weakest.tolist())) + "\n"
    )
    assert (wall_impacts(tmp_path / "c", "ep/thornton", [1, 2, 3], v, properties=pairs).last[:, 6] == softer).all()


def test_parameters_with_a_fallback_may_be_given_or_left_out(tmp_path):
    v = [(0, 0, -5.0), (0, 0, -5.0), (0, 0, -5.0)]
    base = materials("ep/cavity", friction=0.0)
    left_out = wall_impacts(tmp_path / "a", "ep/cavity", [1, 2, 3], v, properties=base).last[:, 6]
    given = (
        base
        + "fix q1 all property/global firstYieldRatio scalar 1.6\n"
        + ("fix q2 all property/global plasticRatio peratomtype 2.8 2.8 2.8\n")
    )
    assert (wall_impacts(tmp_path / "b", "ep/cavity", [1, 2, 3], v, properties=given).last[:, 6] == left_out).all()
    harder = base + "fix q2 all property/global plasticRatio peratomtype 3.0 3.0 3.0\n"
    assert (wall_impacts(tmp_path / "c", "ep/cavity", [1, 2, 3], v, properties=harder).last[:, 6] != left_out).all()


@pytest.mark.parametrize(("law", "default"), [("thornton", 2.8), ("johnson", 3.0)])
def test_a_strength_may_be_given_as_ratio_of_the_yield_stress(tmp_path, law, default):
    """Bitwise: the same product. Per type the body with the smaller yield stress counts, and its ratio with it."""
    v = [(0, 0, -20.0)] * 3
    base = materials(f"ep/{law}", friction=0.0)
    bare = "\n".join(line for line in base.splitlines() if "yieldPressure" not in line) + "\n"
    assert "yieldStress" in bare

    def rebound(name, properties):
        return wall_impacts(tmp_path / name, f"ep/{law}", [1, 2, 3], v, properties=properties).last[:, 6]

    def pressure(values):
        return f"fix p all property/global yieldPressure peratomtype {' '.join(repr(float(p)) for p in values)}\n"

    def ratio(words):
        return f"fix q all property/global yieldPressureRatio {words}\n"

    assert (rebound("a", bare) == rebound("b", bare + pressure(default * Y))).all()
    assert (rebound("c", bare + ratio("scalar 2.5")) == rebound("d", bare + pressure(2.5 * Y))).all()
    # steel on steel: its own ratio; aluminium and polymer are softer than the wall, and bring theirs
    per_type = np.array([2.6, 2.9, 3.1])
    assert (rebound("e", bare + ratio("peratomtype 2.6 2.9 3.1")) == rebound("f", bare + pressure(per_type * Y))).all()
    same = ratio("peratomtypepair 3" + " 2.5" * 9)
    assert (rebound("g", bare + same) == rebound("d", bare + pressure(2.5 * Y))).all()


def test_rigid_type_gives_the_one_sided_modulus(tmp_path):
    """A wall of modulus 1e30: the speed of yield is that of E/(1 - nu^2) of the sphere alone."""
    v = [(0, 0, -3.0), (0, 0, 3.0), (0, 0, -3.0)]  # the rigid sphere, of the wall's type, flies away from it
    base = materials("ep/thornton", friction=0.0)
    rigid = base.replace(repr(float(E[1])), "1e30").replace(repr(float(P_Y[1])), "1e30")
    got = wall_impacts(tmp_path, "ep/thornton", [1, 2, 3], v, properties=rigid).last[0, 6] / 3.0
    v_y = yield_speed(P_Y[0], E[0] / (1 - NU[0] ** 2), R, RHO[0] * 4 / 3 * np.pi * R**3)
    assert got == pytest.approx(float(thornton_restitution(np.array([3.0]), v_y)[0]), rel=2e-4)


def test_dashpot_of_no_history_is_that_of_the_restitution_given(tmp_path):
    """With tangential no_history only the dashpot acts; e = 1 makes it vanish, a smaller e slows the patch more."""
    v = [(2.0, 0, -3.0)] * 3
    spin = {}
    for e in (1.0, 0.8, 0.5):
        properties = materials("ep/thornton", friction=5.0) + per_pair("coefficientRestitution", e)
        final = wall_impacts(
            tmp_path / str(e), "ep/thornton", [1, 2, 3], v, properties=properties, tangential="no_history"
        ).last
        spin[e] = final[:, 8]
        if e == 1.0:
            normal = final[:, 6]
        assert (final[:, 6] == normal).all()  # the normal force does not use it
    assert (spin[1.0] == 0).all() and (spin[0.8] > 0).all() and (spin[0.5] > spin[0.8]).all()
