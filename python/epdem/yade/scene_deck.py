# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes in YADE: one plain Python deck, the spheres' table and the law's module that travels with them."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations_with_replacement
from math import atan
from pathlib import Path

from .. import rendering as decks
from ..case.scene import SceneCase
from ..errors import CaseError, EngineError
from ..liggghts import scene_deck as liggghts
from ..processes import call
from ..scenes import placement as yade_place
from ..scenes.model import Model, model
from .deck import Material
from .deck_modules import cone
from .deck_modules.law import LAWS
from .impacts import Yade
from .launcher import command, deck_modules, environment

SCRIPT, OUT = "scene.py", "out.yade"
KINDS = Yade.can.scenes
NO_DASHPOT = "contact.tangential_restitution: YADE's law has no dashpot, it was left out"


@dataclass(frozen=True)
class Wall:
    """A flat wall: axis and place [m]; in a periodic cell the corners of one triangle that covers it."""

    name: str
    axis: int
    place: float
    corners: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Phase:
    """A part of the run; `plate` is the velocity of the moving wall along z [m/s], 0 where none begins to move."""

    name: str
    steps: int
    plate: float


@dataclass(frozen=True)
class Deck:
    """Everything that the template writes; every number was decided here."""

    title: str
    source: str
    summary: str
    law: str
    ratios: dict[str, float]
    materials: tuple[Material, ...]
    wall_material: int
    frictions: tuple[tuple[int, int, float], ...]
    periodic: bool
    cell: tuple[float, float, float]
    walls: tuple[Wall, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    fall: float
    skin: float
    time_step: float
    phases: tuple[Phase, ...]
    sampling: int
    every: int
    frames: int
    contacts: int
    spins: bool
    dents: bool
    load: str

    @property
    def wall(self) -> str:
        """YADE's shape of the walls: its infinite one does not work in a periodic cell."""
        return "facet" if self.periodic else "wall"

    @property
    def load_column(self) -> str:
        return {"floor": "floor_load", "plate": "plate_force"}[self.load]


def refuse(case: SceneCase) -> None:
    """Raises CaseError for what a scene in YADE cannot have."""
    s, contact, out = case.scene, case.contact, case.output
    if s.kind not in KINDS:
        raise CaseError(f"scene.kind = {s.kind!r}: YADE runs {' and '.join(KINDS)}; use --engine liggghts")
    if case.law.name not in LAWS:
        raise CaseError(f"law.name = {case.law.name!r}: YADE has {', '.join(LAWS)}; use --engine liggghts")
    unknown = {
        "scene.rate": (getattr(s, "rate", None), "all spheres are there from the start"),
        "viscous.restitution": (case.viscous and case.viscous.restitution, "YADE's law has no dashpot"),
        "contact.rolling": (contact.rolling and contact.rolling.model, "YADE's law has no rolling resistance"),
        "contact.cohesion": (contact.cohesion, "YADE's law has no cohesion"),
        "output.restarts": (out.restarts, "a YADE scene is not continued"),
        "output.vtk": (out.vtk, "there is no VTK output; output.particles holds the same"),
        "output.pictures": (out.pictures, "YADE draws none without a display"),
    }
    for place, (value, reason) in unknown.items():
        if value:
            raise CaseError(f"{place} = {value!r}: {reason}; remove it or use --engine liggghts")


def warnings(case: SceneCase) -> list[str]:
    """What of a case a YADE scene leaves out, in words."""
    return [NO_DASHPOT] if case.contact.tangential_restitution is not None else []


def _materials(case: SceneCase, m: Model, friction: list[list[float]]) -> tuple[Material, ...]:
    law, found = LAWS[m.law], []
    for i, t in enumerate(m.types):
        x = case.materials[t.material]
        values = {
            "young_modulus": x.young_modulus,
            "poisson_ratio": x.poisson_ratio,
            "density": x.density,
            "friction": friction[i][i],
        }
        if law.strength_name:
            values[law.strength_name] = t.strength
            ratios = {n: m.law_parameters[n] for n in law.ratios}
            highest = cone.STRONGEST * x.young_modulus / law(1.0, 1e-3, **ratios).trigger_factor
            if t.strength >= highest:
                raise CaseError(
                    f"materials.{t.material}: {law.strength_name} = {t.strength:.6g} Pa, YADE's law takes less than "
                    f"{highest:.6g} Pa at this young_modulus; use --engine liggghts"
                )
        found.append(Material(t.name, values))
    return tuple(found)


def _friction(m: Model) -> list[list[float]]:
    """The square of friction coefficients of the types."""
    n, row = len(m.types), next((r for r in m.rows if r.name == "coefficientFriction"), None)
    values = row.values[1:] if row else [0.0] * n * n
    return [list(values[i * n : (i + 1) * n]) for i in range(n)]


def _pairs(friction: list[list[float]]) -> tuple[tuple[int, int, float], ...]:
    """(type, type, friction angle [rad]) of the pairs, from 0, where YADE's own rule, the smaller one, is not meant."""
    pairs = combinations_with_replacement(range(len(friction)), 2)
    return tuple(
        (a, b, max(atan(friction[a][b]), 1e-9))  # YADE's law needs more than 0
        for a, b in pairs
        if friction[a][b] != min(friction[a][a], friction[b][b])
    )


def _walls(d: liggghts.Deck, case: SceneCase, periodic: bool) -> tuple[Wall, ...]:
    lx, ly, lz = case.scene.box
    planes = [(name, "xyz".index(style[0]), place) for name, style, place in d.planes]
    if case.scene.kind == "compaction":
        planes.append(("plate", 2, lz))

    def corners(z: float) -> tuple[tuple[str, ...], ...]:
        places = ((-lx, -ly, z), (5 * lx, -ly, z), (-lx, 5 * ly, z)) if periodic else ()
        return tuple(tuple(decks.number(x) for x in place) for place in places)

    return tuple(Wall(name, axis, place, corners(place)) for name, axis, place in planes)


def deck(case: SceneCase) -> Deck:
    """The YADE deck of a scene, with time step, rows and frames of the LIGGGHTS one. Raises CaseError."""
    m = model(case)
    refuse(case)
    d, s = liggghts.deck(case), case.scene
    press = s.kind == "compaction"
    periodic = press or s.periodic
    friction = _friction(m)
    ends = [0, *(p.end for p in d.phases)]
    speeds = (-s.speed, s.release) if press else (0.0,)
    lx, ly, lz = s.box
    sides = () if periodic else (lx / 2, ly / 2)
    return Deck(
        title=d.title,
        source=d.source,
        summary=d.summary,
        law=m.law,
        ratios={n: m.law_parameters[n] for n in LAWS[m.law].ratios},
        materials=_materials(case, m, friction),
        wall_material=m.wall_type - 1,
        frictions=_pairs(friction),
        periodic=periodic,
        cell=(lx, ly, 2.0 * lz),
        walls=_walls(d, case, periodic),
        low=(*(-x for x in sides), 0.0),
        high=(*sides, d.box[5]),
        fall=-s.gravity if s.gravity else 0.0,
        skin=d.skin,
        time_step=d.time_step,
        phases=tuple(
            Phase(p.name, end - begin, v)
            for p, begin, end, v in zip(d.phases, ends[:-1], ends[1:], speeds, strict=True)
        ),
        sampling=1 if press else d.sampling if d.loads else d.every,
        every=d.every,
        frames=d.frames,
        contacts=d.contacts,
        spins=d.spins,
        dents=d.energy and d.yields,
        load="plate" if press else "floor" if d.loads else "",
    )


def texts(case: SceneCase) -> dict[str, str]:
    """All files of a YADE scene by name; they run by hand in one folder. Raises CaseError."""
    found = {SCRIPT: decks.render("yade/scene.py.j2", deck=deck(case)), "spheres.txt": _table(case)}
    return found | deck_modules()


def _table(case: SceneCase) -> str:
    lx, ly, lz = case.scene.box
    room = (-lx / 2, lx / 2, -ly / 2, ly / 2, 0.0, lz)
    lines = ["# x y z radius [m], type; random places without overlap"]
    for *numbers, kind in yade_place.spheres(case, model(case), room):
        lines.append(" ".join([*map(decks.number, numbers), str(int(kind))]))
    return "\n".join([*lines, ""])


def missing() -> None:
    """Raises EngineError, with the command that installs it, if YADE is not here."""
    if words := Yade().missing():
        raise EngineError(words)


def version() -> str:
    """YADE's version."""
    return Yade().version()


def run(folder: Path, tell: Callable[[int], None]) -> float:
    """Run what `write` wrote, `tell` every row's step; seconds taken. Raises EngineError with YADE's last words."""
    return call([command(), "-n", "-x", SCRIPT], folder, log=OUT, env=environment(), tell=tell)
