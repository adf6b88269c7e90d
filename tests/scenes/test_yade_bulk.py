# SPDX-License-Identifier: GPL-2.0-or-later
"""Bulk scenes in YADE: weight, energy, and the same spheres pressed in LIGGGHTS, whose forces YADE does not know."""

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from parts_cases import mm, own
from scene_runs import ran, run, write_case, write_deck

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.cli import main as cli
from epdem.engines import log
from epdem.engines.liggghts import launcher
from epdem.engines.yade import tables as yade_tables
from epdem.engines.yade.launcher import OUT, environment
from epdem.errors import CaseError, EngineError
from epdem.scenes.plan import placement
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables.columns import named_rows

CASES = Path(__file__).parents[2] / "cases"
BEADS = {"box": mm(9, 9, 30), "count": 40, "duration": "0.3 s"}
FALL = {"box": mm(9, 9, 16), "count": 20, "duration": "0.07 s"}
POWDER = {"box": mm(0.4, 0.4, 0.65), "count": 50, "height": "0.22 mm", "speed": "2 m/s"}


def small(name: str, keys: dict, contact: dict | None = None, **tables: dict) -> dict:
    """A shrunk copy of a case with thornton; `contact` replaces its table."""
    data = own(name) | {"law": {"name": "thornton"}} | tables
    data |= {"scene": data["scene"] | keys}
    return data if contact is None else data | {"contact": contact}


def verdicts(outcome) -> dict[str, bool]:
    table = outcome.results.checks
    return dict(zip(table["key"], table["passed"], strict=True))


@pytest.mark.yade("module")
@pytest.mark.parametrize("sides", ["walls", "periodic"])
def test_the_floor_of_a_yade_bed_carries_its_weight(sides, tmp_path):
    path = write_case(small("settle_glass", BEADS | {"periodic": sides == "periodic"}), tmp_path)
    reported = []
    outcome = run(path, engine="yade", out=tmp_path / "out", report=lambda step, steps: reported.append((step, steps)))
    rows, spheres = outcome.results.rows, outcome.results.particles
    radius = spheres[spheres["step"] == 0]["radius"].to_numpy()
    weight = 2500 * 4 / 3 * np.pi * (radius**3).sum() * 9.81
    tail = rows[rows["time"] > 0.8 * 0.3]["floor_load"].mean()
    # the momentum that a bed of elastic springs still has, over the 0.06 s of the mean
    assert tail == pytest.approx(weight, rel=0.02)
    assert all(verdicts(outcome).values()) and "floor_load" in verdicts(outcome)
    assert len(radius) == 40 and (rows["particles"] == 40).all()
    assert reported == [(step, outcome.plan.steps) for step in rows["step"]], "progress by rows"
    assert run(path, engine="yade", out=tmp_path / "out").reused


@pytest.mark.yade("module")
@pytest.mark.parametrize("law", ["hertz", "thornton", "cavity"])
def test_the_energy_of_a_frictionless_bed_in_yade_leaves_nothing_over(law, tmp_path):
    data = small("settle_glass", FALL, {}, law={"name": law}, numerics={"error": 1e-3})
    outcome = ran(data, tmp_path, "yade")
    table = outcome.results.energy_balance
    fallen = table["gravity"].iloc[0] - table["gravity"].min()
    # velocity Verlet at the step for e_n within 1e-3 leaves 1e-4; a missing term would be tens of percent
    assert table["balance"].abs().max() < 1e-3 * fallen
    assert (table["plastic"].iloc[-1] > 0.2 * fallen) == (law != "hertz")
    assert table["plastic"].is_monotonic_increasing
    assert "friction" not in table


def liggghts_with_places_of(table: np.ndarray, case, folder: Path) -> None:
    """LIGGGHTS's own deck of a case, its random insertion replaced by the given spheres."""
    write_deck(case, folder)
    lines = (folder / "in.scene").read_text().splitlines()
    kept = [t for t in lines if not re.match(r"region fill1|fix (template|mix|fill)", t)]
    density = case.materials["powder"].density
    atoms = [f"create_atoms {int(kind)} single {x!r} {y!r} {z!r}" for x, y, z, _, kind in table.tolist()]
    sizes = [f"set atom {i} diameter {2 * row[3]!r} density {density!r}" for i, row in enumerate(table.tolist(), 1)]
    begin = next(i for i, t in enumerate(kept) if t.startswith("include"))
    (folder / "in.scene").write_text("\n".join([*kept[: begin + 1], *atoms, *sizes, *kept[begin + 1 :], ""]))


def pressed(path: Path, folder: Path):
    """(outcome of YADE, rows of LIGGGHTS) of one press on the same spheres."""
    outcome = run(path, engine="yade", out=folder / "yade")
    liggghts_with_places_of(np.loadtxt(folder / "yade" / "spheres.txt")[:, :5], outcome.case, folder / "liggghts")
    launcher.run("in.scene", folder / "liggghts")
    return outcome, named_rows(outcome.plan, log.scene_rows(outcome.plan, folder / "liggghts" / launcher.OUT))


@pytest.mark.yade("module")
@pytest.mark.liggghts
def test_spheres_under_a_press_take_the_same_way_in_yade_and_liggghts_until_it_is_chaos(tmp_path):
    outcome, other = pressed(write_case(small("compaction_powder", POWDER, {}), tmp_path), tmp_path)
    early = slice(1, len(other) // 5)
    rows = outcome.results.rows
    # both take the same steps; what YADE leaves of a force, 1e-6 of it, grows a few times in each collision
    assert rows["kinetic_energy"][early].to_numpy() == pytest.approx(other["kinetic_energy"][early], rel=1e-5)
    assert rows["plate_force"][early].sum() == pytest.approx(other["plate_force"][early].sum(), rel=1e-5) != 0.0
    assert (outcome.results.contacts["wall"] == "").any(), "not the plate alone"


@pytest.mark.yade("module")
@pytest.mark.liggghts
def test_a_press_on_rubbing_spheres_has_its_peak_force_and_a_steeper_unloading_in_both_codes(tmp_path):
    outcome, other = pressed(write_case(small("compaction_powder", POWDER), tmp_path), tmp_path)
    rows = outcome.results.rows
    # the ways part by chaos: four random fillings of this box differ by -4, 2, 2 and 3 % between the codes
    assert rows["plate_force"].max() == pytest.approx(other["plate_force"].max(), rel=0.1)
    turn = outcome.plan.phases[0].end
    top = rows["plate_force"].max()

    def way(part) -> float:
        """Way of the plate between the largest and half the largest force [m]."""
        return abs(
            np.interp(0.5 * top, *part.sort_values("plate_force")[["plate_force", "plate_z"]].to_numpy().T)
            - part["plate_z"].min()
        )

    assert way(rows[rows["step"] > turn]) < 0.5 * way(rows[rows["step"] <= turn]), "plastic spheres give little back"
    found = verdicts(outcome)
    assert found["loading_stiffness"] and found["recovered_work"]
    balance = outcome.results.energy_balance
    assert np.diff(balance["friction"]).min() > -0.02 * balance["friction"].max() < 0.0


@pytest.mark.yade("module")
def test_walls_rougher_than_the_spheres_make_them_spin_in_yade(tmp_path):
    """YADE's own rule is the smaller of two friction angles: then none would turn."""
    data = small("settle_glass", FALL | {"duration": "0.06 s"}, {"friction": 0.0, "wall_friction": 0.4})
    outcome = ran(data, tmp_path, "yade")
    last = outcome.results.particles.iloc[-20:]
    assert np.abs(last[["omega_x", "omega_y"]]).to_numpy().max() > 1.0


@pytest.mark.yade("alone", "module")
def test_the_folder_of_a_yade_scene_runs_by_hand_and_repeats_itself(tmp_path):
    path = write_case(small("settle_glass", FALL | {"duration": "0.02 s"}), tmp_path)
    assert not cli.app(["deck", str(path), "--engine", "yade", "--out", str(tmp_path / "deck")], standalone_mode=False)
    with (tmp_path / "deck/scene.py").open("a") as deck:
        deck.write("print('YADE leaves a folder:', Path(O.tmpFilename()).parent.exists(), file=sys.stderr)\n")
    done = subprocess.run(
        ["yade", "-n", "-x", "scene.py"],
        cwd=tmp_path / "deck",
        env=environment(),
        timeout=60,
        capture_output=True,
        text=True,
        check=True,
    )
    assert "YADE leaves a folder: False" in done.stderr
    (tmp_path / "deck" / OUT).write_text(done.stdout)
    outcome = run(path, engine="yade", out=tmp_path / "out")
    rows = named_rows(outcome.plan, yade_tables.rows(outcome.plan, tmp_path / "deck" / OUT))
    assert rows.equals(outcome.results.rows)


def test_spheres_begin_without_overlap_inside_the_box_and_with_their_shares_of_the_mass():
    data = read_toml(CASES / "settle_glass.toml")
    sizes = [
        {"material": "glass", "radius": "1 mm", "share": 0.3},
        {"material": "glass", "radius": "2 mm", "share": 0.7},
    ]
    case = parse(data | {"scene": data["scene"] | {"particles": sizes}})
    table = placement.spheres(plan(case))
    x, r = table[:, :3], table[:, 3]
    distance = np.linalg.norm(x[:, None] - x[None], axis=2) - r[:, None] - r[None] + np.diag(np.full(len(r), 1.0))
    assert len(table) == 1000 and distance.min() > 0.0
    assert (x - r[:, None] >= [-0.015, -0.015, 0.0]).all() and (x + r[:, None] <= [0.015, 0.015, 0.08]).all()
    # of 1000 draws 226 +- 13 are large, which is +- 0.016 of the mass: four standard deviations
    assert (r[r > 1.5e-3] ** 3).sum() / (r**3).sum() == pytest.approx(0.7, abs=0.06)


def test_without_the_module_a_scene_names_the_command_that_builds_it(tmp_path):
    for words in (["run"], ["deck"]):
        with pytest.raises(CaseError, match=r"scene: YADE has it with the module epdem_yade, .* run 'make yade', or"):
            command = [*words, str(CASES / "settle_glass.toml"), "--engine", "yade", "--out", str(tmp_path / "out")]
            cli.app(command, standalone_mode=False)
        assert not (tmp_path / "out").exists()


@pytest.mark.yade("module")
@pytest.mark.parametrize("option", [{"resume": True}, {"ranks": 2}])
def test_a_yade_scene_has_one_core_and_no_restart(option, tmp_path):
    with pytest.raises(CaseError, match="leave it out"):
        run(CASES / "settle_glass.toml", engine="yade", out=tmp_path / "out", **option)
    assert not (tmp_path / "out").exists()


@pytest.mark.yade("module")
def test_without_yade_a_scene_says_how_to_get_it_and_writes_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("EPDEM_YADE", "no-such-yade")
    with pytest.raises(EngineError, match="apt-get install yade") as found:
        run(CASES / "settle_glass.toml", engine="yade", out=tmp_path / "out")
    assert found.value.exit_code == 3
    assert not (tmp_path / "out").exists()


def test_a_scene_has_one_engine_and_it_is_one_that_runs_scenes(tmp_path):
    for words in (["--engine", "yade", "--engine", "liggghts"], ["--engine", "embedded"]):
        with pytest.raises(CaseError, match="engine"):
            cli.app(["run", str(CASES / "settle_glass.toml"), *words, "--out", str(tmp_path)], standalone_mode=False)
