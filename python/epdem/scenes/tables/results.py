# SPDX-License-Identifier: GPL-2.0-or-later
"""results.h5 of a scene: tables, complete or absent, read as pandas DataFrames; the group /VTKHDF shows in ParaView.

Offsets and positions of walls alone are stored in /VTKHDF: values of spheres and triangles are links to the columns of
the tables. VTKHDF 2.2: https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format. Names of arrays are those of
ON-DEM's schema where the schema has one: https://github.com/ON-DEM/ON-DEM-WG3-FileFormat."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd

from ...base import tables as h5
from ...base.tables import write_array, write_attributes
from ...case.motions import FloatArray
from ...jobs.stage import Tables
from ..plan import meshes
from ..plan.meshes import at_end
from ..plan.plan import ScenePlan
from ..plan.quantities import SPINS
from .columns import FORCE, NORMAL, bodies, columns_of_rows, units

ENGINE_TABLES = ("rows", "particles", "contacts", "walls", "phases")
FILES = "files"  # group of the files that the case names


@dataclass
class SceneResults(h5.WithTables):
    """Tables by name (rows, particles, contacts, energy_balance, checks), deck texts, attributes of the file.

    files: the contents of those that the case names; None: of an earlier version, which did not store them.
    """

    case_text: str = ""
    attributes: dict[str, object] = field(default_factory=dict)
    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    decks: dict[str, str] = field(default_factory=dict)
    files: dict[str, bytes] | None = field(default_factory=dict)


def write(path: Path, p: ScenePlan, results: SceneResults, stored: SceneResults | None = None) -> None:
    """Store `results` in the HDF5 file `path`, which ParaView shows, and its rows as CSV beside it.

    stored: results in the file; equal ones stay.
    """
    h5.write_csv(path.with_suffix(".csv"), results.tables["rows"])
    if stored and h5.same(vars(results), vars(stored)):
        return
    with h5.new_file(path) as file:
        h5.write_attributes(file, {"kind": "scene", **results.attributes})
        h5.write_text(file, "case", results.case_text)
        for name, table in results.tables.items():
            h5.write_table(file.create_group(name), table, units(table))
        write_vtkhdf(file, p, results.tables)
        for name, text in results.decks.items():
            h5.write_text(file, f"decks/{name}", text)
        group = file.create_group(FILES)
        for n, (name, content) in enumerate((results.files or {}).items()):
            data = np.frombuffer(content, np.uint8)
            h5.write_attributes(
                group.create_dataset(str(n), data=data, compression="gzip", fletcher32=True), {"name": name}
            )


def read(path: Path | str) -> SceneResults:
    """The results in a file that `write` made. Raises CaseError."""
    with h5.open_results(path, "a results file of a scene") as file:
        results = SceneResults(h5.read_text(file["case"]), h5.attributes(file))
        for name, group in h5.members(file):
            if isinstance(group, h5py.Group) and name not in ("VTKHDF", "decks", FILES):
                results.tables[name] = h5.read_table(group)
        results.decks = {name: h5.read_text(text) for name, text in h5.members(file, "decks")}
        stored = {h5.attributes(x)["name"]: x[()].tobytes() for _, x in h5.members(file, FILES)}
        results.files = stored if FILES in file else None
        return results


def engine_tables(p: ScenePlan, tables: Tables) -> Tables:
    """The tables of an engine run among those of a results file, without columns of measures."""
    found = {name: tables[name] for name in ENGINE_TABLES if name in tables}
    rows = found["rows"]
    return found | {"rows": rows[[name for name in rows if name in columns_of_rows(p)]]}


CELLS = ("Vertices", "Lines", "Polygons", "Strips")  # VTK's order in CellOffsets
NAMES = {"id": "body_id", "type": "material_id"}
VECTORS = {"velocity": ["vx", "vy", "vz"], "angular_velocity": [*SPINS]}
OTHERS = {"step", "x", "y", "z", "wall", "triangle"}  # columns that the geometry states


def write_vtkhdf(file: h5py.File, p: ScenePlan, tables: dict[str, pd.DataFrame]) -> None:
    """Add the group to a file that holds the tables; nothing if no frame holds a sphere."""
    spheres = tables.get("particles", pd.DataFrame())
    if spheres.empty:
        return
    stress = tables.get("walls", pd.DataFrame({"wall": [], "step": []}))
    steps = np.union1d(spheres["step"], stress["step"]).astype(int)
    root = _group(file, "VTKHDF", "PartitionedDataSetCollection")
    _group(root, "Assembly")
    blocks = _Blocks(root, p.time_at(steps))

    count = spheres.groupby("step").size().reindex(steps, fill_value=0).to_numpy()
    first = np.cumsum(count) - count
    every = np.arange(count.max())
    block = blocks.add("spheres", first, count, "Vertices", every[:, None], count)
    _vector(block, "Points", file["particles"], ["x", "y", "z"])
    data = block.create_group("PointData")
    vectors = {name: columns for name, columns in VECTORS.items() if columns[0] in spheres}
    for name, columns in vectors.items():
        _vector(data, name, file["particles"], columns)
    for name in [c for c in spheres if c not in OTHERS | {*chain(*vectors.values())}]:
        data[NAMES.get(name, name)] = file["particles"][name]
    blocks.offsets(block, "PointData", first)
    if not (contacts := tables.get("contacts", pd.DataFrame())).empty:
        _add_contacts(blocks, file["contacts"], contacts, bodies(p, contacts, spheres), steps)

    for name, points, triangles, shown in _walls(p, steps):
        places, start = _distinct(points)
        block = blocks.add(f"wall_{name}", start, np.full(len(steps), len(points[0])), "Polygons", triangles, shown)
        write_array(block, "Points", places)
        rows = np.flatnonzero(stress["wall"] == name)
        if rows.size:
            data = block.create_group("CellData")
            for column in [c for c in stress if c not in OTHERS]:
                data[column] = file["walls"][column]
            blocks.offsets(block, "CellData", pd.Series(rows).groupby(stress["step"].to_numpy()[rows]).min()[steps])


def _add_contacts(
    blocks: "_Blocks", stored: h5py.Group, contacts: pd.DataFrame, ends: Sequence[pd.DataFrame], steps: np.ndarray
) -> None:
    """A line for each contact, from the centre of the first sphere to the centre of the second or to the wall."""
    one, other = ends
    begin, radii = one[[*"xyz"]].to_numpy(), one["radius"] + other["radius"].replace(np.inf, 0.0)
    length = radii.to_numpy() - contacts["overlap"].to_numpy()
    end = begin - length[:, None] * contacts[NORMAL].to_numpy()
    count = contacts.groupby("step").size().reindex(steps, fill_value=0).to_numpy()
    first, every = np.cumsum(count) - count, np.arange(2 * count.max()).reshape(-1, 2)
    block = blocks.add("contacts", 2 * first, 2 * count, "Lines", every, count)
    write_array(block, "Points", np.stack([begin, end], axis=1).reshape(-1, 3).astype(np.float32))
    data = block.create_group("CellData")
    for name, columns in {"normal": NORMAL, "contact_force": FORCE}.items():
        _vector(data, name, stored, columns)
    for name in [c for c in contacts if c not in {"step", "wall", *NORMAL, *FORCE}]:
        data[name] = stored[name]
    blocks.offsets(block, "CellData", first)


def _group(parent: h5py.Group, name: str, kind: str = "") -> h5py.Group:
    group = parent.create_group(name, track_order=True)
    if kind:
        write_attributes(group, {"Version": np.array([2, 2]), "Type": kind})
    return group


def _vector(group: h5py.Group, name: str, table: h5py.Group, columns: list[str]) -> None:
    """Three columns of a table as one array (n, 3) that stores nothing."""
    layout = h5py.VirtualLayout((len(table[columns[0]]), 3), dtype="f8")
    for k, column in enumerate(columns):
        source = table[column]
        layout[:, k] = h5py.VirtualSource(".", source.name, shape=source.shape)
    group.create_virtual_dataset(name, layout)


class _Blocks:
    """Blocks of temporal PolyData in one file, with one list of times; equal arrays are one dataset."""

    def __init__(self, root: h5py.Group, times: FloatArray) -> None:
        self.root, self.frames = root, len(times)
        self.stored: dict[tuple[object, ...], h5py.Dataset] = {}
        self.times = {"Values": times, "PartOffsets": np.arange(len(times)), "NumberOfParts": np.ones(len(times), int)}

    def _put(self, group: h5py.Group, arrays: dict[str, Any]) -> None:
        for name, data in arrays.items():
            array = np.asarray(data)
            key = (array.tobytes(), array.shape, array.dtype.str)
            if key not in self.stored:
                self.stored[key] = write_array(group, name, array, checksum=False)
            else:
                group[name] = self.stored[key]

    def _cells(self, block: h5py.Group, kind: str, cells: np.ndarray, shown: np.ndarray) -> None:
        group, corners = block.create_group(kind), cells.shape[1]
        self._put(group, {"NumberOfCells": shown, "NumberOfConnectivityIds": shown * corners})
        self._put(group, {"Offsets": np.arange(len(cells) + 1) * corners, "Connectivity": cells.reshape(-1)})

    def add(
        self, name: str, first: np.ndarray, points: np.ndarray, kind: str, cells: np.ndarray, shown: np.ndarray
    ) -> h5py.Group:
        """A block. first, points: place in Points and number of the points of each frame, shape (frames,).

        cells: points of each cell of the kind, shape (n, corners); a frame has the first `shown` cells of them.
        """
        place = _group(self.root["Assembly"], name)
        block = _group(self.root, name, "PolyData")
        write_attributes(block, {"Index": len(self.root["Assembly"]) - 1})
        place[name] = h5py.SoftLink(block.name)
        self._put(block, {"NumberOfPoints": points})
        for other in CELLS:
            none = np.empty((0, 1), int), np.zeros(self.frames, int)
            self._cells(block, other, *((cells, shown) if other == kind else none))
        steps, zeros = block.create_group("Steps"), np.zeros((self.frames, len(CELLS)), int)
        write_attributes(steps, {"NSteps": self.frames})
        self._put(steps, self.times | {"PointOffsets": first, "CellOffsets": zeros, "ConnectivityIdOffsets": zeros})
        return block

    def offsets(self, block: h5py.Group, kind: str, first: Any) -> None:
        """The place of each frame in every array of PointData or CellData."""
        self._put(block["Steps"].create_group(f"{kind}Offsets"), dict.fromkeys(block[kind], first))


def _walls(p: ScenePlan, steps: np.ndarray) -> Iterator[tuple[str, list[np.ndarray], np.ndarray, np.ndarray]]:
    """(name, points of each frame, triangles by their points, number of triangles in each frame) of each wall.

    A wall that a force drives is left out: no table has its position.
    """
    gates = {w.name for w in p.scene.gates}
    sheets = {w.name: meshes.sheet(w, p.box) for w in (*p.scene.planes, *p.scene.gates)}
    corners = sheets | p.triangles
    places = [at_end(p.motions_until(int(step)), corners) for step in steps]
    phases = [p.phases[k] for k in np.searchsorted([phase.end for phase in p.phases[:-1]], steps)]
    for name in places[0]:
        _, index, cells = np.unique(corners[name].reshape(-1, 3), axis=0, return_index=True, return_inverse=True)
        triangles = cells.reshape(-1, 3)
        points = [frame[name].reshape(-1, 3)[index].astype(np.float32) for frame in places]
        there = [name not in gates or name in phase.gates for phase in phases]
        yield name, points, triangles, len(triangles) * np.array(there, int)


def _distinct(frames: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """(points of frames without repetitions, place of each frame in them): a wall at rest is stored once."""
    every = np.array(frames)
    new = np.append(True, (every[1:] != every[:-1]).any(axis=(1, 2)))
    return every[new].reshape(-1, 3), (np.cumsum(new) - 1) * every.shape[1]
