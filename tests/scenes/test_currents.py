# SPDX-License-Identifier: GPL-2.0-or-later
"""Currents through contacts at frames: networks with closed forms, one sphere between two planes, what is refused."""

import itertools

import numpy as np
import pytest
from parts_cases import FLOOR, GLASS, STEEL, bead, mm, parts, timed
from scene_runs import ran

from epdem.scenes.tables.network import node_currents

CELLS = {  # places of a cell in its sides; the next spheres; contacts of a sphere with the next layer; layers of a cell
    "sc": ([(0, 0, 0)], 1.0, 1, 1),
    "bcc": ([(0, 0, 0), (0.5, 0.5, 0.5)], np.sqrt(0.75), 4, 2),
    "fcc": ([(0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)], np.sqrt(0.5), 4, 2),
}


@pytest.mark.parametrize("kind", CELLS)
def test_a_lattice_between_two_walls_is_layers_in_series(kind):
    """Periodic to the sides; the lowest and highest layers touch a wall of 3 V and one of 1 V."""
    places, distance, bonds, layers = CELLS[kind]
    n, height, g, g_wall = 3, 4, 0.7, 1.9
    cells = itertools.product(range(n), range(n), range(height))
    at = np.array([np.add(cell, place) for cell in cells for place in places], float)
    apart = at[:, None] - at[None]
    apart[..., :2] -= n * np.round(apart[..., :2] / n)
    one, other = np.nonzero(np.triu(np.abs(np.linalg.norm(apart, axis=2) - distance) < 1e-9))
    lowest, highest = (np.flatnonzero(at[:, 2] == z) for z in (at[:, 2].min(), at[:, 2].max()))
    i = np.concatenate([one, lowest, highest]) + 2
    j = np.concatenate([other + 2, np.zeros(len(lowest), int), np.ones(len(highest), int)])
    conductance = np.concatenate([np.full(len(one), g), np.full(len(lowest) + len(highest), g_wall)])
    found = node_currents(i, j, conductance, np.array([3.0, 1.0, *np.full(len(at), np.nan)]))
    spheres, count = len(lowest), height * layers
    expected = 2.0 / (2 / (spheres * g_wall) + (count - 1) / (spheres * bonds * g))
    assert found[:2] == pytest.approx([expected, -expected], rel=1e-10)
    assert not found[2:].any()


def test_what_touches_no_wall_carries_no_current():
    """Nodes 0 and 1 are walls; 2 and 3 touch each other alone, 4 joins the walls; 4 and 5 are released."""
    i, j, g = np.array([2, 4, 4, 4]), np.array([3, 0, 1, 5]), np.array([1.0, 2.0, 2.0, 0.0])
    found = node_currents(i, j, g, np.array([1.0, 0.0, *np.full(4, np.nan)]))
    assert found.tolist() == [1.0, -1.0, 0.0, 0.0, 0.0, 0.0]


ROOF = FLOOR | {"name": "roof", "at": "3.98 mm"}


def held(floor=0.0, roof=2.0, **changes):
    """A frozen sphere of glass between two planes of steel."""
    ball = bead("ball", mm(0, 0, 1.99), "2 mm", "glass")
    walls = [w | ({} if V is None else {"potential": f"{V} V"}) for w, V in ((FLOOR, floor), (ROOF, roof))]
    data = parts(wall=walls, fill=[], body=[ball | {"frozen": True}], phase=[timed("rest", "2 ms")])
    data["law"] = {"name": "hertz"}
    data["output"] = {"rows": 20, "particles": 2, "contacts": 2} | changes
    metals = ((GLASS, "3 S/m"), (STEEL, "7 S/m"))
    glass, steel = ({k: v for k, v in m.items() if k != "yield_stress"} for m, _ in metals)
    glass, steel = (m | {"electrical_conductivity": s} for m, (_, s) in zip((glass, steel), metals, strict=True))
    return data | {"materials": {"glass": glass, "steel": steel}}


@pytest.mark.parametrize(
    "engine", [pytest.param(name, marks=getattr(pytest.mark, name)) for name in ("lammps", "liggghts")]
)
def test_a_sphere_between_two_planes_is_two_contacts_in_series(engine, tmp_path):
    """2 k a each, a = sqrt(R delta), 2/k = 1/3 + 1/7."""
    found = ran(held(), tmp_path, engine).results.currents
    expected = (2 / (1 / 3 + 1 / 7)) * np.sqrt(2e-3 * 1e-5)
    assert found["conductance"].to_numpy() == pytest.approx(np.full(3, expected), rel=1e-6)
    assert found["roof_current"].to_numpy() == pytest.approx(2 * found["conductance"].to_numpy(), rel=1e-12)
    assert found["floor_current"].to_numpy() == pytest.approx(-found["roof_current"].to_numpy(), rel=1e-9)
