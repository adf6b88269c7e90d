# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/trees on small stand-ins of checkouts: what is copied, mended, and skipped with its reason."""

import importlib.machinery
import importlib.util
from pathlib import Path

import pytest

from epdem.tools import header

SCRIPT = Path(__file__).parents[2] / "scripts/trees"
AUTO = "H := \\#\nX := '\\#include <mpi.h> \\n \\#if defined(MPICH)'\n"
FILES = {  # a tree of LIGGGHTS-PUBLIC as far as the script looks at it
    "contact_models.h": "void surfacesIntersect();\n",
    "utils.h": "  return static_cast< std::ostringstream & >(x).str();\n",
    "finish.cpp": "    if (neighbor->lists[m]->numneigh > 0) {\n",
    "dump_mesh_vtk.cpp": "#include <vtkPoints.h>\n",
    "dump_mesh_vtk.h": "",
    "CMakeLists.txt": "SET(CMAKE_CXX_FLAGS -std=c++11)\n",
    "MAKE/Makefile.auto": AUTO,
    "MAKE/Makefile.user_default": 'USE_VTK = "ON"\n',
    "Makefile": "auto:\n\t@echo 'x.cpp:7: error: no such thing' >&2; exit 1\n",
    "Obj_auto/x.o": "an object of another compiler",
}


@pytest.fixture
def script(tmp_path, monkeypatch):
    loader = importlib.machinery.SourceFileLoader("trees", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("trees", loader))
    loader.exec_module(module)
    monkeypatch.setattr(module, "CACHE", tmp_path / "cache")
    return module


def checkout(folder, **changed):
    for name, text in (FILES | {k.replace("__", "."): v for k, v in changed.items()}).items():
        (folder / "src" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "src" / name).write_text(text)
    return folder


def contents(folder):
    return {str(f.relative_to(folder)): f.read_text() for f in folder.rglob("*") if f.is_file()}


def test_a_checkout_is_copied_and_mended_and_stays_as_it_is(script, tmp_path):
    tree = checkout(tmp_path / "mine")
    before = contents(tree)
    src = script.copied(tree)
    script.mend(src)
    assert header.check(src) == [] and contents(tree) == before
    assert (src / "MAKE/Makefile.auto").read_text() == AUTO.replace("\\#in", "#in").replace("\\#if", "#if")
    assert not (src / "Obj_auto").exists() and not (src / "dump_mesh_vtk.h").exists()
    text = (src / "MAKE/Makefile.user").read_text()
    assert 'USE_VTK = "OFF"' in text and "MPI_LIB_USR=/" in text
    made = src.stat().st_mtime_ns, (src / "utils.h").stat().st_mtime_ns
    script.mend(script.copied(tree))
    assert (src.stat().st_mtime_ns, (src / "utils.h").stat().st_mtime_ns) == made  # nothing to compile anew
    assert script.copied(checkout(tree, utils__h="int newer;\n")) != src


def test_trees_that_cannot_be_served_are_skipped_with_a_reason_each(script, tmp_path):
    checkout(tmp_path / "trees" / "fails")
    checkout(tmp_path / "trees" / "foreign", contact_models__h="int x;\n")
    (tmp_path / "trees" / "notes").mkdir()
    trees = script.checkouts(tmp_path / "trees")
    executables, reasons = script.served(trees)
    assert executables == [] and len(reasons) == len(trees) == 3
    assert "fails is skipped: its build fails: x.cpp:7: error: no such thing; see " in reasons[0]
    assert "foreign is skipped: " in reasons[1] and "neither the interface surfacesIntersect nor" in reasons[1]
    assert "notes is skipped: it has no src/contact_models.h" in reasons[2]
    assert script.checkouts(tmp_path / "trees" / "fails") == [trees[0]]


def test_a_tree_that_builds_gives_its_executable_and_the_warnings_of_our_files(script, tmp_path, capsys):
    make = "auto:\n\t@echo '../normal_model_ep.cpp:3: warning: ours' >&2; echo 'fix.h:1: warning: theirs' >&2\n"
    executables, reasons = script.served([checkout(tmp_path / "good", Makefile=make)])
    assert reasons == [] and [p.name for p in executables] == ["lmp_auto"]
    assert "1 warnings of our files\n../normal_model_ep.cpp:3: warning: ours" in capsys.readouterr().out
