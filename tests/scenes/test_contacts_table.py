# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of contacts of a bed in which every sphere has its own radius."""

import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from epdem.case import scene
from epdem.case.toml import read_toml
from epdem.scenes.plan.model import pair_law
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables import columns

CASES = Path(__file__).parents[2] / "cases"
N = 100_000


def bed(name):
    """A planned scene and N contacts of it: half with walls of the same type, loaded and partly unloaded."""
    p = plan(scene.parse(read_toml(CASES / f"{name}.toml"), name))
    rng = np.random.default_rng(7)
    radius = rng.uniform(0.5, 1.5, (2, N)) * p.smallest
    R_star = np.where(rng.random(N) < 0.5, radius[0], radius[0] * radius[1] / radius.sum(axis=0))
    largest = 10 ** rng.uniform(-5, -1.5, N) * R_star
    return p, R_star, rng.uniform(0.9, 1.0, N) * largest, largest


@pytest.mark.parametrize("name", ["settle_glass", "adhesive_powder"])
def test_a_hundred_thousand_radii_take_less_than_a_second_and_each_row_is_that_of_the_theory(name):
    p, R_star, overlap, largest = bed(name)
    contacts = pd.DataFrame({"i": 1, "j": 1, "R_star": R_star, "radius": 2 * R_star, "overlap": overlap})
    contacts = contacts.assign(largest=largest, attached=True, screening=1.0, grown_overlap=0.0, body_pressure=0.0)
    begin = time.process_time()
    table = columns.energies(p, contacts)
    assert time.process_time() - begin < 1.0
    spec, E_star = pair_law(p.case, p.model.types[0].material, p.model.types[0].material)
    for k in range(0, N, N // 50):
        law = spec.theory(E_star=E_star, R_star=float(R_star[k]), radius=float(2 * R_star[k]))
        if spec.adheres:
            top = np.maximum(law.radius(largest[k]), law.touch_radius)
            branch, dent = law.branch(top)
            force = branch.force(branch.radius(overlap[k] - dent))
        else:
            dent = law.residual_overlap(largest[k])
            force = law.unloading_force(overlap[k], largest[k]) if overlap[k] > dent else 0.0
        assert table["force"][k] == pytest.approx(force, rel=1e-9, abs=1e-15)
        assert table["residual_overlap"][k] == pytest.approx(dent, rel=1e-9, abs=1e-18)
    assert (table["elastic_energy"] != 0).sum() > N // 10
    assert spec.adheres or (table["plastic_work"] > 0).sum() > N // 10
