# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene is run again when one of its inputs has changed and only then; the engine here copies stored files."""

import shutil
from pathlib import Path

import pytest
from scene_runs import write_case
from stored_runs import STORED, data_of

from epdem.case.scene import parse
from epdem.engines.liggghts.engine import Liggghts
from epdem.errors import CaseError, EngineError
from epdem.jobs.engine import Feature
from epdem.scenes.plan.model import pair_law
from epdem.scenes.plan.plan import plan
from epdem.scenes.run import run
from epdem.scenes.tables import results


class Stored(Liggghts):
    """LIGGGHTS whose runs are copies of stored ones."""

    ranks, mpirun = 4, "true"

    def __init__(self, name: str = "drum"):
        self.stored, self.runs, self.says, self.here = STORED / name, 0, "LIGGGHTS 3.8.0", True

    def missing(self):
        return None if self.here else "LIGGGHTS was not found; apt-get install liggghts"

    def version(self):
        return self.says

    def run(self, job, folder, *, ranks, report):
        self.runs += 1
        for path in self.stored.iterdir():
            if path.suffix != ".toml":
                shutil.copy(path, folder)
        report(job.steps)
        return self.read(job, folder)


@pytest.fixture
def case(tmp_path) -> Path:
    return write_case(data_of("drum"), tmp_path)


def test_the_second_call_takes_the_stored_results(case, tmp_path):
    engine, reported = Stored(), []
    first = run(case, engine, out=tmp_path / "out", report=lambda step, steps: reported.append((step, steps)))
    second = run(case, engine, out=tmp_path / "out")
    assert (first.reused, second.reused, engine.runs) == (False, True, 1)
    assert reported == [(8000, 8000)]
    for name, table in first.results.tables.items():
        assert second.results.tables[name].astype(str).equals(table.astype(str)), name
    stored = results.read(tmp_path / "out/results.h5")
    assert stored.case_text == case.read_text()
    assert set(stored.decks) == {"in.scene", "setup.in", "drum.stl"}, "all that is needed to run it by hand"
    assert run(case, engine, out=tmp_path / "out", fresh=True).reused is False


@pytest.mark.parametrize(
    ("lacks", "options", "words"),
    [
        ({"laws": ("hertz",)}, {}, r"law.name = .*has hertz only; use --engine"),
        ({"ranks": 4}, {"ranks": 5}, r"--ranks 5: .* at most 4 ranks"),
        ({"ranks": 1}, {"ranks": 2}, r"--ranks 2: .* one rank"),
        ({"features": Stored.features - {Feature.RESTART}}, {"resume": True}, r"--resume: .* from its start"),
    ],
)
def test_what_an_engine_cannot_do_is_refused_before_anything_is_written(lacks, options, words, case, tmp_path):
    engine = Stored()
    vars(engine).update(lacks)
    with pytest.raises(CaseError, match=words):
        run(case, engine, out=tmp_path / "out", **options)
    assert not (tmp_path / "out").exists() and engine.runs == 0


def test_an_engine_that_is_not_here_says_how_to_get_it(case, tmp_path):
    engine = Stored()
    engine.here = False
    with pytest.raises(EngineError, match="apt-get install"):
        run(case, engine, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


STRENGTH = {"yield_pressure": "3 MPa"}


def test_a_material_s_own_strength_goes_before_that_of_the_law():
    data = data_of("settle")
    glass = data["materials"]["glass"]
    elastic = {key: value for key, value in glass.items() if key != "yield_stress"}
    cases = {
        "by ratio": (glass, {"name": "thornton", "yield_pressure_ratio": 2.0}),
        "of the law": (glass, {"name": "thornton", **STRENGTH}),
        "its own": (elastic | {"yield_pressure": "7 MPa"}, {"name": "thornton", **STRENGTH}),
    }
    found = {
        name: plan(parse(data | {"materials": {"glass": material}, "law": law})).model.types[0].strength
        for name, (material, law) in cases.items()
    }
    assert found == pytest.approx({"by ratio": 1e6, "of the law": 3e6, "its own": 7e6})


def test_of_two_materials_the_softer_one_s_strength_counts():
    """johnson's own ratio 3.0 times 0.5 GPa of the plate; the shot has 2 GPa."""
    case = parse(data_of("peening"))
    for a, b in (("shot", "plate"), ("plate", "shot")):
        assert pair_law(case, a, b)[0].parameters["yield_pressure"] == pytest.approx(1.5e9)
