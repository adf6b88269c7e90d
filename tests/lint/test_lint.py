# SPDX-License-Identifier: GPL-2.0-or-later
"""Linters, formatters and the type checker find nothing; documents agree with the files beside them."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from marks import thorough

ROOT = Path(__file__).parents[2]
# ruff and shellcheck find scripts without a suffix only by name
ALL_SCRIPTS = [p for p in sorted((ROOT / "scripts").iterdir()) if p.is_file()]  # beside __pycache__
SCRIPTS = [str(p) for p in ALL_SCRIPTS if p.read_text().startswith("#!/usr/bin/env python3")]
SHELL = [str(p) for p in ALL_SCRIPTS if p.read_text().startswith("#!/usr/bin/env bash")]
PYTHON = ["python", "tests", "bench", "docs", "packaging", *SCRIPTS]
CPP = [str(p) for room in ("cpp_contact", "tests", "bench") for p in sorted((ROOT / room).rglob("*.[hc]*"))]
CPP = [path for path in CPP if path.endswith((".hpp", ".h", ".cpp"))]
# clang-tidy reads one source that includes every header of the laws; `make tidy` reads all of C++, in minutes
LAWS = ["cpp_contact/capi/epdem.cpp", "--", "-std=c++17", "-Icpp_contact/include", '-DEPDEM_VERSION=""']
# names, attributes and arguments of the scripts of pages; their own lines have few types
SCRIPTS_OF_PAGES = ["mypy", "--config-file=", "--check-untyped-defs", "--ignore-missing-imports"]
OF_TYPES = ("assignment", "operator", "index", "var-annotated", "misc", "arg-type", "union-attr", "list-item")
SCRIPTS_OF_PAGES += [f"--disable-error-code={code}" for code in OF_TYPES]
SCHEMA = ["check-jsonschema", "--builtin-schema"]
GITHUB = ROOT / ".github"
TOOLS = {
    "ruff check": ["ruff", "check", "--output-format", "concise", *PYTHON],
    "ruff format": ["ruff", "format", "--check", *PYTHON],
    "mypy": ["mypy"],
    "mypy of bench": [*SCRIPTS_OF_PAGES, *(str(p) for p in sorted((ROOT / "bench").glob("*.py")))],
    "mypy of docs": [
        *SCRIPTS_OF_PAGES,
        *(str(p) for p in sorted((ROOT / "docs").glob("*.py")) if p.stem != "paraview"),
    ],
    "lint-imports": ["lint-imports", "--no-cache"],
    "clang-format": ["clang-format", "--dry-run", "--Werror", *CPP],
    "reuse": ["reuse", "lint", "--lines"],
    "clang-tidy": ["clang-tidy", "--quiet", *LAWS],
    # single quotes keep $ for another shell or for dpkg-query (SC2016)
    "shellcheck": ["shellcheck", "--exclude=SC2016", *SHELL],
    "workflows": [*SCHEMA, "vendor.github-workflows", *map(str, sorted(GITHUB.glob("workflows/*.yml")))],
    "issue forms": [*SCHEMA, "vendor.github-issue-forms", *map(str, sorted(GITHUB.glob("ISSUE_TEMPLATE/[!c]*.yml")))],
}


@pytest.mark.parametrize("command", [thorough(TOOLS[n], id=n, unless=n != "clang-tidy") for n in TOOLS])
def test_the_tool_finds_nothing(command):
    path = f"{ROOT}/.venv/bin:/usr/bin:/bin"
    done = subprocess.run(
        command, cwd=ROOT, capture_output=True, text=True, env={"PATH": path, "MYPYPATH": "python:bench:tests:docs"}
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("folder", ["bench", "docs"])
def test_the_scripts_of_pages_find_what_they_import(folder):
    """Each is read, not run: ParaView's Python and YADE's run one each."""
    scripts = [str(p) for p in sorted((ROOT / folder).glob("*.py")) if p.stem not in ("paraview", "community_yade")]
    code = "import runpy, sys\nfor path in sys.argv[1:]: runpy.run_path(path, run_name='read')"
    place = {"PYTHONPATH": str(ROOT / folder), "PATH": "/usr/bin:/bin"}
    words = [sys.executable, "-c", code, *scripts]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, env=place)
    assert done.returncode == 0, done.stderr


def test_every_source_states_its_licence():
    """The physics is free for every code; an adapter of a host under GPL is not."""
    python = [path for room in PYTHON[:4] for path in (ROOT / room).rglob("*.py")]
    scripts = [path for path in ALL_SCRIPTS if not path.suffix]
    cmake = [path for path in (ROOT / "cpp_contact").rglob("CMakeLists.txt")]
    seen = set()
    for path in [*python, *scripts, *cmake, *map(Path, CPP)]:
        free = path.is_relative_to(ROOT / "cpp_contact/include") or path.is_relative_to(ROOT / "cpp_contact/kernels")
        licence = "BSD-3-Clause" if free else "GPL-2.0-or-later"
        stated = re.search(r"SPDX-License" + r"-Identifier: (.+)", path.read_text()[:200])
        assert stated and stated[1] == licence, path
        seen.add(licence)
    assert seen == {path.stem for path in (ROOT / "LICENSES").iterdir()}
    for name in ("pyproject.toml", "packaging/spack/package.py"):
        assert f'"{" AND ".join(sorted(seen, reverse=True))}"' in (ROOT / name).read_text()


def test_the_physics_includes_itself_and_the_standard_library_alone():
    folders = [ROOT / "cpp_contact/include/epdem", ROOT / "cpp_contact/kernels"]
    files = [path for folder in folders for path in folder.rglob("*.[hc]pp")]
    for path in files:
        for quoted, system in re.findall(r'#\s*include (?:"(.+)"|<(.+)>)', path.read_text()):
            places = [path.parent, ROOT / "cpp_contact/include", ROOT / "cpp_contact"]
            assert not quoted or (next(p / quoted for p in places if (p / quoted).exists())).resolve() in files, path
            assert not system or "." not in system or system == "immintrin.h", path


def test_adapters_leave_powers_and_roots_to_the_laws():
    """A formula in an adapter is a second copy of the physics."""
    adapters = ("liggghts/*.[hc]pp", "capi/*.cpp", "yade/*.[hc]pp")
    for path in [path for pattern in adapters for path in (ROOT / "cpp_contact").glob(pattern)]:
        assert not re.search(r"\b(sqrt|pow|exp|log|cbrt)\s*\(", path.read_text()), path


# state outside of objects: variables of a namespace, of a class or of a function, and maps from addresses
STATE = (
    r"^(?!using|namespace|class|struct|enum|return|extern|template|typedef|friend|const|inline const)"
    r"(?:[\w:<>,*&]+ )+[*&]*\w+(?:\[\])?(?: = [^;]*|\{[^;]*\})?;",
    r"^ *(?:inline )?(?:static|thread_local) (?!const|inline const)[\w:<>,*& ]+ [*&]*\w+(?:\[\w*\])?(?: =|;|\{)",
    r"map<(?:const )?[\w:]+ ?\*",
)


def state_of(text):
    """Declarations of state outside of objects, without comments."""
    text = re.sub(r"//.*", "", text)
    return [found.strip() for pattern in STATE for found in re.findall(pattern, text, re.MULTILINE)]


def test_state_belongs_to_objects():
    """A simulation ends, and another one begins in the same program, at the same address."""
    rooms = [ROOT / "cpp_contact" / room for room in ("include", "kernels", "liggghts", "lammps")]
    for path in [path for room in rooms for path in sorted(room.rglob("*.[hc]pp"))]:
        assert state_of(path.read_text()) == [], path


def test_a_recipe_of_easybuild_is_python_with_its_keys():
    for path in (ROOT / "packaging/easybuild").glob("*.eb"):
        given: dict[str, object] = {}
        exec(compile(path.read_text(), str(path), "exec"), given)
        assert path.name == f"{given['name']}-{given['version']}-{'-'.join(given['toolchain'].values())}.eb"


def test_recipes_name_every_package_that_epdem_imports():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    spack = (ROOT / "packaging/spack/package.py").read_text()
    (easybuild,) = (ROOT / "packaging/easybuild").glob("*.eb")
    bundles = dict.fromkeys(("numpy", "pandas", "scipy"), "SciPy-bundle")
    bundles |= dict.fromkeys(("jinja2", "psutil"), "Python-bundle-PyPI")
    for requirement in project["dependencies"]:
        name, least = requirement.split(">=")
        assert f'depends_on("py-{name}@{least}:"' in spack, name
        assert f'("{bundles.get(name, name)}", "'.lower() in easybuild.read_text().lower(), name


def test_the_paper_cites_what_its_bibliography_has():
    entries = re.findall(r"^@\w+\{(\w+),", (ROOT / "paper/paper.bib").read_text(), re.MULTILINE)
    assert {*entries} == {*re.findall(r"@(\w+)", (ROOT / "paper/paper.md").read_text())}


def test_links_between_documents_lead_to_files():
    for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]:
        prose = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.M | re.S)
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", prose):
            assert (page.parent / target).exists(), f"{page.name} -> {target}"


def test_both_recipes_of_the_image_have_the_same_steps():
    recipes = [(ROOT / name).read_text() for name in ("Containerfile", "epdem.def")]
    steps = [re.findall(r"^(?:RUN |    )((?:scripts/setup|apt-get) .+)", text, re.MULTILINE) for text in recipes]
    assert len(steps[0]) == 2 and steps[0] == steps[1]


def test_all_files_state_one_version():
    places = {
        "cpp_contact/lammps/export/CMakeLists.txt": r"^project\(epdem VERSION (\S+)",
        "python/epdem/base/__init__.py": r'^__version__ = "(.+)"',
        "CITATION.cff": r"^version: (.+)",
        "packaging/spack/package.py": r'^    version\("(.+)"\)',
        "packaging/easybuild/epdem-0.2.0-foss-2024a.eb": r'^version = "(.+)"',
    }
    found = {re.search(pattern, (ROOT / name).read_text(), re.MULTILINE)[1] for name, pattern in places.items()}
    assert len(found) == 1, found
