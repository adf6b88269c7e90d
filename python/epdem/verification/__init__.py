# SPDX-License-Identifier: GPL-2.0-or-later
"""The proof: every engine, law and model of another code compared with theory and with each other.

It may import every other package of epdem. None imports it but `epdem.__main__`, where the command begins.
"""

import importlib
from typing import Any

__all__ = ["crosscheck"]


def __getattr__(name: str) -> Any:
    """`crosscheck` as a function, imported when it is used: the engines take a second."""
    if name in __all__:
        return getattr(importlib.import_module(".engine_comparison", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
