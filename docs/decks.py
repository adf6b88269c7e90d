# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/decks.md: the models and the lines of decks, for programs that write decks, from the declarations.

Run: .venv/bin/python docs/decks.py
"""

import re
from pathlib import Path

import pandas as pd
from pages import markdown

from epdem.base.declarations import Declaration, declarations

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs/decks.md"
HEADERS = ROOT / "cpp_contact/include/epdem"
HEAD = """\
# For programs that write decks

`python docs/decks.py` writes this page from the declarations of the laws, which a program reads as
`epdem.base.declarations.declarations()`. Numbers are SI. The restitution is a result: no deck sets it.

## Laws

"""
PARAMETERS = """
LAMMPS takes the parameters in this order; those in brackets have a default and can be left out from the end. Values of
the pair belong to two materials: `workOfAdhesion` is `peratomtypepair` in LIGGGHTS and an attribute of
`Ip2_EpMat_EpMat_EpPhys` in YADE, where `surfaceEnergy` of each material gives it, too.

"""
REST = """
## The two lines

LIGGGHTS, beside the properties of the table (`fix m5 all property/global yieldPressure peratomtype 2.8e9`):

```deck
pair_style gran model ep/thornton tangential history
fix wall all wall/gran model ep/thornton tangential history primitive type 1 zplane 0.0
```

LAMMPS, E, nu and the parameters of the law in one line:

```text
pair_style ep
pair_coeff * * thornton 208e9 0.3 2.8e9 tangential history 0.3
```

YADE, with materials `EpMat(young=208e9, poisson=0.3, density=7850, frictionAngle=0.29, yieldPressure=2.8e9)`:

```text
[Ip2_EpMat_EpMat_EpPhys()],
[Law2_ScGeom_EpPhys_Thornton(tangential="history")],
```

## Check

```sh in decks/test_deck_page.py
epdem doctor --json                                               # engines and models of this machine: part, ok, advice
epdem predict --material steel --radius "10 mm" --speed "5 m/s" --json  # e_n, contact time, peak force, and warnings
epdem deck cases/steel_wall.toml -e lammps -o example --reasons   # a deck to compare with, the reason of each line
epdem deck --convert my.in --set yieldPressure=2.8e9 -o converted # a deck of LIGGGHTS with a law; changes on stderr
epdem deck --check my.in                                          # inputs of LIGGGHTS that are probably wrong
epdem verify contacts -e lammps --json                            # the laws on this machine, against closed forms
```

A run checks the rest: `epdem-liggghts -in my.in` and LAMMPS end before the first step with exit code 1 and a line
`ERROR: ...` that names model, property, value, types and range; YADE raises `RuntimeError`. Commands of epdem end with
0, 1 (a check failed), 2 (input) or 3 (engine), and one sentence.

- LIGGGHTS: keep the real Young's modulus (`hard_particles yes`); a plain `liggghts` does not have the models.
- The [time step](choose.md#the-time-step) is 1/30 of the shortest contact at most; `epdem predict` names it.
- LAMMPS: `atom_style sphere`, `comm_modify vel yes`, walls as `fix ID all wall/ep` ([LAMMPS](lammps.md)).
- [Properties and settings in LIGGGHTS](properties.md), [YADE](yade.md), [case files](scenes.md) instead of decks.
"""


def words(law: Declaration) -> str:
    """LAW and the symbols of its parameters, as pair_coeff of LAMMPS takes them behind I J."""
    text, closing = f"{law.name} E nu", ""
    for p in law.parameters:
        text += f" {p.symbol}" if not has_default(p.name, law) else f" [{p.symbol}"
        closing += "]" if has_default(p.name, law) else ""
    return f"`{text}{closing}`"


def has_default(name: str, law: Declaration) -> bool:
    """Whether a deck can leave out the parameter of that name."""
    return law.parameter(name).default is not None


def models(folder: str) -> str:
    """Names of the models of a folder of headers."""
    found = []
    for header in sorted((HEADERS / folder).glob("*.hpp")):
        for given in re.findall(r"const char\* name = ([^;]*);", header.read_text(encoding="utf-8")):
            found += re.findall(r'"(.*?)"', given)
    return ", ".join(f"`{name}`" for name in sorted(found, key=lambda name: (name != "off", name)))


def page() -> str:
    """The text of the page."""
    laws = [
        {
            "law": f"`{law.name}`: {law.title}",
            "LIGGGHTS": f"`ep/{law.name}`",
            "LAMMPS `pair_coeff I J`": words(law),
            "YADE": f"`Law2_ScGeom_EpPhys_{law.name.title().replace('_', '')}`",
        }
        for law in declarations().values()
    ]
    rows = {
        p.property: {
            "property, attribute of `EpMat`": f"`{p.property}`",
            "key of `[law]`": f"`{p.name}`",
            "symbol": p.symbol,
            "unit": p.unit,
            "range": p.limits(),
            "default": "none" if p.default is None else f"{p.default:g}",
        }
        for law in declarations().values()
        for p in law.parameters
    }
    beside = "".join(f"- {name}: {models(name)}\n" for name in ("friction", "rolling", "cohesion"))
    text = HEAD + markdown(pd.DataFrame(laws)) + "\n" + PARAMETERS + markdown(pd.DataFrame(rows.values()))
    note = "\n\nModels beside the law; LAMMPS and YADE write them without `ep/`, LAMMPS `none` for `off`:\n\n"
    return text + note + beside + REST


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
