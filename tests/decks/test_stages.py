# SPDX-License-Identifier: GPL-2.0-or-later
"""Each stage by itself, on made-up data whose answer is known."""

import os
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest

from epdem.base import paths
from epdem.case.impact import Check, load
from epdem.engines import engine
from epdem.engines.embedded import Embedded
from epdem.errors import CaseError, EngineError
from epdem.impacts import store
from epdem.impacts.engine import Trajectory
from epdem.impacts.experiment import experiment
from epdem.impacts.measurement import CHECKED, compare, measure
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.impacts.run import run
from epdem.jobs.stage import without_comments

STEEL = Path(__file__).parents[2] / "cases" / "steel_wall.toml"


@pytest.fixture(scope="module")
def steel():
    x = experiment(load(STEEL))
    prediction = predict(x)
    return x, prediction, plan(x, prediction)


def test_phases_cover_the_step_evenly_and_the_fastest_impact_gets_the_steps(steel):
    _, prediction, p = steel
    phase = (p.gap / (p.speed * p.time_step)).reshape(-1, 8)
    assert phase == pytest.approx(np.broadcast_to((np.arange(8) + 0.5) / 8, phase.shape), rel=1e-12)
    assert prediction.contact_time.min() / p.time_step == pytest.approx(400, rel=1e-12)
    assert p.steps * p.time_step > prediction.contact_time.max()


def made_up(steel, dent_share=0.25):
    """A path with a known dent: F^(2/3) falls linearly to 0 at the dent, between two samples."""
    x, _, p = steel
    one = replace(p, speed=p.speed[:1], gap=np.array([0.5 * p.speed[0] * p.time_step]))
    delta = np.concatenate([np.arange(-0.5, 100), np.arange(98.5, -60, -1)]) * p.speed[0] * p.time_step
    top, dent = delta.max(), dent_share * delta.max()
    rising = np.arange(delta.size) < 101
    share = np.where(rising, delta / top, (delta - dent) / (top - dent))
    force = np.clip(share, 0, None) ** 1.5
    velocity = np.where(rising, p.speed[0], -p.speed[0])
    return one, Trajectory(p.time_step, delta[None], force[None], velocity[None]), dent, top


def test_the_dent_and_the_end_of_contact_are_found_between_samples(steel):
    one, path, dent, top = made_up(steel)
    found = measure(one, path)
    step = one.speed[0] * one.time_step
    assert found.residual_overlap[0] == pytest.approx(dent, rel=1e-12)
    end = 100 + (99.5 * step - dent) / step  # steps at one speed: from the peak sample down to the dent
    assert found.contact_time[0] / one.time_step == pytest.approx(end - 0.5, abs=1e-9)
    assert found.e_n[0] == 1.0 and found.overlap_max[0] == top


def test_a_contact_that_never_ends_is_an_engine_error(steel):
    one, path, _, _ = made_up(steel)
    with pytest.raises(EngineError, match="still in contact"):
        measure(one, replace(path, **{k: getattr(path, k)[:, :120] for k in ("overlap", "force", "velocity")}))
    with pytest.raises(EngineError, match="never touched"):
        measure(one, replace(path, force=0 * path.force))


def test_the_error_of_a_speed_is_that_of_its_worst_phase(steel):
    x, prediction, p = steel
    n = prediction.speed.size
    columns = {name: np.repeat(getattr(prediction, name), 8) for name in CHECKED}
    columns |= dict.fromkeys(("energy_residual", "steps_in_contact"), np.zeros(8 * n))
    columns["e_n"] = columns["e_n"] * (1 + 1e-2 * (np.arange(8 * n) % 8 == 3))
    rows = compare("embedded", "thornton", pd.DataFrame(columns), prediction, Check())
    assert rows["e_n_error"].to_numpy() == pytest.approx(1e-2, rel=1e-9)
    assert rows["e_n_rms"].to_numpy() == pytest.approx(1e-2 / 8**0.5, rel=1e-9)
    assert not rows["passed"].any() and rows["contact_time_error"].max() == 0


def test_psi_2_of_one_spring_is_not_checked_unless_the_case_asks(tmp_path):
    """Theory has partial slip."""
    text = (STEEL.parent / "oblique_steel.toml").read_text().replace('tangential = "partial_slip"\n', "")
    text = text.replace("phases = 8", "phases = 1").replace("count = 16", "count = 4")
    for name, checks, passed in (("own", text, False), ("none", text.replace("psi_2 = 0.05", ""), True)):
        (tmp_path / f"{name}.toml").write_text(checks)
        found = run(tmp_path / f"{name}.toml", engines=[engine("embedded")], out=tmp_path / name)
        assert found.passed == passed and found.results.comparison["psi_2_error"].max() > 0.05
        assert any("psi_2 is not checked" in warning for warning in found.warnings) == passed
        assert any("the reference of psi_2 is partial slip" in warning for warning in found.warnings) != passed


def test_a_stored_result_is_used_only_while_its_inputs_are_the_same(tmp_path):
    text = STEEL.read_text().replace("count = 32", "count = 3")
    (tmp_path / "a.toml").write_text(text)
    words = {"engines": [engine("embedded")], "laws": [], "out": tmp_path / "out"}
    assert run(tmp_path / "a.toml", **words).reused == []
    assert run(tmp_path / "a.toml", **words).reused == ["thornton/embedded"]
    (tmp_path / "a.toml").write_text(text.replace("yield_pressure_ratio = 2.8", "yield_pressure_ratio = 2.7"))
    assert run(tmp_path / "a.toml", **words).reused == []


def test_stored_runs_of_other_laws_stay_while_their_numbers_are_those_of_the_case(tmp_path):
    """A title, a source or a tolerance is no input; other speeds are. The case judges what is stored."""
    case, out = tmp_path / "a.toml", tmp_path / "out"
    text = STEEL.read_text().replace("count = 32", "count = 3").replace("e_n = 1e-4", "e_n = 1e-2")
    for changed, kept, passed in (
        (text, True, True),
        (text.replace('title = "', 'title = "A new '), True, True),
        (text.replace('source = "', 'source = "A new '), True, True),
        (text.replace("e_n = 1e-2", "e_n = 1e-12"), True, False),
        (text.replace('"150 m/s"', '"140 m/s"'), False, True),
    ):
        case.write_text(text)
        run(case, engines=[engine("embedded")], laws=["thornton", "johnson"], out=out)
        case.write_text(changed)
        run(case, engines=[engine("embedded")], laws=["thornton"], out=out)
        found = store.read(out / "results.h5")
        laws = {"thornton", "johnson"} if kept else {"thornton"}
        assert {key.split("/")[0] for key in found.runs} == set(found.predictions) == laws
        assert set(found.comparison["law"]) == laws and found.case_text == changed
        assert found.comparison.groupby("law")["passed"].all().to_dict() == dict.fromkeys(laws, passed)


def test_a_stored_table_that_cannot_be_read_is_an_error_and_stays(tmp_path):
    """Its attribute `columns` is lost. With --fresh the run is made anew."""
    case, words = tmp_path / "a.toml", {"engines": [engine("embedded")], "out": tmp_path / "out"}
    case.write_text(STEEL.read_text().replace("count = 32", "count = 3"))
    run(case, **words)
    path = tmp_path / "out/results.h5"
    with h5py.File(path, "r+") as file:
        del file["impacts/thornton/embedded"].attrs["columns"]
    damaged = path.read_bytes()
    os.utime(path, (0, 0))  # damage of a disk leaves the time of a file
    with pytest.raises(CaseError, match=r"results.h5: .*table /impacts/thornton/embedded: .*case anew \(--fresh\)"):
        run(case, **words)
    assert path.read_bytes() == damaged
    run(case, fresh=True, **words)
    assert run(case, **words).reused


def test_a_write_that_fails_leaves_the_old_results(tmp_path):
    path = tmp_path / "results.h5"
    store.write(path, store.Results("one"))
    with pytest.raises(TypeError):
        store.write(path, store.Results("two", attributes={"bad": object()}))
    assert store.read(path).case_text == "one"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["results.csv", "results.h5"]


def test_every_table_is_read_back_as_it_was_written(tmp_path):
    tables = [
        pd.DataFrame({"speed": [1.0, 2.0], "case": [name, "b"], "steps": [k, 3]}) for k, name in enumerate("xyzu")
    ]
    written = store.Results("text", {"version": "7"})
    written.comparison, written.impacts["law/engine"], written.predictions["law"], written.paths["law/engine"] = tables
    written.runs["law/engine"] = {"hash": "h"}
    store.write(tmp_path / "results.h5", written)
    found = store.read(tmp_path / "results.h5")
    assert (found.case_text, found.attributes["version"], found.runs["law/engine"]["hash"]) == ("text", "7", "h")
    read = (found.comparison, found.impacts["law/engine"], found.predictions["law"], found.paths["law/engine"])
    for before, after in zip(tables, read, strict=True):
        pd.testing.assert_frame_equal(before, after)
    with h5py.File(tmp_path / "results.h5") as file:
        assert file["impacts/law/engine/speed"].attrs["unit"] == b"m/s"


def test_one_wrong_bit_in_a_column_or_a_text_is_refused(tmp_path):
    """Without HDF5's checksums the wrong number is read."""
    path, table = tmp_path / "results.h5", pd.DataFrame({"speed": np.linspace(0.1, 0.7, 7)})
    store.write(path, store.Results("the case", {}, table, {"law/engine": table}, paths={"law/engine": table}))
    whole = path.read_bytes()
    assert store.read(path).impacts["law/engine"].equals(table)
    with h5py.File(path) as file:
        places = [file[name].id.get_chunk_info(0).byte_offset for name in ("impacts/law/engine/speed", "case")]
    for place in places:
        path.write_bytes(whole[: place + 5] + bytes([whole[place + 5] ^ 1]) + whole[place + 6 :])
        with pytest.raises(CaseError, match="damaged"):
            store.read(path)


CASES = Path(__file__).parents[2] / "cases"
CASE = (CASES / "steel_wall.toml").read_text().replace("count = 32", "count = 3")


class Recorded(Embedded):
    """An engine that writes a deck, so that the deck can change."""

    release, deck = "1.0", "run 100\n"

    def __init__(self, folder):
        self.part = folder / "plugin.so"
        self.part.write_bytes(b"compiled")

    def parts(self):
        return [self.part]

    def version(self):
        return self.release

    def files(self, plan):
        return {"in.impact": f"# {plan.experiment.title}\n{self.deck}"}


@pytest.fixture
def product(tmp_path, monkeypatch):
    """Parts of the product that a test may change: two libraries, a launcher, a template, a source, a table."""
    names = ("libepdem.so", "libepdem_liggghts.so", "launcher", "templates/a.j2", "package/a.py", "package/a.toml")
    for name in names:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("first")
    monkeypatch.setattr(paths, "__file__", str(tmp_path / "package/base/paths.py"))
    monkeypatch.setattr(paths, "native", lambda name: tmp_path / name)
    monkeypatch.setattr(paths, "launcher", lambda: tmp_path / "launcher")
    monkeypatch.setattr(paths, "beside", lambda name: tmp_path / name)
    yield tmp_path, names
    paths.product_hash.cache_clear()


@pytest.mark.parametrize("changed", range(6))
def test_a_change_of_the_product_is_a_new_hash(product, changed):
    folder, names = product

    def hashed(**given):
        paths.product_hash.cache_clear()
        return paths.product_hash(**given)

    first, read = hashed(), hashed(sources=False)
    assert hashed() == first
    (folder / names[changed]).write_text("second")
    second = hashed()
    assert (hashed(sources=False) == read) == names[changed].endswith(".py")  # which no engine reads
    (folder / names[changed]).unlink()  # as a launcher that the environment names and that is not there
    assert len({first, second, hashed()}) == 3


def reruns(tmp_path, tool, text=CASE, **options):
    (tmp_path / "a.toml").write_text(text)
    return not run(tmp_path / "a.toml", engines=[tool], out=tmp_path / "out", **options).reused


@pytest.mark.parametrize("change", ["release", "deck", "part", "steps"])
def test_a_change_of_engine_deck_compiled_part_or_steps_runs_again(change, tmp_path):
    tool, options = Recorded(tmp_path), {}
    assert reruns(tmp_path, tool) and not reruns(tmp_path, tool)
    if change == "steps":
        options["steps"] = 401
    elif change == "part":
        (tmp_path / "plugin.so").write_bytes(b"compiled again")
    else:
        setattr(tool, change, "another\n")
    assert reruns(tmp_path, tool, **options)


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("# title\nrun 10  # until the end\n", "\nrun 10\n"),
        ('print "step # of x"  # says it\n', 'print "step # of x"\n'),
        ("x = '#'\n", "x = '#'\n"),
        ("a #b\n", "a\n"),
        ("pair a#b\n", "pair a#b\n"),
    ],
)
def test_comments_go_and_texts_stay(text, left):
    assert without_comments(text) == left
