# SPDX-License-Identifier: GPL-2.0-or-later
"""The spheres of a scene in YADE: spheres of the start and of later phases, and spheres that leave the room."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from yade import O
from yade.utils import sphere


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

    def come(self, phase: str, rows: Any, *keys: tuple[str, int, str]) -> None:
        """Add the spheres of a later phase, see `add`. keys: of each fill and body its place in the case, its number of
        rows and advice. Raises RuntimeError if another sphere is at the place of one."""
        positions, begin = self.positions(), 0
        for key, count, advice in keys:
            for *place, radius in rows[begin : begin + count, :4]:
                if not self.is_free(place, radius * (1.0 - 1e-6), positions):
                    raise RuntimeError(f"{key}: at the begin of phase {phase} another sphere is there; {advice}")
            begin += count
        self.add(rows)

    def is_free(self, place: Any, radius: float, positions: Any) -> bool:
        """Whether a sphere at a place overlaps no other one."""
        way = positions - place
        for axis in np.flatnonzero(self.period):
            way[:, axis] -= self.period[axis] * np.round(way[:, axis] / self.period[axis])
        return bool(((way**2).sum(axis=1) > (radius + self.table[: len(way), 2]) ** 2).all())
