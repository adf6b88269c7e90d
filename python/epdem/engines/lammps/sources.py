# SPDX-License-Identifier: GPL-2.0-or-later
"""The sources of epdemplugin.so for a machine without epdem: plugin, kernels, laws, CMake project."""

from pathlib import Path

from ...base import paths


def sources() -> dict[Path, Path]:
    """The files of the CMake project, by their places in its folder."""
    plugin, laws = paths.cpp_sources("lammps")
    found = {Path("CMakeLists.txt"): plugin / "export" / "CMakeLists.txt"}
    for source in (plugin, plugin.parent / "kernels"):
        here = Path("cpp_contact") / source.name
        found |= {here / f.name: f for f in source.iterdir() if f.suffix in (".hpp", ".cpp", ".txt")}
    found |= {Path("cpp_contact/include") / f.relative_to(laws): f for f in (laws / "epdem").rglob("*.hpp")}
    return found


def commands(folder: Path) -> list[str]:
    """What builds the plugin, and where LAMMPS finds it."""
    return [
        f"cmake -S {folder} -B {folder}/build -DLAMMPS_SOURCE_DIR=/path/to/lammps/src",
        f"cmake --build {folder}/build",
        f"export LAMMPS_PLUGIN_PATH={folder}/build/cpp_contact/lammps",
    ]
