# SPDX-License-Identifier: GPL-2.0-or-later
"""Changes of lines by which the deck of an impact on a wall becomes another set-up."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Edit:
    """`lines` after, or `instead` of, the one line of a deck that begins with `start`."""

    start: str
    lines: tuple[str, ...]
    instead: bool = False


@dataclass(frozen=True)
class Edits:
    """The changes of an engine's deck.

    `wall` is how the line of the wall begins, of which `second_wall` makes that of a wall at another height [m].
    `carry` moves the sphere from its place down by a rise [m] and back, in cycles of so many steps. `unknown` samples
    at the start are not known to the history of a contact that is there from the start.
    """

    deck: str
    wall: str
    second_wall: Callable[[str, float], str]
    carry: Callable[[float, float, int], list[Edit]]
    unknown: int = 0
