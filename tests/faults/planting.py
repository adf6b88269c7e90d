# SPDX-License-Identifier: GPL-2.0-or-later
"""Planted faults: exact replacements of text in a copy of the project, one by one or behind switches of one build."""

import tomllib
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Fault:
    """In `file`, `old` becomes `new`; `test`, a pytest node below tests/, must then fail."""

    name: str
    file: str
    old: str
    new: str
    test: str


def faults(*names: str) -> list[Fault]:
    """The faults of files in `planted`."""
    found = []
    for name in names:
        tables = tomllib.loads((Path(__file__).parent / "planted" / f"{name}.toml").read_text())
        found += [Fault(title, **table) for title, table in tables.items()]
    return found


def planted(fault: Fault, good: str, new: str | None = None) -> str:
    """The text of a file with the fault in it."""
    assert fault.old in good, f"{fault.file} does not contain {fault.old!r} any more; update the fault {fault.name!r}"
    return good.replace(fault.old, fault.new if new is None else new)


# One build of the library or the plugin has all its faults, each of which an environment variable switches on.
SWITCH = """#pragma once
#include <cstdlib>
template <int n>
inline bool planted() {
  static const bool on = [] {
    const char* chosen = std::getenv("PLANTED");
    return chosen && std::atoi(chosen) == n;
  }();
  return on;
}
"""


def with_switches(folder: Path, found: list[Fault]) -> str:
    """Plant all faults, whose `old` and `new` are expressions; the compiler's flags."""
    for n, fault in enumerate(found, 1):
        path = folder / fault.file
        path.write_text(planted(fault, path.read_text(), f"(planted<{n}>() ? ({fault.new}) : ({fault.old}))"))
    (folder / "planted.hpp").write_text(SWITCH)
    return f"-O0 -include {folder}/planted.hpp"
