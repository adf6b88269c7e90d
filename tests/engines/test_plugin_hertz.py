# SPDX-License-Identifier: GPL-2.0-or-later
"""`ep/hertz` is LIGGGHTS's own `hertz` without damping: a free check of E*, G*, k_n and k_t that nobody here wrote."""

import numpy as np
import pytest
from plugin_decks import DUMP, Bodies, deck_of, good, materials, per_pair

pytestmark = pytest.mark.liggghts
BOX = [(-0.05, 0.2), (-0.05, 0.05), (-0.01, 0.06)]


def final(folder, model):
    """Three pairs of unlike spheres and three spheres on a wall, all oblique and spinning: id x y z v w at the end."""
    R = np.array([0.005, 0.003, 0.004, 0.006, 0.002, 0.005, 0.004, 0.004, 0.004])
    kinds = np.array([1, 2, 2, 3, 3, 1, 1, 2, 3])
    v, w = np.zeros((9, 3)), np.zeros((9, 3))
    x = np.array([[0.02 * (k // 2 if k < 6 else k - 3), 0.0, 0.02 if k < 6 else R[k] + 1e-6] for k in range(9)])
    for k in (0, 2, 4):  # the second of a pair lies above the first, a micrometre away
        x[k + 1, 2] = x[k, 2] + R[k] + R[k + 1] + 1e-6
        v[k], v[k + 1], w[k] = (0.3, 0.1, 1.0), (-0.2, 0.0, -1.0), (50.0, -20.0, 10.0)
    v[6:], w[6:] = (0.5, -0.2, -1.0), (-30.0, 40.0, 5.0)
    properties = materials("hertz", friction=0.2) + per_pair("coefficientRollingFriction", 0.05)
    properties = properties.replace(
        "coefficientRestitution peratomtypepair 3 " + " ".join(["0.7"] * 9),
        "coefficientRestitution peratomtypepair 3 " + " ".join(["1.0"] * 9),
    )
    body = f"run 2000\n{DUMP.format(every=1)}run 0\n"
    deck = deck_of(model, body, properties=properties, wall="primitive", models="rolling_friction cdt")
    return good(folder, deck, files={"box.data": Bodies(kinds, R, x, v, w).data(BOX)}).last


def test_oblique_and_rolling_impacts_of_unlike_bodies_equal_those_of_liggghts_own_hertz(tmp_path):
    """Both add the same terms in another order: 1e-11 of each quantity's largest value after 2000 steps."""
    ours, theirs = final(tmp_path / "ours", "ep/hertz"), final(tmp_path / "theirs", "hertz")
    assert np.abs(theirs[:, 7:10] - [0, 0, 0]).max() > 10 and theirs[:, 6].max() > 0.1  # they spun and rebounded
    for columns in (slice(1, 4), slice(4, 7), slice(7, 10)):
        assert np.abs(ours[:, columns] - theirs[:, columns]).max() <= 1e-11 * np.abs(theirs[:, columns]).max()
