# SPDX-License-Identifier: GPL-2.0-or-later
"""Strengths in LIGGGHTS per type, per pair, as a ratio or left out."""

import numpy as np
import pytest
from plugin_decks import DUMP, NU, P_Y, Bodies, E, Y, deck_of, good, materials

pytestmark = pytest.mark.liggghts

BOX = ((-0.02, 1.0), (-0.02, 0.02), (-0.001, 0.2))
R = 5e-3


def e_star(i, j):
    return 1 / ((1 - NU[i - 1] ** 2) / E[i - 1] + (1 - NU[j - 1] ** 2) / E[j - 1])


def wall_impacts(folder, model, types, v, w=None, *, dt=2e-8, steps=8000, properties=None):
    """Spheres of radius R on the wall of type 2; final frame with columns id x y z v w."""
    n = len(types)
    x = np.array([[0.012 * k, 0.0, R + 0.5 * dt * abs(v[k][2])] for k in range(n)])
    bodies = Bodies(np.array(types), np.full(n, R), x, np.asarray(v, float), w)
    body = f"run {steps}\n{DUMP.format(every=1)}run 0\n"
    text = deck_of(model, body, dt=dt, properties=properties or materials(model, friction=0.0), wall="primitive")
    return good(folder, text, files={"box.data": bodies.data(BOX)})


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
