# SPDX-License-Identifier: GPL-2.0-or-later
"""A user's own deck template, with the values of a case and the macros that our own decks use."""

from pathlib import Path

from ..base.folders import write_own
from ..case import scene as scenes
from ..case.impact import load as load_impact
from ..case.toml import read_toml
from ..errors import CaseError
from ..impacts.experiment import experiment
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..scenes.plan import plan as scene_plan
from . import sandbox, stl
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
    values: dict[str, int | float | str] = {}
    for pair in pairs:
        key, equals, text = pair.partition("=")
        if not equals or not key.isidentifier():
            raise CaseError(f"--set {pair!r}, must be key=value with a key of letters, digits and underscores")
        if key in ("deck", "case"):
            raise CaseError(f"--set {key}: this name holds the case's values; choose another")
        if not text.isprintable() or "&" in text:
            raise CaseError(f"--set {key}: {text!r} would begin or join lines of the deck; leave out line ends and '&'")
        if key in values:
            raise CaseError(f"--set {key} is given twice; keep one")
        values[key] = value(text)
    return values


def write(
    template: Path, case_path: Path, sets: dict[str, int | float | str], out: Path, *, force: bool = False
) -> list[Path]:
    """Render `template` with the values of a case into `out`, with the case's own data and mesh files beside it.

    In the template: `deck` (materials, model, time step ...), `case`, the names of `sets`, and our macros by
    {% import "liggghts/macros.j2" as macros %}. Raises CaseError for a mistake in the template, an undefined name, a
    set one that is not used, or a file of the user's in the way, unless `force`.
    """
    name = template.name.removesuffix(".j2")
    if not name or name == template.name:
        raise CaseError(f"{template}: a template's name ends in .j2; the deck is written without it")
    values: dict[str, object] = {}
    beside: dict[str, str] = {}
    if scenes.is_scene(read_toml(case_path)):
        scene = scene_plan(scenes.load(case_path))
        values |= {"deck": scene_deck(scene), "case": scene.case}
        beside |= {f"{n}.stl": stl.text(n, mesh.triangles) for n, mesh in scene.layout.meshes.items()}
    else:
        case = load_impact(case_path)
        x = experiment(case)
        p = plan(x, predict(x))
        deck = Liggghts().deck(p)
        values |= {"deck": deck, "case": case}
        beside[deck.data] = data_text(p, len(deck.types))
    text, unused = sandbox.render(template, values | sets)
    if wrong := unused & set(sets):
        raise CaseError(f"--set {min(wrong)}: {template} does not use it; check the spelling")
    return write_own(out, {name: text} | {n: content for n, content in beside.items() if n in text}, force=force)
