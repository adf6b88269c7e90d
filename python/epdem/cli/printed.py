# SPDX-License-Identifier: GPL-2.0-or-later
"""What a command printed about stored results, for the same command again: at once, without the libraries it needs.

`.epdem.printed.json` in the folder of results holds the text, the hash of all that it depends on, and the state of the
files that it is about. Where anything differs, the command does its work.
"""

import json
import os
import shutil
import tomllib
from pathlib import Path

from ..base.files import atomic
from ..base.folders import LOCK, results_folder
from ..base.stages import inputs_hash

NAME = ".epdem.printed.json"
INSTALLED = Path("/var/lib/dpkg/status")  # changes with every package of Debian's, so with every engine
PROGRAMS = ("liggghts", "yade", "mpirun")
SEEN = (
    "EPDEM",
    "LD_",
    "PATH",
    "TERM",
    "COLUMNS",
    "LINES",
    "NO_COLOR",
    "FORCE_COLOR",
    "LC_",
    "LANG",
)  # in the environment


class Printed:
    """The text that a command prints about the results of a case of impacts in `out` (default: runs/<name>).

    `facts` are all options and what the text depends on else; they count by their repr.
    """

    def __init__(self, case: Path, out: Path | None, *facts: object):
        self.folder, self.key = _folder(case, out), ""
        if self.folder:
            self.key = inputs_hash([case], str(case), str(out), facts, _surroundings())

    def again(self) -> tuple[str, int] | None:
        """(text, exit code) of the same command before; None if there is none or anything has changed since."""
        if self.folder is None or (self.folder / LOCK).exists():
            return None
        try:
            stored = json.loads((self.folder / NAME).read_text(encoding="utf-8"))
            same = stored["key"] == self.key and stored["files"] == _state(self.folder)
            return (str(stored["text"]), int(stored["code"])) if same else None
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def keep(self, text: str, code: int) -> None:
        """Store what the same command is to print."""
        if self.folder:
            stored = {"key": self.key, "code": code, "files": _state(self.folder), "text": text}
            with atomic(self.folder / NAME, sync=False) as temporary:
                temporary.write_text(json.dumps(stored), encoding="utf-8")


def _folder(case: Path, out: Path | None) -> Path | None:
    """Where the results of a case are; None for a scene, and for what is no case."""
    try:
        tables = tomllib.loads(case.read_text(encoding="utf-8"))
        return None if "scene" in tables else results_folder(out, tables["case"]["name"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _state(folder: Path) -> dict[str, list[int]]:
    """Size and time of change of every file below a folder but the hidden ones."""
    found = {}
    for place, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".")]
        for name in files:
            if not name.startswith("."):
                about = (Path(place) / name).stat()
                found[os.path.relpath(Path(place) / name, folder)] = [about.st_size, about.st_mtime_ns]
    return found


def _surroundings() -> list[object]:
    """What tells whether the engines and the terminal are those of before."""
    environment = sorted((name, value) for name, value in os.environ.items() if name.startswith(SEEN))
    places = [str(INSTALLED), *(path for name in PROGRAMS if (path := shutil.which(name)))]
    places += [value for name, value in environment if name.startswith("EPDEM") and Path(value).is_file()]
    return [environment, [(path, Path(path).stat().st_mtime_ns) for path in places if Path(path).exists()]]
