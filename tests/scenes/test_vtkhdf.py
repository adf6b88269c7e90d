# SPDX-License-Identifier: GPL-2.0-or-later
"""results.h5 of a scene read by VTK's own reader, against the files that LIGGGHTS wrote."""

import h5py
import numpy as np
import pandas as pd
import pytest
from parts_cases import BED, BOX, FLOOR, bead, flat, linear, mm, mps, parts, timed
from scene_runs import ran

from epdem.case.scene import parse
from epdem.engines.liggghts import dump
from epdem.scenes.plan.plan import plan
from epdem.scenes.tables import results


@pytest.fixture(scope="module", autouse=True)
def imported():
    """VTK takes a second to import, which no other test needs."""
    global vtk, numpy_support
    vtk = pytest.importorskip("vtk", reason="VTK is not installed; make test installs it")
    numpy_support = pytest.importorskip("vtk.util.numpy_support")


LID = flat("lid", mm(0, 0, 18), mm(17, 17), stress=True)
GATE = {"name": "gate", "kind": "plane", "axis": "z", "at": "20 mm", "material": "steel", "phases": ["fall"]}
FALL = timed("fall", "40 ms")
DOWN = linear("lid", 0, 0, -0.2)
PUSH = timed("push", "40 ms", move=[DOWN])
LATE = bead("late", mm(0, 0, 38), "1 mm", "steel", phase="push", velocity=mps(0, 0, 0))


def case():
    fill = BED | {"count": 20, "region": BED["region"] | {"z": mm(1, 16)}}
    data = parts(
        wall=[FLOOR | {"at": "-1 mm"}, BOX | {"stress": True}, LID, GATE], fill=[fill], body=[LATE], phase=[FALL, PUSH]
    )
    data["output"] |= {"particles": 6}
    return data


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The folder of a scene whose number of spheres, moving wall and gate change from frame to frame."""
    place = tmp_path_factory.mktemp("vtkhdf")
    ran(case(), place)
    return place / "out"


def frames(path):
    """(time, blocks by name) of each frame, as VTK's reader gives them."""
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    for k in range(reader.GetNumberOfSteps()):
        reader.SetStep(k)
        reader.Update()
        found = reader.GetOutputDataObject(0)
        names = [
            found.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME())
            for i in range(found.GetNumberOfPartitionedDataSets())
        ]
        yield reader.GetTimeValue(), {name: found.GetPartition(i, 0) for i, name in enumerate(names)}


def array(data, name):
    return numpy_support.vtk_to_numpy(data.GetArray(name))


def points(block):
    return numpy_support.vtk_to_numpy(block.GetPoints().GetData())


def steps_of(folder, pattern):
    return sorted(int(path.name.split(".")[1]) for path in folder.glob(pattern))


@pytest.mark.liggghts
def test_vtk_reads_every_sphere_of_every_frame(folder):
    steps, counts = steps_of(folder, "particles.*.bin"), []
    read = list(frames(folder / "results.h5"))
    assert steps == [*range(0, 2000, 625), 2000, *range(2500, 4000, 625), 4000]  # both phases end with a frame
    assert [time for time, _ in read] == pytest.approx([2e-5 * step for step in steps])
    for step, (_, blocks) in zip(steps, read, strict=True):
        ((_, rows),) = dump.frames(folder / f"particles.{step}.bin")  # id type radius mass x y z vx vy vz omega...
        spheres = blocks["spheres"]
        data, counts = spheres.GetPointData(), [*counts, len(rows)]
        assert np.array_equal(points(spheres), rows[:, 4:7]) and spheres.GetNumberOfVerts() == len(rows)
        assert np.array_equal(array(data, "velocity"), rows[:, 7:10])
        for name, column in {"body_id": 0, "material_id": 1, "radius": 2, "mass": 3}.items():
            assert np.array_equal(array(data, name), rows[:, column])
        assert array(data, "plastic_work").shape == (len(rows),)
    assert counts == [0, 20, 20, 20, 20, 21, 21, 21, 21] and array(data, "plastic_work").max() > 0


@pytest.mark.liggghts
def test_vtk_reads_walls_where_liggghts_has_them_with_their_stress(folder):
    loaded, end = 0, results.read(folder / "results.h5").phases["end"][0]
    for step, (_, blocks) in zip(steps_of(folder, "stress_lid.*.vtk"), frames(folder / "results.h5"), strict=True):
        for name in ("lid", "box"):
            legacy = vtk.vtkPolyDataReader()
            legacy.SetFileName(str(folder / f"stress_{name}.{step}.vtk"))
            legacy.Update()
            theirs, wall = legacy.GetOutput(), blocks[f"wall_{name}"]
            order = np.argsort(array(theirs.GetCellData(), "meshid").reshape(-1))
            assert wall.GetNumberOfPolys() == len(order)
            for ours, other in enumerate(order):
                for k in range(3):
                    place = theirs.GetPoint(theirs.GetCell(other).GetPointId(k))
                    assert wall.GetPoint(wall.GetCell(ours).GetPointId(k)) == pytest.approx(place, abs=1e-7)
            stress = array(theirs.GetCellData(), "normal_stress_average").reshape(-1)[order]
            assert np.array_equal(array(wall.GetCellData(), "normal_stress"), stress)
            loaded += bool(stress.any())
        assert blocks["wall_gate"].GetNumberOfPolys() == (2 if step <= end else 0)
        assert blocks["wall_floor"].GetNumberOfPolys() == 2 and blocks["wall_floor"].GetBounds()[4] == pytest.approx(
            -1e-3
        )
    assert loaded


@pytest.mark.liggghts
def test_vtk_reads_a_line_for_each_contact(folder):
    found = results.read(folder / "results.h5")
    places = found.particles.set_index(["step", "id"])[["x", "y", "z"]]
    for step, (_, blocks) in zip(steps_of(folder, "particles.*.bin"), frames(folder / "results.h5"), strict=True):
        contacts = found.contacts[found.contacts["step"] == step]
        lines, pairs = blocks["contacts"], (contacts["j"] > 0).to_numpy()
        assert lines.GetNumberOfLines() == len(contacts)
        if pairs.any():
            ends, cells = points(lines).reshape(-1, 2, 3), lines.GetCellData()
            assert ends[:, 0] == pytest.approx(places.loc[step].loc[contacts["i"]].to_numpy(), abs=1e-8)
            assert ends[pairs, 1] == pytest.approx(places.loc[step].loc[contacts["j"][pairs]].to_numpy(), abs=1e-8)
            assert np.array_equal(array(cells, "contact_force"), contacts[["force_x", "force_y", "force_z"]])
            assert np.array_equal(array(cells, "contact_radius").ravel(), contacts["contact_radius"])
    assert (found.contacts["j"] > 0).any()


@pytest.mark.liggghts
def test_the_group_stores_no_value_twice(folder):
    with h5py.File(folder / "results.h5") as file:
        data = file["VTKHDF/spheres/PointData"]
        assert data["radius"] == file["particles/radius"] and data["velocity"].is_virtual
        assert file["VTKHDF/wall_lid/CellData/normal_stress"] == file["walls/normal_stress"]
        floor, lid = (len(file[f"VTKHDF/wall_{name}/Points"]) for name in ("floor", "lid"))
    assert floor == 4 and lid == 5 * 4  # a wall at rest has one position, the lid one more in each frame that it moves


def test_a_results_file_is_at_most_a_tenth_larger(tmp_path, monkeypatch):
    """500 spheres in 20 frames, numbers that gzip cannot shorten."""
    frames, spheres, rng = 20, 500, np.random.default_rng(1)
    table = pd.DataFrame({"step": np.repeat(np.arange(frames), spheres), "id": np.tile(np.arange(spheres), frames)})
    table[["type", *"xyz", "vx", "vy", "vz", "radius"]] = rng.random((len(table), 8))
    tables = {"particles": table, "rows": pd.DataFrame({"step": [0]})}
    results.write(tmp_path / "with.h5", plan(parse(case())), results.SceneResults(tables=tables))
    monkeypatch.setattr(results, "write_vtkhdf", lambda *_: None)
    results.write(tmp_path / "without.h5", plan(parse(case())), results.SceneResults(tables=tables))
    assert 1.0 < (tmp_path / "with.h5").stat().st_size / (tmp_path / "without.h5").stat().st_size < 1.1
