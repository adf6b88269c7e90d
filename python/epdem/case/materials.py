# SPDX-License-Identifier: GPL-2.0-or-later
"""The materials file: typical values with their sources, in the form of a case file's materials."""

from dataclasses import dataclass
from functools import cache

from ..errors import CaseError
from . import library
from .fields import Material


@dataclass(frozen=True)
class Sourced:
    """A material in SI and where its numbers come from."""

    name: str
    material: Material
    source: str


@cache
def materials() -> dict[str, Sourced]:
    """All materials of the file by name."""
    found = {}
    for name, entry in library.entries().items():
        values = {k: v for k, v in entry.items() if k != "source"}
        found[name] = Sourced(name, Material.model_validate(values), entry["source"])
    return found


def material(name: str) -> Sourced:
    """The material of that name. Raises CaseError that lists the existing names."""
    if name not in materials():
        raise CaseError(f"--material {name!r} is not in the materials file; there are {', '.join(materials())}")
    return materials()[name]
