# SPDX-License-Identifier: GPL-2.0-or-later
"""A stored run is repeated from its results file alone; what differs is named."""

import shutil
from pathlib import Path

import h5py
import pytest

from epdem.base.tables import write_text
from epdem.engines import engine, scene_engine
from epdem.errors import CaseError
from epdem.impacts.run import run
from epdem.scenes.run import run as run_scene
from epdem.verification.rerun import rerun

CASES = Path(__file__).parents[2] / "cases"


def stored(out: Path, **options) -> Path:
    run(CASES / "two_materials.toml", engines=[engine("embedded")], out=out, **options)
    return out / "results.h5"


def test_impacts_are_repeated_with_their_law_and_steps(tmp_path):
    path = stored(tmp_path / "out", laws=["thornton", "cavity"], steps=123)
    path.rename(tmp_path / "alone.h5")
    found = rerun(tmp_path / "alone.h5")
    assert found.same and found.versions == {}
    assert set(found.differences) == {"table thornton/embedded", "table cavity/embedded"}


def test_a_number_that_has_changed_is_named_by_its_column(tmp_path):
    path = stored(tmp_path)
    with h5py.File(path, "a") as file:
        (law,) = file["impacts"]
        file[f"impacts/{law}/embedded/e_n"][3] += 1e-16
        file.attrs["epdem"] = "0.0.1"
    found = rerun(path)
    assert not found.same and found.versions["epdem"][0] == "0.0.1"
    assert found.differences == {f"table {law}/embedded": "other numbers in e_n"}


def test_a_file_that_does_not_say_how_it_was_made_is_refused(tmp_path):
    path = stored(tmp_path)
    with h5py.File(path, "a") as file:
        (law,) = file["impacts"]
        del file[f"impacts/{law}/embedded"].attrs["own_law"]
    with pytest.raises(CaseError, match="does not hold how it was run"):
        rerun(path)


def test_a_stored_case_that_is_no_longer_valid_is_named_by_its_results_file(tmp_path):
    path = stored(tmp_path)
    with h5py.File(path, "a") as file:
        text = file["case"][0].decode()
        del file["case"]
        write_text(file, "case", text.replace("[law]\n", "[law]\nstiffness = 1\n"))
    with pytest.raises(CaseError) as refused:
        rerun(path)
    assert str(refused.value).startswith(f"{path}: the stored case: law.stiffness: law ")


@pytest.mark.liggghts
def test_a_scene_and_impacts_in_liggghts_have_the_same_decks_and_numbers_again(tmp_path):
    """The scene from a file that names a sieve table, both of which have gone since."""
    text = (CASES / "sieve_cylinder.toml").read_text().replace('mass = "8 g"', "count = 40").replace("0.3 s", "0.05 s")
    place = tmp_path / "lab"
    shutil.copytree(CASES / "parts", place / "parts")
    (place / "bed.toml").write_text(text)
    run_scene(place / "bed.toml", scene_engine("liggghts"), out=tmp_path / "bed")
    shutil.rmtree(place)
    found = rerun(tmp_path / "bed/results.h5")
    tables = {"rows", "particles", "contacts", "energy_balance", "checks", "phases"}
    decks = {"deck in.scene", "deck setup.in"}
    assert found.same and set(found.differences) == {f"table {t}" for t in tables} | decks
    with h5py.File(tmp_path / "bed/results.h5", "a") as file:
        del file["files"]  # as earlier versions wrote it
    with pytest.raises(CaseError, match="does not hold the files that its case names"):
        rerun(tmp_path / "bed/results.h5")
    run(CASES / "two_materials.toml", engines=[engine("liggghts")], out=tmp_path / "impacts", steps=60)
    with h5py.File(tmp_path / "impacts/results.h5", "a") as file:
        (law,) = file["impacts"]
        text = file[f"decks/{law}/liggghts/in.impact"][0].decode()
        del file[f"decks/{law}/liggghts/in.impact"]
        write_text(file, f"decks/{law}/liggghts/in.impact", text.replace("timestep", "timestep  "))
    found = rerun(tmp_path / "impacts/results.h5")
    line = next(n for n, words in enumerate(text.splitlines(), 1) if words.startswith("timestep"))
    assert found.differences[f"deck {law}/liggghts/in.impact"] == f"differs from line {line} on"
    assert found.differences[f"table {law}/liggghts"] == ""
