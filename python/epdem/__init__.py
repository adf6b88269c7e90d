# SPDX-License-Identifier: GPL-2.0-or-later
"""Elastic-plastic particle contact for LIGGGHTS, YADE and LAMMPS, checked against theory."""

import importlib
from typing import Any

from .base import __version__ as __version__

__all__ = [
    "Calibration",
    "Case",
    "Fit",
    "Run",
    "Scene",
    "SceneRun",
    "Stored",
    "calibrate",
    "cite",
    "deck",
    "predict",
    "read",
    "run",
    "sweep",
    "theory",
]


def __getattr__(name: str) -> Any:
    """The Python interface, which takes a second to import: not before it is used."""
    if name in __all__:
        return getattr(importlib.import_module("epdem.api"), name)
    raise AttributeError(f"module 'epdem' has no attribute {name!r}")


def __dir__() -> list[str]:
    return [*globals(), *__all__]
