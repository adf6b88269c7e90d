# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene for any engine: bodies, motions, times of output. All SI, without names of engines."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from ..case.kinds import Compaction, Drum
from ..case.parts import Parts
from ..case.scene import Output, SceneCase
from . import kinds
from .filling import refuse_too_many
from .layout import Layout, Linear, Move, Turn, Until
from .limits import refuse_faster_than_sound, refuse_steps
from .model import Model, model
from .shares import refuse_missing
from .timestep import time_step

SAMPLES = 50  # of a force, at least, in the mean that a row holds


@dataclass(frozen=True)
class Phase:
    """A part of the run up to step `end`, or less if `until` holds; what moves in it, which gates are there; record:
    whether it has frames."""

    name: str
    end: int
    moves: dict[str, Move]
    gates: tuple[str, ...] = ()
    until: Until | None = None
    time_step: float | None = None
    record: bool = True

    @property
    def plate(self) -> float:
        """Velocity of the plate along z [m/s]."""
        move = self.moves.get("plate")
        return move.velocity[2] if isinstance(move, Linear) else 0.0


@dataclass(frozen=True)
class ScenePlan:
    """What an engine runs, and what its tables are made from.

    every: steps of a row, and so of the mean forces in it, which are sampled every `sampling` steps; frames, contacts,
    vtk, pictures, restarts: steps between two of them, 0: none.
    """

    case: SceneCase
    model: Model
    layout: Layout
    time_step: float
    phases: tuple[Phase, ...]
    every: int
    sampling: int
    frames: int
    contacts: int
    vtk: int
    pictures: int
    restarts: int

    @property
    def steps(self) -> int:
        """All steps of the run."""
        return self.phases[-1].end

    @property
    def ends_early(self) -> bool:
        """Whether a phase may end before its duration, so that the steps of a run are known only after it."""
        return any(phase.until for phase in self.phases)

    def ended(self, ends: Mapping[str, int]) -> "ScenePlan":
        """The plan of a run whose phases ended at these steps; those behind a phase that ended early move with it."""
        phases, shift = [], 0
        for phase in self.phases:
            end = ends.get(phase.name, phase.end + shift)
            shift = end - phase.end
            phases.append(replace(phase, end=end))
        return replace(self, phases=tuple(phases))

    def frame_steps(self, every: int) -> list[int]:
        """The steps of the frames that are written each so many steps: those of phases that are recorded."""
        begins = [0, *(phase.end for phase in self.phases)]
        recorded = [(begin, phase.end) for begin, phase in zip(begins, self.phases, strict=False) if phase.record]
        return [n for n in range(0, self.steps + 1, every) if any(low <= n <= high for low, high in recorded)]

    @property
    def phase_table(self) -> pd.DataFrame:
        """One row per phase: name, steps and times [s] of its begin and end."""
        ends = np.array([0, *(phase.end for phase in self.phases)])
        times = self.time_at(ends)
        names = [phase.name for phase in self.phases]
        return pd.DataFrame(
            {"phase": names, "begin": ends[:-1], "end": ends[1:], "begin_time": times[:-1], "end_time": times[1:]}
        )

    def time_at(self, steps: np.ndarray) -> np.ndarray:
        """Times [s] of steps."""
        if not any(phase.time_step for phase in self.phases):
            return np.asarray(steps * self.time_step)
        ends = np.array([0, *(phase.end for phase in self.phases)])
        lengths = np.diff(ends) * [phase.time_step or self.time_step for phase in self.phases]
        return np.asarray(np.interp(steps, ends, np.concatenate([[0.0], np.cumsum(lengths)])))

    @property
    def output(self) -> Output:
        """The output that the case requests."""
        return self.case.output

    @property
    def smallest(self) -> float:
        """Smallest radius [m]."""
        return min(p.radii()[0] for p in self.case.scene.filled)

    @property
    def largest(self) -> float:
        """Largest radius [m]."""
        return max(p.radii()[1] for p in self.case.scene.filled)

    @property
    def types(self) -> tuple[str, ...]:
        """Names of the types, from number 1."""
        return tuple(t.name for t in self.model.types)

    @property
    def wall_types(self) -> dict[str, int]:
        """The number of the type of each wall."""
        walls = {w.name: w.material for w in (*self.layout.planes, *self.layout.gates)}
        walls |= {name: mesh.material for name, mesh in self.layout.meshes.items()}
        return {name: self.model.wall_types[material] for name, material in walls.items()}

    @property
    def plates(self) -> bool:
        """Whether there is a plate whose force is measured."""
        return isinstance(self.case.scene, Compaction)

    @property
    def floor_load(self) -> bool:
        """Whether the mean force on the floor is in the rows."""
        floor = any(p.name == "floor" for p in self.layout.planes)
        return floor and self.output.loads and not self.layout.loads

    @property
    def torque(self) -> bool:
        """Whether the mean torque on a drum is in the rows."""
        return isinstance(self.case.scene, Drum) and (self.output.loads or self.output.energy)

    @property
    def powered(self) -> bool:
        """Whether the mean power of moving walls is in the rows: of walls whose work no other column tells."""
        moving = any(m.turn for m in self.layout.meshes.values()) or any(phase.moves for phase in self.phases)
        return moving and self.output.energy and not (self.plates or self.torque)

    @property
    def dents(self) -> bool:
        """Whether the plastic work of each sphere is in the frames."""
        return self.output.energy and self.model.yields

    @property
    def jumps(self) -> bool:
        """Whether the work that adhesion took of each sphere is in the frames."""
        return self.output.energy and self.model.adheres

    @property
    def rubs(self) -> bool:
        """Whether the work of friction of each sphere is in the frames."""
        return self.output.energy and self.model.nodes > 0

    def turns(self, wall: str) -> list[Turn]:
        """The turns of a wall of triangles: of its surface, and in each phase."""
        moves = [self.layout.meshes[wall].turn, *(phase.moves.get(wall) for phase in self.phases)]
        return [move for move in moves if isinstance(move, Turn)]

    @property
    def summary(self) -> str:
        """One line for the head of a deck."""
        s = self.case.scene
        return (
            f"{s.kind}: {self.layout.count} spheres, law {self.model.law}, {self.steps} steps of {self.time_step:g} s"
        )


def _intervals(output: Output, steps: float) -> tuple[int, int]:
    """(rows, steps per row): enough rows that the last one is also a frame of particles."""
    frames = max(output.particles, 1)
    rows = frames * math.ceil(output.rows / frames)
    every = max(1, math.ceil(steps / rows))
    tens = 10 ** max(0, len(str(every)) - 2)  # round numbers: samples divide a row, and a person reads them
    return rows, tens * math.ceil(every / tens)


def _phases(layout: Layout, rows: int, every: int, dt: float) -> tuple[Phase, ...]:
    phases, end = [], 0
    for stage in layout.stages:
        end += every * max(1, round(stage.seconds / (stage.time_step or dt) / every))
        phases.append(Phase(stage.name, end, stage.moves, stage.gates, stage.until, stage.time_step, stage.record))
    last = phases.pop()
    end = max(rows * every, last.end) if phases else rows * every
    return (*phases, replace(last, end=end))


def _divisor(n: int, parts: int) -> int:
    """The largest divisor of n that leaves at least `parts` parts (1 if there is none)."""
    return next(d for d in range(max(1, n // parts), 0, -1) if n % d == 0)


def _may_shrink(case: SceneCase, layout: Layout) -> bool:
    """Whether the step becomes a little smaller, so that the last phase is not longer than a motion in it should be."""
    given = case.numerics.time_step or any(stage.time_step for stage in layout.stages)
    return isinstance(case.scene, Parts) and bool(layout.stages[-1].moves) and not given


def plan(case: SceneCase) -> ScenePlan:
    """The plan of a scene. Raises CaseError for what does not fit."""
    refuse_faster_than_sound(case)
    contact_model, dt, layout, out = model(case), time_step(case), kinds.layout(case), case.output
    refuse_too_many(case, layout.fills)
    refuse_missing(case, layout)
    steps = layout.duration / dt
    if any(stage.time_step for stage in layout.stages):
        steps = sum(stage.seconds / (stage.time_step or dt) for stage in layout.stages)
    rows, every = _intervals(out, steps)
    if _may_shrink(case, layout):
        dt = layout.duration / (rows * every)
    refuse_steps(case, rows, layout.duration, layout.duration / steps)

    def interval(count: int) -> int:
        return 0 if count == 0 else every * max(1, rows // count)

    return ScenePlan(
        case=case,
        model=contact_model,
        layout=layout,
        time_step=dt,
        phases=_phases(layout, rows, every, dt),
        every=every,
        sampling=_divisor(every, SAMPLES),
        frames=interval(out.particles),
        contacts=interval(out.contacts or (out.particles if out.energy else 0)),
        vtk=interval(out.vtk),
        pictures=interval(out.pictures),
        restarts=interval(out.restarts),
    )
