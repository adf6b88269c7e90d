# SPDX-License-Identifier: GPL-2.0-or-later
"""TOML files: raw tables, the files that they name, errors that name the file; the materials file."""

import contextlib
import re
import stat
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from ..base.declarations import declarations
from ..errors import CaseError

KIND = ".toml.j2"  # at the end of the name of a file with a kind of scene: other kinds are no files
MAX_BYTES = 1_000_000  # of a case file
MAX_DEPTH = 20  # of tables and lists in each other
T = TypeVar("T")
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
def error_context(place: object) -> Iterator[None]:
    """Errors of a case name its `place`: the file of the case, or its own name."""
    try:
        yield
    except CaseError as error:
        text = str(error)
        text = text.removeprefix(f"{place}: ") if text.startswith(f"{place}: ") else text
        if str(place) in text:
            raise error
        raise CaseError(f"{place}: {text}") from None


class LoadedCase(NamedTuple):
    """A case that a program has read: the Case or SceneCase, its text, and its name in messages."""

    model: Any
    text: str
    place: object

    def __str__(self) -> str:
        return str(self.place)


def files_in(data: Any) -> Iterator[tuple[Any, Any]]:
    """(table, key) of each name of a file in the tables of a case, or in a point of a sweep, whose keys have dots."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        last = str(key).rpartition(".")[2]
        if isinstance(value, str) and (last in ("file", "sieve") or (last == "kind" and value.endswith(KIND))):
            yield data, key
        else:
            yield from files_in(value)


def file_names(data: object) -> set[str]:
    """The names of files in the data of a case."""
    return {table[key] for table, key in files_in(data)}


def with_whole_paths(data: T, folder: Path) -> T:
    """The tables of a case, or a point of a sweep; its names of files, which count from `folder`, become absolute.

    Raises CaseError for a file that is not there.
    """
    for table, key in files_in(data):
        path = (folder / table[key]).resolve()
        if not path.is_file():
            counts = f"names of files count from the folder of the case ({folder})"
            raise CaseError(f"{key} = {table[key]!r}: no such file; {counts}")
        table[key] = str(path)
    return data


def portable_text(path: Path | str) -> str:
    """The text of a case file with absolute paths of its files, valid in any folder.

    Raises CaseError as `read_toml` does.
    """
    text = text_of(path)
    if not file_names(tables(text, path)):
        return text
    import tomlkit  # slow, and most cases name no file

    with error_context(path):
        return with_whole_paths(tomlkit.parse(text), Path(path).parent).as_string()


def strength_keys() -> tuple[str, ...]:
    """Keys of a material's strength, of which one may be given: of any law, then of one law each."""
    laws = [law.strength for law in declarations().values() if law.strength]
    return tuple(dict.fromkeys(["yield_stress", "hardness", "yield_ratio", *laws]))


@cache
def entries() -> dict[str, dict[str, Any]]:
    """Every material of the file as it is written there, by name."""
    return tomllib.loads(Path(__file__).with_name("materials.toml").read_text(encoding="utf-8"))


def with_library(data: dict[str, Any], path: object) -> dict[str, Any]:
    """The tables of a case in which `from = "steel"` of a material has become the numbers of the materials file.

    Keys beside `from` replace the keys of the file. Raises CaseError for a name that is not there.
    """
    materials = data.get("materials")
    if not isinstance(materials, dict) or not any(isinstance(m, dict) and "from" in m for m in materials.values()):
        return data
    return data | {"materials": {name: _fill_in(name, m, path) for name, m in materials.items()}}


def _fill_in(name: str, material: Any, path: object) -> Any:
    if not isinstance(material, dict) or "from" not in material:
        return material
    origin = material["from"]
    if not isinstance(origin, str) or origin not in entries():
        have = ", ".join(entries())
        raise CaseError(f"{path}: materials.{name}.from = {origin!r} is not in the materials file; there are {have}")
    own = {"source"} | ({"yield_stress"} if any(key in material for key in strength_keys()) else set())
    known = {key: value for key, value in entries()[origin].items() if key not in own}
    return known | {key: value for key, value in material.items() if key != "from"}
