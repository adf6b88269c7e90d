# SPDX-License-Identifier: GPL-2.0-or-later
"""A stored result is taken only while every one of its inputs is the same: each is changed in turn."""

from pathlib import Path

import pytest

from epdem.base import paths
from epdem.engines.embedded import Embedded
from epdem.impacts.run import run

CASES = Path(__file__).parents[2] / "cases"
CASE = (CASES / "steel_wall.toml").read_text().replace("count = 32", "count = 3")


class Recorded(Embedded):
    """An engine that writes a deck, so that the deck can change."""

    release, deck = "1.0", "run 100\n"

    def version(self):
        return self.release

    def write(self, plan, folder):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "in.impact").write_text(self.deck)
        return [folder / "in.impact"]


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
    for function in (paths.library_hash, paths.product_hash):
        function.cache_clear()


@pytest.mark.parametrize("changed", range(6))
def test_a_change_of_the_product_is_a_new_hash(product, changed):
    folder, names = product

    def hashed():
        for function in (paths.library_hash, paths.product_hash):
            function.cache_clear()
        return paths.product_hash()

    first = hashed()
    assert hashed() == first
    (folder / names[changed]).write_text("second")
    second = hashed()
    (folder / names[changed]).unlink()  # as a launcher that the environment names and that is not there
    assert len({first, second, hashed()}) == 3


def reruns(tmp_path, tool, text=CASE, **options):
    (tmp_path / "a.toml").write_text(text)
    return not run(tmp_path / "a.toml", engines=[tool], out=tmp_path / "out", **options).reused


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("yield_pressure_ratio = 2.8", "yield_pressure_ratio = 2.7"),
        ('radius = "10 mm"', 'radius = "11 mm"'),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.31"),
        ('"150 m/s"', '"149 m/s"'),
        ("phases = 8", "phases = 9"),
    ],
)
def test_a_change_of_the_case_runs_again(old, new, tmp_path, monkeypatch):
    monkeypatch.setattr(paths, "product_hash", lambda: "product")
    assert old in CASE
    assert reruns(tmp_path, Recorded()) and not reruns(tmp_path, Recorded())
    assert reruns(tmp_path, Recorded(), CASE.replace(old, new))


@pytest.mark.parametrize("change", ["product", "release", "deck", "steps"])
def test_a_change_of_product_engine_deck_or_steps_runs_again(change, tmp_path, monkeypatch):
    monkeypatch.setattr(paths, "product_hash", lambda: "product")
    tool, options = Recorded(), {}
    assert reruns(tmp_path, tool) and not reruns(tmp_path, tool)
    if change == "product":
        monkeypatch.setattr(paths, "product_hash", lambda: "another")
    elif change == "steps":
        options["steps"] = 401
    else:
        setattr(tool, change, "another\n")
    assert reruns(tmp_path, tool, **options)
