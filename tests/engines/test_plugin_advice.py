# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks of others with a law in place of `hertz`: the log says what no longer acts, and converted decks run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from plugin_decks import good
from tutorials import FOLDER, archive, need_source, rewritten, unpacked

from epdem.tools.convert import convert
from marks import thorough

pytestmark = pytest.mark.liggghts
DOCS = Path(__file__).parents[2] / "docs"
# a deck as the tutorials are, two spheres on a floor; {words} of the models
TUTORIAL = """atom_style granular
atom_modify map array
boundary m m m
newton off
communicate single vel yes
units si
hard_particles yes
region reg block -0.05 0.05 -0.05 0.05 0. 0.15 units box
create_box 1 reg
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {E}
fix m2 all property/global poissonsRatio peratomtype 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.9
fix m4 all property/global coefficientFriction peratomtypepair 1 0.05
fix m5 all property/global yieldPressure peratomtype {p_y}
pair_style gran model {words}
pair_coeff * *
timestep 0.00001
fix zwalls1 all wall/gran model {words} primitive type 1 zplane 0.0
create_atoms 1 single 0 0 0.006 units box
set group all diameter 0.01 density 2500
fix integr all nve/sphere
run 2
run 2
"""


def advice(folder, **values):
    """The lines of a run that begin with the name of the model."""
    words = values.pop("words", "ep/thornton tangential history")
    text = good(folder, TUTORIAL.format(words=words, **values)).text
    return [line for line in text.splitlines() if line.startswith("epdem: ep/")]


def test_the_log_says_once_that_a_contact_does_not_yield_and_what_the_restitution_is_for(tmp_path):
    """E* = 5e6/(2 (1 - 0.45^2)) = 3.135 MPa of a tutorial, with the strength of steel."""
    strength, restitution = advice(tmp_path / "a", E=5e6, p_y=2.8e9)
    assert "yieldPressure of types 1 and 1 is 893.2 E*, above 0.1 E*" in strength and "youngsModulus" in strength
    assert "coefficientRestitution acts on the tangential dashpot only" in restitution and "viscous on" in restitution


@pytest.mark.parametrize(("p_y", "lines"), [(3.13e5, 1), (3.14e5, 2), (1e30, 1)])
def test_the_line_on_the_strength_comes_above_a_tenth_of_the_modulus_but_not_for_rigid_bodies(tmp_path, p_y, lines):
    assert len(advice(tmp_path, E=5e6, p_y=p_y)) == lines


def test_a_normal_dashpot_needs_no_line_and_without_friction_the_restitution_has_no_effect(tmp_path):
    deck = TUTORIAL.replace("gran model {words}\n", "gran model {words} viscous on\n").replace(
        "zplane 0.0", "zplane 0.0 viscous on"
    )
    text = good(tmp_path / "a", deck.format(words="ep/thornton tangential history", E=2e11, p_y=1e9)).text
    assert "coefficientRestitution" not in text
    (line,) = advice(tmp_path / "b", E=2e11, p_y=1e9, words="ep/thornton tangential off")
    assert "coefficientRestitution has no effect" in line


@pytest.mark.parametrize("name", [thorough("packing/in.packing"), "cohesion/in.noCohesion"])
def test_a_converted_tutorial_runs_and_yields(name, tmp_path):
    need_source()
    (tmp_path / "deck").mkdir()
    unpacked(name, tmp_path / "deck")
    path = tmp_path / "deck" / name.split("/")[1]
    words = ["deck", "--convert", path, "--set", "yieldPressure=1e5", "-o", tmp_path / "new"]
    done = subprocess.run([sys.executable, "-m", "epdem", *words], capture_output=True, text=True)
    assert done.returncode == 0 and "contact models are ep/thornton now" in done.stderr, done.stderr
    new = (tmp_path / "new" / path.name).read_text()
    assert "model hertz" not in re.sub("#.*", "", new)
    short = rewritten(new, "ep/thornton", 300, 100)
    assert " ep/thornton" in good(tmp_path / "deck", short).text


def test_every_public_tutorial_is_converted_or_refused_with_its_line():
    need_source()
    import tarfile

    converted = 0
    with tarfile.open(archive()) as tar:
        decks = [m for m in tar.getmembers() if m.name.startswith(FOLDER) and "/in." in m.name and m.isfile()]
        for member in decks:
            text = tar.extractfile(member).read().decode()
            try:
                done = convert(text, "thornton", {"yieldPressure": "1e5"}, Path(member.name))
            except Exception as error:
                assert str(error).startswith(member.name) and "\n" not in str(error)
                assert not re.search(r"(?m)^(pair_style|fix).*gran.*model\s+hertz", text), member.name
                continue
            converted += 1
            plain = re.sub("#.*", "", done.text)
            assert not re.search(r"model\s+(hertz|hooke)\b", plain) and plain.count("epdem_yieldPressure") == 1
    assert converted >= 14 and len(decks) >= 20


def test_the_wall_line_of_the_page_is_accepted(tmp_path):
    """Settings stand after the geometry."""
    (line,) = re.findall(r"(?m)^fix wall all wall/gran .* viscous on.*$", (DOCS / "liggghts.md").read_text())
    deck = TUTORIAL.replace("fix zwalls1 all wall/gran model {words} primitive type 1 zplane 0.0", line)
    good(tmp_path, deck.format(words="ep/thornton tangential history viscous on", E=2e11, p_y=1e9))
