# SPDX-License-Identifier: GPL-2.0-or-later
"""Whatever a case file, an option or a template holds: it is done, or one sentence says what is wrong; no traceback."""

import contextlib
import io
import json
import re
import sys
import tempfile
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import CASES, FILES, cases, damaged, numbers, quantities, toml, values, words

from epdem.case import impact, scene
from epdem.case.plausibility import case_warnings
from epdem.case.toml import read_toml
from epdem.cli import main as cli
from epdem.engines.yade import deck as scene_deck
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.plan import plan
from epdem.impacts.prediction import COLUMNS, predict
from epdem.scenes.plan.plan import plan as plan_scene
from epdem.tools.own_decks import write
from stored_decks import checked_deck

FOREIGN = re.compile(r"Input should|should have|Field required|valid (number|string|list)|function-|pydantic|Traceback")


def one_sentence(text: str) -> None:
    assert text.strip() and "\n" not in text.strip() and len(text) < 1000 and not FOREIGN.search(text), text


def carried_out(data: dict) -> None:
    """All that a case leads to without an engine. Raises CaseError."""
    if scene.is_scene(data):
        p = plan_scene(scene.parse(data))
        for sentence in case_warnings(p.case):
            one_sentence(sentence)
        assert all(checked_deck(p).values())
        if p.case.scene["count"] <= 2000:
            scene_deck.files(p)
        return
    x = experiment(impact.parse(data))
    found = predict(x)
    for name in COLUMNS:
        sticks = (found.e_n == 0) if name == "contact_time" else False  # and never parts
        assert (np.isfinite(getattr(found, name)) | sticks).all(), name
    assert plan(x, found).time_step > 0


@given(cases())
def test_a_case_is_carried_out_or_refused_by_one_sentence(data):
    try:
        carried_out(data)
    except CaseError as error:
        one_sentence(str(error))


@given(st.sampled_from(FILES).flatmap(lambda path: damaged(path.read_bytes())))
def test_a_damaged_file_is_read_or_refused_by_one_sentence(raw):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.toml"
        path.write_bytes(raw)
        try:
            carried_out(read_toml(path))
        except CaseError as error:
            one_sentence(str(error))


material = st.fixed_dictionaries(
    {
        "young_modulus": st.one_of(quantities, st.floats(-3, 33).map(lambda p: f"1e{p:.0f} Pa")),
        "poisson_ratio": st.one_of(numbers, st.floats(-1, 0.5)),
        "density": st.one_of(quantities, st.floats(-9, 20).map(lambda p: f"1e{p:.0f} kg/m^3")),
    },
    optional={
        "yield_stress": st.one_of(quantities, st.floats(-3, 33).map(lambda p: f"1e{p:.0f} Pa")),
        "from": st.one_of(st.sampled_from(["steel", "ice"]), words),
    },
)


@given(material, st.floats(-12, 6), st.floats(-20, 12), st.sampled_from(["hertz", "thornton", "johnson", "cavity"]))
def test_any_material_of_any_size_at_any_speed_has_finite_numbers_or_is_refused(entry, size, speed, law):
    body = {"radius": f"{10**size:.6g} m", "material": "m"}
    data = {
        "case": {"name": "x", "title": "x", "source": "x"},
        "materials": {"m": entry},
        "impact": {
            "kind": "sphere-wall",
            "body": body,
            "target": {"material": "m"},
            "speeds": [f"{10**speed:.6g} m/s"],
        },
        "law": {"name": law},
    }
    try:
        carried_out(data)
    except CaseError as error:
        one_sentence(str(error))


COMMANDS = ["predict", "deck", "soften", "calibrate", "export", "status", "sweep", "points", "run", "nothing"]
OPTIONS = ["-o", "--out", "-e", "--law", "-l", "--json", "--set", "-k", "--hv", "--e-n", "--speed", "--case", "--force"]
OPTIONS += ["--points", "--seed", "--latin-hypercube", "--radius", "--material", "--table", "--task", "-h", "--", "-"]
OPTIONS += [""]
THINGS = ["steel.toml", "scene.toml", "own.j2", "nowhere", "out", "embedded", "thornton", "cavity", "0.5", "-1"]
THINGS += ["1e400", "=", "a=b", ".", "/dev/null", "steel", "2 m/s", "impact.body.radius=1 mm..2 mm:3"]
THINGS += ["law.name=hertz,cavity"]
arguments = st.lists(st.one_of(st.sampled_from(OPTIONS + THINGS), quantities, words), max_size=6)


def called(argv: list[str]) -> tuple[int, str]:
    """(exit code, standard error) of the command in this process."""
    error = io.StringIO()
    with (
        mock.patch.object(sys, "argv", ["epdem", *argv]),
        mock.patch("signal.signal"),
        contextlib.redirect_stdout(io.StringIO()),
        contextlib.redirect_stderr(error),
        pytest.raises(SystemExit) as ended,
    ):
        cli.main()
    return ended.value.code or 0, error.getvalue()


@given(st.sampled_from(COMMANDS), st.sampled_from(["steel.toml", "scene.toml", "own.j2", ""]), arguments)
def test_any_command_line_is_carried_out_or_refused_by_one_sentence(command, file, more):
    more = ["-e", "embedded", *more] if command == "run" else more
    more = ["--dry-run", *more] if command == "sweep" else more
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        steel = (CASES / "steel_wall.toml").read_text()
        Path("steel.toml").write_text(re.sub("speeds = .*", 'speeds = ["5 m/s"]', steel))
        Path("scene.toml").write_bytes((CASES / "settle_glass.toml").read_bytes())
        Path("own.j2").write_text("{{ deck.plan.time_step }}\n")
        before = sorted(map(str, Path().iterdir()))
        code, said = called([w for w in [command, file, *more] if "\0" not in w])
        assert code in (0, 1, 2, 3), code
        if code == 2 and said.count("\n") > 1:
            assert said.lstrip().startswith("Usage"), said  # without arguments: the help
        elif code == 2:
            one_sentence(said)
            assert sorted(map(str, Path().iterdir())) == before


PIECES = ["{{ deck.plan.time_step }}", "{% for i in range(9) %}", "{% endfor %}", "{{ a }}", "{{ 1/0 }}", "{% if a %}"]
PIECES += ["{#", "{{", "}}", "{% include 'own.j2' %}", "{% endif %}", "{{ deck.__class__ }}", "{{ ''.join(case) }}"]
PIECES += ["run 1\n", "{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}", "{% set x = deck %}", "{{ x.y.z }}"]
PIECES += ["{% import 'liggghts/macros.j2' as m %}", "{{ case.materials | length }}", "{{ deck.head.title | upper }}"]
PIECES += ["{% raw %}"]


@given(
    st.lists(st.one_of(st.sampled_from(PIECES), words), max_size=6).map("".join), st.dictionaries(words, st.integers())
)
def test_any_template_is_filled_or_refused_by_one_sentence(text, sets):
    with tempfile.TemporaryDirectory() as folder:
        template, out = Path(folder) / "own.j2", Path(folder) / "out"
        template.write_text(text, encoding="utf-8")
        try:
            write(template, CASES / "steel_wall.toml", dict(sets), out)
        except CaseError as error:
            one_sentence(str(error))
            assert not out.exists()


@given(values)
def test_a_quantity_is_a_number_or_a_sentence(value):
    from epdem.case.units import to_si

    for unit in ("m", "1"):
        try:
            assert np.isfinite(to_si(value, unit))
        except ValueError as error:
            assert str(error)


@given(cases())
def test_what_is_written_as_toml_is_read_as_the_same_case(data):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.toml"
        try:
            path.write_text(toml(data), encoding="utf-8")
        except (ValueError, TypeError):  # tomlkit's own limits on keys and numbers
            return
        assert json.dumps(read_toml(path), sort_keys=True) == json.dumps(data, sort_keys=True)
