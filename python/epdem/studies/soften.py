# SPDX-License-Identifier: GPL-2.0-or-later
"""A softened twin of a case: larger time steps with the same yield speed and the same e_n(v).

The yield speed goes as p_y^2.5/E*^2, so E*/k with p_y/k^0.8 keeps it, and with it the whole curve e_n(v/v_y). The time
step grows by k^0.4, dents and overlaps by k^0.4 and a/R by k^0.2. Softening the modulus alone loses e_n.

The sticking speed goes as Gamma^(5/6)/E*^(1/3), so Gamma/k^0.4 keeps it. Then sqrt(2 pi Gamma a/E*) grows as the
overlaps and sqrt(2 Gamma E*/(pi a)) falls as p_y: all lengths and pressures of such a contact keep their ratios.

The force of a contact at a speed, its yield force and its pull-off force fall as k^0.4. Forces that a scene prescribes
fall with them, weight does not. At the same density the pressure of a bed at rest is that of its strength: pressures of
a press, and forces without weight, fall as k^0.8. Kinetic energies of impacts at the same speeds are the same, and
falls, ways and turns take the same times: lengths, times, speeds and energies of a scene stay.

The overlap of first yield goes as (p_y/E*)^2: yield_ratio k^0.4. The constraint of a hardness depends on E/Y, so that a
hardness becomes the yield_ratio of the same strength.

What depends on a/R itself follows it: finite strain takes c k^0.14 in exp(-c (w a/R*)^-0.7), and the reference of a
strength that grows with the rate 0.2 w v/a falls as the rate. The area that finite strain takes off goes with
overlap/R*, which no parameter scales: there e_n changes.
"""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import tomlkit

from ..case.fields import Material
from ..case.impact import Rate
from ..case.law import law_numbers
from ..case.toml import portable_text, read_toml, text_of, with_library
from ..case.units import to_si
from ..errors import CaseError
from ..laws.strengths import ADHESION, find_law, yield_ratio_of
from ..theory.cavity import FINITE_STRAIN, STRAIN_EXPONENT
from ..theory.validity import SMALL_DEFORMATION

if TYPE_CHECKING:
    from ..impacts.prediction import Prediction

STRENGTH_POWER, ADHESION_POWER, FORCE_POWER, STEP_POWER, STRAIN_POWER = 0.8, 0.4, 0.4, 0.4, 0.2
OVERLAP_POWER = 0.4  # of overlaps over the radius
KEPT = ("s", "Hz", "m/s", "rad/s", "J")  # units of what a scene keeps and a twin names
Key = tuple[str | int, ...]  # names of tables and numbers of entries


@dataclass(frozen=True)
class Change:
    """A changed value of the case file, before and after, as text."""

    place: str
    before: str
    after: str


@dataclass(frozen=True)
class Twin:
    """The softened case file, its changes, the largest strain w a_max/R* before and after, and by how much of itself
    e_n changes at most.
    """

    text: str
    changes: tuple[Change, ...]
    strain: tuple[float, float]
    time_step_factor: float
    e_n_change: float
    warnings: tuple[str, ...]


def _scaled(value: str, factor: float) -> str:
    number, _, unit = value.strip().partition(" ")
    return f"{float(number) * factor:.15g} {unit.strip()}"


def _quantities(data: Any, unit: str, place: Key = ()) -> Iterator[tuple[Key, str]]:
    """(key, value) of each quantity in tables of a case that has this unit of SI, or a multiple."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data):
        if isinstance(value, dict | list):
            yield from _quantities(value, unit, (*place, key))
        elif isinstance(value, str):
            with suppress(ValueError):
                to_si(value, unit)
                yield (*place, key), value


def _replacements(data: dict[str, Any], factor: float) -> dict[Key, str | float]:
    law = data["law"]
    strength = find_law(law["name"]).strength
    texts: dict[Key, str | float] = {}
    for name, material in data["materials"].items():
        texts["materials", name, "young_modulus"] = _scaled(material["young_modulus"], 1.0 / factor)
        ratio = material.get("yield_ratio")
        if "hardness" in material and strength:
            numbers = law_numbers(law["name"], {key: value for key, value in law.items() if key != "name"})
            solid = Material.model_validate({k: v for k, v in material.items() if k in Material.model_fields})
            ratio = yield_ratio_of(numbers, numbers.strength(name, solid), solid)
        if ratio is not None:
            texts["materials", name, "yield_ratio"] = float(f"{ratio * factor**OVERLAP_POWER:.15g}")
        for key in ("yield_stress", *([strength] if strength else [])):
            if key in material:
                texts["materials", name, key] = _scaled(material[key], factor**-STRENGTH_POWER)
        if "surface_energy" in material:
            texts["materials", name, "surface_energy"] = _scaled(material["surface_energy"], factor**-ADHESION_POWER)
    if ADHESION in law:
        texts["law", ADHESION] = _scaled(law[ADHESION], factor**-ADHESION_POWER)
    if strength and strength in law:
        texts["law", strength] = _scaled(law[strength], factor**-STRENGTH_POWER)
    none = {p.name: p.default for p in find_law(law["name"]).parameters}.get("finite_strain")
    if none and (strain := law.get("finite_strain", False)) and strain < none:
        strain = FINITE_STRAIN if strain is True else strain
        texts["law", "finite_strain"] = strain * factor ** (STRAIN_POWER * STRAIN_EXPONENT)
    if "bond_strength" in data.get("contact", {}):
        texts["contact", "bond_strength"] = _scaled(data["contact"]["bond_strength"], factor**-STRENGTH_POWER)
    if "rate" in data:
        reference = data["rate"].get("reference", f"{Rate.model_fields['reference'].default} 1/s")
        texts["rate", "reference"] = _scaled(reference, factor**-STRAIN_POWER)
    resting = data.get("scene", {}).get("gravity", "9.81").split()[0]
    power = FORCE_POWER if float(resting) else STRENGTH_POWER  # no impact drives a bed without weight
    prescribed = {name: data[name] for name in ("scene", "measured") if name in data}
    for unit, fall in (("N", power), ("Pa", STRENGTH_POWER)):
        texts |= {key: _scaled(value, factor**-fall) for key, value in _quantities(prescribed, unit)}
    name = f"{data['case']['name']}_soft{factor:g}".replace(".", "_").replace("+", "")[:64]
    return texts | {("case", "name"): name}


def _change(document: tomlkit.TOMLDocument, data: Any, keys: Key, after: str | float) -> Change:
    """Replace one value of the document, which holds `data`; comments and order stay."""
    table: Any = document
    for key in keys[:-1]:
        table, data = table[key], data[key]
    before = data.get(keys[-1], "the default") if isinstance(data, dict) else data[int(keys[-1])]
    if keys[-1] == "yield_ratio" and "hardness" in table:
        before = f"hardness = {table.pop('hardness')}"
    table[keys[-1]] = after
    return Change(".".join(map(str, keys)), str(before), str(after))


def _prediction(data: dict[str, Any], path: Path) -> "Prediction":
    """Prediction for a case, or for the impact that represents a scene."""
    from ..case import impact as impacts
    from ..case import scene as scenes
    from ..impacts.experiment import experiment
    from ..impacts.prediction import predict
    from ..scenes.plan.timestep import leading_impact

    if scenes.is_scene(data):
        return predict(leading_impact(scenes.parse(data, path)))
    return predict(experiment(impacts.parse(data, path)))


def _loads(data: dict[str, Any], path: Path, factor: float) -> list[str]:
    from ..case import scene as scenes

    if not scenes.is_scene(data):
        return []
    scene, fall, found = scenes.parse(data, path).parts, factor**FORCE_POWER, []
    if any(move.constant_velocity for phase in scene.phase for move in phase.move):
        found.append(
            "a wall that moves with a given velocity compresses the same way: where spheres yield, its forces and "
            f"stresses fall with the strength, by a factor of {factor**STRENGTH_POWER:.3g} (k^{STRENGTH_POWER:g}); "
            f"springback grows by a factor of {factor**STRAIN_POWER:.3g} (k^{STRAIN_POWER:g}), the inertial number of "
            f"the press by {factor**STEP_POWER:.3g} (k^{STEP_POWER:g}): press slower by as much where a run warns of it"
        )
    places = (key for unit in KEPT for key, _ in _quantities(data["scene"], unit, ("scene",)))
    if kept := dict.fromkeys(".".join(map(str, k if isinstance(k[-1], str) else k[:-1])) for k in places):
        found.append(
            f"times, speeds and kinetic energies are kept ({', '.join(kept)}): contacts last "
            f"{factor**STEP_POWER:.3g} times longer; phases must be long beside them"
        )
    if scene.gravity:
        found.append(
            f"weight is kept, and the force of a contact at a speed falls by a factor of {fall:.3g} "
            f"(k^{FORCE_POWER:g}): overlaps and dents grow by more under static loads than in impacts; "
            "take a small --factor where they matter"
        )
    return found


def soften(path: Path, factor: float, *, folder: Path | None = None) -> Twin:
    """The twin of the case in `path` with E/factor, to lie in `folder` (beside it). Raises CaseError."""
    if not 0.0 < factor < 1e12:
        raise CaseError(f"--factor {factor:g}, must lie in (0, 1e12); 100 makes the time step 6.3 times larger")
    data = with_library(read_toml(path), path)
    hard = _prediction(data, path)
    before = float(hard.strain.max())
    after, change = before * factor**STRAIN_POWER, 0.0
    moved = folder is not None and folder.resolve() != path.parent.resolve()
    document = tomlkit.parse(portable_text(path) if moved else text_of(path))
    replacements = _replacements(data, factor)
    changes = [_change(document, data, keys, text) for keys, text in replacements.items()]
    if ("law", "finite_strain") in replacements:
        soft = _prediction(with_library(document.unwrap(), path), path)
        after, change = float(soft.strain.max()), float(np.abs(soft.e_n / hard.e_n - 1.0).max())
    warnings = []
    if before > SMALL_DEFORMATION:
        warnings.append(f"w a_max/R* was {before:.2f} already, above {SMALL_DEFORMATION}; it becomes {after:.2f}")
    elif after > SMALL_DEFORMATION:
        most = (SMALL_DEFORMATION / before) ** (1.0 / STRAIN_POWER)
        warnings.append(
            f"w a_max/R* reaches {after:.2f} (> {SMALL_DEFORMATION}): contacts of one sphere begin to touch each "
            f"other; up to factor {most:.3g} it stays below"
        )
    if data.get("contact", {}).get("cohesion"):
        warnings.append("contact.cohesion is kept: its share of the contact force grows with the contact area")
    warnings += _loads(data, path, factor)
    steps = [data.get("numerics", {}), *data.get("scene", {}).get("phase", [])]
    if any("time_step" in table for table in steps):
        warnings.append(f"every time_step is kept as given; it can be {factor**STEP_POWER:.3g} times larger")
    return Twin(document.as_string(), tuple(changes), (before, after), factor**STEP_POWER, change, tuple(warnings))
