# SPDX-License-Identifier: GPL-2.0-or-later
"""Kind brazilian, a tablet of bonds: energies, the table of contacts, its key of strength, what is refused."""

import numpy as np
import pytest
from scene_runs import run, write_case
from stored_runs import CASES

from engines.hosts import CLASSES, LAMMPS, LIGGGHTS
from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.scenes.plan.model import pair_law
from epdem.scenes.plan.plan import plan
from epdem.theory.pair import E_star
from marks import thorough

STRENGTH = 100e6


def tablet(**changes):
    """Sixty spheres without friction, faster and smaller than those of the case."""
    data = read_toml(CASES / "tablet_strength.toml")
    data["scene"] |= {"diameter": "0.5 mm", "height": "0.8 mm", "thickness": "0.24 mm", "count": 60}
    data["scene"] |= {"unload_speed": "1 m/s", "test_speed": "1 m/s"}
    data["contact"] = {"bond_strength": f"{STRENGTH / 1e6} MPa"}
    data["output"] = {"rows": 400, "particles": 20, "energy": True}
    return data | changes


@pytest.mark.parametrize("host", [LIGGGHTS, LAMMPS, thorough(*CLASSES.values, marks=CLASSES.marks, id="yade")])
def test_a_tablet_is_pressed_and_broken(host, tmp_path):
    """Energies by two routes; no pull is above strength times area, and each pull is its spring's.

    Ejection ends contacts, whose dents compaction forgets: without bonds the same scene leaves 0.19 of its energy.
    """
    case = write_case(tablet(), tmp_path)
    found = run(case, host, out=tmp_path / "out").results
    balance = found.energy_balance
    moved = balance[["kinetic", "plastic", "elastic"]].abs().max().sum()
    steps = found.phases.set_index("phase")["end"]
    assert balance["balance"][balance["step"] <= steps["release"]].abs().max() < 5e-3 * moved
    assert balance["balance"].abs().max() < 0.05 * moved
    c = found.contacts
    assert set(c["bonded"].unique()) == {0.0, 1.0} and not c["bonded"][c["j"] == 0].any()
    assert (c["dent_radius"][c["bonded"] > 0] == c["contact_radius"][c["bonded"] > 0]).all()
    normal = c[["normal_x", "normal_y", "normal_z"]].to_numpy()
    pull = -(c[["force_x", "force_y", "force_z"]].to_numpy() * normal).sum(axis=1)
    pulls = pull > 1e-3 * pull.max()
    assert pulls.sum() > 20 and (c["bonded"][pulls] == 1).all()
    assert (pull[pulls] <= STRENGTH * np.pi * c["dent_radius"][pulls] ** 2 * (1 + 1e-3)).all()
    # from the overlap at which the contact alone has no force: the dent is what the screened one gives back less
    largest, E = c["delta_max"] + c["added_overlap"], E_star(12e9, 0.34, 12e9, 0.34)
    yields = pair_law(parse(tablet()), "powder", "powder")[0].backbone(E_star=E, R_star=25e-6, radius=50e-6)
    kept = 1 - (1 - c["screening"]) * (1 - yields.yield_overlap / largest)
    gives_back = (largest - c["residual_overlap"]) / kept
    stretch = c["delta_max"] - gives_back - c["overlap"] + c["retreat"]
    spring = 2 * E * c["dent_radius"] * stretch
    assert pull[pulls] == pytest.approx(spring[pulls].to_numpy(), rel=0.03)
    whole = [(c["bonded"][c["step"] == steps[name]] > 0).sum() for name in ("press", "free", "test")]
    assert whole[0] > whole[1] > 0 and whole[2] > 0
    assert found.rows["tensile_stress"].max() > 0


def test_what_bonds_need_is_said():
    for change, said in (
        ({"law": {"name": "cavity"}}, "law.compaction = true"),
        ({"contact": {"bond_strength": "1 MPa", "friction": 0.2, "tangential": "partial_slip"}}, "'history'"),
        ({"scene": tablet()["scene"] | {"thickness": "1 mm"}}, "below the height of the punch"),
    ):
        with pytest.raises(CaseError, match=said):
            plan(parse(tablet(**change)))
