# SPDX-License-Identifier: GPL-2.0-or-later
"""A stored result is taken only while every one of its inputs is the same: each is changed in turn."""

from pathlib import Path

import pytest

from epdem.base import paths
from epdem.engines.embedded import Embedded
from epdem.impacts.run import run
from epdem.jobs.stage import without_comments

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
