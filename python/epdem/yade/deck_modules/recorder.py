# SPDX-License-Identifier: GPL-2.0-or-later
"""Phases of a scene in YADE, and its output: rows on the screen, frames and contact tables in files."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from yade import O
from yade.utils import sumForces, sumTorques
from yade.wrapper import PyRunner

from .spheres import Spheres, remove

KINDS = ("force", "torque")  # of loads
GROWTH = ("addedOverlap", "screening", "grownOverlap", "bodyPressure", "retreat")  # of contacts with compaction
AXES = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
STRAINS = ("largest_radius_ratio", "largest_overlap_ratio")  # contact radius and overlap over R*, times w, so far


class Recorder:
    """Rows, frames and contact tables; all of one row are of one step. SI.

    law       functor of the law, with recordStrain
    low, high the room that a sphere must not leave [m]
    fall      acceleration along z [m/s^2]
    every     steps between two rows
    frames    steps between two frames particles.STEP.npy: id, type, radius, mass, place, velocity, spin if `spins`;
              0: none
    tables    steps between two tables contacts.STEP.npy: see `contact_table`; 0: none
    loads     (wall, its bodies, origin) of walls: means of their force and, where an origin [m] is given, torque
    moving    bodies of each wall that moves: the mean of the power that walls give, wall_power; none: no such column
    works     attributes of EpState in the frames; after frictionWork stands the elastic energy of friction
    """

    def __init__(
        self,
        folder: Path,
        spheres: Spheres,
        law: Any,
        *,
        low: Sequence[float],
        high: Sequence[float],
        fall: float,
        every: int,
        frames: int = 0,
        spins: bool = False,
        tables: int = 0,
        loads: Sequence[tuple[str, Sequence[int], Sequence[float] | None]] = (),
        moving: Sequence[Sequence[int]] = (),
        works: Sequence[str] = (),
    ):
        self.folder, self.spheres, self.law, self.low, self.high = folder, spheres, law, low, high
        self.every, self.frames, self.spins, self.tables = every, frames, spins, tables
        self.gravity = np.array([0.0, 0.0, fall])
        self.loads, self.moving, self.works = loads, moving, works
        if works:
            O.trackEnergy = True
        kinds = [f"{name}_{kind}" for name, _, origin in loads for kind in KINDS[: 1 if origin is None else 2]]
        self.means = ["wall_power"] * bool(moving) + [f"{kind}_{axis}" for kind in kinds for axis in "xyz"]
        self._sums, self._samples = np.zeros(len(self.means)), 0
        self._before: dict[int, Any] = {}  # velocities of the last step of bodies of walls that change theirs
        self.starts = PyRunner(command="recorder.start()", iterPeriod=1, initRun=True, dead=True)  # an engine
        self.strain()  # from now on
        self.names = ["particles", "kinetic_energy", *STRAINS, *self.means]
        self.values: dict[str, float] = {}  # of the last row
        self._begin, self._end, self._records, self._recorded = 0, 0, False, False
        self._until: tuple[Callable[[dict[str, float]], float], Callable[[float], bool]] | None = None  # of this phase
        self._held, self._value = -1, 0.0  # step at which the condition held, what it held at
        self._came = 0  # spheres at the end of the phase before
        self._looked = 0
        self._leaving: list[int] = []
        print("Step", *self.names)

    def run(
        self,
        name: str,
        steps: int,
        *,
        record: bool = True,
        until: tuple[Callable[[dict[str, float]], float], Callable[[float], bool]] | None = None,
        after: int = 0,
    ) -> None:
        """A phase. record: whether it has frames and tables; until: value of a row and whether it ends the phase; rows
        of the first `after` steps do not count.

        The row of a step is known in the step itself, so that walls go on as in this phase for that one step.
        """
        self._records, self._recorded = record, self._records
        self._begin, self._end = self._end, self._end + steps
        self._until, self._looked, self._held = until, self._begin + after, -1
        if until is None:
            while O.iter < self._end:
                self._step()
            self._came = self.spheres.came
            return
        while O.iter <= self._end and self._held < 0:
            self._step()
        self._end, self._came = O.iter - 1, self.spheres.came
        if self._held < 0:
            print(f"phase {name} was not ended by its condition")
        print(f"phase {name} held at step {self._end}: {self._value:.10g}")
        print(f"phase {name} ended at step {self._end}", flush=True)

    def _step(self) -> None:
        self.starts.dead = not self.spheres.new
        O.step()

    def start(self) -> None:
        """Between forces and motion: new spheres get velocity and spin of half a step before, which YADE keeps. One at
        rest under its weight and the forces on it stays at rest."""
        for k, state in self.spheres.new:
            force, torque = (np.array(tuple(x)) for x in (O.forces.f(k), O.forces.t(k)))
            state.vel = np.array(tuple(state.vel)) - 0.5 * O.dt * (force / state.mass + self.gravity)
            state.angVel = np.array(tuple(state.angVel)) - 0.5 * O.dt * torque / state.inertia[0]
        self.spheres.new.clear()

    def finish(self) -> None:
        """The row of the last step."""
        if O.iter == self._end:
            O.step()

    def take_away(self, wall: Sequence[int]) -> None:
        """Remove a wall that goes at the end of a phase: at once if this step is recorded, else behind its record, so
        that a frame still shows it. Spheres that come in between do not touch it."""
        if O.iter > self._end:
            return remove(wall)
        self._leaving += wall
        for bodies, mask in ((self.spheres.ids, 3), (wall, 2)):
            for k in bodies:
                O.bodies[k].groupMask = mask
        return None

    def record(self) -> None:
        """Between forces and motion: all that is due at this step."""
        self._record()
        for k in self._leaving:  # half of its last force acts, for the half of a step that has gone
            for i in (i for i in O.bodies[k].intrs() if i.isReal):
                sphere, side = (i.id2, 1.0) if i.id1 == k else (i.id1, -1.0)
                force = side * (i.phys.normalForce + i.phys.shearForce)
                arm = -side * (O.bodies[sphere].shape.radius - 0.5 * i.geom.penetrationDepth) * i.geom.normal
                O.forces.addF(sphere, -0.5 * force)
                O.forces.addT(sphere, -0.5 * arm.cross(force))
        remove(self._leaving)
        self._leaving.clear()

    def _record(self) -> None:
        if self.means:
            self._sums, self._samples = self._sums + self.on_walls(), self._samples + 1
        if O.iter % self.every == 0:
            self.spheres.remove_outside(self.low, self.high)
            self.row()
            if self._until and self._held < 0 and O.iter > self._looked:
                value, holds = self._until
                self._value = float(value(self.values))
                self._held = O.iter if holds(self._value) else -1
        ended = self._recorded and O.iter == self._begin  # the phase before
        if not (self._records or ended):
            return
        last = ended or self._held >= 0 or O.iter == self._end
        if self.frames and (last or O.iter % self.frames == 0):
            self.frame()
        if self.tables and (last or O.iter % self.tables == 0):
            self.contact_table()

    def move(self, ids: Sequence[int], velocity: Sequence[float]) -> None:
        """Give bodies of a wall their velocity in the coming step [m/s], which is another one in each step."""
        for k in ids:
            self._before[k] = 1.0 * O.bodies[k].state.vel  # a copy: YADE returns the vector itself
            O.bodies[k].state.vel = velocity

    def rest(self, ids: Sequence[int]) -> None:
        """Bring the bodies of a wall to rest."""
        for k in ids:
            self._before.pop(k, None)
            O.bodies[k].state.vel = O.bodies[k].state.angVel = (0, 0, 0)

    def on_walls(self) -> Any:
        """The power of moving walls [W], then force [N] and torque [N m] on each wall, in the order of the names."""
        values = []
        if self.moving:
            power = 0.0
            for bodies in self.moving:  # a wall is rigid: sums over its bodies, which YADE makes, are enough
                s = O.bodies[bodies[0]].state
                turn = s.angVel
                velocity = s.vel - 0.5 * O.dt * turn.cross(s.vel)  # now; a turn's is the mean of the coming step
                if any(turn):
                    center = s.pos + turn.cross(velocity) / turn.squaredNorm()
                    power -= sum(w * sumTorques(bodies, axis, center) for w, axis in zip(turn, AXES, strict=True) if w)
                else:
                    velocity = 0.5 * (velocity + self._before.get(bodies[0], velocity))
                    power -= sum(v * sumForces(bodies, axis) for v, axis in zip(velocity, AXES, strict=True) if v)
            values.append(power)
        for _, bodies, origin in self.loads:
            values += [sumForces(bodies, axis) for axis in AXES]
            if origin is not None:
                values += [sumTorques(bodies, axis, origin) for axis in AXES]
        return np.array(values)

    def velocities(self) -> Any:
        """(n, 3) at the time of the positions: YADE keeps velocities of half a step before [m/s]."""
        force = np.array([tuple(O.forces.f(k)) for k in self.spheres.ids]).reshape(-1, 3)
        *_, mass, free = self.spheres.table.T[..., None]
        speed = np.array([tuple(s.vel) for s in self.spheres.states]).reshape(-1, 3)
        return speed + free * 0.5 * O.dt * (force / mass + self.gravity)

    def shown(self) -> Any:
        """(n,) whether a sphere is of the phase of this step: at the end of a phase those of the next one are not."""
        ended = 0 < O.iter == self._begin
        return self.spheres.table[:, 0] <= (self._came if ended else np.inf)

    def row(self) -> None:
        """Print step, spheres in the room, kinetic energy of their motion [J], largest strain so far, mean loads."""
        there = self.shown()
        v = self.velocities()[there]
        energy = float(0.5 * self.spheres.table[there, 3] @ (v * v).sum(axis=1))
        means = self._sums / max(1, self._samples)
        found = [len(v), energy, *self.strain(), *means.tolist()]
        self.values = dict(zip(self.names, found, strict=True))
        self._sums, self._samples = np.zeros(len(self.means)), 0
        print(f" {O.iter}" + "".join(f" {x:.10g}" for x in found), flush=True)

    def frame(self) -> None:
        """Write every sphere."""
        states, table = self.spheres.states, self.spheres.table
        columns = [*table.T[:4], *self.spheres.positions().T, *self.velocities().T]
        if self.spins:
            inertia = np.array([s.inertia[0] for s in states])[:, None]
            torque = np.array([tuple(O.forces.t(k)) for k in self.spheres.ids]).reshape(-1, 3)
            spin = np.array([tuple(s.angVel) for s in states]).reshape(-1, 3)
            columns += [*(spin + table[:, 4:] * (0.5 * O.dt * torque / inertia)).T]
        columns += [np.array([getattr(s, name) for s in states]) for name in self.works]
        if "frictionWork" in self.works:
            columns.append(self.friction_energy())
        np.save(self.folder / f"particles.{O.iter}.npy", np.column_stack(columns)[self.shown()])

    def friction_energy(self) -> Any:
        """Elastic energy of friction of each sphere [J]: half of a contact with another one, all of it at a wall."""
        energy = dict.fromkeys(self.spheres.ids, 0.0)
        for i in O.interactions:
            if i.isReal:
                spheres = [k for k in (i.id1, i.id2) if k in energy]
                for k in spheres:
                    energy[k] += i.phys.frictionEnergy / len(spheres)
        return np.array([*energy.values()])

    def strain(self) -> tuple[float, float]:
        """Largest contact radius and overlap over R*, times the share of the weaker body in the strain, so far."""
        return self.law.largestRadiusRatio, self.law.largestOverlapRatio

    def contacts(self) -> Iterator[tuple[Any, ...]]:
        """Bodies, overlap, largest overlap [m], 1 if attached, force on the first body [N], unit normal from the second
        body to the first, and GROWTH."""
        for i in (i for i in O.interactions if i.isReal):
            x, force = i.phys, i.phys.normalForce + i.phys.shearForce  # on the second body, as the normal points to it
            attached = x.contactRadius > 0.0 if self.law.cohesion != "bond" else not x.brokenBond
            touch = (i.geom.penetrationDepth, x.deltaMax, attached)
            yield (i.id1, i.id2, *touch, *-force, *-i.geom.normal, *(getattr(x, name) for name in GROWTH))

    def contact_table(self) -> None:
        """Write every contact, bodies by number. Overlap 0: the bodies have separated since the last table."""
        number, gone, width = self.spheres.number, self.spheres.gone, 11 + len(GROWTH) * self.law.compaction
        gone = gone | {k for k, there in zip(self.spheres.ids, self.shown(), strict=True) if not there}
        here = [row[:width] for row in self.contacts() if gone.isdisjoint(row[:2])]
        rows = np.array([(number[a], number[b], *values) for a, b, *values in here], float)
        rows = rows.reshape(-1, width)
        rows[rows[:, 0] > rows[:, 1], 5:11] *= -1.0  # force and normal of the other body
        rows[:, :2] = np.sort(rows[:, :2], axis=1)
        np.save(self.folder / f"contacts.{O.iter}.npy", rows)
