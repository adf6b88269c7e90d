# SPDX-License-Identifier: GPL-2.0-or-later
"""Places, directions and names of the parts of a scene. SI."""

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from .fields import Quantity
from .messages import PART_NAME

Place = Annotated[float, Quantity("m")]
Vector = Annotated[list[Place], Field(min_length=3, max_length=3)]
Axis = Literal["x", "y", "z"]
PartName = Annotated[str, Field(pattern=PART_NAME)]


def _ordered(span: list[float]) -> list[float]:
    """Raise ValueError unless a span begins below its end."""
    if not span[0] < span[1]:
        raise ValueError(f"{span[0]:g} m must be below {span[1]:g} m")
    return span


Pair = Annotated[list[Place], Field(min_length=2, max_length=2)]
Span = Annotated[Pair, AfterValidator(_ordered)]  # from, to
SIDES = {"-x": [-1.0, 0.0, 0.0], "-y": [0.0, -1.0, 0.0], "-z": [0.0, 0.0, -1.0]}
SIDES |= {f"+{side[1]}": [abs(x) for x in vector] for side, vector in SIDES.items()}


def _vector(value: object) -> object:
    return SIDES.get(value, value) if isinstance(value, str) else value


def _side(value: object) -> object:
    return next((side for side, vector in SIDES.items() if value == vector), value)


Side = Annotated[Literal["-x", "+x", "-y", "+y", "-z", "+z"], BeforeValidator(_side)]  # or a vector of length 1


def _unit(direction: list[float]) -> list[float]:
    """The direction with the length 1."""
    length = math.hypot(*direction)
    if not length:
        raise ValueError("has no direction; give another one")
    return [x / length for x in direction]


Direction = Annotated[  # or a Side
    list[float], BeforeValidator(_vector), Field(min_length=3, max_length=3), AfterValidator(_unit)
]
Limits = tuple[float, float, float, float, float, float]  # xlo xhi ylo yhi zlo zhi [m]
Vector3 = tuple[float, float, float]
