# SPDX-License-Identifier: GPL-2.0-or-later
"""Common parts of the input scripts of LIGGGHTS and LAMMPS: atom types, data files, ids, skin, loads, stops."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from ..base.rendering import number, wall_id
from ..case.motions import PressMove
from ..case.walls import PlateWall
from ..errors import CaseError
from ..impacts.plan import Group, Plan, room, side_by_side
from ..laws.strengths import ADHESION
from ..scenes.plan.beds import PressedBed, bed_of, closing_speed
from ..scenes.plan.limits import TOUCH
from ..scenes.plan.model import Model, Type
from ..scenes.plan.phases import LAG, MISS, SLOWING, PhaseSteps
from ..scenes.plan.plan import ROUNDING, ScenePlan
from . import log

RIGID = 1e30  # modulus [Pa] of a rigid type: 1e15 would change E* of steel by 2e-4
WRITE_RESTART = ("write_restart restart.*.bin",)
SKIN_OF_GROWTH = 0.2  # of the largest radius, with compaction: lists, made anew after half of it, hold 0.1 of growth
SKIN = 0.5  # of the smallest radius: rebuilds cost less than idle neighbours


def data_text(title: str, types: int, box: Iterable[float], rows: Iterable[Sequence[float]], first: int = 1) -> str:
    """A data file of `types` atom types in a box xlo xhi ... [m]; ids from `first`. rows: type, diameter, density,
    place, velocity, spin of each sphere, SI."""
    atoms, velocities = [], []
    for n, (kind, *values) in enumerate(rows, first):
        words = [number(x) for x in values]
        atoms.append(" ".join([str(n), str(int(kind)), *words[:5]]))
        velocities.append(" ".join([str(n), *words[5:]]))
    xlo, xhi, ylo, yhi, zlo, zhi = map(number, box)
    head = [f"{' '.join(title.split())}: id type diameter density x y z", "", f"{len(atoms)} atoms"]
    head += [f"{types} atom types", f"{xlo} {xhi} xlo xhi", f"{ylo} {yhi} ylo yhi", f"{zlo} {zhi} zlo zhi"]
    return "\n".join([*head, "", "Atoms", "", *atoms, "", "Velocities", "", *velocities, ""])


def heat_words(p: ScenePlan) -> str:
    """The words of fix heat/ep; "": the scene has no heat."""
    if p.heat is None:
        return ""
    types = zip(p.heat.conductivities, p.heat.capacities, strict=True)
    conductivity = {name: p.heat.conductivities[kind - 1] for name, kind in p.wall_types.items()}
    words = [number(x) for x in (p.heat.share, *(x for one in types for x in one))]
    walls = (f"wall {wall_id(w)} {number(T)} {number(conductivity[w])}" for w, T in p.heat.walls.items())
    return " ".join([*words, *walls])


def temperature_words(p: ScenePlan, phase: str, spheres: Iterable[tuple[int, float | None]]) -> tuple[str, ...]:
    """First and last id of spheres that come with a phase, and their temperature; spheres: (number, temperature)."""
    last, found = p.count_before(phase), []
    for T, some in groupby(spheres, key=lambda x: x[1]):
        first, last = last + 1, last + sum(count for count, _ in some)
        if T is not None:
            found.append(f"{first} {last} {number(T)}")
    return tuple(found)


def taken_places(p: ScenePlan, phase: str, radius: str) -> tuple[tuple[str, str], ...]:
    """(name, formula of the spheres that lie in its place) of each single sphere that comes with a phase but the first.

    radius: the host's word for the radius of a sphere.
    """
    found = []
    for b in p.scene.later:
        ways = []
        for axis, place, period in zip("xyz", b.position, p.scene.periods, strict=True):
            way = f"({axis}-({number(place)}))"
            ways.append(f"({way}-{number(period)}*round({way}/{number(period)}))" if period else way)
        squares = "+".join(f"{way}*{way}" for way in ways)
        if b.phase == phase:
            found.append((b.name, f"{squares} < ({radius}+{number(b.radius * (1.0 - TOUCH))})^2"))
    return tuple(found)


def equal_spheres(kind: int, g: Group) -> list[list[float]]:
    """The bodies of one side of impacts as rows of `data_text`."""
    still = np.zeros(len(g.place))
    same = np.tile([kind, 2 * g.body.radius, g.body.density], (len(g.place), 1))
    spin = (still, still if g.spin is None else g.spin, still)
    rows: list[list[float]] = np.column_stack([same, g.place, g.velocity, *spin]).tolist()
    return rows


def impact_data(plan: Plan, types: int) -> str:
    """The data file of all bodies of impacts; a target that moves is of the last type."""
    sides = zip((1, types), side_by_side(plan), strict=False)
    return data_text(plan.experiment.name, types, room(plan), [row for side in sides for row in equal_spheres(*side)])


def finite(value: float) -> float:
    """A modulus or strength [Pa] for LIGGGHTS, which has no infinity."""
    return RIGID if math.isinf(value) else value


def impact_model(plan: Plan) -> Model:
    """The contact model of impacts: one or two types, the moving body first."""
    x, oblique = plan.experiment, plan.experiment.oblique
    bodies = [x.body] if x.target.material == x.body.material else [x.body, x.target]
    types = tuple(
        Type(
            b.material,
            b.material,
            strength,
            b.young_modulus,
            b.poisson_ratio,
            b.density if b.density < math.inf else 1.0,
        )
        for b, strength in zip(bodies, x.law.strengths, strict=False)
    )

    def of_pairs(value: float) -> tuple[tuple[float, ...], ...]:
        return ((value,) * len(types),) * len(types)

    return Model(
        law=x.law.name,
        parameters=x.law.parameters,
        types=types,
        wall_types={},
        friction=of_pairs(oblique.friction if oblique else 0.0),
        tangential=oblique.tangential if oblique else "history",
        viscous=None if x.viscous_restitution is None else of_pairs(x.viscous_restitution),
        tangential_restitution=oblique.restitution if oblique else None,
        rolling=None,
        cohesion=None,
        adhesion=of_pairs(x.law.parameters[ADHESION]) if x.law.adheres else (),
    )


@dataclass(frozen=True)
class StopCondition:
    """How a phase ends early: after `first` steps at most `rows` times `every`, until the condition holds.

    formula: "" without a condition; limit: its value. look: steps between two looks, fewer as the limit comes near if
    `nears`; apart: these do not stop at rows. loose: formula of the steps in which a bed is too loose to bear a force,
    "": they are not known. left: formula of the steps that are left to a height, "": no height is awaited. slowing:
    words of the fix that gives the share of their speed that walls have near their force, but the share at the begin,
    "": they do not slow. share: at the begin of a phase or of a continued run. opposite, force: formulas of the force
    on the wall against a punch and, where a height is awaited, on the punch. stop: commands that bring the walls to
    rest. void: formula of the height of the void in a pressed bed, which ends the run at 0; "": no bed is pressed.
    gone: steps with looks before a continued run.
    """

    first: int
    rows: int
    formula: str
    condition: str
    void: str = ""
    limit: float = 0.0
    look: int = 0
    every: int = 0
    nears: bool = False
    apart: bool = False
    loose: str = ""
    left: str = ""
    slowing: str = ""
    share: str = "1.0"
    opposite: str = ""
    force: str = ""
    stop: tuple[str, ...] = ()
    gone: int = 0

    @property
    def steps(self) -> int:
        """At most, of the rows."""
        return self.rows * self.every


def default_skin(p: ScenePlan) -> float:
    """The skin of a case that gives none [m]."""
    if p.model.compaction:  # lists hold pairs across gaps
        return float(f"{max(0.5 * SKIN * p.smallest, 1.05 * SKIN_OF_GROWTH * p.largest):.1e}")
    return float(f"{SKIN * p.smallest:.1e}")


def torque_origin(p: ScenePlan, name: str) -> Sequence[float]:
    """The place that torques on a mesh refer to [m]: on the axis of its rotation."""
    origins = {tuple(rotation.origin) for rotation in p.rotations(name)}
    if len(origins) > 1:
        raise CaseError(f"scene.wall.{name}: it rotates about several origins, torques are about one; rotate about one")
    return next(iter(origins), (0.0, 0.0, 0.0))


def row_words(p: ScenePlan) -> Iterator[str]:
    """Words of the rows beside the strain: power; of walls three components of the force, of meshes six."""
    yield from (f"f_{word}" for word, column in log.ROWS.items() if column in p.row_columns)
    yield from (f"v_way{n}" for n in range(1, len(p.ways) + 1))
    for n, name in enumerate(p.measured_walls, 1):
        yield from (f"f_load{n}[{k}]" for k in range(1, 7 if name in p.scene.meshes else 4))


def first_look(p: ScenePlan, run: PhaseSteps) -> int:
    """The steps of a phase before its condition is evaluated."""
    rows = math.ceil(run.case.condition_from / run.time_step / p.every)
    return min(run.steps, p.every * rows)


def ended_at(run: PhaseSteps) -> list[str]:
    """The comparisons with which a force on a wall ends a phase; a wall that slows stays near its force."""
    assert run.case.condition is not None
    low, high = (number(share * run.case.condition.limit) for share in (1.0 - MISS, 1.0 + MISS))
    if run.case.condition.force:
        return [f">= {low}", *([] if run.slows is None else [f"<= {high}"])]
    return [f"<= {high}"]


BORNE = 0.05  # of the pressure of a stage, that the opposite wall bears at least
LOOSE = 0.4  # relative density below which spheres that do not attract each other bear no plate
LOOK = 100  # steps between two looks at a condition


def stop_condition(
    p: ScenePlan,
    run: PhaseSteps,
    place: Callable[[PressedBed], str],
    force: Callable[[str, int], str],
    stop: Sequence[str] = (),
) -> StopCondition | None:
    """How a phase ends early, in words of LIGGGHTS and LAMMPS: by its condition, or by a bed without void.

    None: it does not. place: formula of the height that a pressed bed has. force: word of a component of the force
    on a wall at a step. stop: commands that bring the walls of the phase to rest.
    """
    void = next((f"{place(bed)}-{number(bed.solid_height)}" for bed in p.pressed if bed.phase == run.name), "")
    until = run.case.condition
    if until is None:
        return StopCondition(0, run.steps // p.every, "", "", void) if void else None
    first = first_look(p, run)
    if until.kinetic_energy is not None:
        formula, sign = "ke/(atoms+(atoms==0))+1e99*(atoms==0)", "<"  # a room without spheres waits for them
    elif until.count is not None:
        formula, sign = "atoms", "<="
    elif until.of_bed:
        whole = StopCondition(first, (run.steps - first) // p.every, "", "", void)
        return _at_height(p, run, whole, place, force, stop)
    elif not run.stops:  # what shakes or is driven: the mean of a row
        load = f"f_load{1 + p.measured_walls.index(until.wall or '')}"
        formula = "sqrt(" + "+".join(f"{load}[{k}]*{load}[{k}]" for k in (1, 2, 3)) + ")"
        sign = ">=" if until.force else "<="
    else:
        name, stages, opposite = until.wall or "", p.scene.stages, ""
        axis = None
        if stages and name == stages.wall:
            axis = 1 + "xyz".index(next(w.axis for w in p.scene.wall if w.name == name and isinstance(w, PlateWall)))
            opposite = f"abs({force(stages.against, axis)})"

        squares = (f"{force(name, k)}*{force(name, k)}" for k in (1, 2, 3))
        on_wall = f"abs({force(name, axis)})" if axis else f"sqrt({'+'.join(squares)})"
        # a sphere that strikes the punch alone is no pressure
        borne = f"*({opposite}>={number(BORNE * until.limit)})" if opposite and until.force else ""
        words, of_fix = ended_at(run), force(name, axis) if axis else force(name, 1).removesuffix("[1]")
        slowing = f"{of_fix} {'rises' if until.force else 'falls'} {number(until.limit)} {SLOWING} {LAG}"
        return StopCondition(
            first=first,
            rows=(run.steps - first) // p.every,
            formula=on_wall + borne,
            condition=" && ".join(f"${{found}} {x}" for x in words),
            void=void,
            limit=until.limit,
            look=LOOK if run.slows is not None else min(LOOK, p.every),
            every=p.every,
            nears=run.slows is None,
            apart=run.slows is not None,
            loose="" if run.slows is None else _loose(p, run, place),
            slowing="" if run.slows is None else slowing,
            opposite=opposite,
            stop=tuple(stop),
        )
    rows, condition = (run.steps - first) // p.every, f"${{found}} {sign} {number(until.limit)}"
    apart = until.wall is None
    look = min(LOOK, p.every) if apart else p.every
    return StopCondition(first, rows, formula, condition, void, until.limit, look, p.every, apart=apart)


def _loose(p: ScenePlan, run: PhaseSteps, place: Callable[[PressedBed], str]) -> str:
    """Formula of the steps until a bed that a plate presses is dense enough to bear a force; "": they are not known."""
    bed = bed_of(p.pressed, run.case)
    if bed is None or p.model.cohesion or p.model.adhesion or (fall := closing_speed(bed, run.case)) <= 0.0:
        return ""
    return f"({place(bed)}-{number(bed.solid_height / LOOSE)})/{number(fall * run.time_step)}"


def _at_height(
    p: ScenePlan,
    run: PhaseSteps,
    whole: StopCondition,
    place: Callable[[PressedBed], str],
    force: Callable[[str, int], str],
    stop: Sequence[str],
) -> StopCondition:
    """How a phase ends at a height or density of a bed, one look after the steps that its plates need.

    whole: the phase with the void of the bed alone. Other arguments as of `stop_condition`.
    """
    bed, until, stages = bed_of(p.pressed, run.case), run.case.condition, p.scene.stages
    assert bed is not None and until is not None
    height, limit = place(bed), until.limit
    if until.height:
        value, comparison = height, f"<= {number(limit * (1.0 + ROUNDING))}"
    else:
        value, comparison = f"{number(bed.solid_height)}/{height}", f">= {number(limit * (1.0 - ROUNDING))}"
    left = f"({height}-{number(until.height or bed.solid_height / limit)})"
    opposite = of_punch = ""
    if stages and bed.wall == stages.wall:
        opposite, of_punch = (f"abs({force(name, 1 + bed.axis)})" for name in (stages.against, stages.wall))
    return replace(
        whole,
        formula=value,
        condition=f"${{found}} {comparison}",
        limit=limit,
        every=p.every,
        apart=True,
        left=f"{left}/{number(closing_speed(bed, run.case) * run.time_step)}",
        opposite=opposite,
        force=of_punch,
        stop=tuple(stop),
    )


def press_speed(force: str, move: PressMove) -> str:
    """Formula of the speed of a wall by the word of its force on the spheres along its motion: its share of the highest
    speed is the relative error of the force, at most 1."""
    error, most = f"(1-{force}/{number(move.force)})", number(move.speed_in_contact)
    if faster := move.highest_speed - move.speed_in_contact:
        most = f"({most}+{number(faster)}*({force}==0))"
    return f"({error}*(abs({error})<=1)+({error}>1)-({error}<-1))*{most}"


def bed_height(bed: PressedBed, place: Callable[[str], str]) -> str:
    """Formula of the height of a bed between a plate and what it presses against. place: formula of a plate's place."""
    stop = place(bed.against) if bed.against else number(bed.stop)
    return f"({stop}-{place(bed.wall)})" if bed.sign > 0 else f"({place(bed.wall)}-{stop})"
