# SPDX-License-Identifier: GPL-2.0-or-later
"""What a LIGGGHTS executable is: version, models, and the parts that it was built with."""

import re
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path

from ...base import paths
from ...base.processes import ask
from ...errors import EngineError
from . import launcher

_VTK = "custom/vtk"  # the dump style of output.vtk


@dataclass(frozen=True)
class Executable:
    """`version` is "" for a program that does not say it; `models` are the models of epdem that it has."""

    path: Path
    version: str
    superquadrics: bool
    vtk: bool
    mpi: bool
    models: tuple[str, ...]

    def __str__(self) -> str:
        parts = {"superquadrics": self.superquadrics, "VTK": self.vtk, "MPI": self.mpi}
        built = [f"{'with' if has else 'without'} {part}" for part, has in parts.items()]
        return ", ".join([self.version or "version unknown", *built])


def version(path: Path) -> str:
    """What LIGGGHTS says that it is, as "LIGGGHTS-PUBLIC 3.8.0"; "" if it says nothing. Raises EngineError."""
    return _version(_help(path))


def writes_vtk(path: Path) -> bool:
    """Whether it was built with VTK. Raises EngineError."""
    return _VTK in _styles(_help(path), "Dump styles")


def examine(path: Path, laws: tuple[str, ...]) -> Executable:
    """What a LIGGGHTS has, found by one short run for each of `laws`. Raises EngineError if it does not start."""
    text = _help(path)
    return Executable(
        path,
        _version(text),
        superquadrics="superquadric" in _styles(text, "Atom styles"),
        vtk=_VTK in _styles(text, "Dump styles"),
        mpi="libmpi" in ask(["ldd", str(path)]) if shutil.which("ldd") else False,
        models=tuple(law for law in laws if _has(law)),
    )


def _help(path: Path) -> str:
    return ask([str(path), "-log", "none", "-h"], launcher.environment())


def _version(text: str) -> str:
    found = re.search(r"\bVersion (LIGGGHTS[-\w]*) ([\d.]+)", text)
    return f"{found[1]} {found[2]}" if found else ""


def _styles(text: str, heading: str) -> list[str]:
    """The names under a heading of LIGGGHTS's help."""
    _, _, rest = text.partition(f"* {heading}")
    return rest.partition("\n* ")[0].split()


def _has(law: str) -> bool:
    """Whether the LIGGGHTS in use creates the model of a law."""
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "in.doctor"
        deck.write_text(
            "atom_style granular\nnewton off\ncommunicate single vel yes\nregion box block 0 1 0 1 0 1\n"
            f"create_box 1 box\npair_style gran model ep/{law} tangential off\n",
            encoding="utf-8",
        )
        try:
            launcher.run(deck.name, Path(folder), seconds=60)
        except EngineError:
            return False
    return True


def advice(laws: tuple[str, ...], version: str = "") -> str:
    """How an executable without these models, of a LIGGGHTS that says this version, gets them; "" for none."""
    if not laws:
        return ""
    get = f"to get {', '.join('ep/' + law for law in laws)}: "
    if version.startswith("LIGGGHTS-PFM"):
        return (
            f"{get}'epdem export liggghts --out SRC' has the laws without adhesion for LIGGGHTS-PFM; for the others "
            "take LIGGGHTS-PUBLIC or LIGGGHTS-INL"
        )
    plugin = paths.native("libepdem_liggghts.so")
    preload = f"LD_PRELOAD={plugin} with Debian's liggghts, " if plugin else ""
    own = "'epdem export liggghts --out SRC' for a tree that you build yourself"
    return f"{get}{preload}epdem-liggghts in place of it, or {own}"
