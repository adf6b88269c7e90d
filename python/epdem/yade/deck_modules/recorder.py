# SPDX-License-Identifier: GPL-2.0-or-later
"""Output of a scene in YADE: rows on the screen (also its progress), frames and contact tables in files."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from yade import O

from .contact import Contact
from .contacts import Contacts


class Remembering(Contacts):
    """Keeps every contact that has yielded until its end is written: YADE deletes it when the bodies separate."""

    def __init__(self, law: str, interval: int | None = None, tolerance: float = 0.0, **ratios: float):
        super().__init__(law, interval, tolerance, **ratios)
        self.dented: dict[Contact, bool] = {}  # in the order in which they yielded

    def _correct(self, contact: Contact, force: float, computed: float) -> None:
        super()._correct(contact, force, computed)
        if contact.delta_max > 0.0:
            self.dented[contact] = True


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
    ):
        self.folder, self.spheres, self.contacts, self.low, self.high = folder, spheres, contacts, low, high
        self.every, self.frames, self.spins, self.tables, self.load = every, frames, spins, tables, load
        self.states = [O.bodies[k].state for k in range(len(spheres))]
        self.mass = np.array([s.mass for s in self.states])
        self.gravity = np.array([0.0, 0.0, fall])
        self._sum, self._samples = 0.0, 0
        print("Step particles kinetic_energy" + (f" {load[0]}" if load else ""))

    def record(self) -> None:
        """Between forces and motion: all that is due at this step."""
        if self.load:
            _, body, sign = self.load
            self._sum, self._samples = self._sum + sign * O.forces.f(body)[2], self._samples + 1
        if O.iter % self.every == 0:
            self.row()
        if self.frames and O.iter % self.frames == 0:
            self.frame()
        if self.tables and O.iter % self.tables == 0:
            self.contact_table()

    def positions(self) -> Any:
        """(n, 3) [m]."""
        return np.array([tuple(s.pos) for s in self.states])

    def velocities(self) -> Any:
        """(n, 3) at the time of the positions: YADE keeps velocities of half a step before [m/s]."""
        force = np.array([tuple(O.forces.f(k)) for k in range(len(self.states))])
        return np.array([tuple(s.vel) for s in self.states]) + 0.5 * O.dt * (force / self.mass[:, None] + self.gravity)

    def row(self) -> None:
        """Print step, spheres in the room, kinetic energy of their motion [J], mean load [N]."""
        x, v = self.positions()[:, 3 - len(self.low) :], self.velocities()
        inside = int(((x > self.low) & (x < self.high)).all(axis=1).sum())
        energy = float(0.5 * self.mass @ (v * v).sum(axis=1))
        line = f" {O.iter} {inside} {energy:.10g}"
        if self.load:
            line += f" {self._sum / self._samples:.10g}"
            self._sum, self._samples = 0.0, 0
        print(line, flush=True)

    def frame(self) -> None:
        """Write every sphere."""
        columns = [np.arange(1, len(self.mass) + 1), self.spheres[:, 4], self.spheres[:, 3], self.mass]
        columns += [*self.positions().T, *self.velocities().T]
        if self.spins:
            inertia = np.array([s.inertia[0] for s in self.states])
            torque = np.array([tuple(O.forces.t(k)) for k in range(len(self.states))])
            spin = np.array([tuple(s.angVel) for s in self.states])
            columns += [*(spin + 0.5 * O.dt * torque / inertia[:, None]).T]
        np.save(self.folder / f"particles.{O.iter}.npy", np.column_stack(columns))

    def contact_table(self) -> None:
        """Write every contact: sphere, other body (from 0), overlap, largest overlap [m] (0: never yielded).

        Overlap 0: the bodies have separated since the last table.
        """
        rows = [
            (*sorted((i.id1, i.id2)), i.geom.penetrationDepth, i.phys.adhesionForce) for i in O.interactions if i.isReal
        ]
        if isinstance(self.contacts, Remembering):
            for contact in [c for c in self.contacts.dented if not c.alive]:
                rows.append((*sorted(contact.bodies), 0.0, contact.delta_max))
                del self.contacts.dented[contact]
        np.save(self.folder / f"contacts.{O.iter}.npy", np.array(rows, float).reshape(-1, 4))
