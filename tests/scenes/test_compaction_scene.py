# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes with [law] compaction: energy, contacts by growth, restart; what does not go with it."""

import numpy as np
import pytest
from parts_cases import FLOOR, mm, parts, timed
from scene_runs import ran, run, write_case
from stored_runs import CASES

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines import scene_engine
from epdem.engines.liggghts import tables as tables
from epdem.errors import CaseError
from epdem.scenes.plan.plan import plan

COMPACT = {"name": "cavity", "finite_strain": True, "compaction": True}
STICKY = COMPACT | {"name": "cavity_adhesive"}


def pressed(law, **tables):
    """Eighty spheres without friction, pressed to a relative density of 0.80 and released."""
    data = read_toml(CASES / "compaction_powder.toml")
    del data["contact"]
    scene = {"box": mm(0.5, 0.5, 0.8), "count": 80, "height": "0.21 mm", "speed": "4 m/s", "unload_stroke": "0.03 mm"}
    output = {"rows": 100, "particles": 20, "energy": True}
    return data | {"law": law, "scene": data["scene"] | scene, "output": output} | tables


def test_a_press_of_spheres_that_stick_takes_half_of_the_step():
    """With the whole step press_tablet loses half of its pressure in its last hold at 1 J/m^2."""
    data = read_toml(CASES / "press_tablet.toml")
    laws = data["law"], data["law"] | STICKY | {"work_of_adhesion": "1 J/m^2"}
    plain, sticky = (plan(parse(data | {"law": law})).time_step for law in laws)
    assert sticky == pytest.approx(0.5 * plain, rel=0.1)


@pytest.mark.liggghts
@pytest.mark.parametrize("law", [COMPACT, STICKY | {"work_of_adhesion": "1 J/m^2"}], ids=lambda law: law["name"])
def test_energies_of_a_press_leave_nothing_over_and_growth_raises_its_force(law, tmp_path):
    """Plastic work and elastic energy come by two routes: what LIGGGHTS books, and the law at the stored overlaps."""
    force = []
    for name, on in (("on", True), ("off", False)):
        found = ran(pressed(law | {"compaction": on}), tmp_path / name).results
        balance = found.energy_balance
        moved = balance[["kinetic", "plastic", "elastic"]].abs().max().sum()
        assert balance["balance"].abs().max() < 0.02 * moved
        force.append(found.rows["plate_force"].max())
        grown = found.contacts.get("added_overlap", 0.0) * np.ones(len(found.contacts))
        assert (grown.max() > 1e-6) == (name == "on")
        assert ((found.contacts["overlap"] < 0) & (found.contacts["force"] > 0)).any() == (name == "on")
    assert 1.1 * force[1] < force[0] < 1.6 * force[1]


def lattice(folder, law):
    """64 spheres in a grid between planes, which a plate presses within 3 ms, holds and releases."""
    rng = np.random.default_rng(3)
    axis = 3.05e-3 * (np.arange(4) - 1.5)
    x = np.stack(np.meshgrid(axis, axis, axis + 6.125e-3, indexing="ij"), -1).reshape(-1, 3)
    x += rng.uniform(-2e-5, 2e-5, x.shape)
    rows = np.column_stack([x, rng.uniform(1.4e-3, 1.48e-3, 64)]).tolist()
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "spheres.csv").write_text(
        "\n".join(["x,y,z,radius,material", *(f"{','.join(map(repr, row))},glass" for row in rows), ""])
    )
    sides = [("left", "x", -6.1), ("right", "x", 6.1), ("front", "y", -6.1), ("back", "y", 6.1)]
    walls = [FLOOR | {"name": name, "axis": a, "at": f"{at} mm"} for name, a, at in sides]
    lid = {"name": "lid", "kind": "plate", "axis": "z", "center": mm(0, 0, 12.3), "material": "steel"}
    down, up = ({"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", v]} for v in ("-1 m/s", "1 m/s"))
    data = parts(
        wall=[FLOOR, *walls, lid | {"size": mm(17.9, 17.9)}],
        fill=[{"name": "table", "file": "spheres.csv"}],
        phase=[timed("press", "3 ms", move=[down]), timed("hold", "0.2 ms"), timed("release", "0.6 ms", move=[up])],
    )
    for material in data["materials"].values():
        material |= {"young_modulus": "12 MPa", "yield_stress": "0.1 MPa"}
    return write_case(data | {"law": law, "numerics": {"time_step": "4e-6 s"}}, folder)


@pytest.mark.lammps
@pytest.mark.liggghts
@pytest.mark.parametrize("law", [COMPACT, STICKY | {"work_of_adhesion": "0.02 J/m^2"}], ids=lambda law: law["name"])
def test_a_press_in_lammps_is_that_of_liggghts(law, tmp_path):
    """Forces, growth and energies of all contacts while the plate presses, stands and goes back."""
    path = lattice(tmp_path, law)
    ours, theirs = (run(path, engine=name, out=tmp_path / name).results for name in ("lammps", "liggghts"))
    for name in ("kinetic_energy", "largest_overlap_ratio", "lid_force_z", "floor_force_z", "left_force_x"):
        largest = np.abs(theirs.rows[name]).max()  # LIGGGHTS writes 8 digits
        assert np.abs(ours.rows[name] - theirs.rows[name]).max() <= 1e-6 * largest > 0, name
    a, b = ours.contacts, theirs.contacts
    keys = ["step", "wall", "i", "j"]
    assert a[keys].equals(b[keys])
    for name in ("overlap", "delta_max", "added_overlap", "force", "elastic_energy", "plastic_work"):
        assert np.abs(a[name] - b[name]).max() <= 1e-8 * b[name].max(), name
    assert ((a["overlap"] < 0) & (a["force"] > 0)).any() and (a["added_overlap"][a["j"] == 0] > 0).any()
    balance = ours.energy_balance
    assert balance["balance"].abs().max() < 0.01 * balance["work"].max()


def test_a_skin_that_growth_exceeds_is_refused():
    """A sphere touches a plane by growth of a tenth of its radius; lists are made anew after half a skin."""
    liggghts = scene_engine("liggghts")
    radius = plan(parse(pressed(COMPACT))).largest
    for share, law in ((0.21, COMPACT), (0.19, COMPACT | {"compaction": False})):
        liggghts.check(plan(parse(pressed(law, numerics={"skin": f"{share * radius!r} m"}))))
    with pytest.raises(CaseError, match=r"numerics.skin = .* give at least 0.2 of the largest radius"):
        liggghts.check(plan(parse(pressed(COMPACT, numerics={"skin": f"{0.19 * radius!r} m"}))))


def test_a_deck_without_compaction_names_it_nowhere():
    texts = scene_engine("liggghts").files(plan(parse(pressed(COMPACT | {"compaction": False}))))
    assert "compaction on" not in "".join(texts.values())
