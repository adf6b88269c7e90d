# SPDX-License-Identifier: GPL-2.0-or-later
"""`tangential ep/partial_slip` in LIGGGHTS: energy, and pairs that turn."""

import numpy as np
import pytest
from plugin_decks import LAWS, Bodies, deck_of, good, materials
from test_plugin_energy import balance, deck

pytestmark = pytest.mark.liggghts

SLIP, SLIP_2 = "ep/partial_slip", "ep/partial_slip_2"
R, MU = 5e-3, 0.3


@pytest.mark.parametrize(
    ("axis", "loop"), [("0 0 1", "ours"), ("0 1 0", "ours"), ("1 0 0", "ours"), ("1 2 2", "ours"), ("0 0 1", "generic")]
)
@pytest.mark.parametrize("tangential", [SLIP, SLIP_2])
def test_a_sheared_pair_that_turns_rigidly_keeps_its_friction(tmp_path, tangential, axis, loop):
    """One revolution in 1000 steps: |T| to 1e-9, and the friction turns with the pair; also in LIGGGHTS's loop. Its
    direction is off by at most the 2 pi^2/steps of a vector that each step projects on the plane of the contact."""
    delta, N, dt = 1e-6, 1000, 1e-7
    x = np.array([[0, 0, R - delta / 2], [0, 0, -R + delta / 2], [0.04, 0, 0], [0.04, 0.03, 0]])
    types = np.array([2, 2, 1, 3])
    body = "group one id 1\ngroup two id <= 2\nfix go one move linear 2e-3 1e-3 0\nrun 100\nunfix go\n"
    body += (
        f"dump out one custom 1 out.bin id x y z fx fy fz\nfix go two move rotate 0 0 0 {axis} {N * dt!r}\nrun {N}\n"
    )
    properties = materials("ep/hertz", friction=MU)
    text = deck_of("ep/hertz", body, dt=dt, properties=properties, move="", tangential=tangential)
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
    text = deck(law, steps=20000, every=97, tangential=SLIP, more=("frictionWork", "frictionEnergy"))
    rows = balance(tmp_path, text, columns=6)
    kinetic, plastic, elastic, friction, springs = rows[:, 1:].T
    total = kinetic + plastic + elastic + friction + springs
    assert np.abs(total / kinetic[0] - 1).max() < 2e-3
    assert friction[-1] > 0.2 * kinetic[0] and springs.max() > 1e-4 * kinetic[0]
    assert np.diff(friction).min() > -1e-12 * kinetic[0]
