# SPDX-License-Identifier: GPL-2.0-or-later
"""The contact models as a CMake project for a machine without epdem: files by their places in its folder."""

import shlex
from pathlib import Path

from ..base import paths

CODE = (".hpp", ".cpp", ".txt", ".py")
PLACES = {  # folder of the project: folder of the sources
    "yade": {"": "yade"},
    "lammps": {"": "lammps/export", "cpp_contact/lammps": "lammps", "cpp_contact/kernels": "kernels"},
}
LAWS = {"yade": "", "lammps": "cpp_contact/include"}
OPTIONS = {
    "yade": "-DYADE_SOURCE=/path/to/yade  # else the tag is cloned",
    "lammps": "-DLAMMPS_SOURCE_DIR=/path/to/lammps/src",
}


def files(host: str) -> dict[Path, Path]:
    """The module epdem_yade, or the plugin epdemplugin.so of LAMMPS: adapter, laws, licences."""
    laws, found = paths.beside(paths.LAWS), {Path("LICENSES") / f.name: f for f in paths.beside("LICENSES").iterdir()}
    for place, folder in PLACES[host].items():
        found |= {Path(place) / f.name: f for f in paths.beside(f"cpp_contact/{folder}").iterdir() if f.suffix in CODE}
    return found | {Path(LAWS[host]) / f.relative_to(laws): f for f in (laws / "epdem").rglob("*.hpp")}


def commands(host: str, folder: Path) -> list[str]:
    """Commands that build the module or plugin, and the place where the host finds it."""
    build, plugin = shlex.quote(f"{folder}/build"), shlex.quote(f"{folder}/build/cpp_contact/lammps")
    used = {
        "yade": f"export PYTHONPATH={build}  # then in a script of YADE: from epdem_yade import *",
        "lammps": f"export LAMMPS_PLUGIN_PATH={plugin}",
    }
    made = f"cmake -S {shlex.quote(str(folder))} -B {build} {OPTIONS[host]}"
    return [made, f"cmake --build {build}", used[host]]
