# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of a scene in YADE: rows on the screen (also its progress), frames and contact tables in files."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from yade import O

KINDS = ("force", "torque")  # of loads
STRAINS = ("largest_radius_ratio", "largest_overlap_ratio")  # contact radius and overlap over R*, so far


class Contacts(Protocol):
    """The contacts of a scene under one law; columns: of the table."""

    columns: int

    def strain(self) -> tuple[float, float]:
        """Largest contact radius and overlap over R* so far."""

    def table(self) -> list[tuple[float, ...]]:
        """Sphere, other body (from 0), overlap and largest overlap [m] of each contact; more columns may follow."""


class Classes:
    """The contacts of epdem_yade; law: its functor, with recordStrain."""

    columns = 5

    def __init__(self, law: Any):
        self.law = law

    def strain(self) -> tuple[float, float]:
        """Largest contact radius and overlap over R* so far."""
        return self.law.largestRadiusRatio, self.law.largestOverlapRatio

    def table(self) -> list[tuple[float, ...]]:
        """As above, and 1 if the bodies are attached."""
        return [
            (*sorted((i.id1, i.id2)), i.geom.penetrationDepth, i.phys.deltaMax, float(i.phys.contactRadius > 0.0))
            for i in O.interactions
            if i.isReal
        ]


class Recorder:
    """Rows, frames and contact tables of the spheres that are bodies 0, 1, ...; all of one row are of one step. SI.

    spheres   (n, 5): x, y, z, radius [m], number of the type
    low, high the room in which a sphere is counted [m], along the last axes if there are fewer than three
    fall      acceleration along z [m/s^2]
    every     steps between two rows
    frames    steps between two frames particles.STEP.npy: id, type, radius, mass, place, velocity, spin if `spins`;
              0: none
    tables    steps between two tables contacts.STEP.npy: see `contact_table`; 0: none
    load      (column, body, sign): the mean of sign times the body's force along z since the last row; None: none
    loads     (wall, its bodies, origin) of walls: means of their force and, where an origin [m] is given, torque
    moving    bodies of walls that move: the mean of the power that they give, wall_power; none: no such column
    unrecorded  (step, step) between which there are no frames and tables
    works     attributes of EpState in the frames; after frictionWork stands the elastic energy of friction
    """

    def __init__(
        self,
        folder: Path,
        spheres: Any,
        contacts: Contacts,
        *,
        low: Sequence[float],
        high: Sequence[float],
        fall: float,
        every: int,
        frames: int = 0,
        spins: bool = False,
        tables: int = 0,
        load: tuple[str, int, float] | None = None,
        loads: Sequence[tuple[str, Sequence[int], Sequence[float] | None]] = (),
        moving: Sequence[int] = (),
        works: Sequence[str] = (),
        unrecorded: Sequence[tuple[int, int]] = (),
    ):
        self.folder, self.spheres, self.contacts, self.low, self.high = folder, spheres, contacts, low, high
        self.every, self.frames, self.spins, self.tables, self.load = every, frames, spins, tables, load
        self.states = [O.bodies[k].state for k in range(len(spheres))]
        self.mass = np.array([s.mass for s in self.states])
        self.free = np.array([[not s.blockedDOFs] for s in self.states])
        self.gravity = np.array([0.0, 0.0, fall])
        self.loads, self.moving, self.works, self.unrecorded = loads, moving, works, unrecorded
        if works:
            O.trackEnergy = True
        kinds = [f"{name}_{kind}" for name, _, origin in loads for kind in KINDS[: 1 if origin is None else 2]]
        self.names = ["wall_power"] * bool(moving) + [f"{kind}_{axis}" for kind in kinds for axis in "xyz"]
        self._sums = np.zeros(len(self.names))
        self._sum, self._samples = 0.0, 0
        contacts.strain()  # from now on
        names = [*STRAINS, *([load[0]] if load else []), *self.names]
        print("Step particles kinetic_energy" + "".join(f" {name}" for name in names))

    def record(self) -> None:
        """Between forces and motion: all that is due at this step."""
        if self.load:
            _, body, sign = self.load
            self._sum, self._samples = self._sum + sign * O.forces.f(body)[2], self._samples + 1
        if self.names:
            self._sums, self._samples = self._sums + self.on_walls(), self._samples + (not self.load)
        if O.iter % self.every == 0:
            self.row()
        if any(begin < O.iter < end for begin, end in self.unrecorded):
            return
        if self.frames and O.iter % self.frames == 0:
            self.frame()
        if self.tables and O.iter % self.tables == 0:
            self.contact_table()

    def on_walls(self) -> Any:
        """The power of moving walls [W], then force [N] and torque [N m] on each wall, in the order of the names."""
        values = []
        if self.moving:
            states = [(k, O.bodies[k].state) for k in self.moving]
            values.append(-sum(O.forces.f(k).dot(s.vel) + O.forces.t(k).dot(s.angVel) for k, s in states))
        for _, bodies, origin in self.loads:
            forces = np.array([tuple(O.forces.f(k)) for k in bodies])
            values += [*forces.sum(axis=0)]
            if origin is not None:
                arms = np.array([tuple(O.bodies[k].state.pos) for k in bodies]) - np.array(origin)
                own = np.array([tuple(O.forces.t(k)) for k in bodies])
                values += [*(own + np.cross(arms, forces)).sum(axis=0)]
        return np.array(values)

    def positions(self) -> Any:
        """(n, 3) [m]."""
        return np.array([tuple(s.pos) for s in self.states])

    def velocities(self) -> Any:
        """(n, 3) at the time of the positions: YADE keeps velocities of half a step before [m/s]."""
        force = np.array([tuple(O.forces.f(k)) for k in range(len(self.states))])
        gain = 0.5 * O.dt * (force / self.mass[:, None] + self.gravity)
        return np.array([tuple(s.vel) for s in self.states]) + self.free * gain

    def row(self) -> None:
        """Print step, spheres in the room, kinetic energy of their motion [J], largest strain so far, mean load [N]."""
        x, v = self.positions()[:, 3 - len(self.low) :], self.velocities()
        inside = int(((x > self.low) & (x < self.high)).all(axis=1).sum())
        energy = float(0.5 * self.mass @ (v * v).sum(axis=1))
        line = f" {O.iter} {inside} {energy:.10g}" + "".join(f" {x:.10g}" for x in self.contacts.strain())
        if self.load:
            line += f" {self._sum / self._samples:.10g}"
        line += "".join(f" {x / self._samples:.10g}" for x in self._sums)
        self._sum, self._sums, self._samples = 0.0, np.zeros(len(self.names)), 0
        print(line, flush=True)

    def frame(self) -> None:
        """Write every sphere."""
        columns = [np.arange(1, len(self.mass) + 1), self.spheres[:, 4], self.spheres[:, 3], self.mass]
        columns += [*self.positions().T, *self.velocities().T]
        if self.spins:
            inertia = np.array([s.inertia[0] for s in self.states])
            torque = np.array([tuple(O.forces.t(k)) for k in range(len(self.states))])
            spin = np.array([tuple(s.angVel) for s in self.states])
            columns += [*(spin + self.free * (0.5 * O.dt * torque / inertia[:, None])).T]
        columns += [np.array([getattr(s, name) for s in self.states]) for name in self.works]
        if "frictionWork" in self.works:
            columns.append(self.friction_energy())
        np.save(self.folder / f"particles.{O.iter}.npy", np.column_stack(columns))

    def friction_energy(self) -> Any:
        """Elastic energy of friction of each sphere [J]: half of a contact with another one, all of it at a wall."""
        energy = np.zeros(len(self.states))
        for i in O.interactions:
            if i.isReal:
                spheres = [k for k in (i.id1, i.id2) if k < len(energy)]
                energy[spheres] += i.phys.frictionEnergy / len(spheres)
        return energy

    def contact_table(self) -> None:
        """Write every contact. Overlap 0: the bodies have separated since the last table."""
        rows = self.contacts.table()
        np.save(self.folder / f"contacts.{O.iter}.npy", np.array(rows, float).reshape(-1, self.contacts.columns))
