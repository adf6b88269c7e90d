# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes in YADE: one plain Python deck, the table of the spheres, and modules with a copy of the compiled laws."""

from dataclasses import dataclass
from itertools import combinations_with_replacement

from ...base import rendering as decks
from ...case.kinds import Compaction, Settle
from ...case.walls import Limits
from ...errors import CaseError
from ...scenes import placement
from ...scenes.plan import ScenePlan
from ...yade.deck_modules import cone
from ..host import refuse as refuse_value
from . import classes as words
from .classes import Functors, Material, PairValue, of_pairs
from .deck import strength_values
from .scene_parts import EDGES, Motion, facets, loads, motions, removed, unrecorded
from .scene_parts import files as facet_files
from .scene_parts import refuse as refuse_parts

Square = tuple[tuple[float, ...], ...]
SCRIPT, SPHERES = "scene.py", "spheres.txt"
SKIN = 0.25  # of the smallest radius: few sortings and few idle neighbours
NO_DASHPOT = (
    "contact.tangential_restitution: YADE's law has no dashpot, it was left out; make yade builds a law with it"
)
NO_RANKS = "numerics.processors: a scene in YADE has one rank, it was left out"
NO_SORTING = "numerics.sort_interval: YADE does not sort the spheres in memory, it was left out"


@dataclass(frozen=True)
class Wall:
    """A flat wall: axis and place [m]; in a periodic cell the corners of one triangle that covers it."""

    name: str
    axis: int
    place: float
    corners: tuple[tuple[str, ...], ...]
    material: int


@dataclass(frozen=True)
class Phase:
    """A part of the run; `plate` is the velocity of the moving wall along z [m/s], 0 where none begins to move.

    time_step: its own [s]. motions: of walls of triangles in it. removed: walls that disappear at its begin.
    """

    name: str
    steps: int
    plate: float
    time_step: float | None
    motions: tuple[Motion, ...]
    removed: list[str]


def works(p: ScenePlan) -> dict[str, list[str]]:
    """Attributes of EpState in the frames, and the columns of each."""
    wanted = {
        "plasticWork": p.writes_plastic_work,
        "adhesionLoss": p.writes_adhesive_work,
        "frictionWork": p.writes_friction_work,
    }
    columns = {
        "plasticWork": ["plastic_work"],
        "adhesionLoss": ["adhesive_work"],
        "frictionWork": ["friction_work", "friction_energy"],
    }
    return {name: columns[name] for name, there in wanted.items() if there}


def refuse(p: ScenePlan, *, classes: bool) -> None:
    """Raise CaseError for parts of a scene that YADE does not have; classes: whether epdem_yade is built."""
    m, out = p.model, p.output
    if _parts(p):
        refuse_parts(p, p.scene)
    rolling = m.rolling and m.rolling.model
    unknown: dict[str, tuple[object, str]] = {
        "scene.rate": (next((f.rate for f in p.insertions if f.rate), None), "all spheres are there from the start"),
        "contact.rolling": (rolling == "epsd" and rolling, "YADE's laws have cdt and epsd2"),
        "law.compaction": (m.compaction, "YADE's laws have no compaction"),
        "contact.cohesion": (m.cohesion, "YADE's law has no cohesion"),
        "output.restarts": (out.restarts, "a YADE scene is not continued"),
        "output.vtk": (out.vtk, "there is no VTK output; output.particles holds the same"),
        "output.pictures": (out.pictures, "YADE draws none without a display"),
    }
    of_classes: dict[str, object] = {
        "viscous.restitution": p.case.viscous and p.case.viscous.restitution,
        "contact.tangential": m.nodes and m.tangential,
        "contact.rolling": rolling,
    }
    for place, (value, reason) in unknown.items():
        refuse_value(place, value, reason)
    for place, value in of_classes.items():
        if value and not classes:
            raise CaseError(
                f"{place} = {value!r}: YADE has it with the module epdem_yade, which is not built; run 'make yade', "
                "remove it or use --engine liggghts"
            )


def notes(p: ScenePlan, *, classes: bool) -> list[str]:
    """Sentences on the parts of a case that a YADE scene leaves out."""
    found = [NO_DASHPOT] if p.model.tangential_restitution is not None and not classes else []
    found += [NO_RANKS] if p.case.numerics.processors else []
    found += [NO_SORTING] if p.case.numerics.sort_interval else []
    return [*found, EDGES] if _parts(p) and p.scene.meshes else found


def _parts(p: ScenePlan) -> bool:
    return not isinstance(p.case.scene, Settle | Compaction)


def _materials(p: ScenePlan, friction: Square, *, classes: bool) -> tuple[Material, ...]:
    materials, m = [], p.model
    for i, t in enumerate(m.types):
        x = p.case.materials[t.material]
        values = {
            "young_modulus": x.young_modulus,
            "poisson_ratio": x.poisson_ratio,
            "density": x.density,
            "friction": friction[i][i],
        }
        if classes:
            materials.append(words.material(t.name, m.law, m.parameters, strength=t.strength, **values))
            continue
        own = strength_values(p.model.law, p.model.ratios(), t.strength, x.young_modulus, t.material)
        materials.append(Material(t.name, values | own))
    return tuple(materials)


def _pairs(friction: Square) -> tuple[tuple[int, int, float], ...]:
    """(type, type, friction angle [rad]) of all pairs, from 0, unless each has YADE's own value, the smaller one."""
    pairs = list(combinations_with_replacement(range(len(friction)), 2))
    if all(friction[a][b] == min(friction[a][a], friction[b][b]) for a, b in pairs):
        return ()
    return tuple((a, b, cone.friction_angle(friction[a][b])) for a, b in pairs)


def _functors(p: ScenePlan, friction: Square) -> Functors:
    """Values of pairs as in LIGGGHTS: with [viscous] its restitution is that of both dashpots."""
    m = p.model
    pairs = [PairValue("frictAngle", None, pairs) for pairs in [_pairs(friction)] if pairs]
    pairs += [of_pairs("en", m.viscous)] if m.viscous else []
    if m.tangential_restitution is not None:
        pairs.append(of_pairs("es", m.viscous) if m.viscous else PairValue("es", m.tangential_restitution))
    pairs += [PairValue("rollingFriction", m.rolling.coefficient)] if m.rolling else []
    pairs += [of_pairs("workOfAdhesion", m.adhesion)] if m.adheres else []
    rolling = {"rolling": repr(m.rolling.model)} if m.rolling else {}
    more = words.settings(m.tangential if m.sliding else None, **rolling, recordStrain=True)
    walls = {"Facet"} if p.scene.periodic or (_parts(p) and p.scene.meshes) else set()
    walls |= {"Wall"} if not p.scene.periodic and _walls(p) else set()
    return Functors(words.title(m.law), ("Sphere", *sorted(walls)), tuple(pairs), more)


def _walls(p: ScenePlan) -> tuple[Wall, ...]:
    xlo, xhi, ylo, yhi, *_ = p.box
    lx, ly = xhi - xlo, yhi - ylo
    planes = [(w.name, "xyz".index(w.axis), w.at) for w in (*p.scene.planes, *p.scene.gates)]
    if not _parts(p):
        planes += [(name, 2, float(triangles[0, 0, 2])) for name, triangles in p.triangles.items()]

    def corners(z: float) -> tuple[tuple[str, ...], ...]:
        places = ((-lx, -ly, z), (5 * lx, -ly, z), (-lx, 5 * ly, z)) if p.scene.periodic else ()
        return tuple(tuple(decks.number(x) for x in place) for place in places)

    return tuple(Wall(name, axis, at, corners(at), p.wall_types[name] - 1) for name, axis, at in planes)


def deck(p: ScenePlan, *, classes: bool) -> decks.Deck:
    """The YADE deck of a scene. Raises CaseError for what YADE cannot do."""
    refuse(p, classes=classes)
    m, friction, ends = p.model, p.model.friction, [0, *(phase.end for phase in p.phases)]
    xlo, xhi, ylo, yhi, zlo, zhi = p.box
    sides = () if p.scene.periodic else ((xlo, xhi), (ylo, yhi))
    moves = [motions(p, phase) if _parts(p) else () for phase in p.phases]
    load, column, sign = ("floor", "floor_load", -1) if p.floor_load else ("", "", 0)  # pressed down, the plate up
    if p.plates:
        load, column, sign = "plate", "plate_force", 1
    return decks.Deck(
        p,
        title=p.case.case.title,
        source=p.case.case.source,
        law=m.law,
        native=False,
        functors=_functors(p, friction) if classes else None,
        ratios=m.ratios(),
        materials=_materials(p, friction, classes=classes),
        frictions=_pairs(friction),
        periodic=p.scene.periodic,
        cell=(xhi - xlo, yhi - ylo, 2.0 * _filled(p)[5] if p.scene.periodic else 0.0),
        walls=_walls(p),
        low=(*(low for low, _ in sides), zlo),
        high=(*(high for _, high in sides), zhi),
        fall=-p.case.scene.gravity if p.case.scene.gravity else 0.0,
        skin=p.case.numerics.skin or float(f"{SKIN * p.smallest:.1e}"),
        phases=tuple(
            Phase(
                phase.name,
                end - begin,
                0.0 if _parts(p) else phase.plate,
                (phase.case.time_step or p.time_step) if any(x.case.time_step for x in p.phases) else None,
                moved,
                gone,
            )
            for phase, begin, end, moved, gone in zip(p.phases, ends[:-1], ends[1:], moves, removed(p), strict=True)
        ),
        sampling=1 if p.plates or p.writes_wall_power else p.sampling if p.output.loads else p.every,
        spins=m.spins,
        load=load,
        load_column=column,
        load_sign=sign,
        remembers=p.writes_plastic_work and not classes,  # contacts that have ended, of which the plastic work follows
        works=[*works(p)] if classes else [],  # attributes of EpState in the frames
        moving=any(m.axis or m.amplitude for moved in moves for m in moved),
        wall="facet" if p.scene.periodic else "wall",  # YADE's infinite one does not work in a periodic cell
        unrecorded=unrecorded(p),
        parts=_parts(p),
        facets=facets(p) if _parts(p) else (),
        loads=loads(p),
    )


def files(p: ScenePlan, *, classes: bool) -> dict[str, str]:
    """All files of a YADE scene by name; they run by hand in one folder. Raises CaseError."""
    deck_files = {SCRIPT: decks.render("yade/scene.py.j2", deck=deck(p, classes=classes)), SPHERES: _table(p)}
    return deck_files | (facet_files(p) if _parts(p) else {})


def _filled(p: ScenePlan) -> Limits:
    """The box of the one filling that a YADE scene has."""
    (fill,) = p.insertions
    return fill.region.limits


def _table(p: ScenePlan) -> str:
    if _parts(p):
        head = "# x y z radius [m], type, velocity [m/s], spin [rad/s], 1: frozen"
        rows = [" ".join(map(decks.number, row)) for row in placement.moving_spheres(p)]
    else:
        head = "# x y z radius [m], type; random places without overlap"
        rows = [" ".join([*map(decks.number, place), str(int(kind))]) for *place, kind in placement.spheres(p)]
    return "\n".join([head, *rows, ""])
