# SPDX-License-Identifier: GPL-2.0-or-later
"""Stiff bulk scenes for LIGGGHTS: lattices of some 2,000 equal frictionless spheres, laterally periodic."""

from dataclasses import dataclass, replace

import numpy as np

from ...laws.strengths import default_numbers
from ...theory import pair
from ...theory.backbones import LAWS, Backbone
from ...theory.timestep import stability_limit

DENSITY, POISSON = 7800.0, 0.3
STEEL = (208e9, 3.0e9)  # E [Pa], p_y [Pa]
SHARE = 0.02  # of the stability limit at the highest speed: e_n within 1e-4


@dataclass(frozen=True)
class Scene:
    """Equal spheres of one radius [m]; materials are (E, p_y) [Pa] by type. Plates: a floor at 0, the other on top."""

    name: str
    title: str
    radius: float
    materials: tuple[tuple[float, float], ...]
    box: np.ndarray  # (3,) [m], from the origin
    kind: np.ndarray  # type of each sphere, from 1, shape (n,)
    position: np.ndarray  # (n, 3) [m]
    velocity: np.ndarray  # (n, 3) [m/s]
    highest_speed: float  # of a contact [m/s]: chooses the time step
    duration: float  # [s]
    plate_speed: float = 0.0  # downward [m/s]; 0: no plates
    law: str = "thornton"

    @property
    def mass(self) -> float:
        """Of one sphere [kg]."""
        return float(pair.sphere_mass(radius=self.radius, density=DENSITY))

    def theory(self, i: int, j: int, *, plate: bool = False) -> Backbone:
        """The backbone of types i and j (from 1); of a sphere on a plate of type 1 if `plate`."""
        (Ei, pi), (Ej, pj) = self.materials[i - 1], self.materials[j - 1]
        E_star = float(pair.E_star(Ei, POISSON, Ej, POISSON))
        spec = default_numbers(self.law).pair(self.strength(pi), self.strength(pj))
        R_star = self.radius if plate else self.radius / 2
        law = spec.theory(E_star=E_star, R_star=R_star)
        assert isinstance(law, Backbone)  # laws with adhesion have cases of their own
        return law

    def strength(self, p_y: float) -> float:
        """The law's strength [Pa] of a material of yield pressure p_y [Pa]: that pressure, or a yield stress."""
        pressure_over_stress = LAWS["thornton"].default_ratio
        return p_y / pressure_over_stress if LAWS[self.law].strength == "yield_stress" else p_y

    def time_step(self) -> float:
        """SHARE of the smallest stability limit of all pairs at the highest speed [s]."""
        limits = []
        for i in range(1, len(self.materials) + 1):
            law = self.theory(i, i)
            a = law.radius(law.overlap_of_work(0.25 * self.mass * self.highest_speed**2))
            limits.append(float(stability_limit(E_star=law.E_star, m_star=0.5 * self.mass, radius=a)))
        return SHARE * min(limits)


def _lattice(n: tuple[int, int, int], spacing: float) -> np.ndarray:
    axes = [spacing * (np.arange(k) + 0.5) for k in n]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def _agitated(rng: np.random.Generator, n: int, speed: float) -> np.ndarray:
    """Random velocities of that root mean square speed with no net momentum, (n, 3)."""
    v = rng.normal(0.0, speed / np.sqrt(3.0), (n, 3))
    return np.asarray(v - v.mean(axis=0))


def plate(n: tuple[int, int, int] = (13, 13, 12)) -> Scene:
    """Steel spheres as a loose lattice, compressed by a plate at 20 m/s to two thirds of its height."""
    R, spacing, speed = 5e-3, 12e-3, 20.0
    position = _lattice(n, spacing)
    box, rng = spacing * np.array(n), np.random.default_rng(1)
    return Scene(
        "plate",
        "Steel spheres compressed by a plate to two thirds of their height",
        R,
        (STEEL,),
        box,
        np.ones(len(position), int),
        position,
        _agitated(rng, len(position), 1.0),
        3 * speed,
        box[2] / 3 / speed,
        plate_speed=speed,
    )


def mixture(n: tuple[int, int, int] = (13, 13, 12)) -> Scene:
    """Spheres of 1 TPa and 1 MPa, every other one, flying about at 1 m/s."""
    R, spacing, rng = 5e-3, 11e-3, np.random.default_rng(2)
    position = _lattice(n, spacing)
    kind = 1 + (np.indices(n).sum(axis=0).reshape(-1) % 2)
    return Scene(
        "mixture",
        "Spheres of 1 TPa and 1 MPa",
        R,
        ((1e12, 1e10), (1e6, 5e4)),
        spacing * np.array(n),
        kind,
        position,
        _agitated(rng, len(position), 1.0),
        4.0,
        5e-3,
    )


def shock(n: tuple[int, int, int] = (10, 10, 20)) -> Scene:
    """Two blocks of steel spheres meeting at 300 m/s."""
    R, spacing, rng = 5e-3, 11e-3, np.random.default_rng(3)
    position = _lattice(n, spacing)
    box = spacing * np.array(n, float)
    velocity = _agitated(rng, len(position), 1.0)
    velocity[:, 2] += np.where(position[:, 2] < box[2] / 2, 150.0, -150.0)
    position[:, 2] += box[2] / 2  # room before and behind
    return Scene(
        "shock",
        "Two blocks of steel spheres meet at 300 m/s",
        R,
        (STEEL,),
        box * (1, 1, 2),
        np.ones(len(position), int),
        position,
        velocity,
        300.0,
        4e-4,
    )


SCENES = {"plate": plate, "mixture": mixture, "shock": shock}


def with_law(scene: Scene, law: str) -> Scene:
    """The scene with another law of the same yield pressure."""
    return replace(scene, law=law)
