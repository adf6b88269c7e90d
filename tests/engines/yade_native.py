# SPDX-License-Identifier: GPL-2.0-or-later
"""The module epdem_yade built once for all tests, scripts that import it, and impacts in it."""

import fcntl
import json
import os
import shlex
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

from epdem.cli.main import app
from epdem.engines import sources
from epdem.engines.yade.launcher import environment

ROOT = Path(__file__).resolve().parents[2]
EXPORTED = ROOT / "build/yade_exported"


def title(law: str) -> str:
    """The C++ name of a law: thornton_ning -> ThorntonNing."""
    return law.title().replace("_", "")


@cache
def module_folder() -> Path:
    """The folder of epdem_yade.so, built as `epdem export yade` says; the first test builds it, others wait."""
    if named := os.environ.get("EPDEM_YADE_MODULE"):
        return Path(named)
    EXPORTED.mkdir(parents=True, exist_ok=True)
    with (EXPORTED / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with tempfile.TemporaryDirectory() as scratch:
            new = Path(scratch) / "new"
            app(["export", "yade", "--out", str(new)], standalone_mode=False)
            for file in (f for f in new.rglob("*") if f.is_file()):
                place = EXPORTED / file.relative_to(new)
                if not place.exists() or place.read_bytes() != file.read_bytes():  # else nothing is built again
                    place.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(file, place)
        for command in sources.commands("yade", EXPORTED)[:2]:
            text = command.replace("/path/to/yade", shlex.quote(os.environ["YADE_SOURCE"]))
            done = subprocess.run(["bash", "-c", text], capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return EXPORTED / "build"


HEAD = """
import json, sys
import numpy as np
sys.path.insert(0, {module!r})
from yade import O
from yade.wrapper import *
from yade.utils import sphere, wall, facet, box
from epdem_yade import *
"""


def yade(text: str, folder: Path, threads: int = 1, head: str = HEAD) -> subprocess.CompletedProcess[str]:
    """Run a script in YADE."""
    folder.mkdir(parents=True, exist_ok=True)
    script = folder / "script.py"
    script.write_text(head.format(module=str(module_folder())) + text, encoding="utf-8")
    return subprocess.run(
        ["yade", "-n", f"-j{threads}", "-x", script.name],
        cwd=folder,
        env=environment() | {"OMP_NUM_THREADS": str(threads), "LD_PRELOAD": os.environ.get("EPDEM_YADE_PRELOAD", "")},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def result(text: str, folder: Path, threads: int = 1) -> dict:
    """What a script writes by json to `result.json`."""
    done = yade(text, folder, threads)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-3000:]
    return json.loads((folder / "result.json").read_text())
