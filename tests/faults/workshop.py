# SPDX-License-Identifier: GPL-2.0-or-later
"""A copy of the project that a test may spoil or extend, build, and test by itself."""

import os
import shutil
import subprocess
import sys
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


# Read when Python starts: the installed package, which is found by a hook of its build tool, hides behind the copy.
SITE = "import sys\nsys.meta_path[:] = [f for f in sys.meta_path if 'Scikit' not in type(f).__name__]\n"
CODE = """
import sys, epdem, pytest
assert epdem.__file__.startswith(sys.argv[1])
sys.exit(pytest.main(sys.argv[2:]))
"""


def pytest_in(folder: Path, *tests: str, only: str = "", env: dict[str, str] | None = None):
    """Run tests (pytest nodes) of the copy against the copy, not against the installed package, up to a failure."""
    (folder / "site").mkdir(exist_ok=True)
    (folder / "site" / "sitecustomize.py").write_text(SITE)
    python = {"PYTHONPATH": f"{folder / 'site'}:{folder / 'python'}", "PYTHONDONTWRITEBYTECODE": "1"}
    words = [str(folder), "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", *tests, "-k", only]
    return subprocess.run(
        [sys.executable, "-c", CODE, *words],
        cwd=folder,
        env={k: v for k, v in os.environ.items() if k != "VIRTUAL_ENV"} | python | (env or {}),  # YADE would follow it
        capture_output=True,
        text=True,
        timeout=600,
    )
