# SPDX-License-Identifier: GPL-2.0-or-later
"""Linter, formatter and type checker find nothing."""

import functools
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ["python", "tests", "bench", "docs"]
# What `mypy --strict` finds nothing in; the aim is the whole package.
TYPED = ["errors", "paths", "files", "processes", "rendering", "case/impact", "case/scene", "laws/library", "engines/"]
TYPED += ["case/messages", "terminal", "studies/", "cli/", "scenes/report"]
TYPED += [f"impacts/{name}." for name in ("report", "foreign", "pairs", "timestep")]
TYPED += ["liggghts/", "lammps/", "data_file", "impacts/engine", "impacts/places"]


def tool(*command: str) -> subprocess.CompletedProcess[str]:
    """Run a tool of the environment at the root of the project."""
    path = f"{ROOT}/.venv/bin:/usr/bin:/bin"
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env={"PATH": path})


@functools.cache
def types() -> subprocess.CompletedProcess[str]:
    return tool("mypy")


def test_lint_is_clean():
    done = tool("ruff", "check", "--output-format", "concise", *FOLDERS)
    assert done.returncode == 0, done.stdout


def test_layout_is_the_formatters():
    done = tool("ruff", "format", "--check", *FOLDERS)
    assert done.returncode == 0, done.stdout


def test_the_type_checker_reads_the_whole_package():
    assert re.search(r"checked (\d+) source files", types().stdout), types().stdout + types().stderr
    checked = int(re.search(r"checked (\d+) source files", types().stdout)[1])
    assert checked >= len(list((ROOT / "python").rglob("*.py")))


@pytest.mark.parametrize("place", TYPED)
def test_types_are_complete(place):
    found = [line for line in types().stdout.splitlines() if line.startswith(f"python/epdem/{place}")]
    assert not found, "\n".join(found)
