# SPDX-License-Identifier: GPL-2.0-or-later
"""Linter, formatters and type checker find nothing."""

import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).parents[2]
# ruff finds scripts without a suffix only by name
SCRIPTS = [str(p) for p in sorted((ROOT / "scripts").iterdir()) if p.read_text().startswith("#!/usr/bin/env python3")]
FOLDERS = ["python", "tests", "bench", "docs", *SCRIPTS]
CPP = ["cpp_contact", "tests", "bench"]


def tool(*command: str) -> subprocess.CompletedProcess[str]:
    """Run a tool of the environment at the root of the project."""
    path = f"{ROOT}/.venv/bin:/usr/bin:/bin"
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env={"PATH": path})


def test_lint_is_clean():
    done = tool("ruff", "check", "--output-format", "concise", *FOLDERS)
    assert done.returncode == 0, done.stdout


def test_layout_is_the_formatters():
    done = tool("ruff", "format", "--check", *FOLDERS)
    assert done.returncode == 0, done.stdout


def test_layout_of_cpp_is_the_formatters():
    files = [str(f) for folder in CPP for f in sorted((ROOT / folder).rglob("*")) if f.suffix in {".hpp", ".h", ".cpp"}]
    assert len(files) > 30
    done = tool("clang-format", "--dry-run", "--Werror", *files)
    assert done.returncode == 0, done.stderr


def test_clang_tidy_finds_nothing_in_the_laws():
    """In one source that uses every header of the laws; `make tidy` looks at all of C++, in minutes."""
    flags = ["-std=c++17", "-Icpp_contact/include", '-DEPDEM_VERSION=""']
    done = tool("clang-tidy", "--quiet", "cpp_contact/capi/epdem.cpp", "--", *flags)
    assert done.returncode == 0, done.stdout


def test_types_are_complete_in_the_whole_package():
    done = tool("mypy")
    assert done.returncode == 0, done.stdout + done.stderr
    checked = int(re.search(r"no issues found in (\d+) source files", done.stdout)[1])
    assert checked >= len(list((ROOT / "python").rglob("*.py")))
