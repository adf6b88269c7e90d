# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks of LIGGGHTS with its own contact models, made into decks with a law of epdem."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import takewhile
from pathlib import Path

from ..base.declarations import Declaration, declarations
from ..base.files import write_own
from ..case.toml import text_of
from ..engines.liggghts.properties import HARD
from ..errors import CaseError

HYSTERESIS = "hooke/hysteresis"
REPLACED = ("hertz", "hooke", HYSTERESIS)  # normal models with the elastic constants of a law
MODULUS = "youngsModulus"
WITHOUT_COUNTERPART = {  # properties of hooke/hysteresis
    "coefficientMaxElasticStiffness": "the law unloads with the stiffness 2 E* a",
    "coefficientPlasticityDepth": "the law has no depth from which on a contact is elastic",
    "coefficientAdhesionStiffness": "no law has adhesion that plastic work makes; --law thornton_ning --set "
    "workOfAdhesion=VALUE has the adhesion of the surfaces",
    "characteristicVelocity": "the stiffness of a law depends on no speed",
}
SETTINGS = (  # of these models, refused or unknown beside a law
    "viscous",
    "ktToKnUser",
    "heating_normal_hertz",
    "heating_normal_hooke",
    "computeElasticPotential",
    "computeDissipatedEnergy",
    "disableNormalWhenBonded",
)
_OLD_MODEL = re.compile(r"(wall/)?gran/(hertz|hooke)(/history)?")
_VARIABLE = re.compile(r"\$\{(\w+)\}|\$(\w)")
# A command with its continuation lines and its comment; a word, quoted or not.
_COMMAND = re.compile(r"(?:[^&\n]|&(?![ \t\r]*(?:\n|$)))*(?:&[ \t\r]*(?:\n|$)(?:[^&\n]|&(?![ \t\r]*(?:\n|$)))*)*\n?")
_WORD = re.compile(r"\"\"\".*?\"\"\"|\"[^\"]*\"|'[^']*'|#.*|(?:[^\s&#\"']|&(?![ \t\r]*(?:\n|$)))+", re.DOTALL)


@dataclass
class Conversion:
    """The deck with the law, and sentences on each change and on all that stays."""

    text: str
    notes: list[str] = field(default_factory=list)


def _replace_model(command: str, words: list[re.Match[str]], law: Declaration, place: str) -> tuple[str, list[str]]:
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
    if law.adheres and "cohesion" in texts:
        raise CaseError(f"{place}: law {law.name} has its attraction already; remove cohesion, or take another law")
    cuts, notes = [(words[at].start(), words[at].end(), f"ep/{law.name}")], []
    for k, name in enumerate(texts[:-1]):
        if k > at and name in SETTINGS:
            cuts.append((words[k].start(), words[k + 1].end(), ""))
            notes.append(f"{place}: setting '{name} {texts[k + 1]}' of model {texts[at]} is dropped")
    for start, end, new in sorted(cuts, reverse=True):
        command = command[:start] + new + command[end:]
    return command, notes


def _renewed(text: str, place: Path) -> tuple[str, list[str]]:
    """The deck with the words of today for the contact models of LIGGGHTS 1.5 and 2 (`gran/hertz/history`); sentences
    on them. Raises CaseError for what has no or several meanings today."""
    parts, notes = [], []
    for command, where, words in _split(text, place):
        texts = [word.group() for word in words]
        at = 1 if texts[:1] == ["pair_style"] else 3 if texts[:1] == ["fix"] else len(texts)
        if found := _OLD_MODEL.fullmatch(texts[at] if at < len(texts) else ""):
            new = [f"{found[1] or ''}gran", "model", found[2], *(["tangential", "history"] if found[3] else [])]
            new += _old_flags(texts[at + 1 :], where) if found[1] else _flags(texts[at + 1 :])
            start, end = words[at].start(), words[-1].end()
            notes.append(f"{where}: '{' '.join(texts[at:])}' is '{' '.join(new)}' today")
            command = command[:start] + " ".join(new) + command[end:]
        parts.append(command)
    return "".join(parts), notes


def _flags(words: list[str]) -> list[str]:
    """Settings of today for the flags of LIGGGHTS 1.5 (tangential damping, cohesion); other words stay."""
    if not {*words[:2]} <= {"0", "1"} or len(words) < 2:
        return words
    cohesion = ["cohesion", "sjkr"] if words[1] == "1" else []
    return [*cohesion, *(["tangential_damping", "off"] if words[0] == "0" else []), *words[2:]]


def _old_flags(words: list[str], where: str) -> list[str]:
    """The words behind a wall's model: the flags and the wall of LIGGGHTS 1.5 in words of today; other words stay."""
    match words:
        case ["0" | "1", "0" | "1", "xplane" | "yplane" | "zplane" as kind, low, high, number] if "NULL" in (low, high):
            wall = [kind, high if low == "NULL" else low]
        case ["0" | "1", "0" | "1", "xcylinder" | "ycylinder" | "zcylinder" as kind, radius, number]:
            wall = [kind, radius, "0", "0"]
        case ["0" | "1", "0" | "1", *_]:
            raise CaseError(
                f"{where}: {' '.join(words[2:])}: no single wall of today; write one fix wall/gran with primitive type "
                "N for each plane, or fix mesh/surface for a mesh"
            )
        case _:
            return words
    flags = _flags(words[:2])
    return [*flags[:2] * ("cohesion" in flags), "primitive", "type", number, *wall, *flags[-2:] * (words[0] == "0")]


def commands(text: str, place: object) -> Iterator[tuple[str, list[str]]]:
    """(place, words without the comment) of each command of a deck."""
    for _, where, words in _split(text, place):
        yield where, [word.group() for word in words]


def _split(text: str, place: object) -> Iterator[tuple[str, str, list[re.Match[str]]]]:
    """(text, place, words) of each command; comments reach over continuation lines as in LIGGGHTS."""
    for found in _COMMAND.finditer(text):
        where = f"{place}, line {text.count(chr(10), 0, found.start()) + 1}"
        words = takewhile(lambda word: not word.group().startswith("#"), _WORD.finditer(found.group()))
        yield found.group(), where, [*words]


def _with_words(command: str, words: list[re.Match[str]], new: list[str]) -> str:
    """The command with other words in place of `words`."""
    for word, text in sorted(zip(words, new, strict=True), key=lambda pair: -pair[0].start()):
        command = command[: word.start()] + text + command[word.end() :]
    return command


def number(word: str, known: Mapping[str, str]) -> float:
    """The value of a word of a deck with the `known` variables; NaN if the deck computes it."""
    word = _VARIABLE.sub(lambda m: known.get(m[1] or m[2], "nan"), word)
    try:
        return float(word)
    except ValueError:
        return math.nan


def variable(words: list[str]) -> dict[str, str]:
    """The variable with a plain value that a command defines, if it does."""
    match words:
        case ["variable", name, "equal" | "string" | "index", value, *_]:
            return {name: value.strip("\"'")}
    return {}


def _with_modulus(text: str, given: str, place: Path) -> tuple[str, list[str]]:
    """The deck with the `given` youngsModulus, one value or one for each type, the time step that it needs, and
    properties of hooke/hysteresis as comments; sentences on the changes."""
    parts, notes, growth, known = [], [], 1.0, dict[str, str]()
    for command, where, words in _split(text, place):
        texts = [word.group() for word in words]
        known |= variable(texts)
        name = texts[4] if texts[:1] == ["fix"] and texts[3:4] == ["property/global"] and len(texts) > 5 else ""
        if name in WITHOUT_COUNTERPART:
            notes.append(f"{where}: {name} is dropped: {WITHOUT_COUNTERPART[name]}")
            command = f"#{command}"
        elif name == MODULUS:
            old, new = words[6:], given.split(",")
            new = new * len(old) if len(new) == 1 else new
            values, before = ([number(word, known) for word in each] for each in (new, texts[6:]))
            if len(new) != len(old) or not all(v > 0.0 for v in values):
                raise CaseError(f"--set {MODULUS}={given}: give one value > 0, or {len(old)}, one for each type")
            command = _with_words(command, old, new)
            growth = max(growth, *(now / was for now, was in zip(values, before, strict=True) if was > 0.0))
            if any(was != was for was in before):
                computed = " ".join(texts[6:])
                notes.append(f"{where}: {computed} is computed: give sqrt(E before/E now) of the time step by hand")
        parts.append(command)
    parts, steps = _shorter_steps(parts, place, growth)
    return "".join(parts), notes + steps


def _allow_hard(text: str, modulus: str) -> tuple[str, list[str]]:
    """The deck with the word that LIGGGHTS requires for a modulus above HARD; a sentence on it."""
    if max(map(float, modulus.split(","))) <= HARD or "hard_particles" in text:
        return text, []
    text = re.sub(r"(?m)^([ \t]*units[ \t]+si\b.*\n)", r"\1hard_particles yes\n", text, count=1)
    return text, [f"added: hard_particles yes, which LIGGGHTS requires above {HARD:g} Pa"]


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
        head, count = (f"peratomtypepair {types}", types * types) if p.of_pair else ("peratomtype", types)
        texts = given[name].split(",")
        if not all(p.holds(number(text, {})) for text in texts):
            raise CaseError(f"--set {name}={given[name]}: must lie in {p.limits()} in the units of the deck [{p.unit}]")
        if len(texts) not in (1, count):
            of = "pair of types" if p.of_pair else "type"
            raise CaseError(f"--set {name}={given[name]}: give one value, or {count}, one for each {of}")
        values = " ".join(texts * (count // len(texts)))
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
    text, renewed = _renewed(text, place)
    modulus = given.get(MODULUS)
    given = {name: value for name, value in given.items() if name != MODULUS}
    if modulus is None and any(HYSTERESIS in words for _, words in commands(text, place)):
        raise CaseError(
            f"{place}: model {HYSTERESIS} has no yield, and its modulus is mostly softened; add --set {MODULUS}=VALUE "
            "with the real one (of each type, with commas)"
        )
    changed, changes = (text, []) if modulus is None else _with_modulus(text, modulus, place)
    parts: list[str] = []
    notes: list[str] = renewed
    present: set[str] = set()
    models = moduli = types = 0
    for command, where, words in _split(changed, place):
        texts = [word.group() for word in words]
        pairs = texts[:1] == ["pair_style"] and "gran" in texts
        if pairs or (texts[:1] == ["fix"] and texts[3:4] == ["wall/gran"]):
            command, dropped = _replace_model(command, words, law, where)
            models, notes = models + 1, notes + dropped
        elif texts[:1] == ["fix"] and texts[3:4] == ["property/global"]:
            present.add(texts[4] if len(texts) > 4 else "")
            if texts[4:6] == ["youngsModulus", "peratomtype"]:
                types, moduli = len(texts) - 6, moduli or len(parts) + 1  # before the first run
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
    notes += changes + [f"added: {line.strip()}" for line in lines]
    text, hard = ("".join(parts), []) if modulus is None else _allow_hard("".join(parts), modulus)
    return Conversion(text, notes + hard)


def _shorter_steps(parts: list[str], place: Path, growth: float) -> tuple[list[str], list[str]]:
    """The commands with the time step that a modulus `growth` times larger needs, of the type that stiffens most:
    contacts of the same radius have a stiffness proportional to it."""
    if growth <= 1.0:
        return parts, []
    factor, done, notes = growth**-0.5, [], []
    for part in parts:
        words = [*takewhile(lambda word: not word.group().startswith("#"), _WORD.finditer(part))]
        if [word.group() for word in words[:1]] == ["timestep"] and len(words) > 1:
            try:
                step = f"{factor * float(words[1].group()):.3g}"
            except ValueError:
                notes.append(f"{place}: {part.strip()}: give {factor:.3g} of this step by hand")
            else:
                part = _with_words(part, words[1:2], [step])
                notes.append(f"timestep is {step} now, sqrt(E before/E now) = {factor:.3g} of the step before")
        done.append(part)
    notes.append(
        f"the same time takes {1 / factor:.3g} times as many steps: correct run, every and the like; a softer twin "
        "with the same e_n has a modulus E/k, a strength p_y/k^0.8 and steps k^0.4 longer (epdem soften)"
    )
    return done, notes


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
