# SPDX-License-Identifier: GPL-2.0-or-later
"""The sources of the module epdem_yade for a machine without epdem: adapter, laws, CMake project."""

from pathlib import Path

from ...base import paths


def sources() -> dict[Path, Path]:
    """The files of the CMake project, by their places in its folder."""
    adapter, laws = paths.cpp_sources("yade")
    found = {f.relative_to(adapter): f for f in adapter.iterdir() if f.suffix in (".hpp", ".cpp", ".py", ".txt")}
    return found | {f.relative_to(laws): f for f in (laws / "epdem").rglob("*.hpp")}


def commands(folder: Path) -> list[str]:
    """What builds the module, and where YADE finds it."""
    return [
        f"cmake -S {folder} -B {folder}/build -DYADE_SOURCE=/path/to/yade  # without YADE_SOURCE the tag is cloned",
        f"cmake --build {folder}/build",
        f"export PYTHONPATH={folder}/build  # then in a script of YADE: from epdem_yade import *",
    ]
