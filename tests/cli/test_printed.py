# SPDX-License-Identifier: GPL-2.0-or-later
"""A run that is stored is printed again at once, and only while nothing that it depends on has changed."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from epdem.case import units
from epdem.cli import printed
from epdem.cli.printed import NAME, Printed

CASE = Path(__file__).parents[2] / "cases/steel_wall.toml"
EPDEM = str(Path(sys.executable).parent / "epdem")
RUN = (
    "import sys\nfrom epdem.cli.main import main\ntry:\n    main()\nfinally:\n    print(*sys.modules, file=sys.stderr)"
)


def run(place: Path, *more: str) -> subprocess.CompletedProcess[str]:
    words = ["run", "steel.toml", "-e", "embedded", "-o", "out", *more]
    return subprocess.run([sys.executable, "-c", RUN, *words], cwd=place, capture_output=True, text=True)


@pytest.fixture
def place(tmp_path):
    shutil.copy(CASE, tmp_path / "steel.toml")
    return tmp_path


def test_a_stored_run_is_printed_again_without_the_libraries_of_the_first(place):
    first, again = run(place), run(place)
    assert first.returncode == again.returncode == 0
    *table, summary = first.stdout.splitlines()
    said = summary.replace("; see out/report", " (1 of 1 from out/results.h5); see out/report")
    assert again.stdout.splitlines() == [*table, said]
    assert "pandas" in first.stderr.split() and not {"numpy", "pandas", "pint"} & set(again.stderr.split())
    (place / "out" / NAME).unlink()
    assert run(place).stdout == again.stdout
    assert [json.loads(run(place, "--json").stdout)["passed"] for _ in range(2)] == [True, True]


def test_whatever_has_changed_the_command_does_its_work(place, monkeypatch):
    out = place / "out"
    out.mkdir()
    (out / "results.csv").write_text("1")
    case = place / "steel.toml"

    def asked(*facts):
        return Printed(case, out, *facts).again()

    Printed(case, out, "thornton").keep("text\n", 1)
    assert asked("thornton") == ("text\n", 1) and asked("cavity") is None
    for name, value in (("NO_COLOR", "1"), ("EPDEM_LAUNCHER", "/x"), ("PATH", "/usr/bin")):
        with monkeypatch.context() as changed:
            changed.setenv(name, value)
            assert asked("thornton") is None, name
    with monkeypatch.context() as changed:
        changed.setattr("epdem.base.stages.product_hash", lambda: "another")
        assert asked("thornton") is None
        changed.undo()
        changed.setattr(printed, "INSTALLED", case)  # a package came or went
        assert asked("thornton") is None
    program = place / "yade"
    program.touch()
    monkeypatch.setenv("EPDEM_YADE", str(program))
    Printed(case, out, "thornton").keep("text\n", 1)
    assert asked("thornton") is not None
    os.utime(program, (1, 1))  # another version under the same name
    assert asked("thornton") is None
    monkeypatch.delenv("EPDEM_YADE")
    Printed(case, out, "thornton").keep("text\n", 1)
    (out / ".epdem.lock").touch()
    assert asked("thornton") is None
    (out / ".epdem.lock").unlink()
    assert asked("thornton") is not None
    (out / "results.csv").write_text("2")
    assert asked("thornton") is None
    (out / "results.csv").unlink()
    assert asked("thornton") is None
    Printed(case, out).keep("text\n", 0)
    assert asked() is not None
    case.write_text(case.read_text() + "\n")
    assert asked() is None


def test_a_scene_and_a_file_that_is_no_case_have_nothing_of_the_kind(tmp_path):
    for text in ("[scene]\n[case]\nname='x'\n", "no toml", "[case]\n"):
        (tmp_path / "x.toml").write_text(text)
        found = Printed(tmp_path / "x.toml", None)
        found.keep("text", 0)
        assert found.again() is None and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("si", ["m", "s", "Pa", "J/m^3", "m/s", "m/s^2", "rad", "rad/s", "Hz", "N", "J", "kg/m^3"])
def test_a_prefix_read_without_pint_is_that_of_pint(si):
    for prefix in ("", *units.PREFIXES):
        try:
            expected = units._by_pint(prefix + si, si)
        except ValueError:
            expected = None
        try:
            value = units._factor(prefix + si, si)
        except ValueError:
            value = None
        assert value == (expected and pytest.approx(expected, rel=1e-15)), prefix  # Pint 0.24 rounds 1 nPa
