# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene's deck cut into pieces that differ in the neighbour skin, and the time that LIGGGHTS takes for each."""

import contextlib
import re
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from ...base.files import write_texts
from .. import log
from . import launcher

Loops = list[tuple[float, int]]  # (seconds, steps) of pieces of a run
_MARK = "epdem: a piece begins"  # runs without it end a phase by a condition
_RUN = re.compile(r"^run (\d+) upto(?:  # (.*))?$", re.MULTILINE)


@dataclass(frozen=True)
class Piece:
    """Steps of a stage of a scene with one skin [m], and the number of the turn through all skins."""

    stage: str
    steps: int
    turn: int
    skin: float


class _Enough(Exception):
    """The time of a trial is over."""


def pieces(texts: dict[str, str], skins: list[float], length: int) -> tuple[dict[str, str], list[Piece]]:
    """The deck with its runs cut into pieces of `length` steps and one skin each, and the pieces in order: in each run
    forth and back through `skins`."""
    order: list[Piece] = []

    def cut(match: re.Match[str]) -> str:
        begin, end, lines = sum(piece.steps for piece in order), int(match[1]), []
        first = order[-1].turn + 1 if order else 0
        for n, at in enumerate(range(begin, end, length)):
            turn, place = divmod(n, len(skins))
            skin = skins[place] if turn % 2 == 0 else skins[-1 - place]
            order.append(Piece(match[2] or f"up to step {end}", min(length, end - at), first + turn, skin))
            lines += [f"neighbor {skin!r} bin", f'print "{_MARK}"', f"run {at + order[-1].steps} upto"]
        return "\n".join(lines)

    return texts | {"in.scene": _RUN.sub(cut, texts["in.scene"])}, order


def run(texts: dict[str, str], ranks: int, seconds: float) -> Loops:
    """The pieces that ended within `seconds`."""
    end = time.monotonic() + seconds

    def watch(step: int) -> None:
        if time.monotonic() > end:
            raise _Enough

    with tempfile.TemporaryDirectory(prefix="epdem_tune_") as name:
        folder = Path(name)
        write_texts(folder, texts)
        with contextlib.suppress(_Enough):
            launcher.run("in.scene", folder, ranks=ranks, report=watch)
        text = (folder / launcher.OUT).read_text(errors="replace")
        return [loop for piece in text.split(_MARK)[1:] for loop in log.loops_in(piece)[:1]]
