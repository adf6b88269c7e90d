# SPDX-License-Identifier: GPL-2.0-or-later
"""Sentences on values that are possible and most often have a wrong unit."""

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from .impact import Case

if TYPE_CHECKING:  # imports templates and tables, which impacts do not need
    from .scene import SceneCase

Value = tuple[str, float | None, str, float, float]  # place, value, its unit, the usual least and largest value


def _values(case: "Case | SceneCase") -> Iterator[Value]:
    for name, m in case.materials.items():
        yield f"materials.{name}.young_modulus", m.young_modulus, " Pa", 1e5, 1.3e12  # rubber foam to diamond
        yield f"materials.{name}.density", m.density, " kg/m^3", 100.0, 25_000.0  # foam to osmium
        yield f"materials.{name}.yield_stress", m.yield_stress, " Pa", 0.0, 0.1 * m.young_modulus  # of any bulk solid
    radii: dict[str, float | None]
    frictions: dict[str, float | None]
    if isinstance(case, Case):
        radii = {"impact.body.radius": case.impact.body.radius, "impact.target.radius": case.impact.target.radius}
        frictions = {"contact.friction": case.contact.friction} if case.contact else {}
    else:
        radii = {f"scene.particles.{n}.radius": part.radii()[1] for n, part in enumerate(case.parts.filled)}
        frictions = {f"contact.{key}": getattr(case.contact, key) for key in ("friction", "wall_friction")}
        frictions |= {f"contact.pairs.{n}.friction": pair.friction for n, pair in enumerate(case.contact.pairs)}
    yield from ((place, r, " m", 0.0, 1.0) for place, r in radii.items())
    yield from ((place, mu, "", 0.0, 5.0) for place, mu in frictions.items())  # of clean metals in vacuum


def case_warnings(case: "Case | SceneCase") -> list[str]:
    """A sentence for each value that is probably in another unit than its author meant."""
    return [
        f"{place} = {x:g}{unit}, usually {least:g} to {largest:g}; {'is the unit right?' if unit else 'percent?'}"
        for place, x, unit, least, largest in _values(case)
        if x not in (None, math.inf) and not least <= x <= largest
    ]
