# SPDX-License-Identifier: GPL-2.0-or-later
"""The contact models as a CMake project for a machine without epdem: files by their places in its folder."""

import shlex
from pathlib import Path

from ..base import paths

CODE = (".hpp", ".cpp", ".txt")


def yade() -> dict[Path, Path]:
    """The module epdem_yade: adapter, laws, licences."""
    adapter, laws = paths.beside("cpp_contact/yade"), paths.beside(paths.LAWS)
    found = {f.relative_to(adapter): f for f in adapter.iterdir() if f.suffix in (*CODE, ".py")}
    return found | {f.relative_to(laws): f for f in (laws / "epdem").rglob("*.hpp")} | _licences()


def _licences() -> dict[Path, Path]:
    return {Path("LICENSES") / f.name: f for f in paths.beside("LICENSES").iterdir()}


def yade_commands(folder: Path) -> list[str]:
    """Commands that build the module, and the place where YADE finds it."""
    build = shlex.quote(f"{folder}/build")
    return [
        f"cmake -S {shlex.quote(str(folder))} -B {build} -DYADE_SOURCE=/path/to/yade  # else the tag is cloned",
        f"cmake --build {build}",
        f"export PYTHONPATH={build}  # then in a script of YADE: from epdem_yade import *",
    ]


def lammps() -> dict[Path, Path]:
    """The plugin epdemplugin.so: plugin, kernels, laws, licences."""
    plugin, laws = paths.beside("cpp_contact/lammps"), paths.beside(paths.LAWS)
    found = {Path("CMakeLists.txt"): plugin / "export" / "CMakeLists.txt"}
    for source in (plugin, plugin.parent / "kernels"):
        here = Path("cpp_contact") / source.name
        found |= {here / f.name: f for f in source.iterdir() if f.suffix in CODE}
    found |= {Path("cpp_contact/include") / f.relative_to(laws): f for f in (laws / "epdem").rglob("*.hpp")}
    return found | _licences()


def lammps_commands(folder: Path) -> list[str]:
    """Commands that build the plugin, and the place where LAMMPS finds it."""
    build = shlex.quote(f"{folder}/build")
    return [
        f"cmake -S {shlex.quote(str(folder))} -B {build} -DLAMMPS_SOURCE_DIR=/path/to/lammps/src",
        f"cmake --build {build}",
        f"export LAMMPS_PLUGIN_PATH={shlex.quote(f'{folder}/build/cpp_contact/lammps')}",
    ]
