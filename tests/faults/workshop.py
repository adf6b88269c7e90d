# SPDX-License-Identifier: GPL-2.0-or-later
"""A copy of the project that a test may spoil or extend, build, and test by itself."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
LAWS, CAPI, PLUGIN, PYTHON = "cpp_contact/include/epdem", "cpp_contact/capi", "cpp_contact/liggghts", "python/epdem"


def copy_of_project(folder: Path) -> Path:
    """A copy of the project with its compiled parts where the package looks first."""
    for name in ("cpp_contact", "python", "templates", "tests", "cases"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "CMakeLists.txt", "ARCHITECTURE.md"):
        shutil.copy(ROOT / name, folder)
    return folder


def build(folder: Path, plugin: bool) -> None:
    """Compile what a change of C++ reaches: the C library, and the LIGGGHTS parts if asked."""
    native = folder / PYTHON / "native"
    native.mkdir(exist_ok=True)
    if not plugin:
        command = ["g++", "-std=c++17", "-O1", "-fPIC", "-shared", f"-I{folder}/cpp_contact/include", '-DEPDEM_VERSION="fault"',
                   *map(str, (folder / CAPI).glob("*.cpp")), "-o", str(native / "libepdem.so")]  # fmt: skip
        subprocess.run(command, check=True)
        return
    tree = folder / "build"
    subprocess.run(
        ["cmake", "-S", folder, "-B", tree, "-DCMAKE_CXX_FLAGS_RELEASE=-O1"], check=True, stdout=subprocess.DEVNULL
    )
    subprocess.run(["cmake", "--build", tree, "-j2"], check=True, stdout=subprocess.DEVNULL)
    for pattern in ("libepdem*.so",):
        for found in tree.rglob(pattern):
            shutil.copy(found, native)


def pytest_in(folder: Path, test: str, only: str) -> subprocess.CompletedProcess:
    """Run one test of the copy against the copy, not against the installed package."""
    code = (
        "import sys; sys.meta_path[:] = [f for f in sys.meta_path if 'Scikit' not in type(f).__name__]; "
        f"sys.path.insert(0, {str(folder / 'python')!r}); import pytest, epdem; assert epdem.__file__.startswith({str(folder)!r}); "
        f"sys.exit(pytest.main(['-q', '-x', '-p', 'no:cacheprovider', '-p', 'no:xdist', {test!r}, '-k', {only!r}]))"
    )
    env = os.environ | {"PYTHONPATH": str(folder / "python"), "PYTHONDONTWRITEBYTECODE": "1"}
    launcher = next((folder / "build").rglob("epdem-liggghts"), None) if (folder / "build").exists() else None
    if launcher:
        env["EPDEM_LAUNCHER"] = str(launcher)
    return subprocess.run(
        [sys.executable, "-c", code], cwd=folder, env=env, capture_output=True, text=True, timeout=600
    )
