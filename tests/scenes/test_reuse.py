# SPDX-License-Identifier: GPL-2.0-or-later
"""Every host starts again for what changes its input, and for nothing else: a test counts its starts."""

import copy
import errno
import re
import shutil
from pathlib import Path

import h5py
import pytest
from parts_cases import parts
from scene_runs import HOSTS, write_case
from stored_runs import STORED, data_of

from epdem.base import paths
from epdem.case.scene import parse
from epdem.engines import engine, scene_engine
from epdem.engines.liggghts.engine import Liggghts
from epdem.errors import CaseError, EngineError
from epdem.impacts.run import run as run_impacts
from epdem.jobs.engine import Feature
from epdem.scenes.plan.model import pair_law
from epdem.scenes.plan.plan import plan
from epdem.scenes.run import run
from epdem.scenes.run import run as run_scene
from epdem.scenes.tables import results
from epdem.studies.sweep import run as sweeps
from marks import thorough

STEEL = (Path(__file__).parents[2] / "cases/steel_wall.toml").read_text()
IMPACTS = STEEL.replace('{ from = "0.05 m/s", to = "150 m/s", count = 32 }', '["1 m/s", "5 m/s"]')


def counted(tool, monkeypatch):
    """An engine, and a list that grows with each of its starts."""
    starts, run = [], tool.run

    def start(*job, **how):
        starts.append(how)
        return run(*job, **how)

    monkeypatch.setattr(tool, "run", start)
    return tool, starts


def compiled_again(tool, folder, monkeypatch):
    """Another compiled part of epdem in an engine."""
    (folder / "part.so").write_bytes(b"compiled again")
    monkeypatch.setattr(tool, "parts", lambda: [folder / "part.so"])


@pytest.mark.parametrize("host", ["embedded", *HOSTS])
def test_impacts_run_again_for_what_the_engine_reads_alone(host, tmp_path, monkeypatch):
    tool, starts = counted(engine(host), monkeypatch)
    many = 2 if tool.ranks > 1 else 1

    def again(text, ranks=1):
        """The starts of a run with this case."""
        (tmp_path / "case.toml").write_text(text)
        starts.clear()
        run_impacts(tmp_path / "case.toml", engines=[tool], out=tmp_path / "out", ranks=ranks)
        return len(starts)

    assert again(IMPACTS) == 1
    for old, new in (
        ('title = "Steel', 'title = "Any steel'),
        ("e_n = 1e-4", "e_n = 1e-9"),
        ('source = "phys', 'source = "a phys'),
        ("[check]", "[check]\npsi_2 = 0.5"),
        ("[case]", "# a comment\n[case]"),
    ):
        assert old in IMPACTS and again(IMPACTS.replace(old, new)) == 0
    monkeypatch.setattr(paths, "product_hash", lambda **_: "another page")
    assert again(IMPACTS) == 0
    for old, new in (
        ('name = "thornton"', 'name = "cavity"'),
        ('radius = "10 mm"', 'radius = "11 mm"'),
        ('"5 m/s"]', '"4 m/s"]'),
        ("phases = 8", "phases = 9"),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.31"),
        ("steps_in_contact = 400", "steps_in_contact = 401"),
    ):
        text = IMPACTS.replace(old, new)
        if "cavity" in new:
            text = text.replace("yield_pressure_ratio = 2.8\n", "")
        assert again(text) == 1 and again(text) == 0
    again(IMPACTS)
    if many > 1:
        assert again(IMPACTS, ranks=many) == 1
        again(IMPACTS)
    compiled_again(tool, tmp_path, monkeypatch)
    assert again(IMPACTS) == 1


HEIGHT = {"name": "height", "kind": "height", "share": 0.5}


def scene(**changes):
    data = parts() | {"output": {"rows": 10, "particles": 2}}
    for table, keys in changes.items():
        data[table] = data.get(table, {}) | keys
    return data


@pytest.mark.parametrize("host", HOSTS)
def test_a_scene_runs_again_for_what_the_engine_reads_alone(host, tmp_path, monkeypatch):
    tool, starts = counted(scene_engine(host), monkeypatch)

    def again(data, ranks=1):
        starts.clear()
        found = run_scene(write_case(copy.deepcopy(data), tmp_path), tool, out=tmp_path / "out", ranks=ranks)
        assert found.reused == (not starts)
        return len(starts)

    def stored(name):
        with h5py.File(tmp_path / "out/results.h5") as file:
            return name in file

    assert again(scene()) == 1
    first = results.read(tmp_path / "out/results.h5").tables
    assert again(scene()) == 0
    assert all(table.equals(first[name]) for name, table in results.read(tmp_path / "out/results.h5").tables.items())
    assert again(scene(case={"title": "Another title"})) == 0
    assert again(scene(output={"rows": 10, "particles": 2, "color": "z"})) == 0
    assert again(scene(scene={"measure": [HEIGHT]})) == 0 and stored("measures")
    assert again(scene()) == 0 and not stored("measures")
    monkeypatch.setattr(paths, "product_hash", lambda **_: "another page")
    assert again(scene()) == 0
    for changes in (
        {"law": {"yield_pressure_ratio": 2.5}},
        {"numerics": {"time_step": "1.9e-5 s"}},
        {"output": {"rows": 10, "particles": 5}},
    ):
        assert again(scene(**changes)) == 1 and again(scene(**changes)) == 0
    if tool.ranks > 1:
        assert again(scene()) == 1 and again(scene(), ranks=2) == 1
    again(scene())
    compiled_again(tool, tmp_path, monkeypatch)
    assert again(scene()) == 1 and again(scene()) == 0
    monkeypatch.setattr(tool, "version", lambda: "another one")
    assert again(scene()) == 1 and again(scene()) == 0
    files = tool.files
    monkeypatch.setattr(tool, "files", lambda p: files(p) | {"wall.stl": "another one"})
    assert again(scene()) == 1


@pytest.mark.parametrize("host", [HOSTS[0], *(thorough(*h.values, marks=h.marks) for h in HOSTS[1:])])
def test_a_disk_that_is_full_at_the_end_costs_no_second_run(host, tmp_path, monkeypatch):
    """The results could not be stored: the next run makes them from the frames; not from those of other inputs, and
    not if a frame is missing."""
    tool, starts = counted(scene_engine(host), monkeypatch)

    def full(*words):
        raise OSError(errno.ENOSPC, "No space left on device")

    def ends_on_a_full_disk(out):
        with monkeypatch.context() as disk, pytest.raises(OSError, match="No space"):
            disk.setattr("epdem.scenes.tables.results.write", full)
            run_scene(write_case(scene(), tmp_path), tool, out=out)
        starts.clear()

    whole = run_scene(write_case(scene(), tmp_path), tool, out=tmp_path / "whole").results.tables
    ends_on_a_full_disk(tmp_path / "out")
    found = run_scene(write_case(scene(), tmp_path), tool, out=tmp_path / "out")
    assert not starts and found.reused and found.results.tables.keys() == whole.keys()
    assert all(table.equals(whole[name]) for name, table in found.results.tables.items())
    ends_on_a_full_disk(tmp_path / "other")
    run_scene(write_case(scene(law={"yield_pressure_ratio": 2.5}), tmp_path), tool, out=tmp_path / "other")
    assert len(starts) == 1
    ends_on_a_full_disk(tmp_path / "lacks")
    max((tmp_path / "lacks").glob("particles.*"), key=lambda path: path.stat().st_mtime_ns).unlink()
    run_scene(write_case(scene(), tmp_path), tool, out=tmp_path / "lacks")
    assert len(starts) == 1


@pytest.mark.parametrize("kind", ["impacts", pytest.param("scene", marks=pytest.mark.liggghts)])
def test_results_of_other_inputs_move_aside_and_those_of_another_case_stay(kind, tmp_path):
    out = tmp_path / "out"

    def once(ratio, name="one", **how):
        if kind == "scene":
            path = write_case(scene(case={"name": name}, law={"yield_pressure_ratio": ratio}), tmp_path)
            found = run_scene(path, scene_engine("liggghts"), out=out, **how)
        else:
            text = IMPACTS.replace("yield_pressure_ratio = 2.8", f"yield_pressure_ratio = {ratio}")
            (tmp_path / "case.toml").write_text(re.sub('(?m)^name = "steel_wall"', f'name = "{name}"', text))
            found = run_impacts(tmp_path / "case.toml", engines=[engine("embedded")], out=out, **how)
        return [warning for warning in found.warnings if "previous" in warning], (out / "results.h5").read_bytes()

    first = once(2.8)
    assert not first[0] and once(2.8) == first and not (out / "previous").exists()
    said, second = once(2.5)
    assert "out: the results of other inputs, which were here, are in previous now" in said[0]
    assert (out / "previous/results.h5").read_bytes() == first[1] != second
    assert once(2.2)[0] and (out / "previous/results.h5").read_bytes() == second
    with pytest.raises(CaseError, match="out: it has the results of case 'one'; choose another folder by --out, or"):
        once(2.2, name="two")
    assert not once(2.2, name="two", force=True)[0]
    with pytest.raises(CaseError, match="it has the results of case 'two'"):
        once(2.2)


@pytest.mark.liggghts
def test_a_sweep_of_impacts_is_judged_anew_without_a_start(tmp_path, monkeypatch):
    tool, starts = counted(engine("liggghts"), monkeypatch)
    monkeypatch.setattr(sweeps, "engine", lambda name: tool)
    monkeypatch.setattr(sweeps, "each", lambda function, items, jobs: ((n, function(n)) for n in items))

    def swept(text):
        (tmp_path / "case.toml").write_text(text)
        starts.clear()
        plan = sweeps.plan(tmp_path / "case.toml", {"impact.body.radius": "5 mm,10 mm"}, engines=["liggghts"])
        return sweeps.run(plan, tmp_path / "out"), len(starts)

    first, runs = swept(IMPACTS)
    assert first.passed and runs == 2
    strict, runs = swept(IMPACTS.replace("contact_time = 5e-3", "contact_time = 1e-12"))
    assert not strict.passed and runs == 0 and strict.table["e_n"].equals(first.table["e_n"])
    monkeypatch.setattr(paths, "product_hash", lambda **_: "another page")
    later, runs = swept(IMPACTS.replace('title = "Steel', 'title = "Any steel'))
    assert later.passed and (later.ran, runs) == (2, 0)
    assert swept(IMPACTS.replace("yield_pressure_ratio = 2.8", "yield_pressure_ratio = 2.7"))[1] == 2


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
