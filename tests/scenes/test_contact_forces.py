# SPDX-License-Identifier: GPL-2.0-or-later
"""Forces, normals and radii of the table of contacts, of beds at rest with friction in every engine."""

import copy

import numpy as np
import pytest
from scene_runs import run, write_case

from epdem.case.scene import load
from epdem.scenes.plan.model import pair_law
from epdem.scenes.tables import results

GLASS = {"young_modulus": "10 MPa", "poisson_ratio": 0.3, "density": "2500 kg/m^3", "yield_stress": "0.02 MPa"}
BOX = {"name": "box", "kind": "box", "x": ["-4 mm", "4 mm"], "y": ["-4 mm", "4 mm"], "z": ["0 mm", "20 mm"]}
CASE = {
    "case": {"name": "rest", "title": "A bed at rest", "source": "a test"},
    "materials": {"glass": GLASS},
    "law": {"name": "thornton"},
    "viscous": {"restitution": 0.3},
    # rolling friction, without which spheres roll on for seconds
    "contact": {
        "friction": 0.5,
        "tangential_restitution": 0.3,
        "rolling": {"model": "epsd2", "coefficient": 0.1},
    },
    "scene": {
        "kind": "parts",
        "room": {"x": ["-6 mm", "6 mm"], "y": ["-6 mm", "6 mm"], "z": ["0 mm", "20 mm"]},
        "gravity": "9.81 m/s^2",
        "wall": [
            {"name": "floor", "kind": "plane", "axis": "z", "at": "0 mm", "material": "glass"},
            BOX | {"open": ["+z", "-z"], "material": "glass"},
        ],
        "fill": [
            {
                "name": "bed",
                "region": {"x": ["-4 mm", "4 mm"], "y": ["-4 mm", "4 mm"], "z": ["0 mm", "16 mm"]},
                "particles": [{"material": "glass", "radius": "1 mm"}],
                "count": 30,
            }
        ],
        "phase": [{"name": "rest", "duration": "0.8 s"}],
    },
    "output": {"contacts": 2, "particles": 2, "loads": True, "energy": True},
    "numerics": {"time_step": "5 us"},
}
PRESS = 0.3  # [N]
PRESSED = copy.deepcopy(CASE)  # to overlaps of half a radius, where contacts grow
PRESSED["law"] = {"name": "cavity", "finite_strain": True, "compaction": True}
PRESSED["viscous"] = {"restitution": 0.14}
PRESSED["contact"] = {"friction": 0.5, "tangential_restitution": 0.14}
LID = {"name": "lid", "kind": "plate", "axis": "z", "center": ["0 mm", "0 mm", "13 mm"], "size": ["8 mm", "8 mm"]}
PRESSED["scene"]["wall"].append(LID | {"material": "glass"})
PRESSED["scene"]["fill"][0]["region"]["z"] = ["0 mm", "12 mm"]
PRESSED["scene"]["phase"] = [
    {"name": "fall", "duration": "0.05 s"},
    {
        "name": "press",
        "duration": "0.1 s",
        "until": {"wall": "lid", "force": f"{PRESS} N", "after": "0 s"},
        "move": [{"wall": "lid", "kind": "linear", "velocity": ["0 m/s", "0 m/s", "-0.1 m/s"]}],
    },
    {"name": "rest", "duration": "0.4 s"},
]
ENGINES = [
    pytest.param("liggghts", marks=pytest.mark.liggghts),
    pytest.param("yade", marks=pytest.mark.yade("module")),
    pytest.param("lammps", marks=pytest.mark.lammps),
]


@pytest.fixture(scope="module")
def beds():
    """Beds that have run, by engine and case."""
    return {}


@pytest.fixture(params=ENGINES)
def make_bed(request, beds, tmp_path_factory, module_of_yade):
    """(case file, results) of a bed in an engine."""

    def make(case):
        key = request.param, id(case)
        if key not in beds:
            folder = tmp_path_factory.mktemp(request.param)
            path = write_case(case, folder)
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


def test_paraview_reads_a_line_for_each_contact(bed):
    vtk = pytest.importorskip("vtk")
    support = pytest.importorskip("vtk.util.numpy_support")
    path, r = bed
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path.parent / "out/results.h5"))
    reader.UpdateInformation()
    reader.SetStep(reader.GetNumberOfSteps() - 1)
    reader.Update()
    data = reader.GetOutputDataObject(0)
    names = [
        data.GetMetaData(n).Get(vtk.vtkCompositeDataSet.NAME()) for n in range(data.GetNumberOfPartitionedDataSets())
    ]
    lines = data.GetPartition(names.index("contacts"), 0)
    spheres, contacts, force, normal = last(bed)
    assert lines.GetNumberOfLines() == len(contacts)
    points = support.vtk_to_numpy(lines.GetPoints().GetData()).reshape(-1, 2, 3)
    assert points[:, 0] == pytest.approx(spheres.loc[contacts["i"], ["x", "y", "z"]].to_numpy(), abs=1e-8)
    pairs = contacts["j"].to_numpy() > 0
    others = spheres.loc[contacts["j"][pairs], ["x", "y", "z"]].to_numpy()
    assert points[pairs, 1] == pytest.approx(others, abs=1e-8)
    cells = lines.GetCellData()
    assert np.array_equal(support.vtk_to_numpy(cells.GetArray("contact_force")), force)
    radius = support.vtk_to_numpy(cells.GetArray("contact_radius")).ravel()
    assert np.array_equal(radius, contacts["contact_radius"])
