# SPDX-License-Identifier: GPL-2.0-or-later
"""Drawn decks of LAMMPS: `hertz` has the motion of LAMMPS's own model; lists, ranks and restarts change no law."""

import random
import re

import numpy as np
import pytest
from drawn_decks import ONE_BY_ONE, Deck, difference, merge, read_features, run, spheres
from hypothesis import assume, example, given, note
from hypothesis import strategies as st

from epdem.engines.lammps import launcher

pytestmark = pytest.mark.lammps

FEATURES = read_features("lammps")
RADIUS, PITCH = 1e-3, 1.96e-3  # [m]
LAWS = {  # parameters of both types
    "hertz": ("", ""),
    "thornton": ("2e6", "1e6"),
    "cavity": ("7e5", "4e5"),
    "johnson": ("2e6", "1e6"),
    "meyer": ("2e6 0.2", "1e6 0.2"),
    "jkr": ("5", "3"),
    "thornton_ning": ("5 2e6", "3 1e6"),
    "cavity_adhesive": ("0.05 7e5", "0.03 4e5"),
}
MODELS = ["history 0.3", "none", "history 0.3 restitution 0.7", "no_history 0.3 restitution 0.7"]
MODELS += ["history 0.3 rolling epsd2 0.1", "history 0.3 rolling cdt 0.1"]
WITHOUT_ADHESION = ["partial_slip 0.3", "history 0.3 cohesion sjkr 1e4"]
OWN = "hertz/material 1e8 0.0 0.3 tangential linear_nohistory 0.0 0.0"
DUMP = "write_dump all custom end.txt id x y z vx vy vz omegax omegay omegaz modify sort id format float %.17g\n"


def draw(seed):
    """(features, what is drawn of the law, text of the data file) of a seed."""
    rng = random.Random(seed)
    names = tuple(rng.sample(sorted(FEATURES), rng.choice((1, 2, 2, 3))))
    law = rng.choice(list(LAWS))
    models = MODELS + WITHOUT_ADHESION * (law not in ("jkr", "thornton_ning", "cavity_adhesive"))
    options = rng.choice(models)
    if law == "cavity" and "cohesion" not in options and rng.random() < 0.4:
        options += " compaction on"
    at = {
        "boundary": rng.choice(("f f f", "p p f", "p p p", "s s s")),
        "walls": rng.choice(("planes", "region", "none")),
        "integrate": "fix integr all nve/sphere",
        "atom_style": "sphere",
        "pairs": ["pair_style <STYLE>", "pair_coeff 1 1 <W1>", "pair_coeff 2 2 <W2>"],
    } | merge(rng, [FEATURES[name] for name in names])
    if at["walls"] == "none":
        at["boundary"] = at["boundary"].replace("f", "m")
    cells = rng.choice((4, 5))
    half = cells * PITCH / 2 + 2e-5
    box = [(-half, half) if b == "p" else (-half - 3e-3, half + 3e-3) for b in at["boundary"].split()]
    tilt = f"{0.2 * half!r} 0 0 xy xz yz\n" if at.get("triclinic") else ""
    data = spheres(rng, cells, PITCH, box, 2, lambda _, kind: 2 * RADIUS * (1, 0.97)[kind - 1], tilt, "Atoms # sphere")
    words = [f"{law} 1e8 0.3 {strength} tangential {options}" for strength in LAWS[law]]
    return names, at, words, half, data


def deck_of(at, words, half, data, *, own=False, other_lists=False, ranks=1):
    """The deck with contacts of `words` or of LAMMPS's own model, by these lists."""
    word = [OWN, OWN] if own else words

    def wall(place):
        if own:
            return f"wall/gran granular {word[0]} {place}"
        return f"wall/ep {place} {word[0]}"

    def wall_of(region):
        return f"wall/gran/region granular {word[0]} region {region}" if own else f"wall/ep/region {region} {word[0]}"

    periodic = [b == "p" for b in at["boundary"].split()]
    walls, edge = [], half - 1e-5
    if at["walls"] == "planes":
        sides = [axis for axis, p in zip("xyz", periodic, strict=True) if not p]
        walls = [f"fix w{axis} all {wall(f'{axis}plane {-edge!r} {edge!r}')}" for axis in sides]
    elif at["walls"] == "region" and not all(periodic):
        sides = " ".join("INF INF" if p else f"{-edge!r} {edge!r}" for p in periodic)
        walls = [f"region room block {sides} units box", f"fix wr all {wall_of('room')}"]
    head = [f"atom_style {at['atom_style']}", "atom_modify map array sort " + ("10 0.0" if other_lists else "0 0")]
    head += ["comm_modify vel yes", f"newton {'on' if other_lists else 'off'}"]
    lists = [f"neighbor {'5e-4' if other_lists else '3e-4'} bin", "neigh_modify delay 0 every 1 check yes", *at["head"]]
    rest = [*walls, "fix g all gravity 981 vector 0.3 0.1 -1", *at["fixes"], *at["integrate"].splitlines()]
    rest += ["timestep 5e-7", f"thermo_style custom step atoms ke{at['thermo']}"]
    rest += ["thermo_modify lost ignore norm no format float %.15g"]
    between = [line for line in at["between"] if line != "<RESTART>"]
    if "<RESTART>" in at["between"]:
        again = [line for line in lists if not line.startswith("group")]
        again += at["pairs"] + [line for line in rest if not line.startswith("group")]
        between += ["write_restart r.bin", "clear", *head[1:], "read_restart r.bin", *again]
    lines = ["units si", f"boundary {at['boundary']}", *head, "read_data box.data", *lists, *at["pairs"], *rest]
    text = "\n".join([*lines, "run 300", *between, "run 300"]) + "\n" + DUMP
    text = text.replace("<STYLE>", "granular" if own else "ep").replace("<W1>", word[0]).replace("<W2>", word[1])
    text = re.sub(r"<WALL (\w+)>", lambda found: wall_of(found[1]), text).replace("<PLANE>", wall("zplane 0.0 NULL"))
    return Deck(text, {"box.data": data}, ranks)


def motion(deck, folder):
    """Rows by atom at the end, x to omega; None: LAMMPS refused the deck or died, as some do with a rigid body."""
    command = launcher.command("in.deck", ranks=deck.ranks)
    code, _, files = run(deck, command, folder, launcher.environment())
    assume(code != 124)
    if code:
        return None
    return np.loadtxt(files["end.txt"].decode().splitlines()[9:], ndmin=2)


def assert_equal(one, two, tolerance):
    """Both refused, or the same motion within a share of the largest values."""
    assert (one is None) == (two is None)
    assume(one is not None)
    assert np.array_equal(one[:, 0], two[:, 0])
    for columns in (slice(4, 7), slice(7, 10)):  # a position may be that of another periodic image
        scale = np.abs(one[:, columns]).max(initial=1e-300)
        assert np.abs(one[:, columns] - two[:, columns]).max(initial=0.0) <= tolerance * scale


@ONE_BY_ONE
@given(seed=st.integers(0, 10**9))
def test_hertz_has_the_motion_of_the_own_model_of_lammps(seed, tmp_path_factory):
    names, at, _, half, data = draw(seed)
    note(", ".join(names))
    assume(not at.get("differs"))
    folder = tmp_path_factory.mktemp("deck")
    words = ["hertz 1e8 0.3 tangential none"] * 2
    pair = [motion(deck_of(at, words, half, data, own=own), folder / f"own{own}") for own in (False, True)]
    assert_equal(*pair, 1e-6)


@ONE_BY_ONE
@given(seed=st.integers(0, 10**9))
@example(seed=1457)  # new types of contacts at their largest overlap, and positions that `balance` rounds anew
def test_other_lists_ranks_and_numbers_change_no_motion(seed, tmp_path_factory):
    """New numbers follow the places between the runs; velocities and spins are alike, whichever their numbers."""
    names, at, words, half, data = draw(seed)
    note(", ".join(names))
    folder = tmp_path_factory.mktemp("deck")
    anew = at | {"between": [*at["between"], "reset_atoms id sort yes"]}
    one = motion(deck_of(at, words, half, data), folder / "one")
    two = motion(deck_of(anew, words, half, data, other_lists=True, ranks=2), folder / "two")
    assert (one is None) == (two is None)
    assume(one is not None)
    for columns in (slice(4, 7), slice(7, 10)):
        assert difference(one[:, columns], two[:, columns]) <= 1e-6


@ONE_BY_ONE
@given(seed=st.integers(0, 10**9))
def test_a_restart_changes_no_motion(seed, tmp_path_factory):
    """Beside a second run at its place, with the same number of ranks."""
    names, at, words, half, data = draw(seed)
    note(", ".join(names))
    ranks = 1 + seed % 2
    folder = tmp_path_factory.mktemp("deck")
    plain = motion(deck_of(at | {"between": []}, words, half, data, ranks=ranks), folder / "plain")
    again = motion(deck_of(at | {"between": ["<RESTART>"]}, words, half, data, ranks=ranks), folder / "again")
    assert_equal(plain, again, 1e-12)
