# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/setup on machines that lack something: one sentence each. Its tools are stand-ins on a path of their own.

The build of YADE's module with a source of another version.
"""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
REAL = ["bash", "env", "dirname", "grep", "cat", "mkdir", "rm", "sort", "touch", "xargs", "sha256sum", "true"]
DEBIAN = """
case "$*" in
  *base-files*) echo -n 12.4+deb12u12 ;;
  *Version*) echo -n 1 ;;
  *liggghts) [ -e "$0.complete" ] && echo -n "install ok installed" ;;
  *) echo -n "install ok installed" ;;
esac
"""
VENV = '[ "$1 $2" = "-m venv" ] && mkdir -p "$3/bin" && touch "$3/bin/python"\n'
APT = 'echo "$(basename "$0") $* front=$DEBIAN_FRONTEND proxy=$http_proxy" >> "$0.called"\n'


class Machine:
    """A clone in a folder with spaces, and the tools it sees."""

    def __init__(self, folder: Path):
        self.clone, self.bin = folder / "a clone", folder / "bin"
        (self.clone / "scripts").mkdir(parents=True)
        script = (ROOT / "scripts/setup").read_text()
        assert "command -v /usr/bin/python3 " in script
        shutil.copy(ROOT / "scripts/setup", self.clone / "scripts/setup")  # with its mode
        (self.clone / "scripts/setup").write_text(script.replace("/usr/bin/python3", str(self.bin / "python3")))
        self.bin.mkdir()
        for name in REAL:
            (self.bin / name).symlink_to(shutil.which(name))
        self.tool("dpkg-query", DEBIAN)
        self.tool("apt-get", APT)
        self.tool("id", "echo 1000")
        self.tool("basename", 'echo "${1##*/}"')
        self.tool("find", "exit 9")  # where the build would begin
        self.tool("python3", VENV)

    def tool(self, name: str, text: str) -> None:
        (self.bin / name).write_text(f"#!/bin/bash\n{text}")
        (self.bin / name).chmod(0o755)

    def complete(self) -> None:
        (self.bin / "dpkg-query.complete").touch()

    def setup(self, **environment: str) -> subprocess.CompletedProcess[str]:
        words = {"PATH": str(self.bin), "HOME": os.environ["HOME"]} | environment
        command = [self.clone / "scripts/setup"]
        return subprocess.run(command, cwd="/", env=words, capture_output=True, text=True, timeout=100)


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def test_without_sudo_the_command_for_root_is_told(machine):
    done = machine.setup()
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "liggghts not installed, and there is no sudo; as root: apt-get install liggghts" in done.stderr


@pytest.mark.parametrize(("version", "shown"), [("14.1", "14.1"), ("13ubuntu10", "13ubuntu10"), ("", "unknown")])
def test_another_release_is_named_before_anything_is_installed(version, shown, machine):
    machine.tool("dpkg-query", DEBIAN.replace("12.4+deb12u12", version))
    done = machine.setup()
    assert done.returncode == 1 and f"neither Debian 12 nor 13 (base-files {shown})" in done.stderr
    assert done.stderr.count("\n") == 1 and "'epdem export liggghts' (docs/trees.md)" in done.stderr
    assert not (machine.bin / "apt-get.called").exists()


@pytest.mark.parametrize("version", ["12", "12.4+deb12u12", "13", "13.8+deb13u1"])
def test_two_releases_of_debian_are_served(version, machine):
    machine.tool("dpkg-query", DEBIAN.replace("12.4+deb12u12", version))
    machine.tool("sudo", 'exec "$@"')
    machine.setup()
    assert "install" in (machine.bin / "apt-get.called").read_text()


def test_without_dpkg_it_says_that_this_is_not_debian(machine):
    (machine.bin / "dpkg-query").unlink()
    done = machine.setup()
    assert done.returncode == 1 and done.stderr.startswith("setup: this is not Debian, ")
    assert done.stderr.count("\n") == 1 and "'epdem export liggghts' (docs/trees.md)" in done.stderr


def test_a_sudo_that_refuses_is_named(machine):
    machine.tool("sudo", "echo sudo: a password is required >&2; exit 1")
    done = machine.setup()
    assert done.returncode == 1 and not (machine.bin / "apt-get.called").exists()
    assert "liggghts not installed, and sudo refuses; as root: apt-get install liggghts" in done.stderr


def test_sudo_that_drops_the_environment_keeps_proxy_and_silence(machine):
    machine.tool("sudo", 'exec env -i PATH="$PATH" "$@"')
    machine.setup(http_proxy="http://gate:3128")
    said = (machine.bin / "apt-get.called").read_text().splitlines()
    assert [line.split()[-2:] for line in said] == [["front=noninteractive", "proxy=http://gate:3128"]] * 2
    assert "update" in said[0] and said[1].split()[-3] == "liggghts"


def test_an_apt_that_fails_is_named(machine):
    machine.tool("sudo", 'exec "$@"')
    machine.tool("apt-get", '[[ "$*" == *update* ]]')
    done = machine.setup()
    assert done.returncode == 1 and "apt-get could not install liggghts" in done.stderr


@pytest.mark.parametrize("state", ["half-made", "moved", "whole"])
def test_a_virtual_environment_that_is_not_whole_or_was_moved_is_made_anew(state, machine):
    machine.complete()
    place = machine.clone / ".venv"
    (place / "bin").mkdir(parents=True)
    (place / "mark").touch()
    if state != "half-made":
        home = machine.clone if state == "whole" else Path("/elsewhere")
        (place / "bin/python").write_text("#!/bin/bash\nexit 0\n")
        (place / "bin/python").chmod(0o755)
        (place / "bin/pip").write_text(f"#!{home}/.venv/bin/python\n")
    done = machine.setup()
    assert (place / "mark").exists() == (state == "whole")
    assert ("comes from another folder; it is made anew" in done.stdout) == (state != "whole")
    assert (place / "bin/python").exists()


@pytest.mark.parametrize("changed", ["cpp_contact/pair.cpp", "templates/in.j2"])
def test_changed_sources_in_cpp_remove_the_plugin_of_lammps_and_the_module_of_yade(changed, machine):
    machine.complete()
    (machine.bin / "find").unlink()
    (machine.bin / "find").symlink_to(shutil.which("find"))
    sources = ("pyproject.toml", "CMakeLists.txt", "scripts/constraints.txt", "python/a.py", "cpp_contact/b")
    for name in (*sources, changed):
        (machine.clone / name).parent.mkdir(exist_ok=True)
        (machine.clone / name).touch()
    (machine.clone / "templates").mkdir(exist_ok=True)
    place = machine.clone / ".venv"
    (place / "bin").mkdir(parents=True)
    (place / "bin/python").write_text("#!/bin/bash\nexit 0\n")
    (place / "bin/python").chmod(0o755)
    (place / "bin/pip").write_text(f"#!{place}/bin/python\n")
    assert machine.setup().returncode == 0
    native = place / "lib/python3.11/site-packages/epdem/native"
    built = [native / "lammps/epdemplugin.so", native / "epdem_yade.so"]
    built[0].parent.mkdir(parents=True)
    for file in built:
        file.touch()
    (machine.clone / changed).write_text("other")
    done = machine.setup()
    assert done.returncode == 0 and "setup: building" in done.stdout, done.stderr
    removed = changed.startswith("cpp_contact")
    assert [file.exists() for file in built] == [not removed] * 2
    assert [f"again: make {name}\n" in done.stdout for name in ("lammps", "yade")] == [removed] * 2


@pytest.mark.parametrize(
    ("file", "text"),
    [("debian/changelog", "yade (1:{}-3+deb12u1) unstable; urgency=low\n"), ("RELEASE", "{}\n"), (".git", "")],
)
def test_a_source_of_yade_of_another_version_is_refused(file, text, tmp_path):
    """The YADE is a stand-in without Python headers, where a build with the source of its version stops."""
    program = tmp_path / "yade"
    facts = {"version": "2023.02a", "bits": 64, "digits": 15, "features": "OPENMP", "python": "/nowhere"}
    program.write_text("#!/bin/sh\n" + "".join(f"echo epdem {key} {value}\n" for key, value in facts.items()))
    program.chmod(0o755)
    source = tmp_path / "source"
    (source / "core").mkdir(parents=True)
    (source / "core/Scene.hpp").touch()
    room = ["cmake", "-S", ROOT / "cpp_contact/yade", "-B", tmp_path / "build"]
    for version in ("2019.01a", "2023.02a"):
        if file == ".git":
            git = ["git", "-C", source, "-c", "user.name=a", "-c", "user.email=a@b"]
            for words in (["init", "-q"], ["commit", "-q", "--allow-empty", "-m", version], ["tag", version]):
                subprocess.run([*git, *words], check=True)
        else:
            (source / file).parent.mkdir(exist_ok=True)
            (source / file).write_text(text.format(version))
        done = subprocess.run(
            [*room, f"-DYADE={program}", f"-DYADE_SOURCE={source}"], capture_output=True, text=True, check=False
        )
        said = " ".join(done.stderr.split())
        assert (f"is the source of YADE {version} and {program} is YADE 2023.02a;" in said) == (version == "2019.01a")
        assert ("/nowhere/Python.h was not found" in said or "headers of" in said) == (version == "2023.02a"), said


def test_every_dependency_has_one_version_in_the_lock_file():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    wanted = [*project["dependencies"], *(r for extra in extras.values() for r in extra)]
    locked = dict(re.findall(r"^([\w.-]+)==([\d.]+)", (ROOT / "scripts/constraints.txt").read_text(), re.MULTILINE))
    for requirement in wanted:
        name, _, least = re.match(r"([\w-]+)(>=|==)([\d.]+)", requirement).groups()
        version = locked[re.sub("[-_.]+", "-", name).lower()]  # as uv writes names
        assert [int(n) for n in version.split(".")] >= [int(n) for n in least.split(".")], name


SLOW = ("numpy", "pandas", "pydantic", "pint", "h5py", "jinja2", "matplotlib", "tomlkit", "submitit", "psutil")


TABLES = ("pandas", "matplotlib", "h5py", "jinja2", "pint", "psutil", "tomlkit", "scipy")
STEEL = str(ROOT / "cases/steel_wall.toml")
COMMAND = "from epdem.cli.main import app; app({}, standalone_mode=False)"


@pytest.mark.parametrize(
    ("program", "module", "absent"),
    [
        ("import epdem", "epdem", SLOW),
        ("import epdem.verification.commands", "epdem.verification.commands", SLOW),
        (COMMAND.format(["predict"]), "epdem.impacts.prediction", TABLES),
        (COMMAND.format(["predict", STEEL, "--json"]), "epdem.impacts.prediction", TABLES),
        # scipy.stats alone takes longer than the impacts
        (COMMAND.format(["run", STEEL, "-e", "embedded", "--steps", "30"]), "epdem.impacts.run", ["scipy"]),
    ],
)
def test_nothing_slow_is_imported_before_it_is_needed(program, module, absent, tmp_path):
    code = f"{program}\nimport sys; print(*sys.modules)"
    loaded = subprocess.check_output([sys.executable, "-c", code], text=True, cwd=tmp_path).splitlines()[-1].split()
    assert module in loaded and not [name for name in absent if name in loaded]


@pytest.mark.parametrize("module", ["epdem.theory", "epdem.laws.library", "epdem.laws.strengths"])
def test_theory_and_laws_import_numpy_alone(module):
    """Of all packages of the environment: what is not Python's own and lies in no folder of numpy or epdem."""
    code = f"import sys, {module}; print(*(n for n in sys.modules if '.' not in n and not n.startswith('_')))"
    loaded = {*subprocess.check_output([sys.executable, "-c", code], text=True).split()}
    assert loaded - {*sys.stdlib_module_names} <= {"epdem", "numpy", "cython_runtime", "sitecustomize"}


@pytest.mark.packaging
@pytest.mark.liggghts
@pytest.mark.yade
@pytest.mark.skipif("YADE_SOURCE" not in os.environ, reason="YADE_SOURCE names no source of YADE")
@pytest.mark.parametrize(
    ("order", "more"),
    [
        pytest.param("yade lammps demo", {}, id="yade first"),
        pytest.param("lammps wheel yade demo lammps", {"EXTRA": ""}, marks=pytest.mark.slow, id="lammps first"),
    ],
)
def test_targets_work_in_any_order(order, more, tmp_path):
    """Nothing is optimized, and the second time the tools of tests are left out. As the only slow one of this file it
    begins in another process than the first."""
    subprocess.run(["git", "clone", "-q", ROOT, tmp_path / "a clone"], check=True)
    quick = {"CXXFLAGS": "-O0", "CMAKE_BUILD_TYPE": "None", "PIP_NO_COMPILE": "0"}  # 0: pip takes it for --no-compile
    done = subprocess.run(
        ["make", *order.split()],
        cwd=tmp_path / "a clone",
        env=os.environ | quick | more,
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    native = list((tmp_path / "a clone/.venv").rglob("epdem/native/*"))
    assert {"epdem_yade.so", "lammps", "libepdem.so"} <= {path.name for path in native}
