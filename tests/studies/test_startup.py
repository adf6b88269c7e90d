# SPDX-License-Identifier: GPL-2.0-or-later
"""What is slow to import is imported by what needs it, so that help and refusals come at once."""

import subprocess
import sys
from pathlib import Path

import pytest

SLOW = ("numpy", "pandas", "pydantic", "pint", "h5py", "jinja2", "matplotlib", "tomlkit", "submitit", "psutil")


@pytest.mark.parametrize("module", ["epdem", "epdem.verification.cli"])
def test_nothing_slow_is_imported_before_a_command_needs_it(module):
    code = f"import sys, {module}; print(*sys.modules)"
    loaded = subprocess.check_output([sys.executable, "-c", code], text=True).split()
    assert module in loaded and not [name for name in SLOW if name in loaded]


def test_a_prediction_imports_no_tables_and_no_figures(tmp_path):
    case = Path(__file__).parents[2] / "cases/steel_wall.toml"
    code = f"import sys; sys.argv = ['epdem', 'predict', {str(case)!r}]; from epdem.cli.main import app; "
    code += "app(standalone_mode=False); print(*sys.modules)"
    loaded = subprocess.check_output([sys.executable, "-c", code], text=True, cwd=tmp_path).splitlines()[-1].split()
    assert "epdem.impacts.prediction" in loaded
    assert not {"pandas", "matplotlib", "h5py", "jinja2", "pint", "psutil", "tomlkit"} & {*loaded}


@pytest.mark.parametrize("module", ["epdem.theory", "epdem.laws.library", "epdem.laws.strengths"])
def test_theory_and_laws_import_numpy_alone(module):
    """Of all packages of the environment: what is not Python's own and lies in no folder of numpy or epdem."""
    code = f"import sys, {module}; print(*(n for n in sys.modules if '.' not in n and not n.startswith('_')))"
    loaded = {*subprocess.check_output([sys.executable, "-c", code], text=True).split()}
    assert loaded - {*sys.stdlib_module_names} <= {"epdem", "numpy", "cython_runtime", "sitecustomize"}


def test_a_run_of_impacts_imports_nothing_of_scipy(tmp_path):
    """scipy.stats alone takes longer than the impacts."""
    case = Path(__file__).parents[2] / "cases/steel_wall.toml"
    words = ["epdem", "run", str(case), "-e", "embedded"]
    code = f"import sys; sys.argv = {words!r}; from epdem.cli.main import app; app(standalone_mode=False)"
    code += "; print(*sys.modules)"
    said = subprocess.check_output([sys.executable, "-c", code], text=True, cwd=tmp_path)
    loaded = said.splitlines()[-1].split()
    assert "epdem.impacts.run" in loaded and not [name for name in loaded if name.startswith("scipy")]
