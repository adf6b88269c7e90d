# SPDX-License-Identifier: GPL-2.0-or-later
"""Keys of a scene from numbers of its results: what is found, what is refused, and that no stored scene runs again."""

import json
import logging
import math
import subprocess
import sys
from pathlib import Path

import pytest
from test_sweep_scenes import BED

from epdem import Scene, calibrate
from epdem.errors import CaseError, EngineError, Stopped
from epdem.studies import fit as study

pytestmark = pytest.mark.liggghts
EPDEM = str(Path(sys.executable).parent / "epdem")
DENSITY = {"materials.glass.density": "1000 kg/m^3..4000 kg/m^3"}


def weight(count: int, density: float) -> float:
    """Of so many beads of 1 mm radius [N]."""
    return count * 4.0 / 3.0 * math.pi * 0.001**3 * density * 9.81


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A bed of 20 beads with smooth walls, and the folder of its points, which all tests share."""
    folder = tmp_path_factory.mktemp("fit")
    (folder / "bed.toml").write_text(BED.replace("count = 200", "count = 20").replace("0.3 s", "0.2 s"))
    return folder


def fit(place: Path, targets, free, **options) -> study.Fit:
    return study.fit(place / "bed.toml", targets, free, **({"out": place / "points", "jobs": 1} | options))


def stored(folder: Path) -> dict[str, bytes]:
    return {p.parent.name: p.read_bytes() for p in folder.glob("points/*/point.json")}


def test_a_floor_load_gives_the_density_and_nothing_stored_runs_again(place):
    target = weight(20, 1700.0)
    first = fit(place, {"floor_load_mean": target}, DENSITY)
    found = float(first.values["materials.glass.density"].split()[0])
    assert found == pytest.approx(1700.0, rel=0.04) and first.ran == first.points <= 8
    assert first.numbers["floor_load_mean"] == pytest.approx(target, rel=0.01)
    assert f"<td>{first.values['materials.glass.density']}</td>" in first._repr_html_()
    assert first.case.exists() and f'density = "{first.values["materials.glass.density"]}"' in first.case.read_text()
    before = stored(place / "points")
    again = fit(place, {"floor_load_mean": f"{target * 1e3!r} mN"}, DENSITY)
    assert again.ran == 0 and again.values == first.values and stored(place / "points") == before


def test_an_interrupted_fit_goes_on_to_the_same_result(place, tmp_path):
    def stop(done, total):
        if len(stored(tmp_path)) == 2:
            raise Stopped

    words = ({"floor_load_mean": weight(20, 1700.0)}, DENSITY)
    with pytest.raises(Stopped):
        fit(place, *words, out=tmp_path, report=stop)
    before = stored(tmp_path)
    assert len(before) == 2
    found, whole = fit(place, *words, out=tmp_path), fit(place, *words)
    assert found.ran == found.points - 2 and found.values == whole.values and found.numbers == whole.numbers
    assert {k: v for k, v in stored(tmp_path).items() if k in before} == before


@pytest.mark.thorough
def test_two_targets_give_two_keys(place, caplog):
    with caplog.at_level(logging.INFO, "epdem"):
        found = calibrate(
            Scene.from_toml(place / "bed.toml"),
            {"particles_last": 25, "floor_load_mean": weight(25, 3000.0)},
            DENSITY | {"scene.count": "10..30"},
            tolerance=0.06,
            out=place / "two",
            jobs=1,
        )
    assert "of 1 points" in caplog.text
    assert found.values["scene.count"] == pytest.approx(25, abs=1)
    assert float(found.values["materials.glass.density"].split()[0]) == pytest.approx(3000.0, rel=0.12)
    assert found.units == {"particles_last": "", "floor_load_mean": "N"}


@pytest.mark.parametrize(
    ("targets", "free", "words"),
    [
        ({"floor_loud": "1 N"}, DENSITY, "no such number; the nearest: floor_load"),
        (
            {"floor_load_mean": "1 N"},
            {"materials.glas.density": "1 kg/m^3..2 kg/m^3"},
            "--free.*materials.glass.density",
        ),
        ({"floor_load_mean": "1 kg"}, DENSITY, "wrong dimension.*write it as floor_load_mean=1 N"),
        ({"floor_load_mean": "0 N"}, DENSITY, "other than 0"),
        ({"floor_load_mean": "1 N"}, {"materials.glass.density": "1 kg/m^3..2 kg/m^3:5"}, "write its range as LOW"),
        ({"floor_load_mean": "1 N"}, {}, "a fit needs a --target NAME=VALUE, and one to 3 keys"),
        (
            {"floor_load_mean": "1 N"},
            {"materials.glass.poisson_ratio": "0.2..0.3"},
            "changes floor_load_mean by .* of the value, not more than --tolerance .* another",
        ),
        ({"floor_load_mean": "90 N"}, DENSITY, "floor_load_mean = 90 N is out of reach: .* nearest .* = 4000 kg/m"),
    ],
)
def test_what_cannot_be_found_is_refused_in_words(targets, free, words, place):
    with pytest.raises(CaseError, match=words):
        fit(place, targets, free)


def test_a_case_of_impacts_has_no_such_numbers(place):
    steel = Path(__file__).parents[2] / "cases/steel_wall.toml"
    with pytest.raises(CaseError, match="for impacts give --e-n"):
        study.fit(steel, {"floor_load_mean": "1 N"}, DENSITY)


def test_a_scene_that_fails_ends_the_fit_with_its_reason(place, monkeypatch, tmp_path):
    from epdem.engines.liggghts.engine import Liggghts

    def fails(*words, **named):
        raise EngineError("out of glass")

    monkeypatch.setattr(Liggghts, "run", fails)
    with pytest.raises(EngineError, match=r"point 1 \(.*density.*\): out of glass"):
        fit(place, {"floor_load_mean": "1 N"}, DENSITY, out=tmp_path)


def test_the_command_prints_what_the_function_finds(place):
    free = next(f"{key}={text}" for key, text in DENSITY.items())
    words = [EPDEM, "calibrate", "bed.toml", "--target", f"floor_load_mean={weight(20, 1700.0)!r} N", "--free", free]
    done = subprocess.run([*words, "-o", "points", "-j", "1"], cwd=place, capture_output=True, text=True)
    found = fit(place, {"floor_load_mean": weight(20, 1700.0)}, DENSITY)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0] == f"materials.glass.density = {found.values['materials.glass.density']}"
    assert json.loads(subprocess.check_output([*words, "-o", "points", "--json"], cwd=place))["values"] == found.values
    page = (place / "points/report.html").read_text()
    assert "epdem calibrate bed.toml" in page
    assert f"{found.points} scenes" in page and found.values["materials.glass.density"] in page
    assert 'data-chart="sweep"' in page
