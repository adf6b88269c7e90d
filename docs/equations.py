# SPDX-License-Identifier: GPL-2.0-or-later
"""docs/equations.md, the table of equations from the code itself: number, formula, source, function, C++, tests.

Run: .venv/bin/python docs/equations.py     (a test compares the page with the code)

A docstring states an equation as `Eq. 8.84 [Thornton 1997]: v_y = ...`, to the end of the paragraph. A test calls the
function by its name; a test of a method states `# equation: curve.Curve.elastic_branch`. CPP lists the code that
computes with an equation in C++.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from epdem.theory.sources import CHAPTER, SOURCES

ROOT = Path(__file__).resolve().parents[1]
STATEMENT = re.compile(r"^Eq\. (8\.\d\d) \[(.+?)\]: (.+?)(?=\n\n|\Z)", re.DOTALL | re.MULTILINE)
HEADERS, TESTS = "cpp_contact/include/epdem", "tests"
THEORY = [*(ROOT / "python/epdem/theory").glob("*.py")]
# header, function and code of what computes with an equation; a law that merely leads to one (8.83, 8.84) does not
CPP = {
    "8.78": [("cavity.hpp", "Cavity::parameters", '"c_Y", "1", 1.60')],
    "8.80": [
        ("cavity.hpp", "Cavity::parameters", '"c_P", "1", 2.8'),
        ("johnson.hpp", "Johnson::default_ratio", "default_ratio = 3.0"),
        ("thornton.hpp", "Thornton::default_ratio", "default_ratio = 2.8"),
    ],
    "8.81": [("cavity.hpp", "Cavity::load", "2.0 / 3.0 * c_Y + (1.0 + beta) / 3.0 * log_s")],
    "8.82": [("unloading.hpp", "unload", "(1.0 - tau) * disc * sqrt(disc) + B * v * sqrt(v) * detail::segment(v)")],
    "8.85": [
        ("cavity.hpp", "Cavity::load", "2.0 * pi * R_star * c_P * Y * delta, sqrt(2.0 * R_star * delta)"),
        ("johnson.hpp", "Johnson::load", "slope_ratio * R_star * delta, sqrt(2.0 * R_star * delta)"),
    ],
}


@dataclass(frozen=True, order=True)
class Entry:
    """One equation in one function; `cpp`: header and function; `tests`: file and test."""

    number: str
    function: str
    formula: str
    source: str
    cpp: tuple[str, ...]
    tests: tuple[str, ...]


def _functions(path: Path) -> Iterator[tuple[str, str]]:
    """(name as `module.function` or `module.Class.method`, docstring) of every public function, method and class."""
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            yield f"{path.stem}.{node.name}", ast.get_docstring(node) or ""
            for part in getattr(node, "body", []):
                if isinstance(node, ast.ClassDef) and isinstance(part, ast.FunctionDef):
                    yield f"{path.stem}.{node.name}.{part.name}", ast.get_docstring(part) or ""


def _places(number: str) -> tuple[str, ...]:
    """`header: function` of the C++ that computes with an equation. ValueError if its code is not there any more."""
    for header, _, code in CPP.get(number, ()):
        if code not in (ROOT / HEADERS / header).read_text():
            raise ValueError(f"{header}: {code!r} is not there any more; say in CPP what computes eq. {number} now")
    return tuple(f"{header}: {function}" for header, function, _ in CPP.get(number, ()))


def _tests_of(name: str, tests: dict[str, str]) -> tuple[str, ...]:
    """Tests that call `module.name`, or `name` imported from the module; of a method, those that state it."""
    module, _, word = name.rpartition(".")
    if "." in module:
        stated = re.compile(rf"# equation: {re.escape(name)}$", re.MULTILINE)
        return tuple(place for place, text in tests.items() if stated.search(text))
    imported = re.compile(rf"from epdem\.theory\.{module} import .*\b{word}\b")
    called = re.compile(rf"\b{re.escape(name)}\b")
    bare = re.compile(rf"(?<![\w.\"]){word}\(")
    return tuple(
        place
        for place, text in tests.items()
        if called.search(text) or (imported.search(text.partition("\0")[0]) and bare.search(text))
    )


def _test_functions() -> dict[str, str]:
    """file.py::test_name -> the file's imports and helpers, and the test's own text."""
    functions = {}
    for path in sorted((ROOT / TESTS / "physics").glob("test_*.py")):
        text = path.read_text()
        body = ast.parse(text).body
        imports = "\n".join(ast.unparse(n) for n in body if isinstance(n, ast.Import | ast.ImportFrom))
        for node in body:
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                functions[f"{path.name}::{node.name}"] = imports + "\0" + ast.get_source_segment(text, node)
    return functions


def entries() -> list[Entry]:
    """All equations that docstrings of the theory state, by number. KeyError for a source that is not in SOURCES."""
    tests, rows = _test_functions(), []
    for path in THEORY:
        for name, doc in _functions(path):
            for number, source, formula in STATEMENT.findall(doc):
                formula = " ".join(formula.split())
                rows.append(Entry(number, name, formula, source, _places(number), _tests_of(name, tests)))
                SOURCES[source]
    return sorted(rows)


def page() -> str:
    """The page in Markdown."""
    lines = [
        "# Equations",
        "",
        f"The numbers of the equations are those of {CHAPTER}.",
        "",
        f"The functions are in `epdem.theory`, the headers in `{HEADERS}`, the tests in",
        f"`{TESTS}/physics`. This command writes the page: `.venv/bin/python docs/equations.py`.",
        "",
        "| eq. | formula | source | function | C++ | tests |",
        "|---|---|---|---|---|---|",
    ]
    for e in entries():
        formula = e.formula.replace("|", "\\|")
        tests = "<br>".join(f"`{t}`" for t in e.tests)
        cpp = ", ".join(f"`{c}`" for c in e.cpp)
        lines.append(f"| {e.number} | `{formula}` | {e.source} | `{e.function}` | {cpp or '-'} | {tests or '-'} |")
    lines += ["", "## Sources", "", *(f"- {key}: {text}" for key, text in SOURCES.items())]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    (ROOT / "docs/equations.md").write_text(page())
