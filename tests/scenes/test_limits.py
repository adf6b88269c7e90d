# SPDX-License-Identifier: GPL-2.0-or-later
"""What an engine could not run, or would run otherwise than it is meant; how fast a scene gets, and its time step."""

import itertools
import math
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from parts_cases import BED, CASE, FLOOR, flat, linear, mm, parts, pipe, timed
from scene_runs import run, write_case
from stored_runs import CASES

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines import log
from epdem.engines.liggghts import launcher
from epdem.errors import CaseError
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan
from epdem.scenes.plan.timestep import bed_share, highest_speed, impact, time_step
from epdem.theory import timestep


def test_a_rate_is_taken_up_to_the_layer_s_filling():
    """A layer 12.8 mm deep on 30 mm x 30 mm falls out of itself in sqrt(2 h/g) = 51.1 ms; 0.26 of it are spheres."""
    data = read_toml(CASES / "settle_glass.toml")
    radii = [1.4e-3, 1.45e-3, 1.5e-3, 1.55e-3, 1.6e-3]
    volume = 4.18879 * sum(r**3 for r in radii) / len(radii)
    most = 0.26 * 30e-3 * 30e-3 * 12.8e-3 / volume / (2 * 12.8e-3 / 9.81) ** 0.5
    for rate in (0.999 * most, 1.001 * most):
        case = parse(data | {"scene": data["scene"] | {"rate": f"{rate:.9g} Hz"}})
        if rate < most:
            assert plan(case).insertions[0].rate == pytest.approx(rate)
        else:
            with pytest.raises(CaseError, match="rate"):
                plan(case)


def pressed(height: float, kind: str):
    """1500 spheres of 50 um on 1 mm^2 (0.785 mm without void), or 40 of 1.5 mm under a plate ("plates": on another)."""
    if kind == "compaction":
        data = read_toml(CASES / "compaction_powder.toml")
        return data | {"scene": data["scene"] | {"height": f"{height} mm"}}
    down = linear("lid", 0, 0, -0.1)
    size = {"room": mm(20, 20), "tube": mm(16.4, 16.4), "plates": mm(17, 17), "small": mm(18, 18)}[kind]
    lid = flat("lid", mm(0, 0, 39), size)
    tube = pipe("tube", "-1 mm", "39 mm", "16 mm")
    region = {"diameter": "16 mm", "z": mm(0, 38)}
    phase = timed("press", "1 s", move=[down], until={"wall": "lid", "travel": f"{39 - height} mm"})
    floor = lid | {"name": "floor", "center": mm(0, 0, 0)} if kind == "plates" else FLOOR
    if kind in ("tube", "plates"):
        return parts(wall=[floor, lid, tube], fill=[BED | {"region": region}], phase=[phase])
    return parts(wall=[FLOOR, lid], phase=[phase])


SOLID = {  # height without void [mm]: sum of volumes over the area
    "compaction": 1500 * 4 / 3 * np.pi * 0.05**3,
    "room": 40 * 4 / 3 * np.pi * 1.5**3 / 400,
    "tube": 40 * 4 / 3 * np.pi * 1.5**3 / (np.pi * 8**2),
    "plates": 40 * 4 / 3 * np.pi * 1.5**3 / (np.pi * 8**2),
}


@settings(max_examples=30, deadline=None)
@given(st.sampled_from(sorted(SOLID)), st.floats(0.3, 3.0).filter(lambda x: abs(x - 1) > 1e-3))
def test_a_plate_is_not_pressed_below_the_height_without_void(kind, share):
    case = parse(pressed(share * SOLID[kind], kind))
    if share > 1:
        plan(case)
    else:
        with pytest.raises(CaseError) as caught:
            plan(case)
        (height,) = re.findall(r"are (\S+) m high .* give a larger height", str(caught.value))
        assert float(height) == pytest.approx(1e-3 * SOLID[kind], rel=1e-3)


@pytest.mark.parametrize("kind", SOLID)
def test_a_bed_pressed_beyond_a_relative_density_of_nine_tenths_is_warned_of(kind):
    for density, said in ((0.89, []), (0.92, ["the relative density reaches 0.92"])):
        warnings = planned_warnings(plan(parse(pressed(SOLID[kind] / density, kind))))
        found = [text for text in warnings if "relative density" in text]
        assert len(found) == len(said) and all(part in text for part, text in zip(said, found, strict=True))


def test_spheres_may_pass_beside_a_plate_that_does_not_cover_the_room():
    plan(parse(pressed(0.5 * SOLID["room"], "small")))


COMMON = {"particles": [{"material": "glass", "radius": "1 mm"}], "count": 10, "walls": "steel", "duration": "1 s"}


def scene_of(keys):
    return parse(CASE | {"scene": COMMON | keys, "output": {}})


def hopper(**keys):
    lengths = {"bin_diameter": "100 mm", "bin_height": "80 mm", "outlet": "20 mm", "outlet_height": "30 mm"}
    return scene_of({"kind": "hopper", "half_angle": "30 deg", "fill_time": "0.1 s"} | lengths | keys)


@given(
    st.builds(
        lambda angle, height, drop, outlet: hopper(
            half_angle=f"{angle} deg", bin_height=f"{height} mm", outlet_height=f"{drop} mm", outlet=f"{outlet} mm"
        ),
        st.floats(5, 85),
        st.floats(20, 500),
        st.floats(10, 500),
        st.floats(5, 95),
    )
    | st.builds(lambda z: scene_of({"kind": "settle", "box": mm(50, 50, z)}), st.floats(20, 500))
)
def test_the_highest_speed_is_that_of_the_highest_fall(case):
    """v = sqrt(2 g h) with h between the planned top of the filling and the planned floor."""
    scene = case.parts
    top = scene.random_fills[0].region.limits[5]
    floor = next(plane.at for plane in scene.planes if plane.name == "floor")
    assert highest_speed(case) == pytest.approx(math.sqrt(2 * 9.81 * (top - floor)), rel=1e-9)


@given(st.floats(0, 20), st.floats(1, 60), st.integers(1, 5000))
def test_the_last_shot_of_a_stream_hits_with_the_energy_of_its_fall(gravity, speed, count):
    """v^2 = v_0^2 + 2 g h; the stream is as high as its shot goes in count/rate."""
    keys = {"kind": "peening", "width": "10 mm", "speed": f"{speed!r} m/s", "rate": "1 kHz", "count": count}
    case = scene_of(keys | {"gravity": f"{gravity!r} m/s^2"})
    height = case.parts.random_fills[0].region.limits[5]
    assert height >= speed * count / 1000
    assert highest_speed(case) == pytest.approx(math.sqrt(speed**2 + 2 * gravity * height), rel=1e-9)


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


def press_of_copper(**keys):
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
    """0.8 of (0.5 less 0.2 (1 - gamma)) of 2 sqrt(m*/k), k = 2 E* a/gamma; with friction of sqrt(0.6/(12 gamma kappa))
    where that is less."""
    E_star, m_star = 12e9 / (2 * (1 - 0.34**2)), 4 / 3 * math.pi * 50e-6**3 * 8960 / 2
    a, gamma = 0.4905 * 50e-6, 0.3913
    smooth = 0.5 - 0.2 * (1 - gamma)
    share = min(smooth, math.sqrt(0.6 / (12 * gamma * 2 * 0.66 / 1.66))) if mu else smooth
    expected = 0.8 * share * 2 * math.sqrt(m_star * gamma / (2 * E_star * a))
    for speed in ("1 m/s", "0.1 m/s"):
        found = plan(parse(press_of_copper(speed=speed) | {"contact": {"friction": mu}})).time_step
        assert 0.9 * expected < found <= expected  # two digits, rounded down
    loose = plan(parse(press_of_copper(height="0.26 mm") | {"contact": {"friction": mu}})).time_step  # D = 0.645
    assert loose > 1.3 * expected


@pytest.mark.liggghts
def test_a_press_is_quiet_at_the_step_of_its_density_and_explodes_at_twice_of_it(tmp_path):
    data = press_of_copper() | {"contact": {"friction": 0.0}}
    step = plan(parse(data)).time_step
    created = []
    for factor in (1.0, 2.0):
        scene = write_case(data | {"numerics": {"time_step": f"{factor * step} s"}}, tmp_path)
        energy = run(scene, out=tmp_path / f"{factor}").results.tables["energy_balance"]
        created.append(energy["balance"].abs().max() / energy["work"].max())
    assert created[0] < 0.03 and created[1] > 0.5
