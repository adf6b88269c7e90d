# SPDX-License-Identifier: GPL-2.0-or-later
"""Values of the macros that decks of impacts and of scenes share."""

from dataclasses import dataclass

from .properties import Property


@dataclass(frozen=True)
class ContactWords:
    """Materials and contact model of pairs and walls. hard, soft: whether a modulus is beyond LIGGGHTS's limits.

    has_history: whether contacts have a memory. settings: behind everything else of a pair or wall line.
    """

    hard: bool
    soft: bool
    has_history: bool
    properties: tuple[Property, ...]
    model: str
    tangential: str
    cohesion: str | None = None
    rolling_friction: str | None = None
    settings: tuple[str, ...] = ()
