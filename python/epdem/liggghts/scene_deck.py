# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything that the templates of a scene write; every number is decided here."""

import math
from dataclasses import dataclass
from pathlib import Path

from .. import rendering as decks
from ..case.scene import SceneCase
from ..scenes.insertions import Insertion, insertions
from ..scenes.model import Model, model, time_step
from . import stl
from .properties import HARD, SOFT, Property, of_row

SKIN = 0.25  # of the smallest radius: rebuilds cost less than idle neighbours


@dataclass(frozen=True)
class Phase:
    """A part of the run up to step `end`; the template knows by its name what changes at its begin and end."""

    name: str
    end: int


@dataclass(frozen=True)
class Deck:
    """What the templates read."""

    title: str
    source: str
    summary: str
    kind: str
    hard: bool
    soft: bool
    boundary: str
    box: tuple[float, ...]
    n_types: int
    skin: float
    types: tuple[str, ...]
    properties: tuple[Property, ...]
    model: str
    tangential: str
    cohesion: str | None
    rolling_friction: str | None
    settings: tuple[str, ...]
    wall_type: int
    planes: tuple[tuple[str, str, float], ...]
    meshes: tuple[str, ...]
    gravity: float
    insertions: tuple[Insertion, ...]
    time_step: float
    phases: tuple[Phase, ...]
    every: int
    sampling: int
    samples: int
    frames: int
    contacts: int
    vtk: int
    pictures: int
    restarts: int
    energy: bool
    loads: bool
    spins: bool
    remembers: bool
    yields: bool
    memory_column: int
    wall_memory_column: int
    loses: bool
    motion: dict[str, float]
    from_restart: str | None = None
    resumed_phase: int = 0

    @property
    def steps(self) -> int:
        return self.phases[-1].end

    @property
    def row_words(self) -> tuple[str, ...]:
        """Thermo words beside step, atoms and kinetic energy, which LIGGGHTS shows unasked."""
        floor = self.loads and any(p[0] == "floor" for p in self.planes)
        return (
            *(["f_load"] if floor else []),
            *(["f_press_z"] if "plate" in self.meshes else []),
            *(["f_torque"] if self.torque else []),
        )

    @property
    def loses_energy(self) -> bool:
        """Whether contacts lose energy that no table holds: to friction or dashpots."""
        return self.tangential != "off" or self.rolling_friction is not None or "viscous on" in self.settings

    @property
    def torque(self) -> bool:
        """Whether the torque of a drum is asked for."""
        return "drum" in self.meshes and (self.loads or self.energy)


def _intervals(case: SceneCase, total: float, dt: float) -> tuple[int, int]:
    """(rows, steps per row): enough rows that the last one is also a frame of particles."""
    out = case.output
    frames = max(out.particles, 1)
    rows = frames * math.ceil(out.rows / frames)
    every = max(1, math.ceil(total / dt / rows))
    tens = 10 ** max(0, len(str(every)) - 2)  # round numbers: samples divide a row, and a person reads them
    return rows, tens * math.ceil(every / tens)


def _every(case_count: int, rows: int, every: int) -> int:
    return 0 if case_count == 0 else every * max(1, rows // case_count)


def deck(case: SceneCase) -> Deck:
    """The deck of a scene. Raises CaseError for what does not fit."""
    from ..scenes import kinds

    m, dt, s = model(case), time_step(case), case.scene
    parts = [*s.particles, *getattr(s, "bed", [])]
    smallest = min(p.radii()[0] for p in parts)
    layout = kinds.layout(case)
    rows, every = _intervals(case, layout.duration, dt)
    phases, end = [], 0
    for name, seconds in layout.phases:
        end += every * max(1, round(seconds / dt / every))
        phases.append(Phase(name, end))
    phases[-1] = (
        Phase(phases[-1].name, max(rows * every, end)) if len(phases) > 1 else Phase(phases[0].name, rows * every)
    )
    moduli = m.rows[0].values
    out = case.output
    return Deck(
        title=case.case.title,
        source=case.case.source,
        summary=f"{s.kind}: {s.count} spheres, law {m.law}, {phases[-1].end} steps of {dt:g} s",
        kind=s.kind,
        hard=max(moduli) > HARD,
        soft=min(moduli) < SOFT,
        boundary=layout.boundary,
        box=layout.box,
        n_types=len(m.types),
        skin=_two_digits(SKIN * smallest),
        types=tuple(t.name for t in m.types),
        properties=tuple(of_row(r.name, r.style, r.values, r.comment) for r in m.rows),
        model=f"ep/{m.law}",
        tangential=m.tangential,
        cohesion=m.cohesion,
        rolling_friction=m.rolling,
        settings=_settings(case, m),
        wall_type=m.wall_type,
        planes=layout.planes,
        meshes=tuple(layout.meshes),
        gravity=s.gravity,
        insertions=insertions(case, m, layout.fills, phases[0].name, dt),
        time_step=dt,
        phases=tuple(phases),
        every=every,
        sampling=_divisor(every, 50),
        samples=every // _divisor(every, 50),
        frames=_every(out.particles, rows, every),
        contacts=_every(out.contacts or (out.particles if out.energy else 0), rows, every),
        vtk=_every(out.vtk, rows, every),
        pictures=_every(out.pictures, rows, every),
        restarts=_every(out.restarts, rows, every),
        energy=out.energy,
        loads=out.loads,
        yields=m.yields,
        memory_column=4 + memory(m),
        wall_memory_column=4 + memory(m, wall=True),
        remembers=m.yields or m.tangential != "off" or m.rolling is not None,
        spins=m.tangential != "off" or m.rolling is not None,
        loses=layout.loses,
        motion=layout.motion,
    )


def _settings(case: SceneCase, m: Model) -> tuple[str, ...]:
    """Settings of pair and walls; a dashpot along the normal alone needs the tangential one switched off."""
    alone = case.viscous and m.tangential != "off" and case.contact.tangential_restitution is None
    wanted = {
        "viscous on": case.viscous,
        "tangential_damping off": alone,
        "computePlasticWork on": case.output.energy and m.yields,
    }
    return tuple(words for words, asked in wanted.items() if asked)


def _divisor(n: int, parts: int) -> int:
    """The largest divisor of n that leaves at least `parts` parts (1 if there is none)."""
    return next(d for d in range(max(1, n // parts), 0, -1) if n % d == 0)


LAW_MEMORY = {"hertz": 0, "thornton": 1, "johnson": 1, "cavity": 4}  # values that a law keeps of a contact


def memory(m: Model, *, wall: bool = False) -> int:
    """History values of one contact in LIGGGHTS, the law's first: those of the law, step, shear spring, rolling."""
    law = LAW_MEMORY[m.law]
    others = 3 * (m.tangential == "history") + 3 * (m.rolling in ("epsd", "epsd2"))
    stamp = 0 if wall else int(law + others > 0)
    return law + stamp + others


def _two_digits(x: float) -> float:
    return float(f"{x:.1e}")


def texts(case: SceneCase, d: Deck | None = None) -> dict[str, str]:
    """The text files of a scene's deck by name, without its meshes."""
    d = d or deck(case)
    return {
        "in.scene": decks.render("liggghts/scene.in.j2", deck=d),
        "setup.in": decks.render("liggghts/scene_setup.in.j2", deck=d),
    }


def write(case: SceneCase, folder: Path) -> list[Path]:
    """The deck of a scene with its meshes, in `folder`; it runs by hand there."""
    from ..scenes import kinds

    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for name, text in texts(case).items():
        files.append(folder / name)
        files[-1].write_text(text)
    for name, triangles in kinds.layout(case).meshes.items():
        files.append(folder / f"{name}.stl")
        files[-1].write_text(stl.text(name, triangles))
    return files
