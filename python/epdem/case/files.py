# SPDX-License-Identifier: GPL-2.0-or-later
"""The files that a case names: triangles of walls, sieve tables, tables of spheres."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import CaseError
from .toml import tables, text_of

KEYS = ("file", "sieve")


class Read(NamedTuple):
    """A case that a program has read: the Case or SceneCase, its text, and its name in messages."""

    model: Any
    text: str
    place: object


def names_in(data: object) -> set[str]:
    """The names of files in the data of a case."""
    parts = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    found: set[str] = set()
    for key, value in parts:
        found |= {value} if key in KEYS and isinstance(value, str) else names_in(value)
    return found


def located(key: str, value: Any, folder: Path) -> Any:
    """The value of a key of a case with whole names of its files, which count from `folder`.

    Raises CaseError for a file that is not there.
    """
    if isinstance(value, dict):
        return {name: located(f"{key}.{name}", v, folder) for name, v in value.items()}
    if isinstance(value, list):
        return [located(f"{key}.{n}", v, folder) for n, v in enumerate(value)]
    if key.rpartition(".")[2] not in KEYS or not isinstance(value, str):
        return value
    path = (folder / value).resolve()
    if not path.is_file():
        raise CaseError(f"{key} = {value!r}: no such file; names of files count from the folder of the case ({folder})")
    return str(path)


def renamed(text: str, names: Mapping[str, Path]) -> str:
    """The text of a case with other names of files."""
    for old, new in names.items():
        key = rf"(\b(?:{'|'.join(KEYS)})\"?\s*=\s*)"
        quoted = f'"{new}"'.replace("\\", r"\\")  # in a pattern a backslash counts twice
        text = re.sub(rf"{key}([\"']){re.escape(old)}\2", rf"\1{quoted}", text)
    return text


def text_for_anywhere(path: Path | str) -> str:
    """The text of a case file with whole names of its files, for a copy of it may lie in another folder.

    Raises CaseError as `read_toml` does.
    """
    text, folder = text_of(path), Path(path).parent
    return renamed(text, {name: (folder / name).resolve() for name in names_in(tables(text, path))})
