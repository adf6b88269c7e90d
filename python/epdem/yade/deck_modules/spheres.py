# SPDX-License-Identifier: GPL-2.0-or-later
"""The spheres of a scene in YADE: spheres of a table, spheres that come during the run, spheres that leave the room."""

import math
import random
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from yade import O
from yade.utils import sphere

ATTEMPTS = 10_000  # of one sphere; at the densest filling that a scene allows some hundred are needed


def remove(ids: Iterable[int]) -> None:
    """Take bodies out of the scene. The collider of a periodic cell never ends after an erasure: there they stay, at
    rest, and touch nothing."""
    for k in ids:
        if not O.periodic:
            O.bodies.erase(k)
            continue
        body = O.bodies[k]
        for i in body.intrs():
            O.interactions.erase(i.id1, i.id2)
        body.groupMask, body.state.blockedDOFs = 0, "xyzXYZ"
        body.state.vel = body.state.angVel = (0, 0, 0)


class Spheres:
    """The spheres that are in the room, with numbers 0, 1, ... in the order in which they come. SI.

    materials of the types 1, 2, ...; period: lengths of a periodic cell along x and y [m], 0: along an axis without.
    """

    def __init__(self, materials: Sequence[Any], period: Sequence[float] = (0.0, 0.0)):
        self.materials, self.period = materials, np.array([*period, 0.0])
        self.number: dict[int, int] = {}  # of every body that was ever there, walls too
        self.gone: set[int] = set()  # bodies that left the room
        self._came = 0
        self.ids: list[int] = []  # bodies
        self.states: list[Any] = []
        self.table = np.zeros((0, 5))  # number from 1, type, radius [m], mass [kg], 1: not frozen
        self.new: list[Any] = []  # (body, state) of free spheres that have made no step

    def add(self, rows: Iterable[Sequence[float]]) -> None:
        """Add spheres: x, y, z, radius [m], type, velocity [m/s], spin [rad/s], 1: frozen."""
        new = []
        for x, y, z, radius, kind, *motion, frozen in rows:
            body = sphere((x, y, z), radius, material=self.materials[int(kind) - 1], fixed=bool(frozen))
            body.state.vel, body.state.angVel = motion[:3], motion[3:]
            self.ids.append(O.bodies.append(body))
            self.states.append(body.state)
            if not frozen:
                self.new.append((self.ids[-1], body.state))
            self.number[self.ids[-1]] = self._came
            self._came += 1
            new.append((self._came, kind, radius, body.state.mass, not frozen))
        self.table = np.vstack([self.table, np.array(new).reshape(-1, 5)])

    def add_wall(self, number: int, bodies: Sequence[Any]) -> list[int]:
        """Add the bodies of a wall and return their ids. number: of the wall in contact tables, above all spheres."""
        ids: list[int] = O.bodies.append(bodies)
        self.number |= dict.fromkeys(ids, number)
        return ids

    @property
    def came(self) -> int:
        """Number of the spheres that have come."""
        return self._came

    def positions(self) -> Any:
        """(n, 3) [m]."""
        return np.array([tuple(s.pos) for s in self.states]).reshape(-1, 3)

    def remove_outside(self, low: Sequence[float], high: Sequence[float]) -> None:
        """Erase the spheres that have left the room."""
        x = self.positions()
        inside = ((x >= low) & (x < high)).all(axis=1)
        if inside.all():
            return
        left = [k for k, there in zip(self.ids, inside, strict=True) if not there]
        remove(left)
        self.gone |= {*left}
        kept = np.flatnonzero(inside).tolist()
        self.ids, self.states = [self.ids[k] for k in kept], [self.states[k] for k in kept]
        self.table = self.table[inside]

    def require_free(self, phase: str, **bodies: tuple[float, float, float, float]) -> None:
        """Raise RuntimeError if another sphere is at the place of a body: x, y, z, radius [m] of each by its name."""
        positions = self.positions()
        for name, (*place, radius) in bodies.items():
            if not self.is_free(place, radius * (1.0 - 1e-6), positions):
                raise RuntimeError(
                    f"scene.body.{name}.position: at the begin of phase {phase} another sphere is there; move the "
                    "body, or give it another phase"
                )

    def is_free(self, place: Any, radius: float, positions: Any) -> bool:
        """Whether a sphere at a place overlaps no other one."""
        way = positions - place
        for axis in np.flatnonzero(self.period):
            way[:, axis] -= self.period[axis] * np.round(way[:, axis] / self.period[axis])
        return bool(((way**2).sum(axis=1) > (radius + self.table[: len(way), 2]) ** 2).all())


class Fill:
    """Spheres that come during a phase at random places of a region, without overlap. SI.

    sizes      radius [m] and type of each, in the order in which they come
    low, high  limits of the region [m]; circle: x, y and radius of a region that is round about z
    velocity   [m/s]
    batch      spheres that are due every `every` steps; 0: all come in the first step
    """

    def __init__(
        self,
        spheres: Spheres,
        name: str,
        sizes: Any,
        *,
        low: Sequence[float],
        high: Sequence[float],
        seed: int,
        velocity: Sequence[float] = (0.0, 0.0, 0.0),
        circle: Sequence[float] | None = None,
        batch: float = 0.0,
        every: int = 1,
    ):
        self.spheres, self.name, self.sizes, self.velocity = spheres, name, sizes, velocity
        self.low, self.high, self.circle, self.batch, self.every = low, high, circle, batch, every
        self._random = random.Random(seed)
        self._came = self._batches = 0

    def pour(self, step: int) -> None:
        """Add the spheres that are due in a step of the phase. A sphere without a free place comes later."""
        batches = step // self.every + 1
        if batches == self._batches or self._came == len(self.sizes):
            return
        self._batches = batches
        due = min(len(self.sizes), math.floor(batches * self.batch)) if self.batch else len(self.sizes)
        positions = self.spheres.positions()
        while self._came < due:
            radius, kind = self.sizes[self._came]
            place = self._place(radius, positions)
            if place is None and self.batch:
                break
            if place is None:
                raise RuntimeError(
                    f"{self.name}: no room is left for sphere {self._came + 1} without overlap after {ATTEMPTS} "
                    "attempts; give fewer spheres or a larger region"
                )
            self.spheres.add([(*place, radius, kind, *self.velocity, 0.0, 0.0, 0.0, 0.0)])
            positions = np.vstack([positions, place])
            self._came += 1

    def _place(self, radius: float, positions: Any) -> Any:
        for _ in range(ATTEMPTS):
            place = [self._random.uniform(a + radius, b - radius) for a, b in zip(self.low, self.high, strict=True)]
            if self.circle and math.dist(place[:2], self.circle[:2]) > self.circle[2] - radius:
                continue
            if self.spheres.is_free(place, radius, positions):
                return place
        return None
