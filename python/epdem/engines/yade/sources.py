# SPDX-License-Identifier: GPL-2.0-or-later
"""The sources of the module epdem_yade for a machine without epdem: adapter, laws, CMake project."""

from pathlib import Path

from ...base import paths
from ...base.files import write_texts
from ...errors import CaseError


def write(folder: Path) -> list[Path]:
    """Write the CMake project into a folder, which is made. Raises CaseError if the folder has files."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise CaseError(f"--out {folder}: it has files; name a new folder")
    adapter, laws = paths.cpp_sources("yade")
    found = {f.relative_to(adapter): f for f in adapter.iterdir() if f.suffix in (".hpp", ".cpp", ".py", ".txt")}
    found |= {f.relative_to(laws): f for f in (laws / "epdem").rglob("*.hpp")}
    folder.mkdir(parents=True, exist_ok=True)
    return write_texts(folder, {str(name): found[name].read_text(encoding="utf-8") for name in sorted(found)})


def commands(folder: Path) -> list[str]:
    """What builds the module, and where YADE finds it."""
    return [
        f"cmake -S {folder} -B {folder}/build -DYADE_SOURCE=/path/to/yade  # without YADE_SOURCE the tag is cloned",
        f"cmake --build {folder}/build",
        f"export PYTHONPATH={folder}/build  # then in a script of YADE: from epdem_yade import *",
    ]
