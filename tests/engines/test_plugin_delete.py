# SPDX-License-Identifier: GPL-2.0-or-later
"""Between two runs of LIGGGHTS numbers of spheres change, and lists: histories stay with their contacts."""

import numpy as np
import pytest
from plugin_decks import DUMP, Bodies, deck_of, good, materials, per_pair

pytestmark = pytest.mark.liggghts

HALVES = "group one id 3 17 40:44 90\ngroup two id 5 60:70 101\n"
BOTH = HALVES + "group both union one two\n"


def bed():
    """125 spheres that touch, yield and slide on each other."""
    rng = np.random.default_rng(3)
    places = 1.99e-3 * (np.array(list(np.ndindex(5, 5, 5))) - 2.0) + rng.uniform(-2e-6, 2e-6, (125, 3))
    return Bodies(rng.integers(1, 4, 125), np.full(125, 1e-3), places, rng.uniform(-3, 3, (125, 3)))


def end(folder, between, *, tangential="history", ranks=1, env=None):
    """Places, velocities and spins at the end, in the order of the places; the second run is one of many contacts."""
    properties = materials("ep/thornton") + per_pair("coefficientRollingFriction", 0.1)
    words = {"tangential": tangential, "models": "rolling_friction epsd2", "top": {"ranks": (ranks, 1, 1)}}
    body = f"run 200\n{between}run 200\n{DUMP.format(every=1)}run 0\n"
    text = deck_of("ep/thornton", body, dt=5e-8, skin=2e-4, properties=properties, **words)
    files = {"box.data": bed().data([(-0.01, 0.01)] * 3)}
    rows = good(folder, text, files=files, ranks=ranks, env=env).last[:, 1:]
    return rows[np.lexsort(np.round(rows[:, :3], 5).T)]


@pytest.mark.parametrize("tangential", ["history", "ep/partial_slip"])
def test_new_numbers_change_no_bit(tmp_path, tangential):
    """`compress no` keeps the numbers."""
    old = end(tmp_path / "old", BOTH + "delete_atoms group both compress no\n", tangential=tangential)
    new = end(tmp_path / "new", BOTH + "delete_atoms group both\n", tangential=tangential)
    other = end(
        tmp_path / "loop", BOTH + "delete_atoms group both\n", tangential=tangential, env={"EPDEM_LOOP": "generic"}
    )
    assert len(old) == 125 - 21 and np.array_equal(new, old) and np.array_equal(other, old)


@pytest.mark.parametrize("compress", ["yes", "no"])
def test_two_deletions_are_one(tmp_path, compress):
    """The second finds the spheres at other places in memory than the lists of the first run say."""
    once = end(tmp_path / "once", BOTH + "delete_atoms group both compress no\n")
    two = HALVES + "".join(f"delete_atoms group {name} compress {compress}\n" for name in ("one", "two"))
    twice = end(tmp_path / "twice", two)
    assert len(once) == len(twice) and np.abs(twice - once).max() <= 1e-9 * np.abs(once).max()


def test_ranks_give_partners_the_same_numbers(tmp_path):
    """On three, of which the last has the numbers of two before it."""
    one = end(tmp_path / "one", BOTH + "delete_atoms group both\n")
    three = end(tmp_path / "three", BOTH + "delete_atoms group both\n", ranks=3)
    scale = np.abs(one).max(axis=0)
    assert len(one) == len(three) and (np.abs(three - one) / scale).max() <= 1e-9


@pytest.mark.parametrize("between", ["neigh_modify one 500 page 200000", "neighbor 2e-4 nsq"])
def test_new_lists_keep_histories(tmp_path, between):
    kept, anew = end(tmp_path / "kept", ""), end(tmp_path / "anew", between + "\n")
    assert np.abs(anew - kept).max() <= 1e-9 * np.abs(kept).max()
