# SPDX-License-Identifier: GPL-2.0-or-later
"""Files that are either complete or absent."""

import contextlib
import fcntl
import os
import secrets
import stat
from collections.abc import Iterator
from pathlib import Path

TEMPORARY = ".epdem-tmp-"  # how the names of files begin that are not yet complete


@contextlib.contextmanager
def atomic(path: Path, *, sync: bool = True) -> Iterator[Path]:
    """A temporary path beside `path` that replaces it when the block ends well, and vanishes otherwise.

    The data are on the disk before they take the name: neither a crash nor a full disk leaves half a file. Without
    `sync`, which takes a millisecond a file, this does not hold for a crash of the machine itself. A new file has the
    mode that the umask gives, another one keeps its mode. The temporary file is locked: see `remove_stale`.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f"{TEMPORARY}{path.stem[:100]}.{secrets.token_hex(4)}{path.suffix}")
    try:
        with temporary.open("xb") as lock:
            with contextlib.suppress(OSError):  # not every file system has locks
                fcntl.flock(lock, fcntl.LOCK_EX)
            yield temporary
            with contextlib.suppress(FileNotFoundError):
                temporary.chmod(stat.S_IMODE(path.stat().st_mode))
            if sync:
                with temporary.open("rb") as written:
                    os.fsync(written.fileno())
            temporary.replace(path)
    except OSError as error:  # names a file that the user has never heard of
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        temporary.unlink(missing_ok=True)


def remove_stale(folder: Path) -> None:
    """Remove the temporary files of `atomic` that a killed process has left in `folder`; living ones hold a lock."""
    for path in folder.glob(f"{TEMPORARY}*"):
        with contextlib.suppress(OSError), path.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink()


def write_texts(folder: Path, texts: dict[str, str]) -> list[Path]:
    """Write text files by their path below `folder`, which is made where it is missing."""
    for name, text in texts.items():
        with atomic(folder / name, sync=False) as temporary:
            temporary.write_text(text, encoding="utf-8")
    return [folder / name for name in texts]
