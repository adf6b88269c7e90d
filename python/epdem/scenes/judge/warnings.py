# SPDX-License-Identifier: GPL-2.0-or-later
"""Warnings of a scene before and after its run: probable mistakes and lost spheres, in sentences."""

import itertools
import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt
import pandas as pd

from ...base.readable import in_words
from ...case.motions import FloatArray
from ...case.outputs import AtRest
from ...case.parts import Region
from ...case.walls import Room
from ...errors import CaseError
from ...impacts.prediction import SURFACE_FRICTION, surface_yields
from ...jobs.stage import Tables
from ...theory import validity
from ...theory.timestep import LOOSE
from ..plan import filling
from ..plan.beds import DENSE, dense_beds, largest_density
from ..plan.limits import depths, overlaps
from ..plan.meshes import at_end, sheet
from ..plan.phases import NO_VOID, NOT_REACHED
from ..plan.plan import ScenePlan
from ..plan.quantities import STRAINS
from ..plan.timestep import impact, unstable_steps
from ..tables.columns import bodies, last_frame, reduced
from ..tables.stages import SLOW, against, inertial_numbers, loaded, towards, volume
from .checks import AT_REST, flow_warnings, reached_forces

SIDES = 24  # of the prism that stands for a round region
NAMED = 3  # spheres that are named one by one
ADVICE = "close the walls, enlarge scene.room, or give scene.open_boundary = true"
IN_WALL = 0.999  # of the radius: an engine divides by the distance to the wall
PRESSED = "pressures and springback deviate from finite elements (docs/press.md)"
ALL_LEFT = 0.85  # relative density below which a release leaves too much force on the sides
MISSED = 0.01  # of the duration of a phase
NEAR = 5e-3  # error of the pressure of a stage, or of a force that ends a phase, from which on a sentence names it
FAST = 3.0  # rms speed of a bed over the speed of its punch; spheres that the punch hits fly at twice its speed at most
TAIL, OFF = 0.2, 0.05  # of a phase, over which the force of a wall is averaged; of the force
OVERLAP = 0.05  # of the smaller radius; a bed of an earlier run has less
FLAT = 1e-3  # of the smallest radius: corners of a horizontal triangle differ by less in height


def planned_warnings(p: ScenePlan) -> list[str]:
    """A sentence for each. Raises CaseError for a sphere whose centre lies in a wall."""
    found = [*_law(p), *_yields_at_surface(p), *_cold_losses(p), *_hard_walls(p), *filling.warnings(p.case)]
    found += [*dense_beds(p.beds), *_slower(p), *unstable_steps(p.case, largest_density(p.scene, p.beds))]
    return [*found, *_durations(p), *_overlaps(p), *_walls(p)]


def _law(p: ScenePlan) -> list[str]:
    """A law that does not have the pressure of a pressed bed."""
    if p.model.compaction or not any(bed.solid_height > LOOSE * bed.height for bed in p.beds):
        return []
    return [
        f"law.name = {p.model.law!r}: the pressures of a bed that is pressed with this law are not those of finite "
        "elements (docs/press.md); take law.name = 'cavity' with finite_strain = true and compaction = true"
    ]


def _yields_at_surface(p: ScenePlan) -> list[str]:
    """The sentence on first yield under a large friction of the pair whose surface yields at the lowest pressure; its
    speed does not depend on the radius."""
    found: dict[float, str] = {}
    for material, radius in {part.material: part.radii()[0] for part in p.scene.filled}.items():
        for other, mu in zip(p.model.types, p.model.friction[p.model.type_of(material) - 1], strict=True):
            if mu > SURFACE_FRICTION:
                x = impact(p.case, material, radius, other.material, 1.0, wall=other.wall)
                found |= surface_yields(x, mu)
    return [found[min(found)]] if found else []


def _cold_losses(p: ScenePlan) -> list[str]:
    """Losses of a scene with heat that do not become heat, because no table books them."""
    if not (p.heat and p.heat.share and p.model.loses_energy):
        return []
    return [
        "friction of one spring, rolling friction and dashpots heat nothing, because no history holds their work: "
        "temperatures are too low by it; contact.tangential = 'partial_slip' books the work of friction"
    ]


def _hard_walls(p: ScenePlan) -> list[str]:
    """Walls of a press that never yield beside some of its spheres, which pass through them at high pressure."""
    if not (p.scene.stages and p.model.compaction):
        return []
    types, shares = p.model.types, p.model.shares()
    filled = [n for n, t in enumerate(types) if t.material in {part.material for part in p.scene.filled}]
    soft = {
        w.material: types[n].material
        for w, wall in ((w, p.wall_types[w.name] - 1) for w in p.scene.wall)
        for n in filled
        if shares[n][wall] == 1.0 and types[n].strength < types[wall].strength
    }
    return [
        f"walls of {wall!r} never yield beside spheres of {name!r}: the force of such a contact grows up to an overlap "
        f"of 0.9 radii only, and at high pressure spheres pass through; give the walls the material {name!r} (their "
        "friction is contact.wall_friction)"
        for wall, name in soft.items()
    ]


def measured_warnings(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> list[str]:
    """A sentence for contacts beyond small strain, for a bed without void, and for each phase whose `until` was not
    reached."""
    largest = float(tables["rows"][STRAINS[0]].iloc[-1])
    limit = max((limit for limit in validity.FINITE_STRAIN if largest > limit), default=0.0)
    share = _share_above(p, tables, limit) if limit and "contacts" in tables else 0.0
    where = f" in up to {share:.3g} % of the contacts of a frame" if share else ""
    phases = tables.get("phases", pd.DataFrame(columns=["until"]))
    no_void = [
        f"scene.phase.{phase['phase']}: the run ended after step {phase['end']}, because the pressed bed has no void "
        "left (relative density 1), and the tables end there; reduce the force, or the duration of the phase"
        for phase in phases[phases["until"] == NO_VOID].head(1).to_dict("records")
    ]
    pressing = [*_gains_energy(p, tables), *press_warnings(p, tables)] if "stages" in tables else []
    pressing += [
        f"scene.phase.{name}.until: {found:.4g} N, {found / asked - 1.0:+.2%} beside the {asked:.4g} N asked for; move "
        "slower near it"
        for name, (found, asked) in reached_forces(p).items()
        if abs(found / asked - 1.0) > NEAR
    ]
    softens = "finite_strain" in p.model.ratios()
    effect = PRESSED if p.model.compaction else validity.SOFTENED if softens else validity.OVERESTIMATED
    others = [*_force_not_reached(p, tables["rows"]), *flow_warnings(p, tables), *_still_moves(p, tables)]
    return [*validity.finite_strain(largest, where, effect), *no_void, *pressing, *others] + [
        f"scene.phase.{phase['phase']}.until was not reached: the phase ended by its duration, at "
        f"{phase['end_time']:.4g} s; give a longer duration, or another condition"
        for phase in phases[phases["until"] == NOT_REACHED].to_dict("records")
    ]


def _still_moves(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> list[str]:
    """A sentence for each phase in which spheres come to rest and at whose end they move."""
    settles = {check.phase for check in p.scene.check if isinstance(check, AtRest)}
    if not settles or "particles" not in tables:
        return []
    rows, found = tables["rows"], []
    mass, radius = last_frame(tables["particles"])[["mass", "radius"]].mean()
    for phase in (x for x in p.phases if x.name in settles):
        end = rows[rows["step"] <= phase.end].iloc[-1]
        energy = end["kinetic_energy"] / max(1.0, end["particles"])
        if energy > AT_REST * mass * p.scene.gravity * radius:
            speed = math.sqrt(2.0 * energy / mass)
            found.append(
                f"phase {phase.name} ends while the spheres still move, at {speed:.3g} m/s (rms); give more time"
            )
    return found


def _share_above(p: ScenePlan, tables: dict[str, pd.DataFrame], limit: float) -> float:
    """Largest share of the contacts of a frame whose largest strain w a/R* is above the limit [%]."""
    contacts = tables["contacts"]
    if contacts.empty:
        return 0.0
    one, other = bodies(p, contacts, tables["particles"])
    R_star = reduced(one["radius"], other["radius"])
    weaker = np.array(p.model.shares())[one["type"].astype(int) - 1, other["type"].astype(int) - 1]
    elastic = np.sqrt(R_star * contacts["delta_max"].clip(lower=0.0))  # Hertz, where there is no dent
    strain = weaker * np.maximum(contacts["dent_radius"], elastic) / R_star
    return float(100.0 * (strain > limit).groupby(contacts["step"]).mean().max())


def _durations(p: ScenePlan) -> list[str]:
    """Phases that are longer or shorter than requested, because their time step is given and they end with a row."""
    found = []
    for times, phase in zip(p.phase_table.to_dict("records"), p.phases, strict=True):
        seconds, wanted = times["end_time"] - times["begin_time"], phase.case.seconds
        given = phase.case.time_step or p.case.numerics.time_step
        if given and abs(seconds / wanted - 1.0) > MISSED:
            row = p.every * phase.time_step
            found.append(
                f"phase {phase.name} takes {seconds:.4g} s, not {wanted:.4g} s: its time_step is given, and it ends "
                f"with a row (each {row:.2g} s); give more output.rows, or leave time_step out"
            )
    return found


def _overlaps(p: ScenePlan) -> list[str]:
    """Spheres of a table that lie in each other at the start."""
    i, j, share = overlaps(p.scene.table, p.scene)
    if not (many := int((share > OVERLAP).sum())):
        return []
    worst = int(share.argmax())
    one, other = sorted((i[worst] + 1, j[worst] + 1))
    return [
        f"scene: {many} pairs of spheres overlap at the start by more than {OVERLAP:.0%} of the smaller radius, "
        f"spheres {one} and {other} of scene.fill and scene.body by {share[worst]:.0%}; check places and radii, or the "
        "bed begins with a burst"
    ]


def _walls(p: ScenePlan) -> list[str]:
    """Regions that a wall runs through and spheres of the start that lie in one, of walls that have not moved yet."""
    moved, found = set[str](), {}
    spheres = [(f"sphere {n} of scene.fill and scene.body", s) for n, s in enumerate(p.scene.table, 1) if not s.frozen]
    for phase in p.phases:
        gates = [w for w in p.scene.gates if w.name in phase.gates]
        walls = {w.name: sheet(w, p.box) for w in (*p.scene.planes, *gates)}
        walls |= {name: triangles for name, triangles in p.triangles.items() if name not in moved}
        moved |= set(phase.moves)
        fills = [f for f in p.insertions if f.phase == phase.name]
        places, radii = np.array([s.place for _, s in spheres]), np.array([s.radius for _, s in spheres])
        for name, triangles in walls.items():
            for f in fills:
                if crosses(f.region, triangles, OVERLAP * min(particles.radii()[0] for particles in f.particles)):
                    found[f.key, name] = f"{f.key}.region: wall {name} runs through it; move one of them"
            share = depths(triangles, places, radii) / radii if spheres else np.zeros(1)
            if share.max() > OVERLAP:
                place = spheres[int(share.argmax())][0]
                if share.max() > IN_WALL:
                    raise CaseError(f"{place}: its centre lies in wall {name}; move it")
                found["", name] = f"{place} lies in wall {name} by {share.max():.0%} of its radius; move it"
        spheres = []  # they come with the first phase
    return list(found.values())


def _faces(region: Region, free: float) -> tuple[FloatArray, FloatArray]:
    """(normals, shape (n, 3); distances [m] from the origin, shape (n,)) of the faces of a region, `free` inside it."""
    both = np.array([[-1.0], [1.0]])
    if isinstance(region, Room):
        normals: FloatArray = np.kron(np.eye(3), both)
        return normals, np.array(region.limits) * normals.sum(axis=1) - free
    angle = 2 * math.pi * np.arange(SIDES) / SIDES
    sides = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(SIDES)])
    apothem = region.radius * math.cos(math.pi / SIDES)
    around = apothem + sides[:, :2] @ np.array(region.center)
    return np.concatenate([both * [0.0, 0.0, 1.0], sides]), np.array([-region.z[0], region.z[1], *around]) - free


def crosses(region: Region, triangles: FloatArray, free: float) -> bool:
    """Whether one of the triangles, shape (n, 3 corners, 3), has a part more than `free` [m] inside a region."""
    normals, distances = _faces(region, free)
    beyond = np.any(np.all(triangles @ normals.T >= distances, axis=1), axis=1)
    corners = triangles[~beyond].reshape(-1, 3)
    faces = np.arange(len(corners)).reshape(-1, 3)
    for normal, distance in zip(normals, distances, strict=True):
        if not len(faces):
            return False
        from trimesh.intersections import slice_faces_plane  # a second: only where a wall is near

        corners, faces, _ = slice_faces_plane(corners, faces, -normal, normal * distance)  # type: ignore[no-untyped-call]
    return len(faces) > 0


def lost_spheres(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> list[str]:
    """A sentence for a run that has lost spheres: how many, when, and from the frames, which."""
    rows = tables["rows"]
    lost = int(rows["particles"].max() - rows["particles"].iloc[-1])
    if p.scene.open_boundary or not lost:
        return []
    before = int(np.flatnonzero(np.diff(rows["particles"]) < 0)[0])
    said = f"scene: {lost} spheres have left the room, the first between "
    said += " s and ".join(f"{time:.4g}" for time in rows["time"].iloc[before : before + 2]) + " s"
    if p.frames:
        last = tables["particles"].drop_duplicates("id", keep="last")
        for x in last[last["step"] < p.frame_steps(p.frames)[-1]].head(NAMED).itertuples():
            said += f", sphere {x.id} (last at ({x.x:.4g}, {x.y:.4g}, {x.z:.4g}) m with ({x.vx:.3g}, {x.vy:.3g}, "
            said += f"{x.vz:.3g}) m/s, step {x.step})"
    return [f"{said}; {ADVICE}"]


def passed_walls(p: ScenePlan, tables: Tables) -> list[str]:
    """A sentence for each plane of all phases, and for each wall with horizontal triangles whose way is known, through
    which spheres have passed: how many, and the largest overlap."""
    if not p.frames:
        return []
    spheres, found = tables["particles"], []
    for name, passed in ((name, ids) for name, ids in _passed(p, spheres).items() if ids):
        said = f"{len(passed)} of {spheres['id'].nunique()} spheres have passed through wall {name}"
        contacts = tables.get("contacts", pd.DataFrame(columns=["wall"]))
        if len(contacts := contacts[contacts["wall"] == name]):
            share = contacts["delta_max"].to_numpy() / bodies(p, contacts, spheres)[0]["radius"].to_numpy()
            said += f", whose contacts overlap by up to {share.max():.2g} radii"
        found.append(
            f"{said}: a sphere whose centre reaches a wall is free behind it; reduce the load or the time step, "
            "or give a higher modulus"
        )
    return found


def _passed(p: ScenePlan, spheres: pd.DataFrame) -> dict[str, set[int]]:
    """The spheres that are on another side of a wall than a frame before, by wall.

    The motion of a sphere that the next frame lacks goes on until then. Where it leaves the sphere in the room although
    its surface was within a radius of the wall, a load between two frames has pressed the sphere through.
    """
    steps = p.frame_steps(p.frames)
    frames = [spheres[spheres["step"] == step].set_index("id") for step in steps]
    limits = np.array(p.scene.room.limits).reshape(3, 2)
    surfaces, passed = [*_surfaces(p, steps)], dict[str, set[int]]()
    for n, (now, later) in enumerate(itertools.pairwise(frames)):
        gone = ~now.index.isin(later.index)
        begin, velocity = now[[*"xyz"]].to_numpy(), now[["vx", "vy", "vz"]].to_numpy()
        end = begin + p.frames * p.time_step * velocity
        end[~gone] = later.loc[now.index[~gone], [*"xyz"]]
        left = gone & ((end >= limits[:, 0]) & (end <= limits[:, 1])).all(axis=1)
        for name, axis, triangles, levels in surfaces:
            before, after = begin[:, axis] - levels[n], end[:, axis] - levels[n + 1]
            through = (before * after < 0) | (left & (np.abs(before) < 2 * now["radius"].to_numpy()))
            for place in (begin, end):
                through[through] = _within(np.delete(triangles, axis, 2), np.delete(place[through], axis, 1))
            passed.setdefault(name, set()).update(now.index[through])
    return passed


def _surfaces(p: ScenePlan, steps: list[int]) -> Iterator[tuple[str, int, FloatArray, list[float]]]:
    """(wall, axis across it, its triangles, their place along the axis at each step) of the planes of all phases, and
    of the horizontal triangles of one height of walls that rest or move up and down in a known way; not of the punch of
    a press, which has a sentence."""
    for plane in p.scene.planes:
        yield plane.name, "xyz".index(plane.axis), sheet(plane, p.box), [plane.at] * len(steps)
    moves = [entry for phase in p.phases for entry in phase.moves.items()]
    aside = {name for name, move in moves if move.press or move.rotation or move.along[0] or move.along[1]}
    aside |= {p.scene.stages.wall} if p.scene.stages else set()
    motions, flat = [p.motions_until(step) for step in steps], FLAT * p.smallest
    for name in (name for name in p.triangles if name not in aside):
        corners = p.triangles[name]
        horizontal = corners[np.ptp(corners[..., 2], axis=1) < flat]
        levels = np.round(horizontal[:, 0, 2] / flat)
        for level in np.unique(levels):
            one = horizontal[levels == level]
            yield name, 2, one, [float(at_end(moves, {name: one[:1]})[name][0, 0, 2]) for moves in motions]


def _within(triangles: FloatArray, places: FloatArray) -> npt.NDArray[np.bool_]:
    """Which places, shape (n, 2), lie in one of the triangles, shape (m, 3 corners, 2)."""
    sides = (np.roll(triangles, -1, axis=1) - triangles)[None]
    arms = places[:, None, None] - triangles[None]
    turns = sides[..., 0] * arms[..., 1] - sides[..., 1] * arms[..., 0]
    inside = np.asarray((turns >= 0).all(axis=2) | (turns <= 0).all(axis=2))
    return np.asarray(inside.any(axis=1))


def press_warnings(p: ScenePlan, tables: Tables) -> list[str]:
    """A sentence for a stage beside its pressure, for a bed too dense for the laws, for a press that is too fast for an
    even stress while it loads, for an ejection, and for spheres that have passed the punch."""
    table, found = tables["stages"], []
    numbers = inertial_numbers(p, loaded(p, table))
    found += [
        f"phase {row['phase']}: {in_words(row['asked'] * (1 + row['error']), 'Pa')}, {row['error']:+.2%} beside the "
        f"{in_words(row['asked'], 'Pa')} asked for" + "; press slower near it" * (row["error"] > 0.0)
        for row in table[table["error"].abs() > NEAR].to_dict("records")
    ]
    dense, densest = table[table["relative_density"] > DENSE], table["relative_density"].max()
    if not dense.empty:
        worst = dense.loc[dense["relative_density"].idxmax()]
        found.append(
            f"phase {worst['phase']}: the relative density is {worst['relative_density']:.3g}, and above {DENSE} no "
            "contact law of spheres gives the pressure (docs/press.md); press less"
        )
    if not numbers.empty and numbers.max() > SLOW:
        name = table["phase"][numbers.idxmax()]
        speed = next(towards(p, phase) for phase in p.phases if phase.name == name)
        found.append(
            f"phase {name}: the inertial number v/h d sqrt(rho/P) is {numbers.max():.2g}, above {SLOW:g}, so that "
            f"inertia bears a part of the pressure; {speed * SLOW / numbers.max():.2g} m/s is slow enough"
        )
    found += [
        f"phase {phase.name}: its forces are too large: a bed that is released from a relative density of "
        f"{densest:.2g} keeps more force on the sides than finite elements, 1.3 times at 0.8 (docs/press.md)"
        for phase in p.phases
        if densest < ALL_LEFT and np.any(phase.velocity(p.stages.against)) and towards(p, phase) == 0.0
    ]
    if "particles" in tables and (behind := _behind(p, tables)):
        found.append(
            f"{behind} spheres have passed wall {p.stages.wall}, and pressures and densities are wrong: the force of a "
            "contact with a hard wall grows up to an overlap of 0.9 radii; give the walls the material of the spheres, "
            "lower pressures, or smaller spheres"
        )
    return found


def _gains_energy(p: ScenePlan, tables: Tables) -> list[str]:
    """A sentence for a bed that gains energy: by its balance, or because it moves faster than a punch can drive it."""
    checks, rows = tables["checks"], tables["rows"]
    mass, fast = volume(p, tables) * max(p.case.materials[part.material].density for part in p.scene.filled), False
    for phase in p.phase_steps:
        during = rows[(rows["step"] > phase.end - phase.steps) & (rows["step"] <= phase.end)]
        speed = max(0.0, towards(p, phase))
        fast |= speed > 0.0 and bool((during["kinetic_energy"] > 0.5 * mass * (FAST * speed) ** 2).any())
    if not fast and checks[checks["key"].isin(["energy_residual", "energy_gained"])]["passed"].all():
        return []
    step = max(phase.time_step for phase in p.phases)
    return [
        f"the pressed bed gains energy that no wall puts in: its time step, {step:.2g} s, is too large, and its "
        f"pressures and densities are wrong; give numerics.time_step = '{0.5 * step:.2g} s'"
    ]


def _behind(p: ScenePlan, tables: Tables) -> int:
    """Largest number of spheres in a frame at the end of a phase whose centres are behind the punch."""
    stages, spheres = tables["stages"], tables["particles"]
    axis, at = against(p, p.time_at(stages["step"].to_numpy()))
    height, begin = (spheres["step"].map(pd.Series(x, stages["step"])) for x in (stages["height"].to_numpy(), at))
    counts = (np.abs(spheres["xyz"[axis]] - begin) > height).groupby(spheres["step"]).sum()
    return int(counts.max())


def _slower(p: ScenePlan) -> list[str]:
    """A sentence for each wall that a force drives and that is slower in contact than the case says."""
    return [
        f"scene.phase.{phase.name}.move: with the dashpots of [viscous] wall {name} would oscillate at highest_speed = "
        f"{press.highest_speed:g} m/s; where spheres touch it, it has at most {press.speed_in_contact:g} m/s"
        for phase in p.phases
        for name, move in phase.moves.items()
        if (press := move.press) and press.speed_in_contact < press.highest_speed
    ]


def _force_not_reached(p: ScenePlan, rows: pd.DataFrame) -> list[str]:
    """A sentence for each wall that a force drives whose force is not the requested one at the end of a phase, which no
    condition ends."""
    found = []
    for phase in p.phase_steps:
        presses = {name: move.press for name, move in phase.moves.items() if move.press}
        for name, move in presses.items() if not phase.case.condition else ():
            after = phase.end - max(p.every, TAIL * phase.steps)
            tail = rows[(rows["step"] > after) & (rows["step"] <= phase.end)]
            force = -float((tail[[f"{name}_force_{axis}" for axis in "xyz"]] @ np.array(move.direction)).mean())
            if abs(force / move.force - 1.0) > OFF:
                found.append(
                    f"scene.phase.{phase.name}.move: the force of wall {name} is {force:.4g} N in the last rows, "
                    f"requested are {move.force:g} N; give a longer duration, or a lower highest_speed if it oscillates"
                )
    return found
