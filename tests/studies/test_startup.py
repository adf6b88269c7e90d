# SPDX-License-Identifier: GPL-2.0-or-later
"""What is slow to import is imported by what needs it, so that help and refusals come at once."""

import subprocess
import sys

import pytest

SLOW = ("numpy", "pandas", "pydantic", "pint", "h5py", "jinja2", "matplotlib", "tomlkit", "submitit")


@pytest.mark.parametrize("module", ["epdem", "epdem.cli.main"])
def test_nothing_slow_is_imported_before_a_command_needs_it(module):
    code = f"import sys, {module}; print(*sys.modules)"
    loaded = subprocess.check_output([sys.executable, "-c", code], text=True).split()
    assert module in loaded and not [name for name in SLOW if name in loaded]
