# SPDX-License-Identifier: GPL-2.0-or-later
"""TOML files: their raw tables, and errors that name the file."""

import contextlib
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import CaseError
from .lines import line_of

MAX_BYTES = 4_000_000  # of a case file


def read_toml(path: Path | str) -> dict[str, Any]:
    """The raw tables of a TOML file. Raises CaseError."""
    path = Path(path)
    try:
        with path.open("rb") as stream:  # the path may name a device or a large file: at most this is read
            raw = stream.read(MAX_BYTES + 1)
        if len(raw) > MAX_BYTES:
            raise CaseError(f"{path}: more than {MAX_BYTES // 1_000_000} MB, which no case has; name the case file")
        return tomllib.loads(raw.decode("utf-8-sig").replace("\r\n", "\n"))
    except FileNotFoundError:
        raise CaseError(f"{path}: no such file; the examples are in cases/") from None
    except UnicodeDecodeError as error:
        raise CaseError(f"{path}: not UTF-8 at byte {error.start}; save the file as UTF-8") from None
    except OSError as error:
        raise CaseError(f"{path}: cannot be read ({error})") from None
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{path}: not valid TOML: {error}") from None
    except RecursionError:
        raise CaseError(f"{path}: tables and lists are nested too deeply; a case needs three levels") from None


@contextlib.contextmanager
def named(place: object) -> Iterator[None]:
    """Errors of a case name its `place`: the file that it was read from, or its own name; of a scene of parts the line,
    too."""
    try:
        yield
    except CaseError as error:
        text = str(error)
        text = text.removeprefix(f"{place}: ") if text.startswith(f"{place}: ") else text
        if str(place) in text:
            raise error
        line = _line(place, text)
        raise CaseError(f"{place}{line}: {text}") from None


def _line(place: object, message: str) -> str:
    """ " line 7", of a file with a scene of parts; "" of others."""
    path = Path(str(place))
    if path.suffix != ".toml" or not path.is_file():
        return ""
    data = read_toml(path)
    scene = data.get("scene")
    if not isinstance(scene, dict) or scene.get("kind") != "parts":
        return ""
    line = line_of(message, path.read_text(encoding="utf-8-sig"), data)
    return "" if line is None else f" line {line}"
