# SPDX-License-Identifier: GPL-2.0-or-later
"""Our loops over pairs and walls and LIGGGHTS's own, with the same models: not one bit differs on any processor."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from plugin_decks import run
from plugin_loop import (
    NAMED,
    SAID,
    SAID_OF_WALLS,
    SIMD,
    WITH_ADHESION,
    WITH_COMPACTION,
    Scene,
    bodies,
    covering,
    deck,
    outcome,
)

from marks import thorough

pytestmark = pytest.mark.liggghts

SCENES = [*NAMED, *WITH_COMPACTION, *covering(), *covering(WITH_ADHESION)]


@pytest.fixture(scope="module")
def instruction_sets():
    """Those of the plugin that this processor has."""
    flags = Path("/proc/cpuinfo").read_text().split()
    needed = {"avx512": {"avx512f", "avx512dq", "avx512vl"}}
    found = [simd for simd in SIMD if needed.get(simd, {simd}) <= {*flags}]
    assert "sse2" in found
    return found


@pytest.mark.parametrize(
    "scene", [thorough(s, unless=s in NAMED + WITH_COMPACTION or n % 3 == 0, id=str(s)) for n, s in enumerate(SCENES)]
)
def test_both_loops_give_the_same_bits(tmp_path, scene, instruction_sets):
    """Positions, velocities, forces, spins and torques of 108 spheres after each of 60 steps."""
    theirs, text = outcome(tmp_path / "generic", scene, loop="generic")
    assert text.count(SAID) == 1 and SAID + "EPDEM_LOOP = generic" in text
    assert len(theirs) == 61 and np.abs(theirs[-1][:, 7:10]).max() > 0
    if scene.walls:
        assert np.all(np.abs(theirs[1:, :, [-4, -1]]).max(axis=(0, 1)) > 0)  # normal forces of both
    for simd in instruction_sets:
        ours, text = outcome(tmp_path / simd, scene, simd=simd)
        assert SAID not in text and SAID_OF_WALLS not in text
        assert np.array_equal(ours, theirs), f"{simd}: {np.abs(ours - theirs).max()}"
    if scene in WITH_COMPACTION:
        settings = tuple(s for s in scene.settings if s != "compaction on")
        without, _ = outcome(tmp_path / "off", replace(scene, settings=settings))
        assert not np.array_equal(without[-1][:, :4], theirs[-1][:, :4])


def test_without_the_elastic_energy_no_other_bit_changes(tmp_path):
    """computeElasticEnergy off: the same motion and plastic work in both loops; two properties are not there."""
    scene = WITH_COMPACTION[2]
    text = deck(scene).replace("compaction on", "compaction on computeElasticEnergy off")
    less = text.replace(" f_elasticEnergy f_loadedContacts", "")
    whole, _ = outcome(tmp_path / "whole", scene)
    for loop in ("", "generic"):
        works, _ = outcome(tmp_path / f"works{loop}", scene, loop=loop, text=less)
        assert np.array_equal(np.delete(whole, [-8, -7], axis=-1), works)  # before the forces of two walls
    with pytest.raises(AssertionError, match="Could not find dump custom fix ID"):
        outcome(tmp_path / "named", scene, text=text)


@pytest.mark.parametrize("law", ["hertz", "cavity", "thornton_ning"])
def test_a_restart_goes_on_with_the_other_loop(tmp_path, law):
    """In the middle of contacts, three materials: equal bits in all four combinations."""
    scene = Scene(law=law, types=3, rolling="epsd2", loose=True, walls=law != "thornton_ning")
    ends = []
    for first in ("", "generic"):
        folder = tmp_path / f"first{first}"
        outcome(folder, scene, loop=first, steps=30, end="write_restart x.restart\n")
        for second in ("", "generic"):
            name = str(folder / "x.restart")
            ends.append(outcome(tmp_path / f"{first}-{second}", scene, loop=second, steps=30, restart=name)[0])
    assert len(ends) == 4 and all(np.array_equal(ends[0], e) for e in ends[1:])


STRESS = (
    "compute s all stress/atom\ncompute sum all reduce sum c_s[1]\nthermo_style custom step atoms c_sum\nthermo 20\n"
)
LOCAL = "compute p all pair/gran/local id force history delta\ndump l all local 5 local.txt c_p[1] c_p[3]\n"
VISCOUS = "fix v all property/global coefficientRollingViscousDamping peratomtypepair 1 0.1\n"
EPSD3 = {"pair_style": VISCOUS + "fix s all property/global rollingStiffness scalar 2.25\npair_style"}


def output(lines):
    return {"thermo_modify": lines + "thermo_modify"}


MULTICONTACT = output("fix mc all multicontact/halfspace\n")
MULTICONTACT |= {"boundary p p p": "boundary s s s"}  # LIGGGHTS's does not survive a periodic box
MULTICONTACT |= {"\npair_coeff": " surface multicontact\npair_coeff"}
STORED = {"store_force yes": "store_force yes store_force_contact yes"}
REASONS = {  # keys of the scene, edits of its deck
    "pair": {
        "rolling_friction epsd": ({"rolling": "epsd"}, {"pair_style": VISCOUS + "pair_style"}),
        "rolling_friction epsd3": ({"rolling": "epsd3"}, EPSD3),
        "surface multicontact": ({}, MULTICONTACT),
        "heating_tangential_history on": ({"settings": ("heating_tangential_history on",)}, {}),
        "contacts at a distance": ({}, output("neigh_modify contact_distance_factor 1.1\n")),
        "steps that ask for the virial": ({"law": "thornton_ning", "loose": True}, output(STRESS)),
        "steps of compute pair/gran/local": ({}, output(LOCAL)),
    },
    "wall": {  # of the floor and of the lid
        "rolling_friction epsd3": ({"rolling": "epsd3", "walls": True}, EPSD3),
        "contacts with adhesion": ({"law": "jkr", "walls": True}, {}),
        "contact forces are stored": ({"walls": True}, STORED),
    },
}


@pytest.mark.parametrize(("loop", "reason"), [(loop, reason) for loop, rows in REASONS.items() for reason in rows])
def test_what_our_loops_cannot_do_takes_liggghts_loop_and_says_so_once(tmp_path, loop, reason):
    keys, edits = REASONS[loop][reason]
    scene = Scene(**keys)
    text = deck(scene)
    for old, new in edits.items():
        assert old in text
        text = text.replace(old, new, -1 if edits is STORED else 1)
    says, count = (SAID, 1) if loop == "pair" else (SAID_OF_WALLS, 2)
    frames, said = outcome(tmp_path / "ours", scene, text=text)
    assert said.count(says) == said.count(says + reason) == count
    assert (tmp_path / "ours" / "log.liggghts").read_text().count(says) == count
    theirs, said = outcome(tmp_path / "generic", scene, text=text, loop="generic")
    why = "EPDEM_LOOP = generic" if loop == "pair" or "stored" in reason else reason  # what the models lack comes first
    assert loop == "pair" or said.count(says + why) == count
    assert np.array_equal(frames, theirs)


def test_a_wrong_instruction_set_is_refused(tmp_path):
    scene = Scene()
    done = run(tmp_path, deck(scene), files={"packing.data": bodies(scene)}, env={"EPDEM_SIMD": "avx1024"})
    assert done.code == 1 and "EPDEM_SIMD = avx1024" in done.error and "sse2, avx2 or avx512" in done.error


@pytest.mark.parametrize("models", ["of the loop", "of LIGGGHTS alone"])
def test_a_wrong_loop_is_refused(tmp_path, models):
    scene = Scene() if models == "of the loop" else Scene(rolling="epsd")
    done = run(tmp_path, deck(scene), files={"packing.data": bodies(scene)}, env={"EPDEM_LOOP": "nonsense"})
    assert done.code == 1 and "EPDEM_LOOP = nonsense: no such loop" in done.error
