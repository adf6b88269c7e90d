# SPDX-License-Identifier: GPL-2.0-or-later
"""The materials file: typical values with their sources, in the form of a case file's materials."""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ..errors import CaseError
from .impact import Material


@dataclass(frozen=True)
class Sourced:
    """A material in SI and where its numbers come from."""

    name: str
    material: Material
    source: str


@cache
def materials() -> dict[str, Sourced]:
    """All materials of the file by name."""
    raw = tomllib.loads(Path(__file__).with_name("materials.toml").read_text(encoding="utf-8"))
    entries = {}
    for name, entry in raw.items():
        values = {k: v for k, v in entry.items() if k != "source"}
        entries[name] = Sourced(name, Material.model_validate(values), entry["source"])
    return entries


def material(name: str) -> Sourced:
    """The material of that name. Raises CaseError that lists the existing names."""
    if name not in materials():
        raise CaseError(f"--material {name!r} is not in the materials file; there are {', '.join(materials())}")
    return materials()[name]
