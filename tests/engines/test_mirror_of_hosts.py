# SPDX-License-Identifier: GPL-2.0-or-later
"""Like spheres that meet and their mirror image, half of them and a rigid plane, in every host: one motion to 1e-12.

Lengths in radii, E/Y = 30; spheres lie and move symmetrically to the plane z = 0 or hit a rigid plane there.
"""

import numpy as np
import pytest
from free_spheres import FORCE, HOSTS, PLASTIC, Scene, frames

Y, RIGID = 1e6, 1e25
GAMMA = 0.02 * Y  # work of adhesion of two spheres; half of it at the plane
LAWS = {
    "hertz": {},
    "thornton": {"yieldPressure": 2.8 * Y},
    "johnson": {"yieldPressure": 3.0 * Y},
    "cavity": {"yieldStress": Y, "firstYieldRatio": 1.7, "plasticRatio": 2.8},
    "cavity, finite strain": {"yieldStress": Y, "firstYieldRatio": 1.6, "plasticRatio": 2.8, "finiteStrain": 0.82},
    "cavity, compaction": {"yieldStress": Y, "firstYieldRatio": 1.6, "plasticRatio": 2.8, "finiteStrain": 0.82},
    "meyer": {"yieldPressure": 2.8 * Y, "hardeningExponent": 0.3},
    "jkr": {"workOfAdhesion": GAMMA},
    "thornton_ning": {"workOfAdhesion": GAMMA, "yieldPressure": 2.8 * Y},
    "cavity_adhesive": {"workOfAdhesion": GAMMA / 2, "yieldStress": Y, "firstYieldRatio": 1.6, "plasticRatio": 2.8},
}
LAWS["cavity_adhesive, finite strain"] = LAWS["cavity_adhesive"] | {"workOfAdhesion": GAMMA / 4, "finiteStrain": 0.82}
OF_PLANE = {"E": RIGID, "nu": 0.0, "yieldPressure": RIGID, "yieldStress": RIGID, "workOfAdhesion": 0.25}
SPEEDS = np.array([0.01, 0.1, 0.5, 1.0])
ALONE = np.array([[6.0 * k, 0.0, 1.001] for k in range(4)]), np.array([[0.0, 0.0, -v] for v in SPEEDS])
# one sphere above the plane, which a second presses from above and a third from the side
HEAP = (
    np.array([[0.0, 0.0, 1.001], [0.0, 0.0, 3.003], [1.98, 0.0, 1.4]]),
    np.array([[0, 0, -0.2], [0, 0, -0.8], [-0.5, 0, -0.1]]),
)


def images(law, viscous):
    """The spheres above the plane z = 0, and with their mirror image below it."""
    sphere = {"E": 30 * Y, "nu": 0.2, "density": 1e6} | LAWS[law]
    rigid = {key: value * OF_PLANE.get(key, 1.0) for key, value in sphere.items()}
    same = {"law": law.split(",")[0], "materials": [sphere, rigid], "compaction": "compaction" in law}
    same |= {"dt": 0.005, "steps": 1000, "every": 5, "restitution": 0.7 if viscous else None}
    x, v = HEAP if "compaction" in law else ALONE
    flip = [1.0, 1.0, -1.0]
    whole = Scene(x=np.concatenate([x, x * flip]), v=np.concatenate([v, v * flip]), **same)
    return Scene(x=x, v=v, plane=1, **same), whole


CASES = [(law, viscous) for law in LAWS for viscous in (False, True)[: 1 if "workOfAdhesion" in LAWS[law] else 2]]


@pytest.mark.parametrize("host", HOSTS)
@pytest.mark.parametrize(("law", "viscous"), CASES)
def test_mirror_images_are_one(host, law, viscous, tmp_path):
    """Places, velocities, forces and plastic works of the spheres above the plane."""
    half, whole = (frames(host, tmp_path / str(k), s) for k, s in enumerate(images(law, viscous)))
    for column in (2, 5, 11, PLASTIC):
        a, b = half[..., column], whole[:, : half.shape[1], column]
        assert np.abs(a - b).max() <= 1e-12 * max(np.abs(a).max(), 1e-300), column
    assert half[..., 5].max() > 0 and np.abs(half[..., FORCE]).max() > 0
