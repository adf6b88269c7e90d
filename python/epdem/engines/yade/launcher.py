# SPDX-License-Identifier: GPL-2.0-or-later
"""Starting YADE, and the modules in a deck."""

import os
import shutil
from pathlib import Path

from ...base.declarations import library_path
from ...base.files import atomic, write_texts
from ...yade.deck_modules.law import LIBRARY

MODULES = Path(__file__).parents[2] / "yade/deck_modules"


def command() -> str:
    """YADE's program; EPDEM_YADE names another one."""
    return os.environ.get("EPDEM_YADE", "yade")


def deck_modules() -> dict[str, str]:
    """The modules that a deck with a law of ours imports, by path beside the deck."""
    note = '"""The part of epdem that YADE needs; it came with the deck."""\n'
    files = {"epdem/__init__.py": note, "epdem/yade/__init__.py": note}
    return files | {
        f"epdem/yade/deck_modules/{p.name}": p.read_text(encoding="utf-8") for p in sorted(MODULES.glob("*.py"))
    }


def write_deck_modules(folder: Path) -> list[Path]:
    """Write `deck_modules` and a copy of the C library beside them into a deck's folder. Raises EngineError."""
    written = write_texts(folder, deck_modules())
    copy = folder / "epdem/yade/deck_modules" / LIBRARY
    with atomic(copy, sync=False) as temporary:
        shutil.copyfile(library_path(), temporary)
    return [*written, copy]


def environment() -> dict[str, str]:
    """Ours without what would lead the system Python, which YADE embeds, to packages of another one."""
    kept = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONHOME", "PYTHONSTARTUP", "DISPLAY")}
    return {"HOME": "/tmp", **kept, "OMP_NUM_THREADS": "1"}  # YADE does not start without a home
