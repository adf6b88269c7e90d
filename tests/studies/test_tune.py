# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem tune`: every skin sees every part of the scene, a choice needs a certain saving, the case file is kept."""

import re
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from epdem.case.scene import load
from epdem.engines.lammps import scene_deck as lammps_deck
from epdem.engines.liggghts import launcher, scene_deck, tune
from epdem.engines.liggghts.tune import Choice, Trial, Tuned
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
    assert len({re.sub(r"processors .*\n|atom_modify sort .*\n", "", deck) for deck in decks}) == 1
    skins = [float(x) for x in re.findall(r"^neighbor (\S+) bin$", decks[0], re.M)]
    ends = [int(x) for x in re.findall(r"^run (\d+) upto$", decks[0], re.M)]
    tried = {t.choice.skin for t in found.trials}
    assert ends[-1] == plan(load(path)).steps and len(skins) == len(ends) >= 2 * len(tried) == 2 * len(set(skins))
    assert skins[: len(tried)] == skins[len(tried) : 2 * len(tried)][::-1]
    pieces = [b - a for a, b in zip([0, *ends], ends, strict=False)]
    taken = {x: sum(n for n, at in zip(pieces, skins, strict=True) if at == x) for x in skins}
    assert max(taken.values()) - min(taken.values()) <= max(pieces)  # the last turn may be incomplete
    first = found.trials[0]
    assert first.choice == Choice(0.7e-3) and first.steps == {"settle": ends[-1]}
    assert all(t.seconds > 0 and len(t.turns["settle"]) == len(ends) // len(tried) for t in found.trials)
    grids = [re.findall(r"^(?:processors|atom_modify sort) .*$", text, re.M) for text in decks]
    sorts = [[f"atom_modify sort {n} 0.0"] for n in (200, 5000)]
    assert grids == [[], ["processors * 1 1"], ["processors 1 * 1"], ["processors 1 1 *"], *sorts]
    assert [x.keys for x in dict.fromkeys(replace(t.choice, skin=1.0) for t in found.trials)][3:] == [
        {"skin": "1000 mm", "processors": "z", "sort_interval": None},
        {"skin": "1000 mm", "processors": None, "sort_interval": 200},
        {"skin": "1000 mm", "processors": None, "sort_interval": 5000},
    ]
    assert path.read_text() == small(tmp_path).read_text()


def test_each_stage_begins_with_the_first_skin_and_counts_with_its_steps():
    texts, order = tune.pieces({"in.scene": "run 1000 upto  # fill\nunfix x\nrun 9500 upto  # flow\n"}, [1.0, 2.0], 400)
    assert [(p.stage, p.steps, p.turn, p.skin) for p in order[:4]] == [
        ("fill", 400, 0, 1.0),
        ("fill", 400, 0, 2.0),
        ("fill", 200, 1, 2.0),
        ("flow", 400, 2, 1.0),
    ]
    assert len(order) == 3 + 22 and texts["in.scene"].count("unfix x") == 1
    first = Trial(Choice(1.0), {"fill": (1.0, 1.0), "flow": (2.0, 2.0, 2.0)}, {"fill": 1000, "flow": 9000, "end": 500})
    assert first.seconds == pytest.approx(0.1 * 1.0 + 0.9 * 2.0)
    other = Trial(Choice(2.0), {"fill": (0.5, 0.5), "flow": (2.0, 2.1, 1.9)}, first.steps)
    saved, error = other.saves(first)
    assert saved == pytest.approx(0.1 * 0.5 / 1.9)
    assert error == pytest.approx(0.9 * 0.1 / 3**0.5 / 1.9)
    assert Tuned((first, other), 1).stages == {"fill": other.choice, "flow": first.choice, "end": None}


def test_the_choices_of_the_case_are_in_its_decks(tmp_path):
    path = small(tmp_path, skin="1.5 mm", processors="yz")
    path.write_text(path.read_text() + "sort_interval = 300\n")
    p = plan(load(path))
    texts = scene_deck.files(p)
    assert re.search(r"^neighbor 0\.0015 bin ", texts["setup.in"], re.M)
    for text in (texts["in.scene"], lammps_deck.files(p)["in.scene"]):
        assert re.search(r"^processors 1 \* \*$", text, re.M) and re.search(r"^atom_modify sort 300 0\.0$", text, re.M)


def tuned(*seconds):
    """Trials of skins with these seconds per step in each turn, the present one first."""
    found = [Trial(Choice((k + 1) * 1e-3), {"all": turns}, {"all": 100}) for k, turns in enumerate(seconds)]
    return Tuned(tuple(found), 2)


def test_the_fastest_skin_is_chosen_with_its_saving():
    found = tuned((2.0, 4.0, 6.0), (1.0, 2.0, 3.0), (0.9, 1.9, 2.9))
    assert found.changes == {"skin": "3 mm"} and found.reason == "epdem tune: 52% less time than skin 1 mm, 2 ranks"


@pytest.mark.parametrize(
    "other",
    [(1.0, 1.0, 1.0, 1.0), (0.985, 0.985, 0.985, 0.985), (0.5, 1.3, 0.6, 1.1)],
    ids=["the same", "1.5 % less", "12 % less, but by chance"],
)
def test_nothing_is_chosen_without_a_certain_saving(other):
    assert tuned((1.0, 1.0, 1.0, 1.0), other).changes == {}


def test_the_case_file_gets_the_changes_and_keeps_its_comments(tmp_path):
    path = small(tmp_path)
    before = path.read_text()
    now = tuned((4.0, 4.0), (3.0, 3.0)).trials
    fastest = Trial(Choice(2e-3, "x", 200), {"all": (1.0, 1.0)}, {"all": 100})
    found = Tuned((*now, fastest), 2)
    (tmp_path / "link.toml").symlink_to(path)
    tune.write(tmp_path / "link.toml", found)
    text = path.read_text()
    assert [line for line in text.splitlines() if line not in before.splitlines()] == found.lines
    assert all(line in text for line in before.splitlines())
    numerics = tomllib.loads(text)["numerics"]
    assert numerics["skin"] == "2 mm" and numerics["time_step"] == "5e-5 s"
    assert (numerics["processors"], numerics["sort_interval"]) == ("x", 200)
    assert load(path).numerics.skin == 2e-3
    tune.write(path, tuned((1.0, 1.0), (1.0, 1.0)))
    assert path.read_text() == text


def test_all_trials_share_the_time(tmp_path, monkeypatch):
    limits = []

    def run(texts, ranks, seconds):
        limits.append(seconds)
        return [(1.0, 200)] * 20

    monkeypatch.setattr(tune, "run", run)
    tune.tune(small(tmp_path), ranks=2, seconds=60.0)
    assert limits == [10.0] * 6  # four processor grids, two intervals of sorting


def test_trials_that_are_too_short_say_so(tmp_path, monkeypatch):
    monkeypatch.setattr(tune, "run", lambda *words: [(1.0, 200)] * 7)  # seven pieces of five skins
    with pytest.raises(EngineError, match="ended before each skin had two turns; give them more time"):
        tune.tune(small(tmp_path))
    path = small(tmp_path)
    path.write_text(path.read_text().replace("0.1 s", "0.01 s"))
    with pytest.raises(CaseError, match=r"has 200 steps, two turns through its skins 2000; it is short as it is"):
        tune.tune(path)
