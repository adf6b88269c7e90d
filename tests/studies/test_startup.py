# SPDX-License-Identifier: GPL-2.0-or-later
"""What is slow to import is imported by what needs it, so that help and refusals come at once."""

import subprocess
import sys
from pathlib import Path

import pytest

SLOW = ("numpy", "pandas", "pydantic", "pint", "h5py", "jinja2", "matplotlib", "tomlkit", "submitit")


@pytest.mark.parametrize("module", ["epdem", "epdem.verification.cli"])
def test_nothing_slow_is_imported_before_a_command_needs_it(module):
    code = f"import sys, {module}; print(*sys.modules)"
    loaded = subprocess.check_output([sys.executable, "-c", code], text=True).split()
    assert module in loaded and not [name for name in SLOW if name in loaded]


def test_a_run_of_impacts_imports_nothing_of_scipy(tmp_path):
    """scipy.stats alone takes longer than the impacts."""
    case = Path(__file__).parents[2] / "cases/steel_wall.toml"
    words = ["epdem", "run", str(case), "-e", "embedded"]
    code = f"import sys; sys.argv = {words!r}; from epdem.cli.main import app; app(standalone_mode=False)"
    code += "; print(*sys.modules)"
    said = subprocess.check_output([sys.executable, "-c", code], text=True, cwd=tmp_path)
    loaded = said.splitlines()[-1].split()
    assert "epdem.impacts.run" in loaded and not [name for name in loaded if name.startswith("scipy")]
