# SPDX-License-Identifier: GPL-2.0-or-later
"""The line of a TOML file that a message is about."""

import re
from collections.abc import Iterator
from typing import Any

Keys = tuple[str | int, ...]
_HEAD = re.compile(r"\s*(\[\[?)\s*([\w.\-]+)\s*\]\]?\s*(?:#.*)?$")
_KEY = re.compile(r"\s*([\w\-]+)\s*=")


def lines_of(text: str) -> dict[Keys, int]:
    """The line of each table and key as they are mostly written: heads and keys begin a line, names have no quotes."""
    found: dict[Keys, int] = {}
    counts: dict[Keys, int] = {}
    table: Keys = ()
    for number, line in enumerate(text.splitlines(), 1):
        if head := _HEAD.match(line):
            table = ()
            *before, last = head[2].split(".")
            for name in before:
                table = (*table, name)
                if table in counts:  # the newest table of a list
                    table = (*table, counts[table] - 1)
            table = (*table, last)
            if head[1] == "[[":
                counts[table] = counts.get(table, 0) + 1
                table = (*table, counts[table] - 1)
            found[table] = number
        elif key := _KEY.match(line):
            found.setdefault((*table, key[1]), number)
    return found


def _resolved(words: list[str], data: Any) -> Keys:
    """As many words as lead into `data`; an element of a list goes by its number or its name."""
    keys: Keys = ()
    for word in words:
        if isinstance(data, list):
            names = [x.get("name") if isinstance(x, dict) else None for x in data]
            at = int(word) if word.isdigit() and int(word) < len(data) else names.index(word) if word in names else None
            if at is None:
                return keys
            keys, data = (*keys, at), data[at]
        elif isinstance(data, dict) and word in data:
            keys, data = (*keys, word), data[word]
        else:
            return keys
    return keys


def _places(message: str, data: dict[str, Any]) -> Iterator[Keys]:
    """Whatever a message names of the data: first places of two keys and more, then the table that it begins with."""
    scene = data.get("scene", {})
    for words in re.findall(r"\w+(?:\.\w+)+", message):
        for start, tables in ((), data), (("scene",), scene):
            keys = (*start, *_resolved(words.split("."), tables))
            if len(keys) >= 2 + len(start):
                yield keys
    if first := re.match(r"\w+", message):
        yield (first[0],)


def line_of(message: str, text: str, data: dict[str, Any]) -> int | None:
    """The line that the first place in a message names, as scene.wall.floor.at or wall.0; None: no place is found."""
    lines = lines_of(text)
    for keys in _places(message, data):
        for end in range(len(keys), 0, -1):
            for place in (keys[:end], (*keys[:end], 0)):  # a list begins with its first table
                if place in lines:
                    return lines[place]
    return None
