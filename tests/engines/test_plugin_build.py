# SPDX-License-Identifier: GPL-2.0-or-later
"""What is settled when the plugin is built: headers, symbols, size, and the numbers that restart files keep."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from plugin_decks import LAWS, Bodies, deck_of, good, launcher, materials, run
from test_plugin_launch import library

pytestmark = pytest.mark.liggghts

SOURCES = Path(__file__).resolve().parents[2] / "cpp_contact"


def compiles(folder, header):
    """Whether a source that includes `header` alone compiles."""
    (folder / "alone.cpp").write_text(f'#include "{header}"\n')
    mpi = subprocess.run(["mpicxx", "--showme:compile"], capture_output=True, text=True, check=True).stdout.split()
    line = ["g++", "-fsyntax-only", "-std=c++17", "-DOMPI_SKIP_MPICXX", f"-I{SOURCES}/liggghts"]
    line += [
        f"-I{SOURCES}/liggghts/styles",
        f"-I{SOURCES}/include",
        f"-I{SOURCES}",
        "-isystem",
        "/usr/include/liggghts",
        *mpi,
    ]
    return subprocess.run([*line, folder / "alone.cpp"], capture_output=True, check=False).returncode == 0


def test_the_host_header_brings_what_liggghts_headers_forget(tmp_path):
    """Must 13: LIGGGHTS's own pair_gran_base.h includes a header without the class that it derives from."""
    assert not compiles(tmp_path, "pair_gran_base.h")
    assert compiles(tmp_path, "host.hpp")


@pytest.mark.parametrize("binary", [library, launcher])
def test_no_symbol_is_missing(binary):
    """Must 14: else it would be found at the first load, as `symbol lookup error`."""
    done = subprocess.run(["ldd", "-r", binary()], capture_output=True, text=True, check=True)
    assert "libliggghts.so.3" in done.stdout
    assert not [line for line in (done.stdout + done.stderr).splitlines() if "undefined" in line or "not found" in line]


def test_the_library_loads_by_itself():
    """Must 14 again: it brings LIGGGHTS and MPI along, whoever loads it, and settles every symbol at once."""
    code = f"import ctypes, os; ctypes.CDLL({library()!r}, mode=os.RTLD_NOW)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stderr == "", done.stderr


def test_the_plugin_exports_only_the_functions_that_it_takes_over():
    """Must 10: with default visibility 298 of LIGGGHTS's own symbols would be interposed."""
    lines = subprocess.run(["nm", "-D", "--defined-only", library()], capture_output=True, text=True, check=True).stdout
    names = [line.split()[-1] for line in lines.splitlines()]
    ours = [n for n in names if "epdem" in n or "LIGGGHTS" in n or "LAMMPS" in n]
    wrong_names, *members = sorted(ours)
    assert wrong_names.startswith("_ZN8LIGGGHTS13ContactModels7Factory6select")
    assert [re.match(r"_ZN9LAMMPS_NS\d+([A-Za-z]+?)\d", name)[1] for name in members] == [
        *["FixGravity"] * 2,
        "DeleteAtoms",
        "FixMoveMesh",
        *["FixWallGran"] * 2,
        *["FixNVESphere"] * 2,
        *["AtomVecSphere"] * 2,
        "FixMeshSurface",
        *["FixNeighlistMesh"] * 3,
        "FixContactHistory",
        *["Neighbor"] * 4,
    ]


def test_library_and_launcher_stay_small():
    """4.4 MB without the kernels of walls, 5.7 MB with them (three instruction sets)."""
    assert Path(library()).stat().st_size < 6e6 and Path(launcher()).stat().st_size < 6e6


# Fixed for ever, because restart files keep them: a law's id, its history values of a pair and of a wall.
STORED = {"hertz": (40, 1, 0), "thornton": (41, 2, 1), "johnson": (42, 2, 1), "cavity": (43, 5, 4)}
STORED["meyer"] = (46, 3, 2)
TAKEN = {0, 1, 2, 3, 4, 8, 9, 10, 11, 12}  # LIGGGHTS's own normal models; 9 is none
TANGENTIAL_HISTORY, STRETCH = 2, 3  # LIGGGHTS's id of that model, and its history: the vector of tangential stretch
STEPS = 30


def touching(how, folder, law, end):
    """Two spheres that come together on the wall, with `tangential history`; `end` follows on the run."""
    x = np.array([[-0.00499, 0, 0.005 - 1e-6], [0.00499, 0, 0.005 - 1e-6]])
    v = np.array([[0.5, 0, -0.5], [-0.5, 0, -0.5]])
    bodies = Bodies(np.array([1, 2]), np.full(2, 5e-3), x, v)
    properties = materials("ep/any")
    text = deck_of(f"ep/{law}", f"run {STEPS}\n{end}", properties=properties, wall="primitive")
    text = text.replace("timestep", "compute c all pair/gran/local history delta\ntimestep")
    return how(folder, text, files={"box.data": bodies.data(((-0.05, 0.05),) * 2 + ((-0.01, 0.05),))})


@pytest.mark.parametrize("law", STORED)
def test_restart_files_keep_the_id_of_the_law(tmp_path, law):
    """Must 15. After the name of the pair style: six bits for the normal model, six for the tangential one, ..."""
    touching(good, tmp_path, law, "write_restart x.restart\n")
    raw = (tmp_path / "x.restart").read_bytes()
    at = raw.index(b"gran\0") + 5
    id_of_law = STORED[law][0]
    assert int.from_bytes(raw[at : at + 8], "little") == id_of_law + (TANGENTIAL_HISTORY << 6)
    assert id_of_law < 64 and id_of_law not in TAKEN and set(LAWS) == set(STORED)


@pytest.mark.parametrize("law", STORED)
def test_the_number_of_history_values_is_the_one_that_restart_files_keep(tmp_path, law):
    """Must 15: one column more does not exist; the first is the largest overlap, and a pair's last its last step."""
    _, pair, wall = STORED[law]

    def dump(style, column, count):
        columns = " ".join(column.format(k) for k in range(1, count + 1))
        return f"dump d all {style} 1 out.txt {columns}\nrun 0\n"

    n = pair + STRETCH
    touching(good, tmp_path / "pair", law, dump("local", "c_c[{}]", n + 1))  # the last column: the overlap
    values = np.loadtxt(tmp_path / "pair" / "out.txt", skiprows=9)
    assert values.shape == (n + 1,) and values[pair - 1] == STEPS
    assert pair == 1 or values[0] == pytest.approx(values[n], rel=1e-5)  # the dump rounds; they still come together
    assert "out-of-range" in touching(run, tmp_path / "pair-more", law, dump("local", "c_c[{}]", n + 2)).error

    n = wall + STRETCH
    touching(good, tmp_path / "wall", law, dump("custom", "f_history_wall[{}]", n))
    assert (
        "out-of-range" in touching(run, tmp_path / "wall-more", law, dump("custom", "f_history_wall[{}]", n + 1)).error
    )


@pytest.mark.thorough
def test_the_level_of_optimisation_is_the_users_if_he_gives_one(tmp_path):
    """Else Release means -O3."""
    for flags, level in (("", "-O3"), ("-O1 -g", "-O1")):
        tree = tmp_path / (level + "tree")
        line = ["cmake", "-S", SOURCES.parent, "-B", tree, f"-DCMAKE_CXX_FLAGS={flags}"]
        subprocess.run(line, capture_output=True, check=True)
        used = [re.findall(r"-O\S", c["command"]) for c in json.loads((tree / "compile_commands.json").read_text())]
        assert used and all(u == [level] for u in used)
