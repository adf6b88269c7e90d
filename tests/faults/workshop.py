# SPDX-License-Identifier: GPL-2.0-or-later
"""A copy of the project that a test may spoil or extend, build, and test by itself."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
LAWS, PYTHON = "cpp_contact/include/epdem", "python/epdem"


def copy_of_project(folder: Path) -> Path:
    """A copy of the project; the compiled parts that it uses are the installed ones until it has its own."""
    for name in ("cpp_contact", "python", "templates", "tests", "cases", "data", "docs"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__", "*.png"))
    for name in ("pyproject.toml", "CMakeLists.txt", "ARCHITECTURE.md", "README.md"):
        shutil.copy(ROOT / name, folder)
    # pages of code that a fault in their source, and nothing else, makes invalid
    compiled = [sys.executable, "-m", "compileall", "-q", "--invalidation-mode", "checked-hash", "python", "tests"]
    subprocess.run(compiled, cwd=folder, check=True)
    return folder


def with_one_instruction_set(folder: Path) -> Path:
    """A copy in which two of three files of the kernels are empty: that halves the compiler's work."""
    for name in ("avx2", "avx512"):
        text = f"namespace epdem::kernels {{\nconst Kernels kernels_{name} = kernels_sse2;\n}}\n"
        (folder / f"cpp_contact/kernels/{name}.cpp").write_text(f'#include "kernels/block.hpp"\n{text}')
    return folder


def build_library(folder: Path, flags: str = "-O0") -> None:
    """Compile the C library of a copy with the compiler's `flags`."""
    native = folder / PYTHON / "native"
    native.mkdir(exist_ok=True)
    shutil.copy(_build(folder, "epdem_capi", flags).with_name("libepdem.so"), native)


def build_plugin(folder: Path, flags: str) -> None:
    """Compile the LIGGGHTS parts of a copy with the compiler's `flags`."""
    _build(folder, "epdem-liggghts", flags)


def build_lammps(folder: Path, flags: str) -> None:
    """Compile the plugin of a copy for the LAMMPS in use with the compiler's `flags`."""
    settings = [sys.executable, ROOT / "scripts/lammps", "--settings"]
    words = subprocess.run(settings, check=True, capture_output=True, text=True).stdout.split("\n")
    more = [word.replace("cmake.define.", "-D") for word in words if word]
    native = folder / PYTHON / "native/lammps"
    native.mkdir(parents=True, exist_ok=True)
    shutil.copy(_build(folder, "epdem_lammps", flags, more), native)


def build_yade(folder: Path, flags: str) -> Path:
    """Compile YADE's module of a copy with the compiler's `flags`; its folder."""
    more = ["-DCMAKE_BUILD_TYPE=None", f"-DYADE_SOURCE={Path(os.environ['YADE_SOURCE']).resolve()}"]
    return _build(folder, "epdem_yade", flags, more, source="cpp_contact/yade").parent


def program(folder: Path) -> Path:
    """The LIGGGHTS of a copy."""
    return next((folder / "build").rglob("epdem-liggghts/**/epdem-liggghts"))


PRODUCTS = {
    "epdem_capi": "libepdem.so",
    "epdem-liggghts": "epdem-liggghts",
    "epdem_lammps": "epdemplugin.so",
    "epdem_yade": "epdem_yade.so",
}


def _build(folder: Path, target: str, flags: str, more: Sequence[str] = (), *, source: str = ".") -> Path:
    """What a target of the project's own build file makes, again only where a source has changed."""
    tree = folder / "build" / target
    if not tree.exists():
        plugin = "ON" if target == "epdem-liggghts" else "OFF"
        settings = [f"-DCMAKE_CXX_FLAGS={flags}", f"-DEPDEM_PLUGIN={plugin}", *more]
        configure = ["cmake", "-S", folder / source, "-B", tree, *settings]
        subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", tree, "-j2", "--target", target], check=True, stdout=subprocess.DEVNULL)
    return next(tree.rglob(PRODUCTS[target]))


# Read when Python starts: the installed package, which is found by a hook of its build tool, hides behind the copy.
SITE = "import sys\nsys.meta_path[:] = [f for f in sys.meta_path if 'Scikit' not in type(f).__name__]\n"
# Imports what is not ours, and the modules of ours that are named, once; every line of input is a run of pytest in a
# child that has all this already. A red test need not look for its simplest example.
SERVER = """
import gc, importlib, json, os, signal, sys
import h5py, hypothesis, jinja2, numpy, pandas, pint, pydantic, pytest, rich, scipy.optimize, tomlkit, typer
from hypothesis import Phase, settings
settings.register_profile("red", derandomize=True, deadline=None, suppress_health_check=list(hypothesis.HealthCheck),
                          phases=[Phase.explicit, Phase.generate], report_multiple_bugs=False)
for name in sys.argv[1:]:
    importlib.import_module(name)
gc.collect()
gc.freeze()
for line in sys.stdin:
    words, env, out = json.loads(line)
    if not (child := os.fork()):
        signal.alarm(600)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(os.open(out, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 1)
        os.dup2(1, 2)
        os.environ.update(env)
        code = 70
        try:
            import epdem
            assert epdem.__file__.startswith(os.getcwd())
            code = int(pytest.main(words))
        finally:
            sys.stdout.flush()
            os._exit(code)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


@dataclass(frozen=True)
class Done:
    """How a run of tests ended: pytest's exit code, and all that it printed."""

    returncode: int
    stdout: str


class Runner:
    """Runs tests of a copy against the copy, not against the installed package."""

    def __init__(self, folder: Path, env: dict[str, str] | None = None, *sound: str):
        """`sound`: modules of ours that no run changes."""
        self.folder = folder
        (folder / "site").mkdir(exist_ok=True)
        (folder / "site" / "sitecustomize.py").write_text(SITE)
        python = {"PYTHONPATH": f"{folder / 'site'}:{folder / 'python'}", "PYTHONDONTWRITEBYTECODE": "1"}
        ours = {k: v for k, v in os.environ.items() if k != "VIRTUAL_ENV"}  # YADE would follow it
        self.server = subprocess.Popen(
            [sys.executable, "-c", SERVER, *sound],
            cwd=folder,
            env=ours | python | {"OPENBLAS_NUM_THREADS": "1"} | (env or {}),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(self, *words: str, only: str = "", env: dict[str, str] | None = None) -> Done:
        """Run pytest with `words`, up to a failure, and with `env` in the environment."""
        out = self.folder / "out.pytest"
        options = ["-qx", "--assert=plain", "-pno:cacheprovider", "-pno:xdist", "-m", "", "--hypothesis-profile=red"]
        print(json.dumps([[*options, *words, "-k", only], env or {}, str(out)]), file=self.server.stdin, flush=True)
        code = int(self.server.stdout.readline())
        return Done(code, out.read_text(errors="replace"))

    def close(self) -> None:
        """End the process that the runs share."""
        self.server.stdin.close()
        self.server.wait()
