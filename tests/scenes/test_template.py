# SPDX-License-Identifier: GPL-2.0-or-later
"""Own templates: the case's values and our macros, so that a wall cannot have another model than the pairs."""

import subprocess
import sys
from pathlib import Path

import pytest

from epdem.base import paths
from epdem.errors import CaseError
from epdem.tools.own_decks import settings, write

ROOT = Path(__file__).parents[2]
SETTLE, STEEL = ROOT / "cases/settle_glass.toml", ROOT / "cases/steel_wall.toml"

OWN = """{% import "liggghts/macros.j2" as macros %}
units si
atom_style granular
boundary f f f
newton off
communicate single vel yes
region box block -0.01 0.01 -0.01 0.01 0 {{ height }} units box
create_box {{ deck.plan.types | length }} box
neighbor {{ deck.skin | number }} bin
neigh_modify delay 0
{{ macros.properties(deck) }}
{{ macros.pair(deck) }}
{{ macros.wall(deck, "bottom", "primitive type 1 zplane 0.0") }}
fix motion all nve/sphere
fix gravity all gravity 9.81 vector 0 0 -1
timestep {{ deck.plan.time_step | number }}
create_atoms 1 single 0 0 {{ 0.5 * height }} units box
set group all diameter 0.002 density 2500
thermo {{ steps }}
run {{ steps }}
"""


@pytest.fixture
def own(tmp_path):
    path = tmp_path / "own.in.j2"
    path.write_text(OWN)
    return path


@pytest.mark.liggghts
def test_a_deck_of_ones_own_runs_with_the_materials_and_the_model_of_a_case(own, tmp_path):
    files = write(own, SETTLE, settings({"height": "0.02", "steps": "500"}), tmp_path / "out")
    assert [f.name for f in files] == ["own.in"]
    done = subprocess.run([str(paths.launcher()), "-in", "own.in"], cwd=tmp_path / "out", capture_output=True)
    assert done.returncode == 0, done.stdout[-500:]


def test_pair_and_wall_of_ones_own_deck_have_one_model(own, tmp_path):
    text = write(own, SETTLE, settings({"height": "0.02", "steps": "1"}), tmp_path / "out")[0].read_text()
    pair = next(x for x in text.splitlines() if x.startswith("pair_style gran "))
    wall = next(x for x in text.splitlines() if "wall/gran" in x)
    model = pair.removeprefix("pair_style gran ")
    assert model == "model ep/thornton tangential history computePlasticWork on computeContactStrain on"
    # settings stand at the end of a line, so a wall's place comes between
    assert wall.endswith(f"wall/gran {model.replace(' compute', ' primitive type 1 zplane 0.0 compute', 1)}")


@pytest.mark.parametrize(
    ("text", "given", "words"),
    [
        (OWN, {"height": "0.02"}, "'steps' is undefined"),
        (OWN, {"height": "0.02", "steps": "1", "hieght": "3"}, "hieght"),
        ("{{ deck.friction_of_the_moon }}", {}, "friction_of_the_moon"),
    ],
)
def test_a_name_that_only_one_of_template_and_call_has_stops(text, given, words, own, tmp_path):
    own.write_text(text)
    with pytest.raises(CaseError, match=words):
        write(own, SETTLE, settings(given), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_an_impact_case_brings_its_data_file(own, tmp_path):
    own.write_text("read_data impact.data\n")
    files = write(own, STEEL, {}, tmp_path / "out")
    assert [f.name for f in files] == ["own.in", "impact.data"]


@pytest.mark.parametrize("key", ["3", "a b", "deck"])
def test_settings_that_are_none_are_refused(key):
    with pytest.raises(CaseError, match="--set"):
        settings({key: "1"})


def test_settings_read_as_numbers_where_they_are_numbers():
    assert settings({"a": "1", "b": "1e-3", "c": "top"}) == {"a": 1, "b": 1e-3, "c": "top"}


@pytest.mark.parametrize("text", ["1\nshell rm -rf x", "a & b", "tab\there", "line\u2028end", "\r", "\x00"])
def test_a_setting_that_would_begin_or_join_lines_is_refused(text):
    with pytest.raises(CaseError, match=r"--set height: .* leave out line ends"):
        settings({"height": text})


# What a template of somebody else may try, and what of the sentence names it.
HOSTILE = {
    "{{ cycler.__init__.__globals__.os.popen('touch HERE/pwned') }}": "unsafe",
    "{{ deck.__class__.__mro__ }}": "unsafe",
    "{{ case.parse_raw('x', proto='pickle', allow_pickle=True) }}": "not safely callable",
    "{{ deck.plan.time_step.tofile('HERE/pwned') }}": "no attribute 'tofile'",
    "{% include '../outside.j2' %}": "outside.j2 is not in",
    "{% include '/etc/hostname' %}": "is not in",
    "{{ 1/0 }}": "division by zero",
    "{{ 'a' + 1 }}": "can only concatenate str",
    "{{ 'abc' | number }}": "could not convert string to float",
    "{{ nothing_of_the_kind }}": "'nothing_of_the_kind' is undefined",
    "{% for i in range(9) %}": "Unexpected end of template",
    "{{ 'x' | no_such_filter }}": "No filter named 'no_such_filter'",
    "{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}": "recursion depth",
}


@pytest.mark.parametrize("text", HOSTILE)
def test_a_template_runs_no_python_reads_no_foreign_file_and_its_mistakes_name_file_and_line(text, tmp_path):
    home = tmp_path / "home"
    home.mkdir()
    (tmp_path / "outside.j2").write_text("secret")
    own = home / "own.in.j2"
    own.write_text("# first line\n" + text.replace("HERE", str(tmp_path)) + "\n")
    with pytest.raises(CaseError) as error:
        write(own, STEEL, {}, tmp_path / "out")
    sentence = str(error.value)
    assert sentence.startswith((f"{own}:2: ", f"{own}:3: ")) and HOSTILE[text] in sentence, sentence
    assert "\n" not in sentence
    assert not (tmp_path / "out").exists() and not (tmp_path / "pwned").exists()


def test_a_template_may_take_in_its_neighbours_and_a_mistake_there_names_them(tmp_path):
    (tmp_path / "part.j2").write_text("thermo {{ rows }}\n{{ oops }}\n")
    own = tmp_path / "own.in.j2"
    own.write_text("{% include 'part.j2' %}")
    with pytest.raises(CaseError, match=r"part\.j2:2: 'oops' is undefined"):
        write(own, STEEL, {"rows": 7}, tmp_path / "out")
    (tmp_path / "part.j2").write_text("thermo {{ rows }}\n")
    assert write(own, STEEL, {"rows": 7}, tmp_path / "out")[0].read_text() == "thermo 7\n"


def test_the_command_ends_with_2_and_the_sentence(tmp_path):
    own = tmp_path / "own.in.j2"
    own.write_text("{{ deck.plan.experiment.title.nothing }}")
    words = [sys.executable, "-m", "epdem", "deck", "own.in.j2", "--case", str(STEEL), "--out", "out"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.startswith("epdem: own.in.j2:1: "), done.stderr
    assert done.stderr.count("\n") == 1
