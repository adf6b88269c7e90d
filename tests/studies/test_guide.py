# SPDX-License-Identifier: GPL-2.0-or-later
"""The guide: every block runs as it stands, columns and exit codes are explained, the site builds without a warning."""

import importlib.util
import re
import subprocess
import sys

import pandas as pd
import pytest
from test_pages import ROOT, blocks, play

import epdem
from epdem.errors import CaseError, EngineError

spec = importlib.util.spec_from_file_location("guide", ROOT / "docs/guide.py")
guide = importlib.util.module_from_spec(spec)
spec.loader.exec_module(guide)
PAGES = ("tutorial", "choose", "results", "faq")
TOOLS = [name for name in ("mkdocs", "latex2mathml") if importlib.util.find_spec(name) is None]


@pytest.mark.liggghts
def test_every_block_of_the_guide_runs(tmp_path):
    for page in PAGES:
        play(blocks(page), tmp_path)
    found = pd.read_csv(tmp_path / "runs/ball/results.csv")
    assert len(found) == 24 and found["passed"].all() and (tmp_path / "runs/ball/report.html").exists()
    said = set(re.findall(r"`(\w+)`", (ROOT / "docs/results.md").read_text()))
    for name in found:
        assert re.sub(r"_(theory|error|rms)$", "", name) in said, name


def test_pages_that_run_are_in_the_tour_and_hold_blocks():
    assert all(len(blocks(page)) >= 1 for page in PAGES) and len(blocks("tutorial")) >= 6
    nav = (ROOT / "docs/mkdocs.yml").read_text()
    for path in (ROOT / "docs").glob("*.md"):
        assert path.name in nav, f"docs/mkdocs.yml does not have {path.name}"


def test_the_reference_names_every_command_and_what_the_package_offers():
    commands, python = guide.commands(), guide.python()
    for name in ("run", "crosscheck", "sweep", "rerun", "header"):
        assert f"## epdem {name}\n" in commands
    assert "| `--full` |" in commands and "points" not in re.findall(r"## epdem (\w+)", commands)
    assert {f"## {name}" for name in epdem.__all__} <= set(python.splitlines())
    errors = (ROOT / "docs/errors.md").read_text()
    assert all(f"| {code} |" in errors for code in (0, 1, CaseError.exit_code, EngineError.exit_code, 130))


def test_equations_become_mathml_and_code_stays():
    text = "of $a^2$ and `$HOME`\n\n    echo $PATH and $x\n\n$$b$$\n"
    found = guide.mathematics(text, lambda latex, display="inline": f"<{display}:{latex}>")
    assert found.splitlines()[0] == "of <span><inline:a^2></span> and `$HOME`"
    assert "    echo $PATH and $x\n" in found and "<p><block:b></p>" in found


@pytest.mark.skipif(bool(TOOLS), reason=f"{', '.join(TOOLS)} not installed; 'make guide' installs it")
def test_the_site_builds_without_a_warning():
    done = subprocess.run([sys.executable, ROOT / "docs/guide.py"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    page = (ROOT / "runs/guide/site/theory.html").read_text()
    assert page.count("<math") > 60 and not re.search(r'(?:src|href)="https?://(?!squidfunk)', page)
