# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks of LIGGGHTS from templates of the user's own."""

import traceback
from collections.abc import Mapping
from pathlib import Path

import jinja2
from jinja2 import meta
from jinja2.sandbox import ImmutableSandboxedEnvironment

from ..base import paths, rendering
from ..base.files import write_own
from ..case.impact import parse as parse_impact
from ..case.scene import is_scene
from ..case.scene import parse as parse_scene
from ..case.toml import error_context, read_toml
from ..engines.liggghts.deck import deck as scene_deck
from ..engines.liggghts.engine import Liggghts
from ..errors import CaseError
from ..impacts.experiment import experiment
from ..impacts.plan import plan
from ..impacts.prediction import predict
from ..scenes.plan.meshes import stl_text
from ..scenes.plan.plan import plan as plan_scene


class _Sandbox(ImmutableSandboxedEnvironment):
    """Calls only macros and the methods of plain values: pydantic's and numpy's can read pickles and write files."""

    def is_safe_callable(self, obj: object) -> bool:
        """Whether a template may call `obj`."""
        owner = type(getattr(obj, "__self__", obj))
        ours = owner in (str, int, float, tuple, list, dict) or owner.__module__.startswith("jinja2.")
        return ours or any(obj is known for known in self.globals.values())


def value(text: str) -> int | float | str:
    """A value of --set: a number if it reads as one, else the text."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def settings(given: Mapping[str, str]) -> dict[str, int | float | str]:
    """The values of `--set key=value` from texts. Raises CaseError."""
    for key, text in given.items():
        if not key.isidentifier():
            raise CaseError(f"--set {key}, must be key=value with a key of letters, digits and underscores")
        if key in ("deck", "case"):
            raise CaseError(f"--set {key}: this name holds the case's values; choose another")
        if not text.isprintable() or "&" in text:
            raise CaseError(f"--set {key}: {text!r} would begin or join lines of the deck; leave out line ends and '&'")
    return {key: value(text) for key, text in given.items()}


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
    data, values = read_toml(case_path), dict[str, object]()
    with error_context(case_path):
        if is_scene(data):
            job = plan_scene(parse_scene(data, case_path))
            values |= {"deck": scene_deck(job), "case": job.case}
            beside = {f"{n}.stl": stl_text(n, triangles) for n, triangles in job.triangles.items()}
        else:
            case = parse_impact(data, case_path)
            x = experiment(case)
            deck = Liggghts().deck(plan(x, predict(x)))
            values |= {"deck": deck, "case": case}
            beside = Liggghts().data(deck)
    text, unused = _render(template, values | sets)
    if wrong := unused & set(sets):
        raise CaseError(f"--set {min(wrong)}: {template} does not use it; check the spelling")
    return write_own(out, {name: text} | {n: content for n, content in beside.items() if n in text}, force=force)


def _render(template: Path, values: Mapping[str, object]) -> tuple[str, set[str]]:
    """The text of a template, and the names of `values` that neither the template nor its own includes use.

    The template reads the templates of its folder and of the package. Raises CaseError with file and line.
    """
    if not template.is_file():
        raise CaseError(f"{template}: there is no such file; name a template")
    loader = jinja2.FileSystemLoader([template.resolve().parent, paths.beside("templates")])
    environment = rendering.prepare(_Sandbox(loader=loader, **rendering.OPTIONS))
    try:
        text = environment.get_template(template.name).render(values)
        tree = environment.parse(template.read_text(encoding="utf-8"))
    except Exception as error:  # a template can raise any error of Python
        raise CaseError(_sentence(template, error)) from None
    ours = paths.beside("templates")
    included = [n for n in meta.find_referenced_templates(tree) if n is None or not (ours / n).exists()]
    return text, set() if included else set(values) - meta.find_undeclared_variables(tree)


def _sentence(template: Path, error: Exception) -> str:
    """FILE:LINE: message, with the innermost line of a template in the traceback."""
    folder = template.resolve().parent
    lines = [(frame.f_code.co_filename, number) for frame, number in traceback.walk_tb(error.__traceback__)]
    if isinstance(error, jinja2.TemplateSyntaxError):
        lines = [(error.filename or str(template), error.lineno)]
    place, line = next((x for x in reversed(lines) if Path(x[0]).is_relative_to(folder)), (str(template), 0))
    place = str(template) if Path(place) == template.resolve() else place
    what = str(getattr(error, "message", None) or error) or type(error).__name__
    if isinstance(error, jinja2.TemplateNotFound):
        what = f"{error} is not in {folder}, nor a template of epdem"
    return f"{place}{f':{line}' if line else ''}: {' '.join(what.split())}"
