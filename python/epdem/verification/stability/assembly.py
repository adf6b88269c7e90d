# SPDX-License-Identifier: GPL-2.0-or-later
"""Assemblies: equal frictionless spheres at given positions, laterally periodic, and their plan."""

import math
from dataclasses import dataclass

import numpy as np

from ...laws.strengths import default_numbers, yields_by_stress
from ...theory import pair
from ...theory.backbones import LAWS, Backbone
from ...theory.timestep import stability_limit

SHARE = 0.02  # of the stability limit at the highest speed: e_n within 1e-4


@dataclass(frozen=True)
class Assembly:
    """Equal spheres of one radius [m]; materials are (E, p_y) [Pa] by type. Plates: a floor at 0, the other on top."""

    name: str
    title: str
    radius: float
    density: float  # [kg/m^3]
    poisson_ratio: float
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
        return float(pair.sphere_mass(radius=self.radius, density=self.density))

    def theory(self, i: int, j: int, *, plate: bool = False) -> Backbone:
        """The backbone of types i and j (from 1); of a sphere on a plate of type 1 if `plate`."""
        (Ei, pi), (Ej, pj) = self.materials[i - 1], self.materials[j - 1]
        E_star = float(pair.E_star(Ei, self.poisson_ratio, Ej, self.poisson_ratio))
        spec = default_numbers(self.law).pair(self.strength(pi), self.strength(pj))
        R_star = self.radius if plate else self.radius / 2
        law = spec.backbone(E_star=E_star, R_star=R_star, radius=self.radius)
        return law

    def strength(self, p_y: float) -> float:
        """The law's strength [Pa] of a material of yield pressure p_y [Pa]: that pressure, or a yield stress."""
        pressure_over_stress = LAWS["thornton"].declaration().default_ratio
        return p_y / pressure_over_stress if yields_by_stress(self.law) else p_y

    def time_step(self) -> float:
        """SHARE of the smallest stability limit of all pairs at the highest speed [s]."""
        limits = []
        for i in range(1, len(self.materials) + 1):
            law = self.theory(i, i)
            a = law.radius(law.overlap_of_work(0.25 * self.mass * self.highest_speed**2))
            limits.append(float(stability_limit(E_star=law.E_star, m_star=0.5 * self.mass, radius=a)))
        return SHARE * min(limits)


@dataclass(frozen=True)
class AssemblyPlan:
    """An assembly with its time step [s], and how many `frames` of spheres, with or without `contacts`, are written.

    Without frames nothing is recorded or booked.
    """

    assembly: Assembly
    time_step: float
    frames: int
    contacts: bool = True

    @property
    def every(self) -> int:
        """Steps from one frame to the next."""
        return max(1, math.ceil(self.assembly.duration / self.time_step) // (self.frames or 1))

    @property
    def steps(self) -> int:
        """Of the whole run, which ends with a frame."""
        return self.every * math.ceil(math.ceil(self.assembly.duration / self.time_step) / self.every)


@dataclass(frozen=True)
class ContactFrame:
    """The contacts of a frame: numbers of the spheres from 0, (n, 2), or (n, 1) with a plate; overlap now and the
    largest so far [m], (n,)."""

    spheres: np.ndarray
    overlap: np.ndarray
    overlap_max: np.ndarray
