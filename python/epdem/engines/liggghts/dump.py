# SPDX-License-Identifier: GPL-2.0-or-later
"""LIGGGHTS's binary dump files."""

import struct
from pathlib import Path

import numpy as np

from ...errors import EngineError

# step, atoms; triclinic; boundary (6), box (6); columns, blocks (one per rank)
_HEAD = struct.Struct("<qqi6i6dii")


def frames(path: Path) -> list[tuple[int, np.ndarray]]:
    """(step, rows) of every frame of a binary dump, shape (atoms, columns), sorted by the first column, the id.

    Raises EngineError if the file is not there or a frame is not whole.
    """
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise EngineError(f"{path}: the dump cannot be read ({error.strerror}); see the log beside it") from None
    read, at = [], 0
    try:
        while at < len(raw):
            step, atoms, *_, columns, blocks = _HEAD.unpack_from(raw, at)
            at += _HEAD.size
            parts = [np.empty((0, columns))]
            for _ in range(blocks):
                (size,) = struct.unpack_from("<i", raw, at)
                parts.append(np.frombuffer(raw, "<f8", size, at + 4).reshape(-1, columns))
                at += 4 + 8 * size
            rows = np.concatenate(parts)
            if len(rows) != atoms:
                raise ValueError(f"{len(rows)} rows of {atoms}")
            read.append((step, rows[np.argsort(rows[:, 0], kind="stable")]))
    except (struct.error, ValueError, IndexError) as error:
        raise EngineError(f"{path}: frame {len(read)} is incomplete ({error}); the run was stopped there") from None
    return read


def series(path: Path) -> np.ndarray:
    """All frames of a binary dump of the same atoms without the id, shape (frames, atoms, columns - 1).

    Raises EngineError if the file is incomplete, ValueError if the number of atoms changes.
    """
    return np.stack([rows[:, 1:] for _, rows in frames(path)])
