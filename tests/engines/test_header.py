# SPDX-License-Identifier: GPL-2.0-or-later
"""`epdem export liggghts`: our models as sources for a LIGGGHTS tree do in it what the plugin does.

Compiled here against the headers of Debian's package and linked with its library; EPDEM_TREES, paths of executables
that were built from other trees with a ':' between them, brings those in (`make trees`).
"""

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from plugin_decks import ADHESIVE, launcher, per_pair, run
from plugin_loop import SAID, Scene, outcome

from epdem.base import paths
from epdem.case.impact import load
from epdem.engines.liggghts import launcher as liggghts
from epdem.engines.liggghts.engine import Liggghts
from epdem.errors import CaseError
from epdem.impacts.experiment import experiment
from epdem.impacts.measurement import measure
from epdem.impacts.plan import plan
from epdem.impacts.prediction import predict
from epdem.tools import header

pytestmark = [pytest.mark.liggghts, pytest.mark.packaging]

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "cpp_contact" / "liggghts"
LAWS = ("hertz", "thornton", "johnson", "cavity", "meyer")
TREES = [Path(p) for p in os.environ.get("EPDEM_TREES", "").split(":") if p]
SUPERQUADRICS = ("-DSUPERQUADRIC_ACTIVE_FLAG", "-DNONSPHERICAL_ACTIVE_FLAG")


def mpi(what):
    return subprocess.run(["mpicxx", f"--showme:{what}"], capture_output=True, text=True, check=True).stdout.split()


def compiler(*words, standard="c++17"):
    """g++ as a tree of LIGGGHTS calls it, on the headers of Debian's package."""
    headers = [f"-I{SOURCES}/styles", "-isystem", "/usr/include/liggghts", *mpi("compile")]
    return ["g++", f"-std={standard}", "-Wall", "-Wextra", "-DOMPI_SKIP_MPICXX", *headers, *map(str, words)]


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    folder = tmp_path_factory.mktemp("src")
    header.write(folder)
    return folder


@pytest.fixture(scope="module")
def built(shared):
    """LIGGGHTS with our files in it; without optimisation, which is quick and changes no bit."""

    def build(folder):
        for name, text in header.files().items():
            (folder / name).write_text(re.sub("#pragma GCC optimize.*", "", text))
        (folder / "main.cpp").write_text((SOURCES / "main.cpp").read_text())
        line = compiler("-O0", "-w", *folder.glob("*.cpp"), "-o", folder / "lmp_tree", "-lliggghts", *mpi("link"))
        subprocess.run(line, check=True)

    return shared("tree", build) / "lmp_tree"


@pytest.fixture(params=["Debian's library", *TREES], ids=str)
def tree(request):
    """An executable that has our models as sources."""
    return request.getfixturevalue("built") if request.param == "Debian's library" else request.param


def code(text):
    """Lines of C++ without comments, blank lines and what belongs to single files."""
    lines = [line.rstrip() for line in text.splitlines()]
    return [x for x in lines if x and not x.startswith(("//", "#include", "#pragma once"))]


def needed(file, seen):
    """A source of ours and the headers of ours that it includes, directly or not."""
    if file in seen:
        return
    seen.add(file)
    for name in re.findall(r'^#include "(.*)"', file.read_text(), re.MULTILINE):
        for folder in (file.parent, SOURCES, SOURCES.parent / "include", SOURCES.parent):
            if (folder / name).is_file():
                needed((folder / name).resolve(), seen)
                break


PFM = [SOURCES / name for name in ("pfm/models.cpp", "materials.cpp", "cohesion.cpp")]


@pytest.mark.parametrize("pfm", [False, True])
def test_the_files_hold_every_line_of_the_sources_that_they_need_and_no_other(pfm):
    files = header.files(pfm)
    named = ["normal_model_ep.cpp", "normal_model_ep_avx2.cpp", "normal_model_ep_avx512.cpp"]
    licence = "normal_model_ep_BSD-3-Clause.txt"
    assert list(files) == ([named[0], "normal_model_ep.h", licence] if pfm else [*named, licence])
    assert files.pop(licence) == (ROOT / "LICENSES/BSD-3-Clause.txt").read_text()
    if pfm:
        assert files.pop("normal_model_ep.h") == (SOURCES / "pfm" / "commands.h").read_text()
    parts = {name: set() for name in files}
    common = [f for f in SOURCES.rglob("*.cpp") if f.name != "main.cpp" and f.parent.name != "pfm"]
    common += (SOURCES.parent / "kernels").glob("*.cpp")
    for source in PFM if pfm else common:
        apart = f"normal_model_ep_{source.stem}.cpp"
        needed(source, parts[apart if apart in files else "normal_model_ep.cpp"])
    for name, text in files.items():
        assert len(parts[name]) > 10
        top, _, body = text.partition("#define EPDEM_VERSION")
        assert "C++17" in top and "-Identifier: GPL-2.0-or-later AND BSD-3-Clause\n" in top
        for part in parts[name]:  # each under its own licence
            folder = next(f for f in (SOURCES, SOURCES.parent / "include", SOURCES.parent) if part.is_relative_to(f))
            licence = (
                "BSD-3-Clause" if part.parts[len(ROOT.parts) + 1] in ("include", "kernels") else "GPL-2.0-or-later"
            )
            assert f"\n// {part.relative_to(folder)}, {licence}\n" in body
        expected = sorted(line for part in parts[name] for line in code(part.read_text()))
        assert sorted(code(body)[1:-1]) == expected  # without the version and the last #endif


def base_of_inl(folder):
    """The base of contact models with LIGGGHTS-INL's virtual function, to be included before all else."""
    base, first = folder / "base_of_inl.h", "virtual void tally_pp("
    text = Path("/usr/include/liggghts/contact_model_base.h").read_text(errors="replace")
    assert text.count(first) == 1
    match = "virtual bool contact_match(const std::string kind, const std::string model) = 0;\n"
    head = '#include <map>\n#include <string>\n#include "pointers.h"\nusing namespace LAMMPS_NS;\n'
    base.write_text(head + text.replace(first, match + first))
    return base


@pytest.mark.slow
def test_with_superquadrics_and_the_base_of_inl_the_files_compile_without_a_warning(sources):
    """The structure of a contact then has 392 bytes; a user's tree has them on by default."""
    base = base_of_inl(sources)
    for name in (name for name in header.files() if name.endswith(".cpp")):
        line = compiler("-fsyntax-only", "-include", base, *SUPERQUADRICS, sources / name)
        done = subprocess.run(line, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")


def test_an_older_standard_is_refused_with_a_sentence(sources):
    line = compiler("-E", sources / "normal_model_ep.cpp", standard="c++11")
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "epdem needs C++17: add -std=c++17" in done.stderr


@pytest.mark.slow
def test_vectors_are_as_wide_as_the_names_of_the_files_say(built):
    """GCC 12 takes the pragma that names the instructions but defines no macro of theirs."""
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", built], capture_output=True, text=True, check=True)
    assert text.stdout.count("%zmm") > 1000 and text.stdout.count("%ymm") > 1000
    assert "vfmadd" not in text.stdout  # a product and a sum in one rounding would give other bits


def test_the_files_define_no_function_of_liggghts(built):
    """In a tree each of its functions would then be there twice; linked with a library, ours would hide its own."""
    lines = subprocess.run(["nm", "--defined-only", built], capture_output=True, text=True, check=True).stdout
    strong = [line.split()[-1] for line in lines.splitlines() if line.split()[-2] == "T"]
    assert len(strong) > 10 and not [name for name in strong if name.startswith(("_ZN8LIGGGHTS", "_ZN9LAMMPS_NS"))]


def restitution(folder, monkeypatch, program):
    """(n speeds, 8 phases) of the demo, run by a LIGGGHTS."""
    monkeypatch.setenv("EPDEM_LIGGGHTS", str(program))
    paths.launcher.cache_clear()
    try:
        x = experiment(load(ROOT / "cases" / "steel_wall.toml"), None)
        what = plan(x, predict(x))
        Liggghts().write(what, folder)
        return measure(what, Liggghts().run(what, folder)).e_n
    finally:
        paths.launcher.cache_clear()


def test_the_impacts_of_the_demo_are_those_of_the_plugin(tree, tmp_path, monkeypatch):
    found = {}
    for name, program in (("plugin", launcher()), ("tree", tree)):
        (tmp_path / name).mkdir()
        found[name] = np.asarray(restitution(tmp_path / name, monkeypatch, program))
    assert found["tree"].size == 256 and np.abs(found["tree"] - found["plugin"]).max() < 1e-12


@pytest.mark.parametrize("law", [*LAWS, *ADHESIVE, "thornton ep/partial_slip"])
def test_a_restart_file_of_one_is_read_by_the_other(tree, tmp_path, law):
    """In mid-contact, three materials, rolling springs: what follows has the same bits whoever wrote and read it."""
    name, _, tangential = law.partition(" ")
    scene = Scene(law=name, tangential=tangential or "history", types=3, rolling="epsd2", loose=True)
    work = 0.02 if name == "cavity_adhesive" else 0.5
    more = {"before": per_pair("workOfAdhesion", work)} if name in ADHESIVE else {}
    if liggghts.version(tree).startswith(("LIGGGHTS-PFM", "LIGGGHTS-INL")):
        pytest.skip("the restart files of LIGGGHTS-PFM have other ids, those of LIGGGHTS-INL another header")
    programs, ends = {"plugin": launcher(), "tree": str(tree)}, {}
    for writer, first in programs.items():
        folder = tmp_path / writer
        outcome(folder, scene, steps=30, end="write_restart x.restart\n", command=first, **more)
        for reader, second in programs.items():
            where = tmp_path / f"{writer}-{reader}"
            frames, text = outcome(where, scene, steps=30, restart=folder / "x.restart", command=second, **more)
            assert SAID not in text  # our own pair loop
            ends[writer, reader] = frames
    assert all(np.array_equal(e, ends["plugin", "plugin"]) for e in ends.values())


def test_doctor_says_which_models_an_executable_has(built, monkeypatch):
    for program, has in ((built, LAWS), ("/usr/bin/liggghts", ())):
        monkeypatch.setenv("EPDEM_LIGGGHTS", str(program))
        paths.launcher.cache_clear()
        found = liggghts.examine(Path(program), LAWS)
        assert found.models == has and found.mpi and found.version == "LIGGGHTS-PUBLIC 3.8.0"
        assert not found.superquadrics  # Debian's library has none
    paths.launcher.cache_clear()
    assert liggghts.advice(()) == "" and "epdem export liggghts --out" in liggghts.advice(("hertz",))
    assert "take LIGGGHTS-PUBLIC" in liggghts.advice(("jkr",), "LIGGGHTS-PFM 24.01")


SUPERQUADRIC = """atom_style superquadric
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
region box block -0.1 0.1 -0.1 0.1 -0.1 0.1 units box
create_box 1 box
neighbor 0.002 bin
fix e all property/global youngsModulus peratomtype 1e8
fix n all property/global poissonsRatio peratomtype 0.3
fix y all property/global yieldPressure peratomtype 1e6
pair_style gran model ep/thornton tangential off
pair_coeff * *
fix move all nve/superquadric
run 0
"""


def test_superquadrics_are_refused_with_a_sentence(tree, tmp_path):
    """LIGGGHTS's surface default would take them for spheres."""
    done = run(tmp_path, SUPERQUADRIC, command=str(tree))
    expected = "model ep/thornton: it is for spheres" if liggghts.examine(tree, ()).superquadrics else "atom style"
    listed = "surface default, multicontact; nothing else"  # LIGGGHTS-INL takes surface superquadric by itself
    assert done.code == 1 and (expected in done.error or listed in done.error)


OLD = {  # what a tree of 2016 has, and what the sentence must hold
    "MAKE/Makefile.auto": ("TMP := 1\n  X := '\\#include <mpi.h>'\n", ":2: make 4.3"),
    "utils.h": ("\n\n  return static_cast< std::ostringstream & >(x).str();\n", ":3: newer compilers refuse this cast"),
    "finish.cpp": ("      if (neighbor->lists[m]->numneigh > 0) {\n", ":1: newer compilers refuse to compare"),
    "dump_mesh_vtk.cpp": ("#include <vtkPoints.h>\n", ":1: it needs VTK"),
    "CMakeLists.txt": ("\nSET(CMAKE_CXX_FLAGS -std=c++11)\n", ":2: for a build by CMake write -std=c++17"),
}
NEW = {
    "MAKE/Makefile.auto": "H := \\#\nX := '$Hinclude'\n",
    "utils.h": "// return static_cast< std::ostringstream & >(x).str();\n",
    "finish.cpp": "  if (neighbor->lists[m]->inum > 0) { // if (neighbor->lists[m]->numneigh > 0) {\n",
    "dump_mesh_vtk.cpp": "#ifdef LAMMPS_VTK\n#include <vtkPoints.h>\n#endif\n",
    "CMakeLists.txt": "SET(CMAKE_CXX_FLAGS -std=c++17)\n",
}


def test_check_says_what_a_tree_lacks(tmp_path):
    (tmp_path / "MAKE").mkdir()
    (tmp_path / "contact_models.h").write_text("void surfacesIntersect();\n")
    for name, (text, _) in OLD.items():
        (tmp_path / name).write_text(text)
    lacks = header.check(tmp_path)
    assert len(lacks) == 4 + len(OLD) and all("is not there; run 'epdem export liggghts --out" in s for s in lacks[:4])
    for sentence, (name, (_, says)) in zip(lacks[4:], OLD.items(), strict=True):
        assert sentence.startswith(f"{tmp_path / name}{says}")
    header.write(tmp_path)
    for name, text in NEW.items():
        (tmp_path / name).write_text(text)
    assert header.check(tmp_path) == []
    (tmp_path / "normal_model_ep.cpp").write_text("// older\n")
    assert "is of another version of epdem" in header.check(tmp_path)[0]


def test_a_tree_of_liggghts_pfm_gets_a_file_of_its_own(tmp_path):
    (tmp_path / "contact_models.h").write_text("void noCollision();\n")
    names = ["normal_model_ep.cpp", "normal_model_ep.h", "normal_model_ep_BSD-3-Clause.txt"]
    assert [f.name for f in header.write(tmp_path)] == names
    assert header.check(tmp_path) == []
    assert "class NoFriction" in (tmp_path / "normal_model_ep.cpp").read_text()
    (tmp_path / "normal_model_ep.cpp").write_text(header.files()["normal_model_ep.cpp"])
    assert ["another version" in sentence for sentence in header.check(tmp_path)] == [True]


def test_check_refuses_a_tree_with_another_interface(tmp_path):
    (tmp_path / "contact_models.h").write_text("void compute();\n")
    with pytest.raises(CaseError, match="neither the interface surfacesIntersect"):
        header.check(tmp_path)
    with pytest.raises(CaseError, match=r"contact_models\.h is not there"):
        header.check(tmp_path / "nowhere")
