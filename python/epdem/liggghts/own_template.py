# SPDX-License-Identifier: GPL-2.0-or-later
"""A user's own deck template, with the values of a case and the macros that our own decks use."""

from pathlib import Path

import jinja2
from jinja2 import meta

from .. import rendering as decks
from ..case import scene as scenes
from ..case.impact import load as load_impact
from ..case.impact import read_toml
from ..errors import CaseError
from ..impacts.experiment import experiment
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..scenes import kinds
from . import stl
from .impacts import Liggghts, data_text
from .scene_deck import deck as scene_deck


def value(text: str) -> int | float | str:
    """A value of --set: a number if it reads as one, else the text."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def settings(pairs: list[str]) -> dict[str, int | float | str]:
    """The values of `--set key=value`. Raises CaseError."""
    found: dict[str, int | float | str] = {}
    for pair in pairs:
        key, equals, text = pair.partition("=")
        if not equals or not key.isidentifier():
            raise CaseError(f"--set {pair!r}, must be key=value with a key of letters, digits and underscores")
        if key in ("deck", "case"):
            raise CaseError(f"--set {key}: this name holds the case's values; choose another")
        if key in found:
            raise CaseError(f"--set {key} is given twice; keep one")
        found[key] = value(text)
    return found


def write(template: Path, case_path: Path, sets: dict[str, object], out: Path) -> list[Path]:
    """Render `template` with the values of a case into `out`, with the case's own data and mesh files beside it.

    In the template: `deck` (materials, model, time step ...), `case`, the names of `sets`, and our macros by
    {% import "liggghts/macros.j2" as macros %}. Raises CaseError for an undefined name, or a set one that is not used.
    """
    try:
        source = template.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise CaseError(f"{template}: cannot be read ({error})") from None
    if not template.name.endswith(".j2"):
        raise CaseError(f"{template}: a template's name ends in .j2; the deck is written without it")
    extra: dict[str, str] = {}
    triangles = {}
    if scenes.is_scene(read_toml(case_path)):
        case = scenes.load(case_path)
        deck, triangles = scene_deck(case), kinds.layout(case).meshes
    else:
        case = load_impact(case_path)
        x = experiment(case)
        p = plan(x, predict(x))
        deck = Liggghts().deck(p)
        extra[deck.data] = data_text(p, len(deck.types))
    environment = decks.environment(template.resolve().parent)
    try:
        unused = set(sets) - meta.find_undeclared_variables(environment.parse(source))
        if unused and not meta_includes(environment, source):
            raise CaseError(f"--set {min(unused)}: {template} does not use it; check the spelling")
        text = environment.from_string(source).render(deck=deck, case=case, **sets)
    except jinja2.TemplateError as error:
        line = f":{error.lineno}" if getattr(error, "lineno", None) else ""
        raise CaseError(f"{template}{line}: {error}") from None
    out.mkdir(parents=True, exist_ok=True)
    files = [out / template.name.removesuffix(".j2")]
    files[0].write_text(text)
    for name, content in extra.items():
        if name in text:
            files.append(out / name)
            files[-1].write_text(content)
    for name, surface in triangles.items():
        if f"{name}.stl" in text:
            files.append(out / f"{name}.stl")
            files[-1].write_text(stl.text(name, surface))
    return files


def meta_includes(environment: jinja2.Environment, source: str) -> bool:
    """Whether a template takes in others of the user's, which may use a name that it does not."""
    names = [n for n in meta.find_referenced_templates(environment.parse(source)) if n]
    return any(not n.startswith("liggghts/") for n in names)
