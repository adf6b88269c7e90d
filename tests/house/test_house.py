# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules of the house that a machine can hold."""

import re
from pathlib import Path

import pytest
from modules import imports

ROOT = Path(__file__).parents[2]
PYTHON = ROOT / "python" / "epdem"
SOURCES = [
    p
    for pattern in (
        "python/**/*.py",
        "tests/**/*.py",
        "bench/*.py",
        "docs/*.py",
        "cpp_contact/**/*.[hc]pp",
        "cpp_contact/**/*.h",
        "templates/**/*.j2",
    )
    for p in sorted(ROOT.glob(pattern))
    if "native" not in p.parts
]
SCRIPTS = [p for p in sorted(ROOT.glob("scripts/*")) if not p.suffix]


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: str(p.relative_to(ROOT)))
def test_a_file_is_read_in_one_sitting(path):
    assert len(path.read_text().splitlines()) <= 320, "is a room missing?"


@pytest.mark.parametrize("path", sorted((PYTHON / "theory").glob("*.py")), ids=lambda p: p.name)
def test_theory_needs_numpy_alone_and_never_calls_the_law(path):
    allowed = ("numpy", "epdem.theory", "dataclasses", "functools", "typing", "collections", "math")
    for module in imports(path):
        assert module.startswith(allowed), module


# immintrin.h: the square root of a vector, in lanes.hpp
STANDARD = {"algorithm", "cmath", "cstdint", "immintrin.h", "iterator", "limits", "type_traits"}


def test_laws_include_no_host():
    headers = list((ROOT / "cpp_contact/include/epdem").glob("*.hpp"))
    assert len(headers) >= 8
    for path in headers:
        for name in re.findall(r"#include [<\"]([^>\"]+)", path.read_text()):
            assert "/" not in name or name.startswith("epdem/"), f"{path.name} includes {name}"
            assert name.endswith(".hpp") or name in STANDARD, name


def test_adapters_leave_powers_and_roots_to_the_laws():
    """A formula in an adapter is a second copy of the physics."""
    adapters = [*(ROOT / "cpp_contact/liggghts").glob("*.[hc]pp"), *(ROOT / "cpp_contact/capi").glob("*.cpp")]
    assert len(adapters) >= 8
    for path in adapters:
        for call in re.findall(r"\b(?:std::)?(sqrt|pow|exp|log|cbrt)\s*\(", path.read_text()):
            assert call is None, f"{path.name} calls {call}()"


def test_every_source_states_its_licence():
    for path in [*SOURCES, *SCRIPTS]:
        if path.suffix in ("", ".py", ".hpp", ".cpp", ".h"):
            assert "SPDX-License-Identifier: GPL-2.0-or-later" in path.read_text()[:200], path


def test_links_between_documents_lead_somewhere():
    for page in [*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")]:
        for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
            assert (page.parent / target).exists(), f"{page.name} -> {target}"


def test_nothing_is_left_unfinished():
    words = re.compile(r"\b(TO" + r"DO|FIX" + r"ME|X" + r"XX|NotImplemented" + r"Error)\b")
    for path in [*SOURCES, *SCRIPTS]:
        assert not words.search(path.read_text()), path


def test_no_two_test_files_share_a_name():
    """pytest imports tests by file name: two of one name hide each other."""
    names = [p.name for p in (ROOT / "tests").rglob("*.py") if p.name != "conftest.py"]
    assert len(names) == len(set(names))


def test_all_files_state_one_version():
    places = {
        "pyproject.toml": r'^version = "(.+)"',
        "CMakeLists.txt": r"^project\(epdem VERSION (\S+)",
        "python/epdem/__init__.py": r'^__version__ = "(.+)"',
        "CITATION.cff": r"^version: (.+)",
    }
    found = {re.search(pattern, (ROOT / name).read_text(), re.MULTILINE)[1] for name, pattern in places.items()}
    assert len(found) == 1, found


def test_the_formatter_lays_out_every_line():
    for path in SOURCES:
        assert not re.search(r"# fmt: *" + r"(skip|off)", path.read_text()), path
