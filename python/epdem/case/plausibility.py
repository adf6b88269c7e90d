# SPDX-License-Identifier: GPL-2.0-or-later
"""Sentences on values that are possible and most often have a wrong unit."""

from collections.abc import Iterator, Mapping

from .fields import Material
from .impact import Case
from .scene import SceneCase

MODULI = (1e5, 1.3e12)  # [Pa] from rubber foam to diamond
DENSITIES = (100.0, 25_000.0)  # [kg/m^3] from foam to osmium
LARGEST_RADIUS = 1.0  # [m]
LARGEST_STRAIN = 0.1  # Y/E; any bulk solid has less
LARGEST_FRICTION = 5.0  # of clean metals in vacuum; above it stands a percentage


def _of_materials(materials: Mapping[str, Material]) -> Iterator[str]:
    for name, m in materials.items():
        if not MODULI[0] <= m.young_modulus <= MODULI[1]:
            yield f"materials.{name}.young_modulus = {m.young_modulus:g} Pa, of solids {MODULI[0]:g} to {MODULI[1]:g}"
        if not DENSITIES[0] <= m.density <= DENSITIES[1]:
            yield f"materials.{name}.density = {m.density:g} kg/m^3, of solids {DENSITIES[0]:g} to {DENSITIES[1]:g}"
        if m.yield_stress is not None and m.yield_stress > LARGEST_STRAIN * m.young_modulus:
            share = m.yield_stress / m.young_modulus
            yield f"materials.{name}.yield_stress = {m.yield_stress:g} Pa is {share:.2g} of young_modulus"


def _radii(case: Case | SceneCase) -> Iterator[tuple[str, float]]:
    if isinstance(case, Case):
        yield "impact.body.radius", case.impact.body.radius
        if case.impact.target.radius is not None:
            yield "impact.target.radius", case.impact.target.radius
        return
    for n, part in enumerate(case.parts.filled):
        yield f"scene.particles.{n}.radius", part.radii()[1]


def _frictions(case: Case | SceneCase) -> Iterator[tuple[str, float | None]]:
    if case.contact is None:
        return
    yield "contact.friction", case.contact.friction
    if isinstance(case, SceneCase):
        yield "contact.wall_friction", case.contact.wall_friction
        yield from ((f"contact.pairs.{n}.friction", pair.friction) for n, pair in enumerate(case.contact.pairs))


def case_warnings(case: Case | SceneCase) -> list[str]:
    """A sentence for each value that is probably in another unit than its author meant."""
    found = list(_of_materials(case.materials))
    found += [f"{place} = {r:g} m" for place, r in _radii(case) if r > LARGEST_RADIUS]
    units = [f"{text}; is the unit right?" for text in found]
    high = [(place, mu) for place, mu in _frictions(case) if mu is not None and mu > LARGEST_FRICTION]
    return [*units, *(f"{place} = {mu:g}, of solids up to {LARGEST_FRICTION:g}; percent?" for place, mu in high)]
