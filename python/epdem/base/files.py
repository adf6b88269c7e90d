# SPDX-License-Identifier: GPL-2.0-or-later
"""Files that are complete or absent, and folders of results.

One run writes a folder at a time, and no file of the user in it is changed. The marker `.epdem.json` says that the
folder belongs to epdem, and lists the files of the user from before. After a run a file that is newer than the marker
is the user's, too; after a crash all files that the marker does not list are those of the run.
"""

import contextlib
import fcntl
import json
import os
import re
import secrets
import stat
import time
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, TextIO

from ..errors import CaseError
from .processes import POLL, engines_in

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
    except OSError as error:  # names the temporary file, which the user does not know
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        temporary.unlink(missing_ok=True)


def remove_stale(folder: Path) -> None:
    """Remove the temporary files of `atomic` that a killed process has left in `folder`; living ones hold a lock."""
    for path in folder.glob(f"{TEMPORARY}*"):
        with contextlib.suppress(OSError), path.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink()


def write_text(path: Path, text: str, *, sync: bool = True) -> None:
    """Write a text file as `atomic` does."""
    with atomic(path, sync=sync) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_texts(folder: Path, texts: dict[str, str]) -> list[Path]:
    """Write text files by their path below `folder`, which is made where it is missing."""
    for name, text in texts.items():
        write_text(folder / name, text, sync=False)
    return [folder / name for name in texts]


LOCK, MARKER = ".epdem.lock", ".epdem.json"
PATIENCE = 20.0  # [s] for the engine of a run that was killed
RESULTS, PREVIOUS = ("results.h5", "results.csv", "report.html", "*.png", "*.svg", "*.pdf"), "previous"
# Names that a run may write, in the folder or below it.
OUTPUTS = re.compile(
    r"(in|results|out|particles|contacts|triangles|restart|picture|path)\..*|(contacts_|wall_contacts|scene|stress_).*"
    r"|.*\.(in|png|svg|pdf|data|stl|so)|(spheres.*|wall_.*|end)\.txt|report\.html|impact\.py"
    r"|(e_n|psi|key|energy|figure_8_.*|thornton_ning_1998)\.csv",
    re.DOTALL,
)


def results_folder(out: Path | None, *names: str) -> Path:
    """Folder of results: `out`, else runs/<names>."""
    return out or Path("runs", *names)


@dataclass(frozen=True)
class ResultsFolder:
    """A folder that this process may write to; `foreign` are the files in it that are the user's.

    versions: of the programs that made its files, by name; none where no run has noted them. job: the name of the case
    whose results it has, and the hash of the inputs of its last run.
    """

    folder: Path
    foreign: frozenset[str] = field(default_factory=frozenset)
    versions: dict[str, str] = field(default_factory=dict)
    job: dict[str, str] = field(default_factory=dict)

    def note(self, versions: dict[str, str], **job: str) -> None:
        """Keep the versions of the programs that are about to write, and their job, through a crash too."""
        self.versions.clear()
        self.versions.update(versions)
        self.job.update(job)
        self.mark(ended=False)

    def mark(self, *, ended: bool) -> None:
        content = {"foreign": sorted(self.foreign), "versions": self.versions, "job": self.job, "ended": ended}
        write_text(self.folder / MARKER, json.dumps(content, indent=1))

    def remove(self, *patterns: str) -> None:
        """Remove the files of earlier runs whose path in the folder matches a pattern, and only these."""
        for name in _names(self.folder) - self.foreign:
            if any(fnmatch(name, pattern) for pattern in patterns):
                (self.folder / name).unlink()

    def set_aside(self) -> list[str]:
        """Move the results of the earlier run to PREVIOUS, in place of those there; a sentence on it, or none."""
        names = {n for n in _names(self.folder) - self.foreign if any(fnmatch(n, x) for x in RESULTS) and "/" not in n}
        if RESULTS[0] not in names:
            return []
        self.remove(f"{PREVIOUS}/*")
        for name in names:
            (self.folder / PREVIOUS).mkdir(exist_ok=True)
            (self.folder / name).replace(self.folder / PREVIOUS / name)
        return [f"{self.folder}: the results of other inputs, which were here, are in {PREVIOUS} now"]


Known = dict[str, Any]  # content of the marker
_held: dict[Path, ResultsFolder] = {}  # folders that this process keeps now


def stored_results(folder: Path) -> ResultsFolder:
    """The claimed folder of this process; without a claim no file in it is foreign."""
    return _held.get(folder.resolve(), ResultsFolder(folder))


@contextlib.contextmanager
def claim(folder: Path, *, force: bool = False, files: Collection[str] = (), case: str = "") -> Iterator[ResultsFolder]:
    """Keep `folder` (made where it is missing) for one run, until the block ends; blocks of one process may nest.

    Raises CaseError if another process is at work in it, or if it holds files of the user's where a run would write,
    `files` among them, or results of another `case` than this; with `force` all these may be overwritten, and files of
    the user's are never removed.
    """
    place = folder.resolve()
    if place in _held:
        yield _held[place]
        return
    if file := next((p for p in (folder, *folder.parents) if p.exists() and not p.is_dir()), None):
        raise CaseError(f"{folder}: {file} is a file; name a folder by --out")
    made = [p for p in (folder, *folder.parents) if not p.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with (folder / LOCK).open("a+") as lock:
            _lock(folder, lock)
            _await_engines(folder, place)
            yield from _claimed(folder, place, force, files, case)
    except OSError as error:
        if error.errno and not error.filename:  # a full disk, while a file was written that was open
            raise OSError(error.errno, error.strerror, str(folder)) from None
        raise
    finally:
        for path in made:  # a run that has written nothing leaves none
            with contextlib.suppress(OSError):
                path.rmdir()


def _claimed(folder: Path, place: Path, force: bool, files: Collection[str], case: str) -> Iterator[ResultsFolder]:
    try:
        for path in _folders(folder):
            remove_stale(path)
        known = _known(folder)
        foreign = _foreign(folder, known)
        if not force:
            _refuse(folder, foreign, files, known is not None)
        versions, job = ((known or {}).get(key, {}) for key in ("versions", "job"))
        if case and not force and job.get("case", case) != case and (folder / RESULTS[0]).exists():
            raise CaseError(
                f"{folder}: it has the results of case {job['case']!r}; choose another folder by --out, or add --force"
            )
        results = ResultsFolder(folder, frozenset(foreign), versions, job)
        results.note(dict(versions), **({"case": case} if case else {}))
        _held[place] = results
        yield results
    finally:
        try:
            if _held.pop(place, None):
                if known is None and not _names(folder) - foreign:  # the run has written nothing
                    (folder / MARKER).unlink()
                else:
                    results.mark(ended=True)
        finally:
            (folder / LOCK).unlink(missing_ok=True)


def _lock(folder: Path, lock: TextIO) -> None:
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        lock.seek(0)
        owner = lock.read().strip() or "another process"
        raise CaseError(f"{folder}: in use by {owner}; wait for its end, or choose another folder by --out") from None
    if not (folder / LOCK).exists() or (folder / LOCK).stat().st_ino != os.fstat(lock.fileno()).st_ino:
        raise CaseError(f"{folder}: another run has just ended here; run the command again")
    try:
        os.truncate(lock.fileno(), 0)
        os.write(lock.fileno(), f"process {os.getpid()} since {time.strftime('%Y-%m-%d %H:%M:%S')}\n".encode())
    except OSError as error:
        (folder / LOCK).unlink()
        raise OSError(error.errno, error.strerror, str(folder / LOCK)) from None


def running(folder: Path) -> bool:
    """Whether a process on this machine is at work in a folder now."""
    try:
        with (folder / LOCK).open() as lock:
            fcntl.flock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except OSError:
        return True
    return False


def _await_engines(folder: Path, place: Path) -> None:
    """Wait until the engine of a run here that was killed has ended, too. Raises CaseError for one that goes on."""
    end = time.monotonic() + PATIENCE
    while left := [pid for pid, own in engines_in(place) if not _is_apart(own, place)]:
        if time.monotonic() > end:
            (folder / LOCK).unlink(missing_ok=True)
            raise CaseError(f"{folder}: process {left[0]} of an earlier run still writes here; wait for its end")
        time.sleep(POLL)


def _is_apart(own: Path, place: Path) -> bool:
    """Whether a folder below `place` belongs to another run, as the points of a sweep do."""
    return any((p / MARKER).exists() for p in (own, *own.parents) if p != place and p.is_relative_to(place))


def _folders(folder: Path) -> Iterator[Path]:
    """A folder and those below it; no hidden ones, and none that have a marker."""
    yield folder
    for path in folder.iterdir():
        hidden = path.name.startswith(".") or path.is_symlink()
        if path.is_dir() and not hidden and not (path / MARKER).exists():
            yield from _folders(path)


def _names(folder: Path) -> set[str]:
    """All files in `_folders` by their path in the folder, without hidden ones."""
    paths = (path for place in _folders(folder) for path in place.iterdir() if not path.name.startswith("."))
    return {str(path.relative_to(folder)) for path in paths if path.is_symlink() or not path.is_dir()}


def _known(folder: Path) -> Known | None:
    """The content of the marker, or None if the folder has no marker that can be read."""
    try:
        marker = json.loads((folder / MARKER).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return marker if isinstance(marker, dict) else None


def _foreign(folder: Path, known: Known | None) -> set[str]:
    names = _names(folder)
    if known is None:
        return names
    foreign = names & set(known.get("foreign", []))
    if known.get("ended"):
        end = (folder / MARKER).stat().st_mtime_ns
        foreign |= {name for name in names if (folder / name).lstat().st_mtime_ns > end}
    return foreign


def _refuse(folder: Path, foreign: set[str], files: Collection[str], ours: bool) -> None:
    in_the_way = {n for n in foreign if not ours or n in files or OUTPUTS.fullmatch(Path(n).name)}
    if in_the_way:
        what = "was not written by epdem, or has changed since" if ours else "was there before; the folder is not ours"
        raise CaseError(f"{folder}: {min(in_the_way)} {what}; choose another folder by --out, or add --force")


def write_own(folder: Path, texts: dict[str, str], *, force: bool = False) -> list[Path]:
    """Write text files by their path below `folder`, which is claimed for it; their paths. Raises CaseError."""
    with claim(folder, force=force, files=texts):
        return write_texts(folder, texts)


def refuse_existing(path: Path, *, force: bool) -> None:
    """Raise CaseError if a file that a user has named by --out is there, unless `force` allows to replace it.

    Also if its folder can neither be made nor written to, which is so known before the work that it is for.
    """
    if path.exists() and not force:
        raise CaseError(f"{path} exists; name another file by --out, or replace it by --force")
    parent = next(p for p in path.absolute().parents if p.exists())
    if not (parent.is_dir() and os.access(parent, os.W_OK | os.X_OK)):
        raise CaseError(f"{path}: {parent} is not a folder that can be written to; name another file by --out")


def write_project(folder: Path, files: dict[Path, Path]) -> list[Path]:
    """Copy text files to their places in a new folder. Raises CaseError if the folder has files."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise CaseError(f"--out {folder}: it has files; name a new folder")
    folder.mkdir(parents=True, exist_ok=True)
    return write_texts(folder, {str(name): files[name].read_text(encoding="utf-8") for name in sorted(files)})
