# SPDX-License-Identifier: GPL-2.0-or-later
"""The time step of beds whose contacts stick or are pressed: LIGGGHTS is quiet below the limit of theory, not above."""

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from parts_cases import mm
from scene_runs import run, write_case

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines import log
from epdem.engines.liggghts import launcher
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.timestep import bed_share, impact, time_step
from epdem.theory import timestep

CASES = Path(__file__).parents[2] / "cases"
R, E, NU, DENSITY = 1e-3, 1e8, 0.3, 2500.0
OVERLAP = 2e-6
CELLS = 4  # unit cells along each edge: 256 spheres


def stable_step() -> float:
    """Of one of the contacts alone [s]: 2 sqrt(m*/k_n), k_n = 2 E* a."""
    E_star, R_star, m_star = E / (2 * (1 - NU**2)), R / 2, 4 / 3 * math.pi * R**3 * DENSITY / 2
    return 2 * math.sqrt(m_star / (2 * E_star * math.sqrt(R_star * OVERLAP)))


def energies(share: float, folder: Path, *, rubs: bool = True) -> np.ndarray:
    """Kinetic energy [J] of a face-centred cubic packing on 4000 steps of that share of the stable step."""
    edge = math.sqrt(2) * (2 * R - OVERLAP)
    corners = itertools.product(range(CELLS), repeat=3)
    basis = ((0, 0, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0))
    places = np.array([(np.array(c) + b + 0.25) * edge for c in corners for b in basis])
    places += np.random.default_rng(1).uniform(-1e-5, 1e-5, places.shape) * OVERLAP  # so that something moves
    high = CELLS * edge
    friction = "fix m3 all property/global coefficientFriction peratomtypepair 1 0.3" if rubs else ""
    deck = f"""
atom_style granular
atom_modify map array
boundary p p p
newton off
communicate single vel yes
region box block 0 {high!r} 0 {high!r} 0 {high!r} units box
create_box 1 box
neighbor 1e-4 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {E!r}
fix m2 all property/global poissonsRatio peratomtype {NU!r}
{friction}
pair_style gran model ep/hertz tangential {"history" if rubs else "off"}
pair_coeff * *
timestep {share * stable_step()!r}
fix motion all nve/sphere
"""
    deck += "".join(f"create_atoms 1 single {x!r} {y!r} {z!r} units box\n" for x, y, z in places.tolist())
    deck += f"set group all diameter {2 * R!r} density {DENSITY!r}\n"
    deck += "compute spin all erotate/sphere\nthermo 100\nthermo_style custom step atoms ke c_spin\n"
    deck += "thermo_modify norm no lost ignore\nrun 4000\n"
    folder.mkdir()
    (folder / "in.bed").write_text(deck)
    launcher.run("in.bed", folder)
    rows = log.rows(folder / launcher.OUT)
    return (rows["KinEng"] + rows["spin"]).to_numpy()[1:]


@pytest.mark.liggghts
def test_a_sticking_packing_is_quiet_at_the_step_of_scenes_and_explodes_above_the_limit_of_theory(tmp_path):
    """sqrt(1/(20 kappa)) of the contact's own step with kappa = 2 (1 - nu)/(2 - nu): 0.246."""
    limit = math.sqrt((2 - NU) / (40 * (1 - NU)))
    case = read_toml(CASES / "settle_glass.toml")
    case["materials"]["glass"] |= {"poisson_ratio": NU}
    x = impact(parse(case), "glass", R, "glass", 1.0, wall=False)
    assert bed_share(x, sticking=True) == pytest.approx(0.8 * limit, rel=1e-9)
    assert bed_share(x, sticking=False) == pytest.approx(0.8 * 0.5)
    quiet = energies(bed_share(x, sticking=True), tmp_path / "scene")
    below, above = energies(0.975 * limit, tmp_path / "below"), energies(1.055 * limit, tmp_path / "above")
    assert max(quiet.max() / quiet[0], below.max() / below[0]) < 3.0
    assert above.max() > 1e4 * below.max()  # until the contacts slip, which takes the energy away


@pytest.mark.liggghts
def test_a_frictionless_packing_is_quiet_up_to_half_of_the_step_of_one_contact(tmp_path):
    """Central springs of a face-centred cubic packing: 0.5 of the contact's own step."""
    quiet = [energies(share, tmp_path / f"at {share}", rubs=False) for share in (0.26, 0.48)]
    assert max(e.max() / e[0] for e in quiet) < 3.0
    assert energies(0.52, tmp_path / "above", rubs=False).max() > 1e4 * quiet[1].max()


def test_friction_makes_the_step_of_a_bed_smaller():
    data = read_toml(CASES / "settle_glass.toml") | {"numerics": {"error": 0.1}}
    steps = [time_step(parse(data | {"contact": {"friction": mu}}), 0.0) for mu in (0.0, 0.4)]
    # nu = 0.25: kappa = 6/7; both steps are rounded down to two digits
    assert steps[1] / steps[0] == pytest.approx(math.sqrt(7 / 120) / 0.5, rel=0.1)


def press(**keys):
    """80 spheres of 50 um in a box of 0.5 x 0.5 mm, 0.168 mm high without void, pressed to 0.178 mm: D = 0.94."""
    data = read_toml(CASES / "compaction_powder.toml")
    data["law"] = {"name": "cavity", "finite_strain": True, "compaction": True}
    data["scene"] |= {"box": mm(0.5, 0.5, 0.8), "count": 80, "height": "0.178 mm"} | keys
    data["scene"] |= {"unload_stroke": "0.02 mm"}
    data["output"] |= {"rows": 40, "particles": 20}
    return data


def test_a_pressed_contact_is_as_wide_as_in_a_random_packing_and_screened_by_eleven_others():
    """D = 0.94: x = 1 - (0.64/0.94)^(1/3) = 0.1203, a = sqrt(2 x) R = 0.4905 R, e = sqrt(11) a/(2 R) = 0.8134,
    gamma = 0.1866^1.5 + 11 x 0.4905 x 0.32/(2 pi 0.8844) = 0.0806 + 0.3107."""
    a = float(timestep.pressed_radius(0.94))
    assert a == pytest.approx(0.4905, abs=1e-4) and float(timestep.pressed_radius(0.6)) == 0.0
    assert float(timestep.screening(a, poisson_ratio_=0.34)) == pytest.approx(0.3913, abs=2e-4)
    assert float(timestep.screening(0.0, poisson_ratio_=0.34)) == 1.0
    assert float(timestep.screening(0.6, poisson_ratio_=0.5)) == 0.05


@pytest.mark.parametrize("mu", [0.0, 0.2])
def test_the_step_of_a_press_is_that_of_its_density_and_not_of_its_speed(mu):
    """0.8 of half of 2 sqrt(m*/k), k = 2 E* a/gamma; with friction of sqrt(0.6/(12 gamma kappa)) of it."""
    E_star, m_star = 12e9 / (2 * (1 - 0.34**2)), 4 / 3 * math.pi * 50e-6**3 * 8960 / 2
    a, gamma = 0.4905 * 50e-6, 0.3913
    share = min(0.5, math.sqrt(0.6 / (12 * gamma * 2 * 0.66 / 1.66))) if mu else 0.5
    expected = 0.8 * share * 2 * math.sqrt(m_star * gamma / (2 * E_star * a))
    for speed in ("1 m/s", "0.1 m/s"):
        found = plan(parse(press(speed=speed) | {"contact": {"friction": mu}})).time_step
        assert 0.9 * expected < found <= expected  # two digits, rounded down
    loose = plan(parse(press(height="0.26 mm") | {"contact": {"friction": mu}})).time_step  # D = 0.645
    assert loose > 1.3 * expected


@pytest.mark.liggghts
def test_a_press_is_quiet_at_the_step_of_its_density_and_explodes_at_twice_of_it(tmp_path):
    data = press() | {"contact": {"friction": 0.0}}
    step = plan(parse(data)).time_step
    created = []
    for factor in (1.0, 2.0):
        scene = write_case(data | {"numerics": {"time_step": f"{factor * step} s"}}, tmp_path)
        energy = run(scene, out=tmp_path / f"{factor}").results.tables["energy_balance"]
        created.append(energy["balance"].abs().max() / energy["work"].max())
    assert created[0] < 0.03 and created[1] > 1.0
