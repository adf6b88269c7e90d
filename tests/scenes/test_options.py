# SPDX-License-Identifier: GPL-2.0-or-later
"""Options that no case in cases/ uses: they run, and their lines are in the deck only then."""

import json
from pathlib import Path

import pytest
from removals import fingerprint
from scene_runs import write_deck
from stored_runs import STORED
from typer.testing import CliRunner

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.cli.main import app
from epdem.engines.liggghts.deck import deck
from epdem.errors import CaseError
from epdem.scenes.plan.plan import plan
from stored_decks import reasons

CASES = Path(__file__).parents[2] / "cases"


def poured() -> dict:
    """Sticky, rolling beads poured one after the other, with every output."""
    data = read_toml(CASES / "settle_glass.toml")
    scene = {"box": ["16 mm", "16 mm", "30 mm"], "count": 60, "rate": "800 Hz", "duration": "0.08 s"}
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
    scene = {"box": ["0.3 mm", "0.3 mm", "0.6 mm"], "count": 8, "height": "0.5 mm", "speed": "4 m/s"}
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
