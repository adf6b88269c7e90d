# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene for any engine: bodies, motions, times of output. All SI, without names of engines."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np
import pandas as pd

from ...case.motions import FloatArray, Move, RotateMove
from ...case.outputs import Stages
from ...case.parts import Load, Parts
from ...case.places import Limits
from ...case.scene import Output, SceneCase
from ...errors import CaseError
from ...jobs.engine import Engine, Report
from ...jobs.stage import Tables
from . import meshes
from .beds import PressedBed, largest_density, pressed_beds, refuse_below_solid, refuse_heights
from .filling import Insertion, insertions, refuse_missing, refuse_too_many
from .limits import (
    refuse_bodies_in_walls,
    refuse_combinations,
    refuse_faster_than_sound,
    refuse_outside,
    refuse_positions,
    refuse_steps,
    refuse_walls_at_faces,
)
from .model import Heat, Model, heat, model
from .phases import LOOKED, NO_VOID, NOT_REACHED, REACHED, Phase, PhaseSteps, limited
from .quantities import WORKS
from .timestep import time_step, unstable_steps

ROUNDING = 1e-9  # of a number of steps
MISSED = 1e-4  # of the duration of a phase with a given time step, which ends with a row
MORE_ROWS = 10  # times the requested number, so that these phases end with a row
SAMPLES = 50  # of a force, at least, in the mean that a row holds


@dataclass(frozen=True)
class ScenePlan:
    """The job of an engine, from which its tables are made as well.

    triangles: of each wall that is not a plane, at the start, shape (n, 3 corners, 3 coordinates) [m]. loads: walls
    whose force, and if they are meshes torque, is in the rows. beds: that plates press.
    every: steps of a row, and so of the mean forces in it, which are sampled every `sampling` steps; frames, contacts,
    pictures, restarts: steps between two of them, 0: none; all but restarts also at the end of a recorded phase.
    """

    case: SceneCase
    model: Model
    triangles: dict[str, FloatArray]
    insertions: tuple[Insertion, ...]
    loads: tuple[str, ...]
    beds: tuple[PressedBed, ...]
    phases: tuple[Phase, ...]
    every: int
    sampling: int
    frames: int
    contacts: int
    pictures: int
    restarts: int
    heat: Heat | None = None

    @property
    def scene(self) -> Parts:
        """The parts, of which a scene of each kind consists."""
        return self.case.parts

    @property
    def stages(self) -> Stages:
        """Walls and rows of a press, which alone has them."""
        assert self.scene.stages is not None
        return self.scene.stages

    @property
    def pressed(self) -> tuple[PressedBed, ...]:
        """Beds whose relative density is known in the run alone, which ends if it reaches 1."""
        return tuple(bed for bed in self.beds if math.isnan(bed.height))

    @property
    def phase_steps(self) -> tuple[PhaseSteps, ...]:
        """The phases as decks state them."""
        found, upto = [], True
        for before, phase, after in zip((None, *self.phases[:-1]), self.phases, (*self.phases[1:], None), strict=True):
            upto = upto and phase.case.condition is None
            due = (name for name, every in self.intervals.items() if not upto or phase.end % every)
            ends = tuple(due) if phase.case.record else ()
            found.append(PhaseSteps(**vars(phase), before=before, after=after, upto=upto, end_frames=ends))
        return tuple(found)

    @property
    def steps(self) -> int:
        return self.phases[-1].end

    @property
    def time_step(self) -> float:
        """The time step [s] of the first phase without a given time step, else of the first phase."""
        return next((x.time_step for x in self.phases if x.case.time_step is None), self.phases[0].time_step)

    @property
    def intervals(self) -> dict[str, int]:
        """Steps between two frames of each kind that the run writes."""
        every = {"particles": self.frames, "contacts": self.contacts, "pictures": self.pictures}
        return {name: steps for name, steps in every.items() if steps}

    @property
    def ends_early(self) -> bool:
        """Whether a phase may end before its duration, so that the steps of a run are known only after it."""
        return bool(self.pressed) or any(phase.case.condition for phase in self.phases)

    @property
    def solid(self) -> PressedBed | None:
        """The bed without void that has ended the run."""
        ended = [phase.name for phase in self.phases if phase.reached == NO_VOID]
        return next((bed for bed in self.pressed if bed.phase in ended), None)

    def with_ends(
        self,
        ends: Mapping[str, int],
        reached: Mapping[str, str] = MappingProxyType({}),
        held: Mapping[str, tuple[int, float, float, float]] = MappingProxyType({}),
    ) -> "ScenePlan":
        """The plan of a run whose phases ended at these steps; those behind a phase that ended early move with it.

        held: step at which the condition was last looked at, its value, the forces on the opposite wall and the punch.

        reached: NOT_REACHED of the phases that ended by their duration although they have a condition; NO_VOID of a
        phase that ended the run, so that the phases behind it have no step.
        """
        phases: list[Phase] = []
        shift = 0
        for phase in self.phases:
            solid = bool(phases) and phases[-1].reached == NO_VOID
            end = phases[-1].end if solid else ends.get(phase.name, phase.end + shift)
            shift = end - phase.end
            word = NO_VOID if solid else reached.get(phase.name, REACHED if phase.case.condition else phase.reached)
            looked: dict[str, Any] = dict(zip(LOOKED, held[phase.name], strict=True)) if phase.name in held else {}
            phases.append(replace(phase, end=end, reached=word, **looked))
        return replace(self, phases=tuple(phases))

    def with_ways(self, rows: pd.DataFrame) -> "ScenePlan":
        """The plan of a run, with the ways of walls that a condition stops: WALL_way_AXIS [m] of its rows."""
        phases, begin = [], 0
        for phase in self.phases:
            k, condition = phase.measured, phase.case.condition
            if k is not None and condition:
                part = rows[rows["step"].between(begin, phase.end)]
                way = part[f"{condition.wall}_way_{'xyz'[k]}"].to_numpy()
                seconds = (way - way[:1]) / phase.velocity(condition.wall or "")[k]
                phase = replace(phase, slowed=(tuple(part["step"].tolist()), tuple(seconds.tolist())))
            phases.append(phase)
            begin = phase.end
        return replace(self, phases=tuple(phases))

    @property
    def ways(self) -> list[tuple[str, int]]:
        """(wall, axis) of the ways that a run measures, because a condition stops the walls."""
        found = [(x.case.condition.wall, k) for x in self.phases if x.case.condition and (k := x.measured) is not None]
        return [(wall, k) for wall, k in dict.fromkeys(found) if wall]

    @property
    def way_columns(self) -> list[str]:
        """The columns of the rows that have these ways [m]."""
        return [f"{wall}_way_{'xyz'[k]}" for wall, k in self.ways]

    def frame_steps(self, every: int) -> list[int]:
        """The steps of frames written every `every` steps and at the end of a phase, in recorded phases only."""
        begins = [0, *(phase.end for phase in self.phases)]
        recorded = [(begin, phase.end) for begin, phase in zip(begins, self.phases, strict=False) if phase.case.record]
        steps = [*range(0, self.steps + 1, every), *(end for _, end in recorded)]
        return sorted({n for n in steps if any(low <= n <= high for low, high in recorded)})

    def frame_steps_with(self, gate: str, every: int) -> list[int]:
        """The steps of the frames in which a gate is there: a frame at the end of a phase is of this phase."""
        steps, found, first = self.frame_steps(every), [], 0
        for phase in self.phases:
            if phase.case.record and gate in phase.gates:
                found += [n for n in steps if first <= n <= phase.end]
            first = phase.end + phase.case.record
        return found

    @property
    def phase_table(self) -> pd.DataFrame:
        """One row per phase: name, steps and times [s] of its begin and end, whether `until` ended it."""
        ends = np.array([0, *(phase.end for phase in self.phases)])
        times = self.time_at(ends)
        names = [phase.name for phase in self.phases]
        table = {"phase": names, "begin": ends[:-1], "end": ends[1:], "begin_time": times[:-1], "end_time": times[1:]}
        held = [phase.end if phase.held is None else phase.held for phase in self.phases]
        looked = {name: [getattr(x, name) for x in self.phases] for name in LOOKED[1:]}
        return pd.DataFrame(table | {"until": [phase.reached for phase in self.phases], "held": held} | looked)

    def time_at(self, steps: np.ndarray) -> np.ndarray:
        """Times [s] of steps."""
        if len(self.phases) == 1:
            return np.asarray(steps * self.time_step)
        ends = np.array([0, *(phase.end for phase in self.phases)])
        lengths = np.diff(ends) * [phase.time_step for phase in self.phases]
        return np.asarray(np.interp(steps, ends, np.concatenate([[0.0], np.cumsum(lengths)])))

    def middles(self, rows: pd.DataFrame) -> FloatArray:
        """Times [s] in the middle of each row, to which its mean forces belong."""
        return self.time_at((rows["step"] - 0.5 * self.every).clip(lower=0).to_numpy())

    def lasted(self, times: FloatArray) -> list[FloatArray]:
        """How long [s] the motions of each phase have lasted at times [s]: until its end, or its condition held. Of
        walls that slowed the time in which they would have come as far at full speed."""
        found, begin = [], 0.0
        rests = self.time_at(np.array([p.held if p.stops and p.held is not None else p.end for p in self.phases]))
        for phase, rest, end in zip(self.phases, rests, self.phase_table["end_time"], strict=True):
            last = None if phase is self.phases[-1] and rest == end else rest
            seconds = np.clip(times, begin, last) - begin
            if phase.slowed[0]:
                seconds = np.interp(times, self.time_at(np.array(phase.slowed[0])), phase.slowed[1])
            found.append(seconds)
            begin = end
        return found

    def motions_until(self, step: int) -> list[tuple[dict[str, Move], float]]:
        """The motions of each phase and how long [s] they have lasted at a step."""
        lasted = self.lasted(self.time_at(np.array([step])))
        return [(phase.moves, float(seconds[0])) for phase, seconds in zip(self.phases, lasted, strict=True)]

    @property
    def samples(self) -> int:
        """Samples of a force in the mean that a row holds."""
        return self.every // self.sampling

    @property
    def output(self) -> Output:
        return self.case.output

    @property
    def smallest(self) -> float:
        """Smallest radius [m]."""
        return min(p.radii()[0] for p in self.scene.filled)

    @property
    def largest(self) -> float:
        """Largest radius [m]."""
        return max(p.radii()[1] for p in self.scene.filled)

    @property
    def types(self) -> tuple[str, ...]:
        """Names of the types, from number 1."""
        return tuple(t.name for t in self.model.types)

    @property
    def wall_types(self) -> dict[str, int]:
        """The number of the type of each wall."""
        return {w.name: self.model.wall_types[w.material] for w in self.scene.wall}

    @property
    def box(self) -> Limits:
        """xlo xhi ylo yhi zlo zhi of the simulated room [m]."""
        return self.scene.room.limits

    @property
    def count(self) -> int:
        """All spheres that the room gets."""
        return sum(i.count for i in self.insertions) + len(self.scene.table) + len(self.scene.later)

    def count_before(self, phase: str) -> int:
        """All spheres that come before those of a phase."""
        names = [p.name for p in self.phases]
        earlier = names[: names.index(phase)]
        bodies = sum(b.phase in earlier for b in self.scene.later) + (len(self.scene.table) if earlier else 0)
        return bodies + sum(i.count for i in self.insertions if i.phase in earlier)

    @property
    def row_columns(self) -> tuple[str, ...]:
        """The power of moving walls, in the rows of a scene that has their work."""
        moving = any(map(meshes.surface_rotation, self.scene.meshes.values())) or any(p.moves for p in self.phases)
        return ("wall_power",) if moving and (self.output.energy or self.scene.stages) else ()

    @property
    def measured_walls(self) -> tuple[str, ...]:
        """The walls whose forces an engine writes: those of `loads` and of the rows that the scene names."""
        named = {row.wall for row in self.scene.row if row.force or row.torque}
        return tuple(w.name for w in self.scene.wall if w.name in {*self.loads, *named})

    @property
    def potentials(self) -> dict[str, float]:
        """Potentials [V] of walls that have one."""
        return {w.name: w.potential for w in self.scene.wall if w.potential is not None}

    @property
    def heat_flows(self) -> dict[int, str]:
        """The walls into which the rows have a heat flow, by their numbers among the walls with a temperature."""
        walls = enumerate(self.heat.walls if self.heat else (), 1)
        named = {row.wall for row in self.scene.row if row.heat_flow}
        return {n: name for n, name in walls if name in named}

    @property
    def stress_walls(self) -> tuple[str, ...]:
        """The walls whose triangles are in the table of walls."""
        return tuple(name for name, mesh in self.scene.meshes.items() if mesh.stress or mesh.wear)

    @property
    def works(self) -> tuple[str, ...]:
        """The works and energies of each sphere in the frames."""
        return tuple(name for name, work in WORKS.items() if self.output.energy and work.of(self.model))

    @property
    def driven(self) -> list[str]:
        """The walls that a force drives in some phase."""
        return _driven(self.phases)

    def driven_before(self, phase: str) -> list[str]:
        """The walls that a force may have moved before a phase with which single spheres come."""
        names = [p.name for p in self.phases]
        return _driven(self.phases[: names.index(phase)]) if any(b.phase == phase for b in self.scene.later) else []

    def rotations(self, wall: str) -> list[RotateMove]:
        """The rotations of a wall of triangles: of its surface, and in each phase."""
        moves = (phase.moves.get(wall) for phase in self.phases)
        all_moves = [meshes.surface_rotation(self.scene.meshes[wall]), *moves]
        return [move.rotation for move in all_moves if move and move.rotation]

    @property
    def summary(self) -> str:
        """One line for the head of a deck."""
        steps = f"{self.steps} steps of {self.time_step:g} s"
        return f"{self.case.kind}: {self.count} spheres, law {self.model.law}, {steps}"


def _driven(phases: Iterable[Phase]) -> list[str]:
    return sorted({name for p in phases for name, move in p.moves.items() if move.press})


def _rows(output: Output) -> int:
    """Enough rows that the last one is also a frame of particles."""
    frames = max(output.particles, 1)
    return frames * math.ceil(output.rows / frames)


def _row(rows: int, steps: float, given: list[float]) -> int:
    """Steps per row. given: steps in the duration of each phase with a given time step.

    Each of these phases ends within MISSED of its duration, if at most MORE_ROWS times the requested rows do so.
    """
    least = max(1, math.ceil(steps / rows))
    tens = 10 ** max(0, len(str(least)) - 2)  # round numbers: samples divide a row, and a person reads them
    every = int(tens * math.ceil(least / tens))
    if not given:
        return every
    sample = max(1, every // (20 * SAMPLES))
    found = np.array([every, *range(every // sample * sample, max(1, every // MORE_ROWS) - 1, -sample)])
    wanted = np.array(given)[:, None]
    missed = (np.abs(np.maximum(np.rint(wanted / found), 1.0) * found / wanted - 1.0)).max(axis=0)
    return int(found[np.argmax(missed <= max(MISSED, missed.min()))])


def _phases(scene: Parts, rows: int, every: int, dt: float, given: float | None) -> tuple[Phase, ...]:
    """The phases, each of which ends with a row: at the row next to its duration with a given time step, else exactly
    at its duration, with a step of at most dt. Loading and release of a press last as long as their pressures need:
    they have the step dt, so that their densities do not depend on the rows."""
    phases, end = [], 0
    for phase in scene.phase:
        step = phase.time_step or given
        if scene.stages and phase.condition and not step:
            own, step = math.ceil(phase.seconds / dt / every * (1.0 - ROUNDING)), dt
        elif step:
            own = max(1, round(phase.seconds / step / every))
        else:
            own = rows if len(scene.phase) == 1 else math.ceil(phase.seconds / dt / every * (1.0 - ROUNDING))
            step = phase.seconds / (every * own)
        end += every * own
        gates = tuple(w.name for w in scene.gates if phase.name in w.phases)
        reached = "" if phase.travels is None else REACHED if phase.travels else NOT_REACHED
        phases.append(Phase(phase, end, step, gates, reached))
    return tuple(phases)


def _loads(case: SceneCase, scene: Parts) -> tuple[str, ...]:
    """The walls whose forces a scene requests: for its output unless it names rows, for a condition, for a
    measure, and those that a force drives."""
    gates = {w.name for w in scene.gates}
    loads = {w.name for w in scene.wall} - gates if case.output.loads and not scene.row else set()
    conditions = [p.condition for p in scene.phase if p.condition and not p.condition.of_bed]
    loads |= {c.wall for c in conditions if c.wall}
    loads |= {m.wall for m in scene.measure if isinstance(m, Load)}
    loads |= {m.wall for p in scene.phase for m in p.move if m.press}
    return tuple(w.name for w in scene.wall if w.name in loads)


def plan(case: SceneCase) -> ScenePlan:
    """The plan of a scene. Raises CaseError for what does not fit."""
    refuse_faster_than_sound(case)
    contact_model, scene, out = model(case), case.parts, case.output
    triangles = meshes.triangles(scene)
    refuse_positions(scene)
    refuse_outside(scene, triangles)
    meshes.refuse_leaving(scene, triangles)
    refuse_bodies_in_walls(scene, triangles)
    refuse_walls_at_faces(scene, triangles)
    refuse_combinations(case, scene)
    filled = insertions(case, scene)
    refuse_too_many(case, filled)
    refuse_missing(case)
    beds = tuple(pressed_beds(case, scene, filled))
    refuse_below_solid(beds)
    refuse_heights(scene, beds)
    density = largest_density(scene, beds)
    dt = time_step(case, density)
    duration = sum(phase.seconds for phase in scene.phase)
    steps = duration / dt
    if any(phase.time_step for phase in scene.phase):
        steps = sum(phase.seconds / (phase.time_step or dt) for phase in scene.phase)
    given = case.numerics.time_step
    fixed = [phase.seconds / step for phase in scene.phase if (step := phase.time_step or given)]
    rows = _rows(out)
    if rows > steps and (unstable := unstable_steps(case, density)):  # too long a step leaves too few for the rows
        raise CaseError(unstable[0])
    refuse_steps(case, rows, duration, duration / steps)
    every = _row(rows, steps, fixed)

    count = sum(f.count for f in filled) + len(scene.table) + len(scene.later)
    planned = _phases(scene, rows, every, dt, given)
    phases = tuple(limited(contact_model, scene, triangles, count, planned))
    whole = phases[-1].end // every

    def interval(count: int, rows: int = max(rows, whole)) -> int:
        return 0 if count == 0 else every * max(1, rows // count)

    frames = interval(out.particles)
    contacts = interval(out.contacts or (out.particles if out.energy else 0))
    if frames and contacts:  # of frames, in which the spheres are known
        contacts = frames * max(1, contacts // frames)
    return ScenePlan(
        case=case,
        model=contact_model,
        triangles=triangles,
        insertions=filled,
        loads=_loads(case, scene),
        beds=beds,
        phases=phases,
        every=every,
        sampling=next(d for d in range(max(1, every // SAMPLES), 0, -1) if every % d == 0),
        frames=frames,
        contacts=contacts,
        pictures=interval(out.pictures),
        restarts=interval(out.restarts, whole),
        heat=heat(case, contact_model),
    )


class SceneEngine(Engine[ScenePlan, Tables], Protocol):
    """An engine of scenes, whose tables are rows, particles, contacts, walls and phases, as far as a plan has them."""

    def read(self, plan: ScenePlan, folder: Path) -> Tables:
        """The tables of a run that has ended in `folder`. Raises EngineError for what is missing or not whole."""

    def resume(self, job: ScenePlan, folder: Path, *, ranks: int, report: Report) -> tuple[Tables, int, list[int]]:
        """Continue a run from its newest restart file: tables, the step of the file, steps of earlier frames that are
        missing or not whole. Raises CaseError if there is none, EngineError."""
