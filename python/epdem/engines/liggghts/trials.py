# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene's deck cut into pieces that differ in the neighbour skin, and the time that LIGGGHTS takes for each."""

import contextlib
import re
import tempfile
import time
from pathlib import Path

from ...base.files import write_texts
from .. import log
from . import launcher

Loops = list[tuple[float, int]]  # (seconds, steps) of pieces of a run
_MARK = "epdem: a piece begins"  # runs without it end a phase by a condition
_RUN = re.compile(r"^run (\d+) upto.*$", re.MULTILINE)


class _Enough(Exception):
    """The time of a trial is over."""


def pieces(texts: dict[str, str], skins: list[float], steps: int, length: int) -> tuple[dict[str, str], list[float]]:
    """The deck up to `steps` with its runs cut into pieces of `length` steps and one skin each, and the skins in that
    order: forth and back through `skins`."""
    order: list[float] = []
    begin = 0

    def cut(match: re.Match[str]) -> str:
        nonlocal begin
        end, lines = min(int(match[1]), steps), []
        while begin < end:
            turn, place = divmod(len(order), len(skins))
            order.append(skins[place] if turn % 2 == 0 else skins[-1 - place])
            begin = min(end, begin + length)
            lines += [f"neighbor {order[-1]!r} bin", f'print "{_MARK}"', f"run {begin} upto"]
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
