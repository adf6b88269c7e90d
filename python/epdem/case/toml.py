# SPDX-License-Identifier: GPL-2.0-or-later
"""TOML files: their raw tables, and errors that name the file."""

import contextlib
import re
import stat
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import CaseError

MAX_BYTES = 1_000_000  # of a case file
MAX_DEPTH = 20  # of tables and lists in each other
_DOTTED_KEY = re.compile(
    rf"""(?:^|[\[{{,])[ \t]*(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){{{MAX_DEPTH}}}""", re.M
)


def text_of(path: Path | str, most: int = MAX_BYTES) -> str:
    """The text of a case, or of a file of points: a regular file of at most `most` bytes in UTF-8. Raises CaseError."""
    path = Path(path)
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise CaseError(f"{path}: not a regular file; name a file")
        if status.st_size > most:
            raise CaseError(f"{path}: {status.st_size} bytes, must be at most {most}; name another file")
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file; the examples are in cases/") from None
    except UnicodeDecodeError as error:
        raise CaseError(f"{path}: not UTF-8 at byte {error.start}; save the file as UTF-8") from None
    except OSError as error:
        raise CaseError(f"{path}: cannot be read ({error.strerror}); name another file") from None


def tables(text: str, place: object) -> dict[str, Any]:
    """The raw tables of a case's text; `place` names it in messages. Raises CaseError."""
    deep = f"{place}: tables and lists are nested more than {MAX_DEPTH} deep; a case needs eight levels"
    if _DOTTED_KEY.search(text):  # tomllib takes minutes for thousands of dots
        raise CaseError(deep)
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{place}: not valid TOML: {error}") from None
    except ValueError:  # Python's limit
        digits = sys.get_int_max_str_digits()
        raise CaseError(f"{place}: a whole number has more than {digits} digits; correct it") from None
    except RecursionError:
        raise CaseError(deep) from None
    level: list[Any] = [data]
    for _ in range(MAX_DEPTH):
        level = [x for part in level for x in (part.values() if isinstance(part, dict) else part)]
        level = [x for x in level if isinstance(x, dict | list)]
    if level:
        raise CaseError(deep)
    return data


def read_toml(path: Path | str) -> dict[str, Any]:
    """The raw tables of a case file. Raises CaseError."""
    return tables(text_of(path), path)


@contextlib.contextmanager
def named(place: object) -> Iterator[None]:
    """Errors of a case name its `place`: the file of the case, or its own name."""
    try:
        yield
    except CaseError as error:
        text = str(error)
        text = text.removeprefix(f"{place}: ") if text.startswith(f"{place}: ") else text
        if str(place) in text:
            raise error
        raise CaseError(f"{place}: {text}") from None
