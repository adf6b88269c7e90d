# SPDX-License-Identifier: GPL-2.0-or-later
"""Setting computePlasticWork: kinetic, stored and plastic energy of a frictionless bulk scene add up at all times."""

import numpy as np
import pytest
from plugin_decks import LAWS, Bodies, deck_of, good

pytestmark = pytest.mark.liggghts

BOX = ((-0.001, 0.026), (-0.001, 0.026), (-0.001, 0.026))
SIDES = [(f"{axis}plane", at) for axis in "xyz" for at in (0.0, 0.025)]


def gas(speed=8.0):
    """5 x 5 x 5 spheres of three materials and several sizes in a box, each with a velocity of its own."""
    rng = np.random.default_rng(2)
    n = 125
    x = (np.stack(np.meshgrid(*[np.arange(5)] * 3, indexing="ij"), -1).reshape(-1, 3) + 0.5) * 0.005
    return Bodies(rng.integers(1, 4, n), rng.uniform(1.5e-3, 2.4e-3, n), x, rng.uniform(-speed, speed, (n, 3)))


def deck(law, *, steps, every, ranks=1, tangential="off", more=()):
    """A gas between six planes; more: energies of the spheres beside the plastic and the elastic one."""
    words, on = f"model ep/{law} tangential {tangential}", "computePlasticWork on"
    names = ["plasticWork", "elasticEnergy", *more]
    body = "".join(
        f"fix w{k} all wall/gran {words} primitive type 2 {side} {at!r} {on}\n" for k, (side, at) in enumerate(SIDES)
    )
    body += f"compute s all reduce sum {' '.join(f'f_{name}' for name in names)}\n"
    body += "compute l all ke\ncompute r all erotate/sphere\nvariable k equal c_l+c_r\n"
    body += f"thermo_style custom step v_k {' '.join(f'c_s[{k}]' for k in range(1, len(names) + 1))}\nthermo {every}\n"
    body += f"thermo_modify lost error norm no format float %.17g\nrun {steps}\n"
    return deck_of(f"ep/{law}", body, dt=5e-8, tangential=tangential, settings=on, top={"ranks": (ranks, 1, 1)})


def balance(folder, text, ranks=1, columns=4, speed=8.0):
    """Rows of step, kinetic (with spin), plastic, elastic and more energies [J]; those of the start first."""
    lines = good(folder, text, ranks=ranks, files={"box.data": gas(speed).data(BOX)}).text.splitlines()
    rows = [line.split() for line in lines]
    return np.array([r for r in rows if len(r) == columns and all(c.lstrip("-")[:1].isdigit() for c in r)], float)


@pytest.mark.parametrize("law", LAWS)
def test_the_energy_balance_closes_over_1e5_steps(tmp_path, law):
    rows = balance(tmp_path, deck(law, steps=100000, every=97))
    kinetic, plastic, elastic = rows[:, 1:].T
    start = kinetic[0]
    total = kinetic + plastic + elastic
    assert np.abs(total / start - 1).max() < 1e-3
    assert elastic.max() > 1e-2 * start  # some frames catch contacts at work
    assert (np.diff(plastic) >= -1e-13 * start).all()  # LIGGGHTS adds up the atoms in changing order
    assert plastic[-1] == 0 if law == "hertz" else 0.1 < plastic[-1] / start < 1


def test_two_ranks_book_the_same_energy(tmp_path):
    one = balance(tmp_path / "one", deck("thornton", steps=4000, every=50))
    two = balance(tmp_path / "two", deck("thornton", steps=4000, every=50, ranks=2), ranks=2)
    assert np.allclose(one, two, rtol=1e-12, atol=1e-18) and one[-1, 2] > 0


def test_loaded_contacts_are_those_with_a_force(tmp_path):
    """Counted again from LIGGGHTS's own list of contacts, away from the walls, which that list leaves out."""
    output = (
        "compute c all pair/gran/local id force\n"
        "dump l all local 50 local.* c_c[1] c_c[2] c_c[4] c_c[5] c_c[6]\n"
        "dump_modify l format '%.17g %.17g %.17g %.17g %.17g'\n"
        "dump a all custom 50 atoms.* id x y z radius f_loadedContacts\nrun"
    )
    good(tmp_path, deck("thornton", steps=3000, every=1000).replace("run", output), files={"box.data": gas().data(BOX)})
    bearing = resting = 0
    for step in range(50, 3001, 50):
        atoms = np.loadtxt(tmp_path / f"atoms.{step}", skiprows=9)
        pairs = np.loadtxt(tmp_path / f"local.{step}", skiprows=9, ndmin=2).reshape(-1, 5)
        loaded = np.any(pairs[:, 2:] != 0.0, axis=1)
        count = np.bincount(pairs[loaded, :2].astype(int).ravel(), minlength=126)
        x, radius = atoms[:, 1:4], atoms[:, 4]
        free = ((x > radius[:, None]) & (0.025 - x > radius[:, None])).all(axis=1)
        assert (atoms[free, 5] == count[atoms[free, 0].astype(int)]).all()
        bearing, resting = bearing + int(count.sum()), resting + int((~loaded).sum())
    assert bearing > 100 and resting > 10
