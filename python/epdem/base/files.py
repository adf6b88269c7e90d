# SPDX-License-Identifier: GPL-2.0-or-later
"""Files that are either complete or absent."""

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def atomic(path: Path, *, sync: bool = True) -> Iterator[Path]:
    """A temporary path beside `path` that replaces it when the block ends well, and vanishes otherwise.

    The data are on the disk before they take the name: neither a crash nor a full disk leaves half a file. Without
    `sync`, which takes a millisecond a file, this does not hold for a crash of the machine itself.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix="." + path.name + ".", suffix=path.suffix)
    except OSError as error:  # names a file that the user has never heard of
        raise OSError(error.errno, error.strerror, str(path)) from None
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        temporary.chmod(0o644)
        if sync:
            with temporary.open("rb") as written:
                os.fsync(written.fileno())
        temporary.replace(path)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        temporary.unlink(missing_ok=True)


def write_texts(folder: Path, texts: dict[str, str]) -> list[Path]:
    """Write text files by their path below `folder`, which is made where it is missing."""
    for name, text in texts.items():
        with atomic(folder / name, sync=False) as temporary:
            temporary.write_text(text, encoding="utf-8")
    return [folder / name for name in texts]
