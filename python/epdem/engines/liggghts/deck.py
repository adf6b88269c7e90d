# SPDX-License-Identifier: GPL-2.0-or-later
"""The data of the template of an impact deck."""

from dataclasses import dataclass

from .properties import Property


@dataclass(frozen=True)
class Deck:
    """Everything the template writes; every number was decided here."""

    title: str
    source: str
    summary: str
    has_history: bool  # the law has a contact history
    hard: bool
    soft: bool
    data: str
    skin: float
    types: tuple[str, ...]
    properties: tuple[Property, ...]
    model: str
    tangential: str
    settings: tuple[str, ...]
    wall_type: int | None
    oblique: bool
    time_step: float
    path: str
    steps: int
