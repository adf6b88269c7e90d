# SPDX-License-Identifier: GPL-2.0-or-later
"""Templates to text: undefined names stop, numbers keep every digit, nothing is computed here."""

from pathlib import Path
from typing import Any, TypeVar

import jinja2
import numpy as np

from . import paths
from .errors import CaseError


def number(x: float | int) -> str:
    """The shortest text that reads back as the same number."""
    return repr(int(x)) if isinstance(x, int | np.integer) else repr(float(x))


OPTIONS: dict[str, Any] = {
    "undefined": jinja2.StrictUndefined,
    "trim_blocks": True,
    "lstrip_blocks": True,
    "keep_trailing_newline": True,
    "autoescape": False,  # decks are no HTML
}
Prepared = TypeVar("Prepared", bound=jinja2.Environment)


def prepared(env: Prepared) -> Prepared:
    """An environment with our filters."""
    env.filters["number"] = number
    env.filters["numbers"] = lambda values: " ".join(number(v) for v in values)
    return env


def environment(*folders: Path) -> jinja2.Environment:
    """The template environment: our templates, and `folders` before them."""
    return prepared(jinja2.Environment(loader=jinja2.FileSystemLoader([*folders, paths.templates()]), **OPTIONS))


def render(template: str, /, **context: object) -> str:
    """The text of a template. Raises CaseError that names the template and the undefined name."""
    try:
        return environment().get_template(template).render(**context)
    except jinja2.TemplateError as error:
        raise CaseError(f"template {template}: {error}") from None
