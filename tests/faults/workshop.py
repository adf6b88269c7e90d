# SPDX-License-Identifier: GPL-2.0-or-later
"""A copy of the project that a test may spoil or extend, build, and test by itself."""

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
LAWS, CAPI, PYTHON = "cpp_contact/include/epdem", "cpp_contact/capi", "python/epdem"


def copy_of_project(folder: Path) -> Path:
    """A copy of the project; the compiled parts that it uses are the installed ones until it has its own."""
    for name in ("cpp_contact", "python", "templates", "tests", "cases", "docs"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__", "*.png"))
    for name in ("pyproject.toml", "CMakeLists.txt", "ARCHITECTURE.md"):
        shutil.copy(ROOT / name, folder)
    return folder


def build_library(folder: Path) -> None:
    """Compile the C library of a copy."""
    native = folder / PYTHON / "native"
    native.mkdir(exist_ok=True)
    command = ["g++", "-std=c++17", "-O1", "-fPIC", "-shared", f"-I{folder}/cpp_contact/include"]
    sources = map(str, (folder / CAPI).glob("*.cpp"))
    version = '-DEPDEM_VERSION="fault"'
    subprocess.run([*command, version, *sources, "-o", str(native / "libepdem.so")], check=True)


def build_plugin(folder: Path, flags: str) -> Path:
    """Compile the LIGGGHTS parts of a copy with the compiler's `flags`; the launcher."""
    tree = folder / "build"
    configure = ["cmake", "-S", folder, "-B", tree, f"-DCMAKE_CXX_FLAGS=-O1 {flags}"]
    for command in (configure, ["cmake", "--build", tree, "-j2", "--target", "epdem-liggghts"]):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return next(tree.rglob("epdem-liggghts"))


def pytest_in(folder: Path, *tests: str, only: str = "", env: dict[str, str] | None = None):
    """Run tests (pytest nodes) of the copy against the copy, not against the installed package, up to a failure."""
    words: Sequence[str] = ["-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", *tests, "-k", only]
    code = (
        "import sys; sys.meta_path[:] = [f for f in sys.meta_path if 'Scikit' not in type(f).__name__]; "
        f"sys.path.insert(0, {str(folder / 'python')!r}); import pytest, epdem; "
        f"assert epdem.__file__.startswith({str(folder)!r}); sys.exit(pytest.main({words!r}))"
    )
    all_env = os.environ | {"PYTHONPATH": str(folder / "python"), "PYTHONDONTWRITEBYTECODE": "1"} | (env or {})
    return subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=all_env, capture_output=True, text=True, timeout=600
    )
