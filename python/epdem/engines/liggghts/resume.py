# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes in LIGGGHTS: a run, and one that continues from a restart file."""

import contextlib
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

from ...base import paths
from ...base import rendering as decks
from ...base.files import stored_results
from ...base.processes import ROW
from ...errors import CaseError, EngineError
from ...jobs.engine import Report
from ...scenes.engine import Resumed
from ...scenes.plan import ScenePlan
from .. import log
from . import launcher
from . import scene_tables as tables
from .scene_deck import SceneDeck, deck
from .scene_parts import Fill, PhaseCommands


def run(plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> None:
    """Run the deck of a scene, which is in `folder`. Raises CaseError, EngineError."""
    _refuse_vtk(plan)
    with _lost_walls_named(folder):
        launcher.run("in.scene", folder, ranks=ranks, report=_pruning(folder, report))


@contextlib.contextmanager
def _lost_walls_named(folder: Path) -> Iterator[None]:
    """An error of LIGGGHTS about a mesh that has left the domain names the wall and the step."""
    try:
        yield
    except EngineError as error:
        lost = re.search(r"Mesh \(id (?:wall_)?(\w+)\): Mesh elements have been lost", str(error))
        if lost is None:
            raise
        step = int(log.rows(folder / launcher.OUT)["Step"].iloc[-1])
        raise EngineError(
            f"scene.wall.{lost[1]}: the wall has left scene.room after step {step}; enlarge the room, or stop the wall "
            f"before by the duration or the 'until' of its phase ({folder / launcher.OUT})"
        ) from None


def resume(plan: ScenePlan, folder: Path, *, ranks: int, report: Report) -> Resumed:
    """Continue a run from its newest restart file. Raises CaseError, EngineError."""
    _refuse_vtk(plan)
    step, lost = choose(plan, folder)
    script = write_resume(plan, folder, step)
    with _lost_walls_named(folder):
        launcher.run(script.name, folder, ranks=ranks, append=True, report=_pruning(folder, report))
    return Resumed(step, lost)


def _refuse_vtk(plan: ScenePlan) -> None:
    path = paths.launcher()
    if plan.vtk and path and not launcher.writes_vtk(path):
        raise CaseError(
            f"output.vtk: {path} was built without VTK; leave output.vtk out (output.particles holds the same), or "
            "take a LIGGGHTS with VTK"
        )


def _pruning(folder: Path, report: Report) -> Report:
    def row(step: int) -> None:
        prune(folder, step)
        report(step)

    return row


def _restarts(folder: Path) -> list[tuple[int, Path]]:
    ours = [p for p in folder.glob("restart.*.bin") if p.name not in stored_results(folder).foreign]
    names = [(re.fullmatch(r"restart\.(\d+)\.bin", p.name), p) for p in ours]
    return sorted((int(m[1]), p) for m, p in names if m)


def whole_restarts(folder: Path) -> list[int]:
    """Steps of the whole restart files: LIGGGHTS went on after them, so their rows stand twice in succession."""
    out = folder / launcher.OUT
    if not out.exists():
        return []
    rows = [int(m.group(1)) for line in out.read_bytes().splitlines() if (m := ROW.match(line))]
    gone_on = {a for a, b in pairwise(rows) if a == b}
    return [step for step, _ in _restarts(folder) if step in gone_on]


def prune(folder: Path, step: int) -> None:
    """Keep the newest restart file from before `step`, which the engine has gone on after, and all later ones."""
    for _, path in [(s, p) for s, p in _restarts(folder) if s < step][:-1]:
        path.unlink(missing_ok=True)


def choose(p: ScenePlan, folder: Path) -> tuple[int, list[int]]:
    """(step to go on from, steps of earlier frames that are missing or not whole and will stay so).

    The newest restart file from which the damaged frames are written again; if there is none, the newest. Raises
    CaseError if there is none at all.
    """
    steps = [step for step in whole_restarts(folder) if step < p.steps]  # at the end nothing is left to run
    if not steps:
        raise CaseError(f"{folder}: no restart file to continue from; set output.restarts in the case and run it")
    lost = tables.damaged(p, folder, steps[-1])
    repairing = [step for step in steps if not lost or step <= lost[0]]
    step = repairing[-1] if repairing else steps[-1]
    return step, [s for s in lost if s < step]


def _going_on(d: SceneDeck, phase: int, inserted: dict[str, int]) -> Iterator[Fill]:
    """The insertions of a run that goes on in a phase, without streams that have ended: LIGGGHTS refuses these. A
    stream of an earlier phase goes on in this one."""
    names = [part.run.name for part in d.phases]
    for f in d.insertions:
        if f.once:
            yield f
        elif inserted.get(f.id, 0) < f.count:
            yield replace(f, phase=names[min(max(names.index(f.phase), phase), len(names) - 1)])


def _after(part: PhaseCommands, steps: int, every: int) -> PhaseCommands:
    """Remaining phase after `steps` of its steps have run."""
    stop = part.stop
    if stop is not None:
        looked = max(0, steps - stop.first) // every
        stop = replace(stop, first=max(0, stop.first - steps), rows=stop.rows - looked)
    return replace(part, steps=part.steps - steps, stop=stop)


def write_resume(p: ScenePlan, folder: Path, step: int) -> Path:
    """in.resume, which continues from the restart file of `step`."""
    d = deck(p)
    ends = log.ends(folder / launcher.OUT, step) if p.ends_early else {phase.name: phase.end for phase in p.phases}
    number = next((i for i, phase in enumerate(p.phases) if ends.get(phase.name, step + 1) > step), len(p.phases))
    begin = max([0, *(ends[phase.name] for phase in p.phases[:number])])
    comes = False  # spheres that come with this phase and are not in the restart file
    if number < len(p.phases):
        part = d.phases[number]
        at_once = [f for f in d.insertions if f.once and f.phase == part.run.name]
        comes = step == begin and bool(part.particles or at_once)
        rest = _after(part, step - begin, p.every)
        d = replace(d, phases=(*d.phases[:number], rest, *d.phases[number + 1 :]))
    path = folder / "in.resume"
    going_on = tuple(_going_on(d, number, log.inserted(folder / launcher.OUT, step)))
    continued = replace(d, insertions=going_on, from_restart=f"restart.{step}.bin", resumed_phase=number, comes=comes)
    path.write_text(decks.render("liggghts/scene_resume.in.j2", deck=continued), encoding="utf-8")
    return path
