# SPDX-License-Identifier: GPL-2.0-or-later
"""The materials file, and materials of a case that are taken from it."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from ..errors import CaseError


@cache
def entries() -> dict[str, dict[str, Any]]:
    """Every material of the file as it is written there, by name."""
    return tomllib.loads(Path(__file__).with_name("materials.toml").read_text(encoding="utf-8"))


def with_library(data: dict[str, Any], path: object) -> dict[str, Any]:
    """The tables of a case in which `from = "steel"` of a material has become the numbers of the materials file.

    Keys beside `from` replace the keys of the file. Raises CaseError for a name that is not there.
    """
    materials = data.get("materials")
    if not isinstance(materials, dict) or not any(isinstance(m, dict) and "from" in m for m in materials.values()):
        return data
    return data | {"materials": {name: _filled(name, m, path) for name, m in materials.items()}}


def _filled(name: str, material: Any, path: object) -> Any:
    if not isinstance(material, dict) or "from" not in material:
        return material
    origin = material["from"]
    if not isinstance(origin, str) or origin not in entries():
        have = ", ".join(entries())
        raise CaseError(f"{path}: materials.{name}.from = {origin!r} is not in the materials file; there are {have}")
    known = {key: value for key, value in entries()[origin].items() if key != "source"}
    return known | {key: value for key, value in material.items() if key != "from"}
