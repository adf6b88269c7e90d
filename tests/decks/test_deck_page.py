# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/decks.md, the page for programs that write decks: it is up to date, and its lines and commands run."""

import importlib.util
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from epdem.engines.lammps import launcher
from epdem.engines.liggghts import launcher as liggghts

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))
spec = importlib.util.spec_from_file_location("decks", ROOT / "docs/decks.py")
decks = importlib.util.module_from_spec(spec)
spec.loader.exec_module(decks)
PAGE = decks.PAGE.read_text()
BLOCKS = re.findall(r"^```(\S+).*?\n(.*?)^```$", PAGE, re.M | re.S)
# the page's two lines, and the lines that any deck has
LIGGGHTS = (ROOT / "docs/liggghts.md").read_text()
LAMMPS = """units si
atom_style sphere
boundary f f f
comm_modify vel yes
region box block -1 1 -1 1 -1 1
create_box 1 box
create_atoms 1 single 0 0 0
create_atoms 1 single 0.0099 0 0
set group all diameter 0.01 density 7850
timestep 1e-8
{lines}fix move all nve/sphere
run 1
"""


def block(kind, *words):
    (text,) = (text for language, text in BLOCKS if language == kind and all(word in text for word in words))
    return text


def test_the_page_is_up_to_date():
    assert decks.page() == PAGE, "run .venv/bin/python docs/decks.py"
    assert len(PAGE.splitlines()) < 90


@pytest.mark.thorough
def test_the_commands_of_the_page_run(tmp_path):
    shutil.copytree(ROOT / "cases", tmp_path / "cases")
    deck = next(text for text in re.findall(r"^```deck\n(.*?)^```$", LIGGGHTS, re.M | re.S) if "run " in text)
    (tmp_path / "my.in").write_text(re.sub(".*yieldPressure.*\n", "", deck).replace("ep/thornton", "hertz"))
    for line in block("sh", "doctor").splitlines():
        words = shlex.split(line, comments=True)
        if "doctor" in words or ("-e" in words and launcher.missing()):
            continue  # exit code 1 without engines
        done = subprocess.run([sys.executable, "-m", *words], cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0, f"{line}\n{done.stderr}"
        if "--json" in words:
            json.loads(done.stdout)
    assert "model ep/thornton" in (tmp_path / "converted/my.in").read_text()


@pytest.mark.lammps
def test_lammps_takes_the_lines_of_the_page_and_names_what_is_wrong(tmp_path):
    lines = block("text", "pair_coeff")
    for name, text in (("right", lines), ("wrong", lines.replace("2.8e9", "-1"))):
        (tmp_path / name).mkdir()
        (tmp_path / name / "in.deck").write_text(LAMMPS.format(lines=text))
        command = launcher.command("in.deck")
        done = subprocess.run(command, cwd=tmp_path / name, env=launcher.environment(), capture_output=True, text=True)
        said = done.stdout + done.stderr
        assert done.returncode == (name == "wrong"), said
        assert name == "right" or re.search("ERROR: .*p_y .*= -1, must be > 0", said), said


@pytest.mark.liggghts
def test_liggghts_takes_the_lines_of_the_page_and_names_what_is_wrong(tmp_path):
    deck = next(text for text in re.findall(r"^```deck\n(.*?)^```$", LIGGGHTS, re.M | re.S) if "run " in text)
    for line in block("deck", "pair_style").splitlines():
        assert line in deck
    program, *words = liggghts.command("in.deck")
    for name, text in (("right", deck), ("wrong", deck.replace("2.8e9", "-1"))):
        (tmp_path / name).mkdir()
        (tmp_path / name / "in.deck").write_text(re.sub(r"^run .*", "run 1", text, flags=re.M))
        done = subprocess.run([program, *words], cwd=tmp_path / name, capture_output=True, text=True)
        said = done.stdout + done.stderr
        assert done.returncode == (name == "wrong"), said
        assert name == "right" or re.search("ERROR.*yieldPressure = -1", said), said
