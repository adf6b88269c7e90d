# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks and templates to text: undefined names are errors, numbers keep every digit, templates compute nothing."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from typing import Any, TypeVar

import jinja2
import numpy as np

from ..errors import CaseError
from . import __version__, paths


def number(x: float | int) -> str:
    """The shortest text that reads back as the same number."""
    return repr(int(x)) if isinstance(x, int | np.integer) else repr(float(x))


def wall_id(name: str) -> str:
    """The id of a wall's fix: a name that a user gives to a part must not be the id of another fix."""
    return f"wall_{name}"


REASON = "\x1f"  # between a line and its reason
_WITH_REASONS = ContextVar("reasons of lines", default=False)
OPTIONS: dict[str, Any] = {
    "undefined": jinja2.StrictUndefined,
    "trim_blocks": True,
    "lstrip_blocks": True,
    "keep_trailing_newline": True,
    "autoescape": jinja2.select_autoescape(["html.j2"], default_for_string=False),  # decks are no HTML
}
Prepared = TypeVar("Prepared", bound=jinja2.Environment)


def line(text: object) -> str:
    """Text as the comment of one line: no line ends, and no "&", which would continue the line in LIGGGHTS."""
    return " ".join(str(text).split()).rstrip("& ")


def prepare(env: Prepared) -> Prepared:
    """An environment with our filters and names.

    `why("...")` in a template is the reason of its line: in `with_reasons` it follows the line after REASON, else it is
    nothing.
    """
    env.globals["version"] = __version__
    env.globals["why"] = lambda reason: REASON + reason if _WITH_REASONS.get() else ""
    env.filters["line"] = line
    env.filters["number"] = number
    env.filters["wall"] = wall_id
    env.filters["numbers"] = lambda values: " ".join(number(v) for v in values)
    return env


@cache  # with its templates, which take far longer to read than to fill
def environment() -> jinja2.Environment:
    """The environment of our templates."""
    loader = jinja2.FileSystemLoader(paths.beside("templates"))
    return prepare(jinja2.Environment(loader=loader, **OPTIONS))


@contextmanager
def with_reasons() -> Iterator[None]:
    """In this context `render` writes the reason of each line, where the template has one, as its comment."""
    token = _WITH_REASONS.set(True)
    try:
        yield
    finally:
        _WITH_REASONS.reset(token)


def render(template: str, /, **context: object) -> str:
    """The text of a template. Raises CaseError that names the template and the undefined name."""
    try:
        text = environment().get_template(template).render(context)
    except jinja2.TemplateError as error:
        raise CaseError(f"template {template}: {error}") from None
    return "\n".join(map(_commented, text.split("\n"))) if _WITH_REASONS.get() else text


def _commented(line: str) -> str:
    """A line whose reason is a comment, behind the comment that it has."""
    text, _, reason = line.partition(REASON)
    command, _, comment = text.partition("  # ")
    comments = dict.fromkeys(filter(None, (comment, reason)))
    return f"{command.rstrip()}  # {'; '.join(comments)}" if reason else line
