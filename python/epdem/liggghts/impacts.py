# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS with our plugin: a plan becomes one deck with all impacts side by side, its dump a trajectory."""

import math
import os
import re
import shutil
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import paths
from .. import rendering as decks
from ..errors import CaseError, EngineError
from ..impacts.engine import Trajectory
from ..impacts.experiment import Body
from ..impacts.plan import Plan
from ..processes import ask, call

INSTALL = "apt-get install liggghts libliggghts-dev libopenmpi-dev, then 'make setup'"
RIGID = 1e30  # modulus [Pa] of a rigid type: 1e15 would change E* of steel by 2e-4
HARD, SOFT = 1e9, 5e6  # LIGGGHTS refuses moduli [Pa] outside these without being told


@dataclass(frozen=True)
class Property:
    """A `fix property/global` line."""

    id: str
    name: str
    style: str
    values: tuple[float, ...]
    comment: str


@dataclass(frozen=True)
class Deck:
    """Everything the template writes; every number was decided here."""

    title: str
    source: str
    summary: str
    remembers: bool  # the law has a contact history
    hard: bool
    soft: bool
    data: str
    skin: float
    types: tuple[str, ...]
    properties: tuple[Property, ...]
    model: str
    tangential: str
    settings: tuple[str, ...]
    wall_type: int | None
    time_step: float
    path: str
    steps: int


def _finite(modulus: float) -> float:
    return RIGID if math.isinf(modulus) else modulus


def _types(plan: Plan) -> list[tuple[Body, float]]:
    """The distinct (body, strength) of the plan: LIGGGHTS's atom types, the moving body first."""
    x = plan.experiment
    types = [(x.body, x.law.strengths[0])]
    if x.target.material != x.body.material:
        types.append((x.target, x.law.strengths[1]))
    return types


def elastic_rows(plan: Plan) -> list[tuple]:
    """(name, style, values, comment) of the elastic properties of the plan's atom types."""
    types = _types(plan)
    return [
        ("youngsModulus", "peratomtype", [_finite(b.young_modulus) for b, _ in types], "Pa"),
        ("poissonsRatio", "peratomtype", [b.poisson_ratio for b, _ in types], "1"),
    ]


def numbered(rows: list[tuple]) -> tuple[Property, ...]:
    """The lines of a deck from rows as in elastic_rows."""
    return tuple(Property(f"m{i}", n, s, tuple(v), c) for i, (n, s, v, c) in enumerate(rows, 1))


def _properties(plan: Plan) -> tuple[Property, ...]:
    law, types = plan.experiment.law, _types(plan)
    rows = elastic_rows(plan)
    if law.strength_property:
        rows.append(
            (law.strength_property, "peratomtype", [_finite(s) for _, s in types], "Pa, the softer body's counts")
        )
    rows += [(name, "scalar", [value], "1") for name, value in law.ratios().items()]
    if plan.experiment.viscous_restitution is not None:
        values = [len(types), *[plan.experiment.viscous_restitution] * len(types) ** 2]
        rows.append(("coefficientRestitution", "peratomtypepair", values, "of impacts that do not yield"))
    return numbered(rows)


class Liggghts:
    """LIGGGHTS with a model of ours; `model` and more can be replaced to run LIGGGHTS's own models."""

    name = "liggghts"
    template = "liggghts/impact.in.j2"
    takes_dashpot = True

    def missing(self) -> str | None:
        launcher = paths.launcher()
        if launcher is not None and not os.access(launcher, os.X_OK):
            return f"{launcher} (EPDEM_LAUNCHER) is not a program; unset EPDEM_LAUNCHER or name another one"
        if shutil.which("liggghts") is None or launcher is None:
            return f"LIGGGHTS with our models was not found; {INSTALL}"
        return None

    def version(self) -> str:
        found = re.search(r"LIGGGHTS[-\w ]*?(\d+\.\d+\.\d+)", ask([str(paths.launcher()), "-h"]))
        return f"LIGGGHTS {found.group(1) if found else '(version unknown)'}"

    def model(self, plan: Plan) -> str:
        return f"ep/{plan.experiment.law.name}"

    def properties(self, plan: Plan) -> tuple[Property, ...]:
        return _properties(plan)

    def deck(self, plan: Plan) -> Deck:
        """The deck of a plan. Raises CaseError for what LIGGGHTS cannot do."""
        x, types, model = plan.experiment, _types(plan), self.model(plan)
        for b, _ in types:
            if b.poisson_ratio < 0:
                raise CaseError(
                    f"materials.{b.material}.poisson_ratio = {b.poisson_ratio}, LIGGGHTS takes [0, 0.5] "
                    "only; use --engine embedded"
                )
        dashpot = x.viscous_restitution is not None
        if dashpot and not self.takes_dashpot:
            raise CaseError(f"viscous: engine {self.name} does not know our dashpot; use --engine liggghts or embedded")
        moduli = [_finite(b.young_modulus) for b, _ in types]
        return Deck(
            title=x.title,
            source=x.source,
            summary=f"{x.speed.size} speeds x {plan.phases} phases = {plan.n} independent impacts, law {x.law.name}",
            remembers=x.law.strength_property is not None,
            hard=max(moduli) > HARD,
            soft=min(moduli) < SOFT,
            data="impact.data",
            skin=0.2 * min(x.body.radius, x.target.radius),
            types=tuple(b.material for b, _ in types),
            properties=self.properties(plan),
            model=model,
            tangential="off",
            settings=("viscous on",) if dashpot else (),
            wall_type=len(types) if math.isinf(x.target.radius) else None,
            time_step=plan.time_step,
            path="path.bin",
            steps=plan.steps,
        )

    def write(self, plan: Plan, folder: Path) -> list[Path]:
        deck = self.deck(plan)
        folder.mkdir(parents=True, exist_ok=True)
        files = [folder / "in.impact", folder / deck.data]
        files[0].write_text(decks.render(self.template, deck=deck))
        files[1].write_text(data_file(plan, deck))
        return files

    def run(self, plan: Plan, folder: Path, *, ranks: int = 1) -> Trajectory:
        command, env = [str(paths.launcher()), "-in", "in.impact", "-log", "log.liggghts"], dict(os.environ)
        if ranks > 1:
            extra = ["--allow-run-as-root"] if os.geteuid() == 0 else []
            command = ["mpirun", "-np", str(ranks), "--oversubscribe", *extra, *command]
        env["OMP_NUM_THREADS"] = "1"
        (folder / "path.bin").unlink(missing_ok=True)
        start = time.perf_counter()
        call(command, folder, log="out.liggghts", seconds=120 + 2e-6 * plan.n * plan.steps, env=env)
        wall = time.perf_counter() - start
        return trajectory(plan, folder / "path.bin", {"total": wall, "stepping": loop_seconds(folder / "log.liggghts")})


def data_file(plan: Plan, deck: Deck) -> str:
    """Positions and velocities of all bodies: one column of the grid per impact, contact at z = 0."""
    x, n = plan.experiment, plan.n
    wall = deck.wall_type is not None
    reach = max(r for r in (x.body.radius, x.target.radius) if math.isfinite(r))
    side, spacing = math.ceil(math.sqrt(n)), 2.6 * reach
    column = np.arange(n)
    px, py = spacing * (column % side), spacing * (column // side)
    # the bodies part at most as fast as they met; in the centre-of-mass frame each keeps its share
    share = 1.0 if wall else x.m_star / x.body.mass
    bodies = [(1, x.body, x.body.radius + share * plan.gap, -share * plan.speed)]
    if not wall:
        bodies.append((len(deck.types), x.target, -x.target.radius - (1 - share) * plan.gap, (1 - share) * plan.speed))
    travel = plan.steps * plan.time_step * plan.speed.max() + 4 * reach
    atoms, velocities, k = [], [], 0
    for kind, body, z, vz in bodies:
        for j in range(n):
            k += 1
            place = " ".join(decks.number(v) for v in (2 * body.radius, body.density, px[j], py[j], z[j]))
            atoms.append(f"{k} {kind} {place}")
            velocities.append(f"{k} 0 0 {decks.number(vz[j])} 0 0 0")
    edge = spacing * side
    low, high = (-reach if wall else -travel), travel
    head = [
        f"{x.name}: id type diameter density x y z",
        "",
        f"{k} atoms",
        f"{len(deck.types)} atom types",
        *(f"{decks.number(-spacing)} {decks.number(edge)} {a}lo {a}hi" for a in "xy"),
        f"{decks.number(low)} {decks.number(high)} zlo zhi",
        "",
    ]
    return "\n".join([*head, "Atoms", "", *atoms, "", "Velocities", "", *velocities, ""])


def read_dump(path: Path, columns: int) -> np.ndarray:
    """A binary custom dump with the id first: shape (frames, atoms, columns - 1), sorted by id."""
    raw = path.read_bytes()
    frames, at, header = [], 0, 8 + 8 + 4 + 24 + 48 + 8
    while at < len(raw):
        blocks = int.from_bytes(raw[at + header - 4 : at + header], "little")
        at += header
        rows = []
        for _ in range(blocks):
            size = int.from_bytes(raw[at : at + 4], "little")
            rows.append(np.frombuffer(raw, "<f8", size, at + 4).reshape(-1, columns))
            at += 4 + 8 * size
        frame = np.concatenate(rows)
        frames.append(frame[np.argsort(frame[:, 0], kind="stable"), 1:])
    return np.stack(frames)


def trajectory(plan: Plan, path: Path, seconds: dict[str, float]) -> Trajectory:
    """Overlap, force and approach velocity from z, vz, fz of every body. Raises EngineError if samples are missing."""
    x, n = plan.experiment, plan.n
    wall = math.isinf(x.target.radius)
    try:
        z, vz, fz = np.moveaxis(read_dump(path, 4), 2, 0)
        bodies = n if wall else 2 * n
        if z.shape != (plan.steps + 1, bodies):
            raise ValueError(f"{z.shape[0]} frames of {z.shape[1]} bodies, expected {plan.steps + 1} of {bodies}")
    except (OSError, ValueError) as error:
        raise EngineError(f"{path}: the run left an incomplete dump ({error}); see log.liggghts beside it") from None
    if wall:
        overlap, velocity = x.body.radius - z, -vz
    else:
        overlap = x.body.radius + x.target.radius - (z[:, :n] - z[:, n:])
        velocity = vz[:, n:] - vz[:, :n]
    return Trajectory(plan.time_step, overlap.T, fz[:, :n].T, velocity.T, seconds)


def loop_seconds(log: Path) -> float:
    """The engine's own time for its steps [s]; NaN if the log does not say."""
    found = re.findall(r"Loop time of (\S+) on", log.read_text(errors="replace")) if log.exists() else []
    return float(found[-1]) if found else math.nan
