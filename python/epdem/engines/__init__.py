# SPDX-License-Identifier: GPL-2.0-or-later
"""The engines by name. A new engine is a module here and one line below."""

from ..errors import CaseError
from .base import Engine, Trajectory
from .embedded import Embedded
from .liggghts import Liggghts

ENGINES: dict[str, type[Engine]] = {"embedded": Embedded, "liggghts": Liggghts}


def engine(name: str) -> Engine:
    """The engine of that name. Raises CaseError."""
    if name not in ENGINES:
        raise CaseError(f"--engine {name!r} does not exist; there are {', '.join(ENGINES)}")
    return ENGINES[name]()


__all__ = ["ENGINES", "Engine", "Trajectory", "engine"]
