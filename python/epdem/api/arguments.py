# SPDX-License-Identifier: GPL-2.0-or-later
"""Arguments of the Python interface: each function returns one argument as the product takes it, or raises CaseError.

Every sentence names the argument, its value and its type.
"""

import operator
import os
import reprlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import CaseError


def type_error(name: str, given: object, wanted: str) -> CaseError:
    """The error for an argument of a wrong type."""
    return CaseError(f"{name} = {reprlib.repr(given)}: of type {type(given).__name__}; give {wanted}")


def path(name: str, given: object, wanted: str = "the path of a folder") -> Path:
    """A path, from text or a path."""
    if not isinstance(given, str | os.PathLike):
        raise type_error(name, given, wanted)
    return Path(given)


def names(name: str, given: object) -> list[str]:
    """A list of names, from one name or a sequence of names."""
    if isinstance(given, str):
        return [given]
    if not isinstance(given, Sequence):
        raise type_error(name, given, "a name or a list of names")
    if others := [one for one in given if not isinstance(one, str)]:
        raise type_error(name, others[0], "a name or a list of names")
    return [*given]


def text(name: str, given: object, wanted: str = "a name") -> str:
    """A text."""
    if not isinstance(given, str):
        raise type_error(name, given, wanted)
    return given


def integer(name: str, given: object, least: int, most: int) -> int:
    """A whole number within limits, from an integer of Python or numpy."""
    try:
        number = operator.index(given)  # type: ignore[arg-type]
    except TypeError:
        raise type_error(name, given, f"a whole number from {least} to {most}") from None
    if not least <= number <= most:
        raise CaseError(f"{name} = {number}: must lie in [{least}, {most}]")
    return number


def mapping(name: str, given: object, example: str) -> dict[str, Any]:
    """A dict with texts as keys, from any mapping; `example` stands in the message."""
    if not isinstance(given, Mapping):
        raise type_error(name, given, f"a dict, as {example}")
    if others := [key for key in given if not isinstance(key, str)]:
        raise CaseError(f"{name}: {others[0]!r} is a key of type {type(others[0]).__name__}; give a text as {example}")
    return dict(given)
