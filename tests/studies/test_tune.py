# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem tune`: every skin sees every part of the scene, a choice needs a certain saving, the case file is kept."""

import re
import tomllib
from pathlib import Path

import pytest

from epdem.case.scene import load
from epdem.engines.liggghts import launcher, scene_deck, trials, tune
from epdem.engines.liggghts.tune import Trial, Tuned
from epdem.errors import CaseError, EngineError
from epdem.scenes.plan import plan

CASES = Path(__file__).parents[2] / "cases"
SMALL = {"count = 1000": "count = 30", '"0.5 s"': '"0.1 s"', "error = 1e-2": "time_step = '5e-5 s'"}


def small(folder: Path, **numerics: str) -> Path:
    """The settling glass beads, fewer, softer and shorter."""
    text = (CASES / "settle_glass.toml").read_text()
    for old, new in SMALL.items():
        assert old in text
        text = text.replace(old, new)
    path = folder / "case.toml"
    path.write_text(text + "".join(f'{key} = "{value}"\n' for key, value in numerics.items()))
    return path


def test_trials_take_the_steps_of_the_scene_in_turns(tmp_path, monkeypatch):
    decks = []
    run = launcher.run

    def recorded(deck, folder, **options):
        decks.append((folder / deck).read_text())
        return run(deck, folder, **options)

    monkeypatch.setattr(launcher, "run", recorded)
    path = small(tmp_path)
    found = tune.tune(path, ranks=2)
    skins = [float(x) for x in re.findall(r"^neighbor (\S+) bin$", decks[0], re.M)]
    ends = [int(x) for x in re.findall(r"^run (\d+) upto$", decks[0], re.M)]
    assert ends[-1] == plan(load(path)).steps and len(skins) == len(ends) >= 2 * len(found.skins)
    assert skins[: len(found.skins)] == skins[len(found.skins) : 2 * len(found.skins)][::-1]
    assert found.skins[0].value == 0.7e-3 and {t.value for t in found.skins} == set(skins)
    pieces = [b - a for a, b in zip([0, *ends], ends, strict=False)]
    taken = {x: sum(n for n, at in zip(pieces, skins, strict=True) if at == x) for x in skins}
    assert max(taken.values()) - min(taken.values()) <= max(pieces)  # the last turn may be incomplete
    assert found.steps <= min(taken.values()) and all(t.seconds > 0 for t in found.skins)
    assert [t.value for t in found.cuts] == ["", "x", "y", "z"]
    grids = [re.findall(r"^processors (.*)$", text, re.M) for text in decks[1:]]
    assert grids == [[], ["* 1 1"], ["1 * 1"], ["1 1 *"]]
    assert path.read_text() == small(tmp_path).read_text()


def test_a_skin_and_a_cut_of_the_case_are_in_its_decks(tmp_path):
    path = small(tmp_path, skin="1.5 mm", processors="yz")
    texts = scene_deck.files(plan(load(path)))
    assert re.search(r"^neighbor 0\.0015 bin ", texts["setup.in"], re.M)
    assert "\nprocessors 1 * *\n" in texts["in.scene"]


def tuned(*seconds, cuts=()):
    """Skins with these seconds per step in each turn, the present one first."""
    skins = tuple(Trial(f"skin {k + 1} mm", (k + 1) * 1e-3, turns) for k, turns in enumerate(seconds))
    return Tuned(skins, tuple(Trial(f"ranks along {c}", c, t) for c, t in cuts), 100, 1000, 2)


def test_the_fastest_skin_is_chosen_with_its_saving():
    found = tuned((2.0, 4.0, 6.0), (1.0, 2.0, 3.0), (0.9, 1.9, 2.9))
    assert found.choices == {"skin": ("3 mm", "epdem tune: 52% less time than skin 1 mm, 100 steps, 2 ranks")}


@pytest.mark.parametrize(
    "other",
    [(1.0, 1.0, 1.0, 1.0), (0.985, 0.985, 0.985, 0.985), (0.5, 1.3, 0.6, 1.1)],
    ids=["the same", "1.5 % less", "12 % less, but by chance"],
)
def test_nothing_is_chosen_without_a_certain_saving(other):
    assert tuned((1.0, 1.0, 1.0, 1.0), other).choices == {}


def test_the_case_file_gets_the_choices_and_keeps_its_comments(tmp_path):
    path = small(tmp_path)
    before = path.read_text()
    found = tuned((2.0, 2.0), (1.0, 1.0), cuts=[("", (4.0, 4.0)), ("x", (3.0, 3.0))])
    (tmp_path / "link.toml").symlink_to(path)
    tune.write(tmp_path / "link.toml", found)
    text = path.read_text()
    assert [line for line in text.splitlines() if line not in before.splitlines()] == found.lines
    assert all(line in text for line in before.splitlines())
    numerics = tomllib.loads(text)["numerics"]
    assert (numerics["skin"], numerics["processors"], numerics["time_step"]) == ("2 mm", "x", "5e-5 s")
    assert load(path).numerics.skin == 2e-3
    tune.write(path, tuned((1.0, 1.0), (1.0, 1.0)))
    assert path.read_text() == text


def test_all_trials_share_the_time(tmp_path, monkeypatch):
    limits = []

    def run(texts, ranks, seconds):
        limits.append(seconds)
        return [(1.0, 200)] * 20

    monkeypatch.setattr(trials, "run", run)
    tune.tune(small(tmp_path), ranks=2, seconds=50.0)
    assert limits == [10.0] * 5  # skins, and four processor grids


def test_a_trial_that_is_too_short_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(trials, "run", lambda *words: [(1.0, 200)] * 7)  # seven pieces of five skins
    with pytest.raises(EngineError, match="ended before each skin had two turns; give it more time"):
        tune.tune(small(tmp_path))
    path = small(tmp_path)
    path.write_text(path.read_text().replace("0.1 s", "0.01 s"))
    with pytest.raises(CaseError, match=r"has 200 steps, two turns through its skins 2000; it is short as it is"):
        tune.tune(path)
