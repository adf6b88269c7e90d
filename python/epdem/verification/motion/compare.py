# SPDX-License-Identifier: GPL-2.0-or-later
"""Forces and torques of two spheres whose motion is prescribed, compared between engines."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...base.files import results_folder, write_texts
from ...case.impact import load
from ...case.toml import error_context
from ...errors import CaseError
from ...impacts.experiment import experiment
from ...jobs.engine import check_law, require
from ...theory.pair import sphere_mass
from ..runner import STUDIES, Outcome, Progress, Row, run, silent
from .hosts import EmbeddedMotions, LammpsMotions, LiggghtsMotions, YadeMotions
from .paths import MOTIONS, objectivity, rigid_rotation
from .prescribed import Loads, Motion, MotionEngine, Touch, check_motion, read, text, unit_normals

_TOOLS = (EmbeddedMotions, LiggghtsMotions, YadeMotions, LammpsMotions)
ENGINES: dict[str, type[MotionEngine]] = {tool.host.name: tool for tool in _TOOLS}
FRICTION = 0.3  # of a case that has none


def touch_of(case: Path, law: str | None = None) -> Touch:
    """The spheres of a case of impacts; in place of a wall a second sphere of its material. Raises CaseError."""
    with error_context(case):
        read_case = load(case)
        x = experiment(read_case, law)
        if x.viscous_restitution is not None:
            raise CaseError("viscous: motions are compared without a dashpot; remove it")
        if x.target.rigid:
            raise CaseError("impact.target.material = 'rigid': no sphere is rigid; name a material")
        if math.isinf(x.target.radius):
            mass = float(sphere_mass(radius=x.body.radius, density=x.target.density))
            x = replace(x, target=replace(x.target, radius=x.body.radius, mass=mass))
        contact = read_case.contact
        x = replace(x, oblique=None)
        return Touch(x, contact.friction if contact else FRICTION, contact.tangential if contact else "history")


def engine(name: str) -> MotionEngine:
    """The engine of motions of that name. Raises CaseError."""
    if name not in ENGINES:
        raise CaseError(f"--engine {name}: motions run on {', '.join(ENGINES)}")
    return ENGINES[name]()


def compare(
    case: Path,
    *,
    files: Sequence[Path] = (),
    engines: Sequence[str] = (),
    laws: Sequence[str] = (),
    out: Path | None = None,
    force: bool = False,
    progress: Progress = silent,
) -> Outcome:
    """Run each motion (of `files`, else our own) with each law on each engine. Raises CaseError, EngineError.

    Motion, forces and torques of each are in FOLDER/LAW/ENGINE/MOTION/motion.json, the rows in FOLDER/motions.csv:
    motion, law, engine, friction, force_max [N], deviations from the first engine over its largest force.
    """
    tools = STUDIES["motion"].tools(engines, engine)
    given = [read(path) for path in files]
    if twice := [m.name for m in given if [x.name for x in given].count(m.name) > 1]:
        raise CaseError(f"two motions have the name {twice[0]}, which their folders have; rename one file")
    touches = [touch_of(case, law) for law in dict.fromkeys(laws) or [None]]
    runs = [(touch, motion) for touch in touches for motion in given or [make(touch) for make in MOTIONS]]
    for touch, motion in runs:
        check_motion(touch, motion)
        for tool in tools:
            check_law(tool, touch.experiment.law.name)
    require(*tools)
    folder = results_folder(out, load(case).name, "motion")
    return run("motion", _rows(runs, tools, folder, progress), folder, force=force)


def _rows(
    runs: list[tuple[Touch, Motion]], tools: list[MotionEngine], folder: Path, progress: Progress
) -> Iterator[Row]:
    for touch, motion in runs:
        first: Loads | None = None
        for tool in tools:
            law = touch.experiment.law.name
            progress(f"{motion.name}, {law}, {tool.name}")
            place = folder / law / tool.name / motion.name
            found = tool.loads(touch, motion, place)
            write_texts(place, {"motion.json": text(motion.columns() | found.columns())})
            first = first or found
            row = {"motion": motion.name, "law": law, "engine": tool.name, "friction": touch.tangential}
            yield row | {"force_max": found.peak} | deviations(touch, motion, found, first)


def deviations(touch: Touch, motion: Motion, found: Loads, first: Loads) -> dict[str, float]:
    """How far loads lie from the first ones, over the largest force of these.

    normal: of the law's forces; force: of all forces; torque: of the torques, over the smaller radius, too.
    turned: see `paths.objectivity`; NaN for other motions.
    """
    normals, scale = unit_normals(motion), max(first.peak, 1e-300)
    off = {
        "normal": np.abs(found.along(normals) - first.along(normals)).max(),
        "force": np.linalg.norm(found.force - first.force, axis=2).max(),
        "torque": np.linalg.norm(found.torque - first.torque, axis=2).max() / min(touch.radii),
    }
    turned = objectivity(found) if motion.name == rigid_rotation.__name__ else math.nan
    return {name: float(value / scale) for name, value in off.items()} | {"turned": turned}
