# SPDX-License-Identifier: GPL-2.0-or-later
"""Options that no case in cases/ uses: they run, and their lines are in the deck only then."""

import json
from pathlib import Path

import numpy as np
import pytest
from parts_cases import mm
from removals import fingerprint
from scene_runs import run, write_deck
from stored_runs import STORED
from typer.testing import CliRunner

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.cli.main import app
from epdem.engines.liggghts.deck import deck, files
from epdem.errors import CaseError
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.timestep import time_step
from stored_decks import reasons

CASES = Path(__file__).parents[2] / "cases"


def poured() -> dict:
    """Sticky, rolling beads poured one after the other, with every output."""
    data = read_toml(CASES / "settle_glass.toml")
    scene = {"box": mm(16, 16, 30), "count": 60, "rate": "800 Hz", "duration": "0.08 s"}
    contact = {
        "friction": 0.4,
        "cohesion": "1e3 J/m^3",
        "tangential_restitution": 0.5,
        "pairs": [{"between": ["glass", "wall"], "friction": 0.1}],
        "rolling": {"model": "epsd", "coefficient": 0.05, "damping": 0.3},
    }
    output = {"rows": 20, "particles": 2, "pictures": 2, "restarts": 2, "energy": True, "loads": True}
    return data | {"scene": data["scene"] | scene, "contact": contact, "output": output, "numerics": {"error": 0.1}}


def bed() -> dict:
    """Shot on a bed of another material than the shot."""
    data = read_toml(CASES / "peening_steel.toml")
    scene = {"width": "6 mm", "count": 12, "duration": "0.3 ms", "gravity": "9.81 m/s^2"}
    scene |= {"bed": [{"material": "plate", "radius": "0.5 mm"}], "bed_count": 30, "bed_settle_time": "1 ms"}
    return data | {"scene": data["scene"] | scene, "output": {"rows": 20, "particles": 2}, "numerics": {"error": 0.1}}


def tiny() -> dict:
    """Powder in a room so small that LIGGGHTS runs it only if it is asked to."""
    data = read_toml(CASES / "compaction_powder.toml")
    scene = {"box": mm(0.3, 0.3, 0.6), "count": 8, "height": "0.5 mm", "speed": "4 m/s"}
    return data | {"scene": data["scene"] | scene, "output": {"rows": 20}, "numerics": {"error": 0.1}}


@pytest.mark.liggghts
@pytest.mark.parametrize("data", [poured(), bed(), tiny()], ids=["poured", "bed", "tiny"])
def test_a_deck_with_rare_options_runs_and_repeats_itself(data, tmp_path):
    write_deck(parse(data), tmp_path / "deck")
    lines = reasons(plan(parse(data)))
    assert [line for _, line, reason in lines if not reason] == []
    found = fingerprint(tmp_path / "deck", "in.scene")
    assert found is not None
    written = {p.suffix for p in (tmp_path / "deck").iterdir()}
    if "pictures" in data["output"]:
        assert {".ppm", ".bin", ".txt"} <= written


def test_the_walls_keep_their_material_whatever_the_order_of_types():
    d = deck(plan(parse(bed())))
    strength = next(p for p in d.contact.properties if p.name == "yieldPressure")
    types = d.plan.types
    assert types == ("plate", "shot") and {types[wall.type - 1] for wall in (*d.primitives, *d.meshes)} == {"plate"}
    assert strength.values[0] < strength.values[1]


@pytest.mark.liggghts
def test_the_command_takes_its_own_folder_again_and_its_figures_are_no_files_of_the_user(tmp_path):
    """Twice the same call, a fresh one, and one that is forced to take a folder with a file of the user's."""
    case, out = str(STORED / "settle/case.toml"), tmp_path / "out"
    call = ["run", case, "--out", str(out), "--json"]
    first = CliRunner().invoke(app, call)
    documents = [json.loads(first.stdout)]
    assert all((out / name).is_file() for name in ("scene.png", "energy.png"))
    page = (out / "report.html").read_text()
    assert "Spheres and walls at" in page and "Energy balance" in page
    documents += [json.loads(CliRunner().invoke(app, more).stdout) for more in (call, [*call, "--fresh"])]
    assert [d["reused"] for d in documents] == [False, True, False]
    assert all(d["checks"] == documents[0]["checks"] for d in documents)
    (out / "energy.png").write_text("the user's own")
    refused = CliRunner().invoke(app, call)
    assert isinstance(refused.exception, CaseError) and "energy.png" in str(refused.exception)
    assert json.loads(CliRunner().invoke(app, [*call, "--force"]).stdout)["reused"]


def beads(restitution=None, **contact) -> dict:
    """The settling beads, with a dashpot of `restitution`."""
    data = read_toml(CASES / "settle_glass.toml") | {"contact": contact}
    return data if restitution is None else data | {"viscous": {"restitution": restitution}}


def setup_of(data: dict) -> str:
    return files(plan(parse(data, "case.toml")))["setup.in"]


def test_a_scene_has_the_dashpot_in_pair_and_walls_only_if_it_asks():
    models = sum(word in line for line in setup_of(beads()).splitlines() for word in ("pair_style", "wall/gran"))
    for data, expected in ((beads(), 0), (beads(0.7), models)):
        text = setup_of(data)
        assert text.count("viscous on") == expected
        assert ("coefficientRestitution peratomtypepair 1 0.7 " in text) is (expected > 0)
        assert "tangential_damping" not in text, "there is no friction, so nothing to switch off"
        lines = reasons(plan(parse(data, "case.toml")))
        assert [line for _, line, why in lines if not why] == []


def test_a_dashpot_along_the_normal_does_not_bring_one_along_the_tangent():
    assert "tangential_damping off" in setup_of(beads(0.7, friction=0.3))
    assert "tangential_damping" not in setup_of(beads(0.7, friction=0.3, tangential_restitution=0.7))


def test_a_strong_dashpot_makes_the_step_smaller():
    """The engine knows the speed half a step late: an error of first order that grows with the dashpot."""
    steps = [time_step(parse(beads(e) | {"numerics": {"error": 0.01}}), 0.0) for e in (None, 0.9, 0.3)]
    assert steps[0] > steps[1] > 2 * steps[2]


@pytest.mark.liggghts
def test_elastic_shot_with_a_dashpot_leaves_the_plate_with_its_restitution(tmp_path):
    """Hertz never yields, so the restitution of the dashpot is that of every impact, by definition."""
    restitution = 0.4
    text = (CASES / "peening_steel.toml").read_text().replace('"johnson"', '"hertz"')
    text = text.replace("count = 200", "count = 60").replace('"2.4 ms"', '"1.2 ms"').replace("energy = true", "")
    (tmp_path / "case.toml").write_text(f"{text}\n[viscous]\nrestitution = {restitution}\n")
    table = run(tmp_path / "case.toml", out=tmp_path / "out").results.particles
    alone = table[(table["vz"] > 0) & (np.hypot(table["vx"], table["vy"]) < 1e-9)]
    ratio = alone.groupby("id")["vz"].max() / 30.0
    assert len(ratio) > 10
    # the case's own target error of e_n is 1e-3
    assert np.abs(ratio / restitution - 1).max() < 1e-3


@pytest.mark.liggghts
def test_elastic_beads_come_to_rest_by_a_dashpot_alone_and_the_ledger_names_the_loss(tmp_path):
    text = (CASES / "settle_glass.toml").read_text().replace('"thornton"', '"hertz"').split("[contact]")[0]
    for old, new in (
        ('["30 mm", "30 mm", "80 mm"]', '["12 mm", "12 mm", "30 mm"]'),
        ("count = 1000", "count = 70"),
        ('"0.5 s"', '"0.3 s"'),
    ):
        text = text.replace(old, new)
    text += "[viscous]\nrestitution = 0.3\n[output]\nparticles = 20\nenergy = true\n[numerics]\nerror = 0.1\n"
    (tmp_path / "case.toml").write_text(text)
    found = run(tmp_path / "case.toml", out=tmp_path / "out").results
    table = found.energy_balance
    given = table.loc[0, ["kinetic", "elastic", "gravity"]].sum() - table["gravity"].iloc[-1]
    assert table["kinetic"].iloc[-1] < 1e-4 * given
    # nothing else takes energy here: what fell and is neither moving nor elastic (below 1 % in a bed at rest) is lost
    assert table["friction"].iloc[-1] == pytest.approx(given, rel=0.01)
    assert np.diff(table["friction"]).min() > -1e-3 * given
    assert "energy_residual" not in set(found.checks["key"])
