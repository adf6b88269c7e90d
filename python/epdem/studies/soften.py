# SPDX-License-Identifier: GPL-2.0-or-later
"""A softened twin of a case: larger time steps with the same yield speed and the same e_n(v).

The yield speed goes as p_y^2.5/E*^2, so E*/k with p_y/k^0.8 keeps it, and with it the whole curve e_n(v/v_y). The time
step grows by k^0.4, dents and overlaps by k^0.4 and a/R by k^0.2. Softening the modulus alone loses e_n.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from ..case.impact import read_toml
from ..errors import CaseError
from ..impacts.prediction import SMALL_DEFORMATION
from ..laws import library as claw

STRENGTH_POWER, STEP_POWER, STRAIN_POWER = 0.8, 0.4, 0.2


@dataclass(frozen=True)
class Change:
    """One value of the case file, before and after, as written there."""

    place: str
    before: str
    after: str


@dataclass(frozen=True)
class Twin:
    """The softened case file, its changes, and the largest a_max/R* before and after."""

    text: str
    changes: tuple[Change, ...]
    strain_ratio: tuple[float, float]
    time_step_factor: float
    warnings: tuple[str, ...]


def _scaled(value: str, factor: float) -> str:
    number, unit = re.fullmatch(r"\s*([-+.\deE]+)\s*(.*)", value).groups()
    return f"{float(number) * factor:.15g} {unit}".strip()


def _keys(data: dict) -> list[tuple[str, str, float]]:
    """(table, key, power of 1/k) of all values to change."""
    law = data.get("law", {})
    strength = next((p.name for p in claw.laws()[law.get("name")].parameters if p.unit == "Pa"), None)
    found = []
    for name, material in data.get("materials", {}).items():
        found.append((f"materials.{name}", "young_modulus", 1.0))
        found += [
            (f"materials.{name}", key, STRENGTH_POWER)
            for key in dict.fromkeys(("yield_stress", strength))
            if key in material
        ]
    if strength in law:
        found.append(("law", strength, STRENGTH_POWER))
    return found


def _replace(text: str, table: str, key: str, power: float, factor: float) -> tuple[str, Change]:
    """`text` with one quantity changed in place, comments and order kept. Raises CaseError."""
    head = re.search(rf"^\[\s*{re.escape(table)}\s*\][^\n]*\n", text, re.MULTILINE)
    if head is None:
        raise CaseError(f"[{table}] is not a table of its own in this file; write it as one to soften it")
    end = re.compile(r"^\[", re.MULTILINE).search(text, head.end())
    body = text[head.end() : end.start() if end else len(text)]
    line = re.search(rf'^(\s*{re.escape(key)}\s*=\s*")([^"]*)(")', body, re.MULTILINE)
    if line is None:
        raise CaseError(f'{table}.{key}: not found as {key} = "..." on a line of its own')
    after = _scaled(line.group(2), factor**-power)
    changed = body[: line.start(2)] + after + body[line.end(2) :]
    change = Change(f"{table}.{key}", line.group(2), after)
    return text[: head.end()] + changed + text[head.end() + len(body) :], change


def strain_ratio(data: dict, path: object) -> float:
    """Largest a_max/R* that theory expects of a case or scene."""
    from ..case import impact as impacts
    from ..case import scene as scenes
    from ..impacts.experiment import experiment
    from ..impacts.prediction import predict
    from ..scenes import model

    if not scenes.is_scene(data):
        return float(predict(experiment(impacts.parse(data, path))).strain_ratio.max())
    case = scenes.parse(data, path)
    material, radius = case.scene.particles[0].material, case.scene.particles[0].radii()[0]
    x = model.wall_impact(case, material, radius, case.scene.walls, model.highest_speed(case))
    return float(predict(x).strain_ratio.max())


def soften(path: Path, factor: float) -> Twin:
    """The twin of the case in `path` with E/factor. Raises CaseError if a value cannot be changed in place."""
    if not 0.0 < factor < 1e12:
        raise CaseError(f"--factor {factor:g}, must be > 0; 100 makes the time step 6.3 times larger")
    data, text, changes = read_toml(path), path.read_text(), []
    if data.get("law", {}).get("name") not in claw.laws():
        raise CaseError(f"{path}: law.name is missing or unknown; there are {', '.join(claw.laws())}")
    for table, key, power in _keys(data):
        text, change = _replace(text, table, key, power, factor)
        changes.append(change)
    text, change = _rename(text, factor)
    changes.append(change)
    before = strain_ratio(data, path)
    after = before * factor**STRAIN_POWER
    warnings = []
    if before > SMALL_DEFORMATION:
        warnings.append(f"a_max/R* was {before:.2f} already, above {SMALL_DEFORMATION}; it becomes {after:.2f}")
    elif after > SMALL_DEFORMATION:
        most = (SMALL_DEFORMATION / before) ** (1.0 / STRAIN_POWER)
        warnings.append(
            f"a_max/R* reaches {after:.2f} (> {SMALL_DEFORMATION}): contacts of one sphere begin to touch each other; "
            f"up to factor {most:.3g} it stays below"
        )
    if data.get("contact", {}).get("cohesion"):
        warnings.append("contact.cohesion is kept: its share of the contact force grows with the contact area")
    if data.get("scene", {}).get("kind") == "compaction":
        warnings.append("forces and stresses of the press scale with the modulus, not with the real material")
    return Twin(text, tuple(changes), (before, after), factor**STEP_POWER, tuple(warnings))


def _rename(text: str, factor: float) -> tuple[str, Change]:
    line = re.search(r'^(\s*name\s*=\s*")([A-Za-z0-9_-]+)(")', text, re.MULTILINE)
    if line is None:
        raise CaseError("[case] has no name on a line of its own")
    after = f"{line.group(2)}_soft{factor:g}".replace(".", "_").replace("+", "")[:64]
    return text[: line.start(2)] + after + text[line.end(2) :], Change("case.name", line.group(2), after)
