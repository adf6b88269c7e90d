# SPDX-License-Identifier: GPL-2.0-or-later
"""Forces, normals and radii of the table of contacts, of beds at rest with friction in every engine; of many radii."""

import copy
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from parts_cases import linear, mm, timed
from scene_runs import HOSTS, PRESSES, run, write_case

from epdem.case import scene
from epdem.case.scene import load
from epdem.case.toml import read_toml
from epdem.scenes.plan.model import pair_law
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables import columns, results

GLASS = {"young_modulus": "10 MPa", "poisson_ratio": 0.3, "density": "2500 kg/m^3", "yield_stress": "0.02 MPa"}
BOX = {"name": "box", "kind": "box", "x": mm(-4, 4), "y": mm(-4, 4), "z": mm(0, 20)}
CASE = {
    "case": {"name": "rest", "title": "A bed at rest", "source": "a test"},
    "materials": {"glass": GLASS},
    "law": {"name": "thornton"},
    "viscous": {"restitution": 0.3},
    # rolling friction, without which spheres roll on for seconds
    "contact": {"friction": 0.5, "tangential_restitution": 0.3, "rolling": {"model": "epsd2", "coefficient": 0.1}},
    "scene": {
        "kind": "parts",
        "room": {"x": mm(-6, 6), "y": mm(-6, 6), "z": mm(0, 20)},
        "gravity": "9.81 m/s^2",
        "wall": [
            {"name": "floor", "kind": "plane", "axis": "z", "at": "0 mm", "material": "glass"},
            BOX | {"open": ["+z", "-z"], "material": "glass"},
        ],
        "fill": [
            {
                "name": "bed",
                "region": {"x": mm(-4, 4), "y": mm(-4, 4), "z": mm(0, 16)},
                "particles": [{"material": "glass", "radius": "1 mm"}],
                "count": 30,
            }
        ],
        "phase": [timed("rest", "0.6 s")],
    },
    "output": {"contacts": 2, "particles": 2, "loads": True, "energy": True},
    "numerics": {"time_step": "10 us"},
}
PRESS = 0.3  # [N]
PRESSED = copy.deepcopy(CASE)  # to overlaps of half a radius, where contacts grow
PRESSED["law"] = {"name": "cavity", "finite_strain": True, "compaction": True}
PRESSED["numerics"] = {"time_step": "5 us"}
PRESSED["viscous"] = {"restitution": 0.14}
PRESSED["contact"] = {"friction": 0.5, "tangential_restitution": 0.14}
LID = {"name": "lid", "kind": "plate", "axis": "z", "center": mm(0, 0, 13), "size": mm(8, 8)}
PRESSED["scene"]["wall"].append(LID | {"material": "glass"})
PRESSED["scene"]["fill"][0]["region"]["z"] = mm(0, 12)
PRESSED["scene"]["phase"] = [
    timed("fall", "0.05 s"),
    timed(
        "press", "0.1 s", until={"wall": "lid", "force": f"{PRESS} N", "after": "0 s"}, move=[linear("lid", 0, 0, -0.1)]
    ),
    timed("rest", "0.3 s"),
]
BY_WAY = copy.deepcopy(PRESSED)  # in YADE, as far as the lid goes in LAMMPS
BY_WAY["scene"]["phase"][1]["until"] = {"wall": "lid", "travel": "9.3 mm"}


@pytest.fixture(scope="module")
def beds():
    """Beds that have run, by engine and case."""
    return {}


@pytest.fixture(params=HOSTS)
def make_bed(request, beds, tmp_path_factory, module_of_yade):
    """(case file, results) of a bed in an engine."""

    def make(case):
        key = request.param, id(case)
        if key not in beds:
            folder = tmp_path_factory.mktemp(request.param)
            path = write_case(BY_WAY if case is PRESSED and request.param == "yade" else case, folder)
            run(path, request.param, out=folder / "out")
            beds[key] = path, results.read(folder / "out/results.h5")
        return beds[key]

    return make


@pytest.fixture
def bed(make_bed):
    return make_bed(CASE)


def last(bed):
    """Spheres by id and contacts of the last frame, forces and normals of the contacts."""
    _, r = bed
    end = r.contacts["step"].max()
    spheres, contacts = (t[t["step"] == end].reset_index(drop=True) for t in (r.particles, r.contacts))
    vectors = (contacts[[f"{name}_{axis}" for axis in "xyz"]].to_numpy() for name in ("force", "normal"))
    return spheres.set_index("id"), contacts, *vectors


@pytest.mark.parametrize(("case", "press", "least"), [(CASE, 0.0, 6), (PRESSED, PRESS, 3)], ids=["poured", "pressed"])
def test_the_forces_on_each_sphere_at_rest_bear_its_weight_and_those_on_walls_are_the_loads(
    make_bed, case, press, least
):
    """press: force of the lid [N]; least: number of contacts of a wall."""
    bed = make_bed(case)
    spheres, contacts, force, _ = last(bed)
    sums = np.zeros((len(spheres) + 1, 3))
    pairs = contacts["j"].to_numpy() > 0
    np.add.at(sums, contacts["i"].to_numpy(), force)
    np.add.at(sums, contacts["j"].to_numpy()[pairs], -force[pairs])
    weight = 9.81 * spheres["mass"].sort_index().to_numpy()
    sums[1:, 2] -= weight
    assert len(contacts) > 60 and abs(sums).max() < 1e-6 * weight.sum()
    row = bed[1].rows.iloc[-1]
    for wall in [wall["name"] for wall in case["scene"]["wall"]]:
        load = [row[f"{wall}_force_{axis}"] for axis in "xyz"]
        at = contacts["wall"].to_numpy() == wall
        assert -force[at].sum(axis=0) == pytest.approx(load, abs=1e-6 * max(weight.sum(), press)) and at.sum() >= least


@pytest.mark.parametrize("make_bed", PRESSES, indirect=True)
def test_the_press_reaches_its_force_beside_a_strong_dashpot(make_bed):
    """The dashpots of a bed in the way of the lid are worth more than the force near which the lid slows."""
    phase = make_bed(PRESSED)[1].phases.set_index("phase").loc["press"]
    assert phase["until"] == "reached" and phase["end"] < 30000
    assert phase["value"] == pytest.approx(PRESS, rel=5e-3)


def test_normals_follow_from_geometry_and_the_normal_force_is_that_of_the_law(bed):
    spheres, contacts, force, normal = last(bed)
    assert np.linalg.norm(normal, axis=1) == pytest.approx(1.0, abs=1e-12)
    assert (force * normal).sum(axis=1) == pytest.approx(contacts["force"], abs=1e-8 * contacts["force"].max())
    centre = {n: x.to_numpy(float) for n, x in spheres[["x", "y", "z"]].iterrows()}
    friction = 0
    for k, c in contacts.iterrows():
        x = centre[c["i"]]
        other = x - normal[k] * (
            (2e-3 if c["j"] else 1e-3) - c["overlap"]
        )  # centre of the sphere, or point on the wall
        if c["j"]:
            assert other == pytest.approx(centre[c["j"]], abs=1e-9)
        else:
            on_wall = other[2] if c["wall"] == "floor" else abs(other[:2]).max() - 4e-3
            assert on_wall == pytest.approx(0.0, abs=1e-9)
        friction += np.linalg.norm(force[k] - force[k] @ normal[k] * normal[k]) > 1e-3 * contacts["force"].max()
    assert friction > 10


def test_the_radius_is_that_of_a_punch_with_the_stiffness_of_the_law_in_theory(bed):
    """Every unloading of thornton is Hertz's with a larger radius: dF/d(overlap) = 2 E* a."""
    path, _ = bed
    _, contacts, *_ = last(bed)
    spec, E_star = pair_law(load(path), "glass", "glass")
    loaded = contacts[(contacts["force"] > 0) & (contacts["overlap"] < 0.999 * contacts["delta_max"])]
    for _, c in loaded.iterrows():
        law, step = spec.theory(E_star=E_star, R_star=0.5e-3 if c["j"] else 1e-3, radius=1e-3), 1e-5 * c["overlap"]
        ends = [float(law.unloading_force(c["overlap"] + way, c["delta_max"])) for way in (-step, step)]
        assert c["contact_radius"] == pytest.approx((ends[1] - ends[0]) / (4 * E_star * step), rel=1e-3)
    assert len(loaded) > 10


CASES = Path(__file__).parents[2] / "cases"
N = 100_000


def bed_of_radii(name):
    """A planned scene and N contacts of it: half with walls of the same type, loaded and partly unloaded."""
    p = plan(scene.parse(read_toml(CASES / f"{name}.toml"), name))
    rng = np.random.default_rng(7)
    radius = rng.uniform(0.5, 1.5, (2, N)) * p.smallest
    R_star = np.where(rng.random(N) < 0.5, radius[0], radius[0] * radius[1] / radius.sum(axis=0))
    largest = 10 ** rng.uniform(-5, -1.5, N) * R_star
    return p, R_star, rng.uniform(0.9, 1.0, N) * largest, largest


@pytest.mark.parametrize("name", ["settle_glass", "adhesive_powder"])
def test_a_hundred_thousand_radii_take_less_than_a_second_and_each_row_is_that_of_the_theory(name):
    p, R_star, overlap, largest = bed_of_radii(name)
    contacts = pd.DataFrame({"i": 1, "j": 1, "R_star": R_star, "radius": 2 * R_star, "overlap": overlap})
    contacts = contacts.assign(largest=largest, attached=True, **columns.GROWTH)
    begin = time.process_time()
    table = columns.energies(p, contacts)
    assert time.process_time() - begin < 1.0
    spec, E_star = pair_law(p.case, p.model.types[0].material, p.model.types[0].material)
    for k in range(0, N, N // 50):
        law = spec.theory(E_star=E_star, R_star=float(R_star[k]), radius=float(2 * R_star[k]))
        if spec.adheres:
            top = np.maximum(law.radius(largest[k]), law.touch_radius)
            branch, dent = law.branch(top)
            force = branch.force(branch.radius(overlap[k] - dent))
        else:
            dent = law.residual_overlap(largest[k])
            force = law.unloading_force(overlap[k], largest[k]) if overlap[k] > dent else 0.0
        assert table["force"][k] == pytest.approx(force, rel=1e-9, abs=1e-15)
        assert table["residual_overlap"][k] == pytest.approx(dent, rel=1e-9, abs=1e-18)
    assert (table["elastic_energy"] != 0).sum() > N // 10
    assert spec.adheres or (table["plastic_work"] > 0).sum() > N // 10
