# SPDX-License-Identifier: GPL-2.0-or-later
"""Stiff bulk scenes: lattices of some 2,000 equal frictionless spheres, laterally periodic."""

from dataclasses import replace

import numpy as np

from .assembly import Assembly

DENSITY, POISSON = 7800.0, 0.3
STEEL = (208e9, 3.0e9)  # E [Pa], p_y [Pa]


def _lattice(n: tuple[int, int, int], spacing: float) -> np.ndarray:
    axes = [spacing * (np.arange(k) + 0.5) for k in n]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def _agitated(rng: np.random.Generator, n: int, speed: float) -> np.ndarray:
    """Random velocities of that root mean square speed with no net momentum, (n, 3)."""
    v = rng.normal(0.0, speed / np.sqrt(3.0), (n, 3))
    return np.asarray(v - v.mean(axis=0))


def plate(n: tuple[int, int, int] = (13, 13, 12)) -> Assembly:
    """Steel spheres as a loose lattice, compressed by a plate at 20 m/s to two thirds of its height."""
    R, spacing, speed = 5e-3, 12e-3, 20.0
    position = _lattice(n, spacing)
    box, rng = spacing * np.array(n), np.random.default_rng(1)
    return Assembly(
        "plate",
        "Steel spheres compressed by a plate to two thirds of their height",
        R,
        DENSITY,
        POISSON,
        (STEEL,),
        box,
        np.ones(len(position), int),
        position,
        _agitated(rng, len(position), 1.0),
        3 * speed,
        box[2] / 3 / speed,
        plate_speed=speed,
    )


def mixture(n: tuple[int, int, int] = (13, 13, 12)) -> Assembly:
    """Spheres of 1 TPa and 1 MPa, every other one, flying about at 1 m/s."""
    R, spacing, rng = 5e-3, 11e-3, np.random.default_rng(2)
    position = _lattice(n, spacing)
    kind = 1 + (np.indices(n).sum(axis=0).reshape(-1) % 2)
    return Assembly(
        "mixture",
        "Spheres of 1 TPa and 1 MPa",
        R,
        DENSITY,
        POISSON,
        ((1e12, 1e10), (1e6, 5e4)),
        spacing * np.array(n),
        kind,
        position,
        _agitated(rng, len(position), 1.0),
        4.0,
        5e-3,
    )


def shock(n: tuple[int, int, int] = (10, 10, 20)) -> Assembly:
    """Two blocks of steel spheres meeting at 300 m/s."""
    R, spacing, rng = 5e-3, 11e-3, np.random.default_rng(3)
    position = _lattice(n, spacing)
    box = spacing * np.array(n, float)
    velocity = _agitated(rng, len(position), 1.0)
    velocity[:, 2] += np.where(position[:, 2] < box[2] / 2, 150.0, -150.0)
    position[:, 2] += box[2] / 2  # room before and behind
    return Assembly(
        "shock",
        "Two blocks of steel spheres meet at 300 m/s",
        R,
        DENSITY,
        POISSON,
        (STEEL,),
        box * (1, 1, 2),
        np.ones(len(position), int),
        position,
        velocity,
        300.0,
        4e-4,
    )


SCENES = {"plate": plate, "mixture": mixture, "shock": shock}


def with_law(scene: Assembly, law: str) -> Assembly:
    """The scene with another law of the same yield pressure."""
    return replace(scene, law=law)
