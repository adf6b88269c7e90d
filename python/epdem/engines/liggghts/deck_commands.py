# SPDX-License-Identifier: GPL-2.0-or-later
"""Commands of a deck that start a program or read a file of another folder."""

import re
from collections.abc import Iterator
from pathlib import Path

from ...errors import CaseError

_ARGUMENT = re.compile(r"\"[^\"]*\"|'[^']*'|\S+")


def _commands(line: str) -> Iterator[list[str]]:
    """The words of a command, and of each command that `if`, `run ... every` and `partition` take as an argument."""
    words = [word.strip("\"'") for word in _ARGUMENT.findall(line)]
    if not words:
        return
    yield words
    inner: list[str] = []
    if words[0] == "if":
        rest = re.split(r"\s(?:then|else)\s|\selif\s+(?:\"[^\"]*\"|'[^']*'|\S+)", line)[1:]
        inner = [word.strip("\"'") for part in rest for word in _ARGUMENT.findall(part)]
    elif words[0] == "run":
        inner = words[words.index("every") + 2 :] if "every" in words else []
    elif words[0] == "partition":
        inner = [line.split(maxsplit=3)[-1]]
    for command in inner:
        yield from _commands(command)


def refuse_programs(text: str, template: Path) -> None:
    """Raise CaseError for a deck of `template` with `shell` or `python`, or with `include` or `jump` to another folder.

    A command whose name or file is made of variables is refused, too.
    """
    for line in re.sub(r"&[ \t]*\n", "", text).splitlines():
        before, _, _ = line.partition("#")
        for name, *words in _commands(line if "'" in before or '"' in before else before):
            file = words[0] if name in ("include", "jump") and words else ""
            outside = Path(file).is_absolute() or ".." in Path(file).parts
            if name in ("shell", "python") or "$" in name + file or outside:
                command = " ".join([name, *words])[:80]
                raise CaseError(
                    f"{template}: the deck has {command!r}; a deck of a template starts no program and "
                    "reads no file of another folder: remove the command, or write this deck by hand"
                )
