# SPDX-License-Identifier: GPL-2.0-or-later
"""Columns of rows and of frames of spheres: unit, meaning and the word of each host, by which decks request them and
tables name them. A new column is a line here, and the code of a host that fills it."""

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from .model import Model


class Quantity(NamedTuple):
    """SI unit ("": none), meaning, word of the hosts that call it otherwise ("thermo": in the log of the rows)."""

    unit: str
    meaning: str
    words: Mapping[str, str] = MappingProxyType({})


class Work(NamedTuple):
    """A work or energy [J] of each sphere, half of that of its contacts. term: of the energy balance. of: whether
    contacts of a model have it. words: of the hosts, which all have one."""

    meaning: str
    term: str
    of: Callable[[Model], bool]
    words: Mapping[str, str]
    unit: str = "J"


def _both(word: str) -> dict[str, str]:
    return {"liggghts": word, "lammps": word}


STRAINS = ("largest_radius_ratio", "largest_overlap_ratio")
ROWS = {
    "step": Quantity("", "number of the step"),
    "time": Quantity("s", "time"),
    "particles": Quantity("", "number of spheres in the room", {"thermo": "Atoms"}),
    "kinetic_energy": Quantity("J", "kinetic energy of all spheres", {"thermo": "KinEng"}),
    "wall_power": Quantity("W", "power of all moving walls, mean over a row", {"thermo": "power"}),
    STRAINS[0]: Quantity("", "largest w a/R* of all contacts since the start", {"thermo": "ratio[1]"}),
    STRAINS[1]: Quantity("", "largest w delta/R* of all contacts since the start", {"thermo": "ratio[2]"}),
}
PARTICLES = {
    "id": Quantity("", "number of the sphere"),
    "type": Quantity("", "number of its material"),
    "radius": Quantity("m", "radius"),
    "mass": Quantity("kg", "mass"),
    **{axis: Quantity("m", f"{axis} of the centre") for axis in "xyz"},
    **{f"v{axis}": Quantity("m/s", f"velocity along {axis}") for axis in "xyz"},
}
SPINS = {f"omega_{x}": Quantity("rad/s", f"angular velocity about {x}", _both(f"omega{x}")) for x in "xyz"}
TEMPERATURE = {"temperature": Quantity("K", "temperature", {"liggghts": "f_temperature", "lammps": "f_heat"})}
WORKS = {
    "plastic_work": Work(
        "plastic work so far",
        "plastic",
        lambda m: m.yields,
        {"liggghts": "f_plasticWork", "lammps": "f_EP_HISTORY0[1]", "yade": "plasticWork"},
    ),
    "adhesive_work": Work(
        "work that contacts with adhesion have lost so far",
        "adhesion",
        lambda m: m.adheres,
        {"liggghts": "f_adhesiveWork", "lammps": "f_EP_HISTORY0[6]", "yade": "adhesionLoss"},
    ),
    "friction_work": Work(
        "work of friction so far",
        "friction",
        lambda m: m.nodes > 0,
        {"liggghts": "f_frictionWork", "lammps": "f_EP_HISTORY0[4]", "yade": "frictionWork"},
    ),
    "friction_energy": Work(
        "elastic energy of the friction springs",
        "springs",
        lambda m: m.nodes > 0,
        {"liggghts": "f_frictionEnergy", "lammps": "f_EP_HISTORY0[5]"},  # YADE's recorder adds it to frictionWork
    ),
}
OF_FRAMES: dict[str, Quantity | Work] = {**PARTICLES, **SPINS, **TEMPERATURE, **WORKS}
UNITS = {name: x.unit for name, x in {**ROWS, **OF_FRAMES}.items() if x.unit}


def words(host: str, names: Iterable[str]) -> tuple[str, ...]:
    """The words of a host for columns of frames."""
    return tuple(OF_FRAMES[name].words.get(host, name) for name in names)


def page() -> str:
    """The tables of docs/results.md."""
    found = []
    tables: dict[str, Mapping[str, Quantity | Work]] = {"rows": ROWS, "particles": OF_FRAMES}
    for title, table in tables.items():
        found += [f"| column of `{title}` | unit | meaning |", "|---|---|---|"]
        found += [f"| `{name}` | {x.unit} | {x.meaning} |" for name, x in table.items()] + [""]
    return "\n".join(found)
