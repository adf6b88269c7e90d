# SPDX-License-Identifier: GPL-2.0-or-later
"""A LIGGGHTS deck of the user with one of the laws in place of LIGGGHTS's own `hertz` or `hooke`."""

import math
import re
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path

from ...base.declarations import Declaration, declarations
from ...base.files import write_own
from ...case.toml import text_of
from ...errors import CaseError

REPLACED = ("hertz", "hooke")  # normal models with the elastic constants of a law
SETTINGS = (  # of these models, refused or unknown beside a law
    "viscous",
    "ktToKnUser",
    "heating_normal_hertz",
    "heating_normal_hooke",
    "computeElasticPotential",
    "computeDissipatedEnergy",
    "disableNormalWhenBonded",
)
# A command with its continuation lines and its comment; a word, quoted or not.
_COMMAND = re.compile(r"(?:[^&\n]|&(?![ \t\r]*(?:\n|$)))*(?:&[ \t\r]*(?:\n|$)(?:[^&\n]|&(?![ \t\r]*(?:\n|$)))*)*\n?")
_WORD = re.compile(r"\"\"\".*?\"\"\"|\"[^\"]*\"|'[^']*'|#.*|(?:[^\s&#\"']|&(?![ \t\r]*(?:\n|$)))+", re.DOTALL)


@dataclass
class Conversion:
    """The deck with the law, and sentences on each change and on all that stays."""

    text: str
    notes: list[str] = field(default_factory=list)


def _converted(command: str, words: list[re.Match[str]], law: Declaration, place: str) -> tuple[str, list[str]]:
    """The command with the law's model and without settings that the model does not have; what was dropped."""
    texts = [word.group() for word in words]
    at = texts.index("model") + 1 if "model" in texts[:-1] else 0
    if not at:
        raise CaseError(f"{place}: {' '.join(texts[:4])} names no model; write 'model hertz' after gran")
    if texts[at] not in REPLACED:
        raise CaseError(
            f"{place}: model {texts[at]} has parameters that no law replaces; only {' and '.join(REPLACED)} are "
            "converted, choose one of these first"
        )
    cuts, notes = [(words[at].start(), words[at].end(), f"ep/{law.name}")], []
    for k, name in enumerate(texts[:-1]):
        if k > at and name in SETTINGS:
            cuts.append((words[k].start(), words[k + 1].end(), ""))
            notes.append(f"{place}: setting '{name} {texts[k + 1]}' of model {texts[at]} is dropped")
    for start, end, new in sorted(cuts, reverse=True):
        command = command[:start] + new + command[end:]
    return command, notes


def _property_lines(law: Declaration, given: dict[str, str], present: set[str], types: int, place: Path) -> list[str]:
    own = {p.property: p for p in law.parameters}
    for name in given:
        if name not in own:
            raise CaseError(f"--set {name}: ep/{law.name} has no such property; it has {', '.join(own) or 'none'}")
        if name in present:
            raise CaseError(f"--set {name}: {place} gives this property; leave it out, or remove the deck's line")
    lines = []
    for name, p in own.items():
        if name in present:
            continue
        if name not in given:
            if p.default is None:
                raise CaseError(f"{place}: ep/{law.name} needs {name} [{p.unit}]; add --set {name}=VALUE")
            continue
        try:
            number = float(given[name])
        except ValueError:
            number = math.nan
        if not p.holds(number):
            raise CaseError(f"--set {name}={given[name]}: must lie in {p.limits()} in the units of the deck [{p.unit}]")
        head, count = (f"peratomtypepair {types}", types * types) if p.of_pair else ("peratomtype", types)
        values = " ".join([given[name]] * count)
        lines.append(f"fix epdem_{name} all property/global {name} {head} {values}\n")
    return lines


def convert(text: str, law_name: str, given: dict[str, str], place: Path) -> Conversion:
    """The deck `text` with the model ep/`law_name` for pairs and walls. `given`: values of the law's properties.

    Comments, continuation lines and variables stay as they are. Raises CaseError, which names `place` and the line, for
    a deck without a contact model that a law can replace, or a property without a value.
    """
    law = declarations().get(law_name)
    if law is None:
        raise CaseError(f"--law {law_name}: does not exist; there are {', '.join(declarations())}")
    parts: list[str] = []
    notes: list[str] = []
    present: set[str] = set()
    models = moduli = types = 0
    for found in _COMMAND.finditer(text):
        command, where = found.group(), f"{place}, line {text.count(chr(10), 0, found.start()) + 1}"
        # before the comment, which reaches over continuation lines as in LIGGGHTS
        words = [*takewhile(lambda word: not word.group().startswith("#"), _WORD.finditer(command))]
        texts = [word.group() for word in words]
        pairs = texts[:1] == ["pair_style"] and "gran" in texts
        if pairs or (texts[:1] == ["fix"] and texts[3:4] == ["wall/gran"]):
            command, dropped = _converted(command, words, law, where)
            models, notes = models + 1, notes + dropped
        elif texts[:1] == ["fix"] and texts[3:4] == ["property/global"]:
            present.add(texts[4] if len(texts) > 4 else "")
            if texts[4:6] == ["youngsModulus", "peratomtype"]:
                types, moduli = len(texts) - 6, len(parts) + 1
                command += "" if command.endswith("\n") else "\n"
        elif texts[:1] in (["include"], ["jump"]) and len(texts) > 1:
            notes.append(f"{where}: the file {texts[1]} is left as it is; convert it too if it names a contact model")
        elif any(re.search(rf"\bmodel\s+({'|'.join(REPLACED)})\b", t) for t in texts if t[0] in "\"'"):
            notes.append(f"{where}: the contact model inside quotes is left as it is")
        parts.append(command)
    if not models:
        raise CaseError(
            f"{place}: --convert needs a line 'pair_style gran model hertz' or 'fix ... wall/gran model hertz'; name a "
            "LIGGGHTS deck"
        )
    if not types:
        raise CaseError(
            f"{place}: no line 'fix ID all property/global youngsModulus peratomtype ...', which gives the number of "
            "atom types; convert the file that has it"
        )
    lines = _property_lines(law, given, present, types, place)
    parts[moduli:moduli] = lines
    if "coefficientRestitution" in present:
        notes.append(
            "coefficientRestitution acts on the tangential dashpot only: the restitution of the normal direction "
            "follows from the law; 'viscous on' at the end of pair_style and fix wall/gran adds the normal dashpot"
        )
    notes.append(f"{models} contact models are ep/{law.name} now")
    notes += [f"added: {line.strip()}" for line in lines]
    return Conversion("".join(parts), notes)


def convert_file(
    deck: Path, law: str, given: dict[str, str], out: Path, *, force: bool = False
) -> tuple[list[Path], list[str]]:
    """Write `deck` with the model ep/`law` under its own name into the folder `out`: the file, and `Conversion.notes`.

    Raises CaseError, also if the file would replace the deck itself.
    """
    text = text_of(deck)
    if (out / deck.name).resolve() == deck.resolve():
        raise CaseError(f"--out {out}: the deck itself is there; name another folder")
    done = convert(text, law, given, deck)
    return write_own(out, {deck.name: done.text}, force=force), done.notes
