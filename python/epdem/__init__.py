# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic-plastic particle contact for LIGGGHTS, YADE and LAMMPS, checked against theory."""

import importlib
from typing import Any

from .base import __version__ as __version__


def __getattr__(name: str) -> Any:
    """The Python interface, which takes a second to import: not before it is used."""
    if name == "__all__" or not name.startswith("_"):
        api = importlib.import_module("epdem.api")
        names = getattr(api, "__all__", [])  # none yet while the interface itself is imported
        if name in (*names, "__all__"):
            return names if name == "__all__" else getattr(api, name)
    raise AttributeError(f"module 'epdem' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *__getattr__("__all__")]
