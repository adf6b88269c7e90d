# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes with [law] compaction: energy, contacts by growth, restart; what does not go with it."""

import numpy as np
import pytest
from parts_cases import FLOOR, parts
from scene_runs import restart_steps, run, write_case, write_deck
from stored_runs import CASES

from engines.lammps_decks import needs_lammps
from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines import scene_engine
from epdem.engines.frames import Frames
from epdem.engines.liggghts import launcher, resume
from epdem.engines.liggghts import tables as tables
from epdem.errors import CaseError
from epdem.scenes.plan.plan import plan

COMPACT = {"name": "cavity", "finite_strain": True, "compaction": True}


def pressed(law, **tables):
    """Eighty spheres without friction, pressed to a relative density of 0.80 and released."""
    data = read_toml(CASES / "compaction_powder.toml")
    del data["contact"]
    scene = {"box": ["0.5 mm", "0.5 mm", "0.8 mm"], "count": 80, "height": "0.21 mm", "speed": "4 m/s"}
    scene |= {"unload_stroke": "0.03 mm"}
    output = {"rows": 100, "particles": 20, "energy": True}
    return data | {"law": law, "scene": data["scene"] | scene, "output": output} | tables


@pytest.mark.liggghts
def test_energies_of_a_press_leave_nothing_over_and_growth_raises_its_force(tmp_path):
    """Plastic work and elastic energy come by two routes: what LIGGGHTS books, and the law at the stored overlaps."""
    force = []
    for name, law in (("on", COMPACT), ("off", COMPACT | {"compaction": False})):
        found = run(write_case(pressed(law), tmp_path / name), out=tmp_path / name / "out").results
        balance = found.energy_balance
        moved = balance[["kinetic", "plastic", "elastic"]].abs().max().sum()
        assert balance["balance"].abs().max() < 0.02 * moved
        force.append(found.rows["plate_force"].max())
        grown = found.contacts.get("added_overlap", 0.0) * np.ones(len(found.contacts))
        assert (grown.max() > 1e-6) == (name == "on")
        assert ((found.contacts["overlap"] < 0) & (found.contacts["force"] > 0)).any() == (name == "on")
    assert 1.1 * force[1] < force[0] < 1.6 * force[1]


@pytest.mark.liggghts
def test_a_continued_press_ends_bitwise_where_the_uninterrupted_one_does(tmp_path):
    p = write_deck(parse(pressed(COMPACT, output={"rows": 20, "particles": 10, "restarts": 10})), tmp_path)
    launcher.run("in.scene", tmp_path)

    def last():
        table = tables.particles(Frames(p, tmp_path, tables.kinds(p), range(p.steps)))
        return table[table["step"] == p.steps].to_numpy()

    whole = last()
    step = restart_steps(tmp_path)[-4]
    for frame in tmp_path.glob("particles.*.bin"):
        frame.unlink()
    resume.write_resume(p, tmp_path, step)
    launcher.run("in.resume", tmp_path)
    assert np.array_equal(last(), whole)


def lattice(folder):
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
    lid = {"name": "lid", "kind": "plate", "axis": "z", "center": ["0 mm", "0 mm", "12.3 mm"], "material": "steel"}
    down, up = ({"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", v]} for v in ("-1 m/s", "1 m/s"))
    data = parts(
        wall=[FLOOR, *walls, lid | {"size": ["17.9 mm", "17.9 mm"]}],
        fill=[{"name": "table", "file": "spheres.csv"}],
        phase=[
            {"name": "press", "duration": "3 ms", "move": [down]},
            {"name": "hold", "duration": "0.2 ms"},
            {"name": "release", "duration": "0.6 ms", "move": [up]},
        ],
    )
    for material in data["materials"].values():
        material |= {"young_modulus": "12 MPa", "yield_stress": "0.1 MPa"}
    return write_case(data | {"law": COMPACT, "numerics": {"time_step": "4e-6 s"}}, folder)


@needs_lammps
@pytest.mark.liggghts
def test_a_press_in_lammps_is_that_of_liggghts(tmp_path):
    """Forces, growth and energies of all contacts while the plate presses, stands and goes back."""
    path = lattice(tmp_path)
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


REFUSED = {
    "law": ({"law": {"name": "thornton", "compaction": True}}, "law.compaction: law thornton has none"),
    "word": ({"law": COMPACT | {"compaction": 1}}, "law.compaction = 1: it is true or false"),
    "cohesion": ({"contact": {"cohesion": "1e3 J/m^3"}}, "contact.cohesion: .* law.compaction have no cohesion"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_case_that_cannot_have_compaction_is_refused(what):
    tables, said = REFUSED[what]
    with pytest.raises(CaseError, match=said):
        plan(parse(pressed(COMPACT) | tables))


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
