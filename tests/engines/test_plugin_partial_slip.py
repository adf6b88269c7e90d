# SPDX-License-Identifier: GPL-2.0-or-later
"""`tangential ep/partial_slip` in LIGGGHTS: energy, Coulomb's limit, frames, words."""

import numpy as np
import pytest
from plugin_decks import LAWS, NU, Bodies, E, contact, good, head, materials, per_pair
from test_plugin_energy import balance, deck

from epdem.theory import pair

pytestmark = pytest.mark.liggghts

SLIP, SLIP_2 = "ep/partial_slip", "ep/partial_slip_2"
BOX = ((-0.02, 0.3), (-0.02, 0.3), (-0.001, 0.05))
R, MU, G_STAR = 5e-3, 0.3, float(pair.G_star(E[1], NU[1], E[1], NU[1]))  # of steel


def moved(folder, law, tangential, motion, steps, *, n=1, dt=1e-7, extra="", settings="", wall="primitive"):
    """Rows id, x, y, z, v (3), f (3) of each step of n spheres on a wall that are moved as `motion` says.

    The spheres begin in touch, far from each other.
    """
    k = np.arange(n + 2)
    x = np.column_stack([0.011 * (k % 16), 0.011 * (k // 16), np.full(n + 2, R)])
    types = np.full(n + 2, 2)
    types[n:] = 1, 3  # LIGGGHTS needs every type up to the largest in use
    x[n:, 2] = 0.04
    text = (
        head()
        + "read_data box.data\nneighbor 1e-3 bin\nneigh_modify delay 0\n"
        + materials(f"ep/{law}", friction=MU)
        + extra
        + contact(f"ep/{law}", wall=wall, tangential=tangential, settings=settings)
        + f"timestep {dt!r}\nthermo_modify lost error norm no\ngroup moving id <= {n}\n"
        + "dump out moving custom 1 out.bin id x y z vx vy vz fx fy fz\n"
        + motion.format(steps=steps)
    )
    files = {"box.data": Bodies(types, np.full(n + 2, R), x, 0 * x).data(BOX)}
    return good(folder, text, files=files).frames()[1]


DEPTH, COUNT = 2e-6, 60


def wandering(wide):
    """Paths of all spheres: sums of two waves with phases of their own, in the plane and along the normal."""
    terms = {"x": (2.0 * wide, 1.3, 3.1, 0.7, 5.3), "y": (1.5 * wide, 2.1, 2.3, 1.1, 4.9)}
    terms["z"] = (0.9, 1.7, 2.7, 2.9, 3.7)
    text = "variable t equal step*dt*6.3e4\n"
    for axis, (size, p, w, q, u) in terms.items():
        a, rate = size * DEPTH, 6.3e4
        text += (
            f"variable d{axis} atom {a!r}*(sin({w}*v_t+{p}*id)+0.6*sin({u}*v_t+{q}*id)-sin({p}*id)-0.6*sin({q}*id))\n"
        )
        text += f"variable v{axis} atom {a * rate!r}*({w}*cos({w}*v_t+{p}*id)+0.6*{u}*cos({u}*v_t+{q}*id))\n"
    return text + "fix go moving move variable v_dx v_dy v_dz v_vx v_vy v_vz\nrun {steps}\n"


@pytest.mark.parametrize("tangential", [SLIP, SLIP_2])
@pytest.mark.parametrize("e", [1.0, 0.5, 0.2])
@pytest.mark.parametrize("law", ["thornton", "cavity"])
def test_on_wandering_paths_friction_is_passive_and_never_above_coulombs_limit(tmp_path, law, e, tangential):
    """60 spheres that load, unload, part and slide; e: both dashpots. Work by the trapezoid rule."""
    extra, settings = (per_pair("coefficientRestitution", e), "viscous on") if e < 1 else ("", "")
    frames = moved(tmp_path, law, tangential, wandering(0.2), 1200, n=COUNT, dt=1e-8, extra=extra, settings=settings)
    v, f = frames[..., 4:7], frames[..., 7:10]
    F, T = f[..., 2], f[..., :2]
    length = np.hypot(T[..., 0], T[..., 1])
    assert np.all(F >= 0) and not np.any(length[F == 0])
    held = F > 0
    ratio = length[held] / (MU * F[held])
    assert 0.9999 < ratio.max() <= 1 + 1e-12
    assert 0.2 < held.mean() < 0.95 and (np.diff(held.astype(int), axis=0) == 1).any()
    assert (ratio < 0.9).mean() > 0.05  # many stick
    if e == 1:
        work = -np.cumsum(0.5 * (T[1:] + T[:-1]) * v[1:, :, :2], axis=0).sum(axis=-1) * 1e-8
        scale = (MU * F.max()) ** 2 / (16 * G_STAR * np.sqrt(R * DEPTH))
        assert work.min() > -1e-9 * scale and work[-1].max() > 0.1 * scale


@pytest.mark.parametrize(
    ("axis", "loop"), [("0 0 1", "ours"), ("0 1 0", "ours"), ("1 0 0", "ours"), ("1 2 2", "ours"), ("0 0 1", "generic")]
)
@pytest.mark.parametrize("tangential", [SLIP, SLIP_2])
def test_a_sheared_pair_that_turns_rigidly_keeps_its_friction(tmp_path, tangential, axis, loop):
    """One revolution in 1000 steps: |T| to 1e-9, and the friction turns with the pair; also in LIGGGHTS's loop.

    Its direction is off by at most the 2 pi^2/steps of a vector that each step projects on the plane of the contact.
    """
    delta, N, dt = 1e-6, 1000, 1e-7
    x = np.array([[0, 0, R - delta / 2], [0, 0, -R + delta / 2], [0.04, 0, 0], [0.04, 0.03, 0]])
    types = np.array([2, 2, 1, 3])
    text = (
        head()
        + "read_data box.data\nneighbor 1e-3 bin\nneigh_modify delay 0\n"
        + materials("ep/hertz", friction=MU)
        + contact("ep/hertz", tangential=tangential)
        + f"timestep {dt!r}\nthermo_modify lost error norm no\ngroup one id 1\ngroup two id <= 2\n"
        + "fix go one move linear 2e-3 1e-3 0\nrun 100\nunfix go\ndump out one custom 1 out.bin id x y z fx fy fz\n"
        + f"fix go two move rotate 0 0 0 {axis} {N * dt!r}\nrun {N}\n"
    )
    box = ((-0.02, 0.06), (-0.02, 0.06), (-0.02, 0.02))
    files = {"box.data": Bodies(types, np.full(4, R), x, 0 * x).data(box)}
    env = {"EPDEM_LOOP": "generic"} if loop == "generic" else {}
    rows = good(tmp_path, text, files=files, env=env).frames()[1][:, 0]
    force = rows[:, 4:7]
    size = np.linalg.norm(force, axis=1)
    assert np.abs(size / size[0] - 1).max() < 1e-9
    tangent = np.linalg.norm(force[0, :2])  # the normal is along z, but for the shear
    assert tangent > 0.01 * size[0]
    assert np.abs(force[-1] - force[0]).max() < 0.01 * tangent
    if axis == "0 0 1":  # half a turn about the normal: the opposite friction
        assert np.abs(force[N // 2, :2] + force[0, :2]).max() < 1e-5 * tangent


@pytest.mark.parametrize("law", LAWS)
def test_the_energy_balance_of_a_rubbing_gas_closes(tmp_path, law):
    """Kinetic (with spin), elastic, plastic, springs of friction, the work that it took: nothing is left over."""
    text = deck(law, steps=20000, every=97, tangential=SLIP)
    rows = balance(tmp_path, text, columns=6)
    kinetic, plastic, elastic, friction, springs = rows[:, 1:].T
    total = kinetic + plastic + elastic + friction + springs
    assert np.abs(total / kinetic[0] - 1).max() < 2e-3
    assert friction[-1] > 0.2 * kinetic[0] and springs.max() > 1e-4 * kinetic[0]
    assert np.diff(friction).min() > -1e-12 * kinetic[0]
