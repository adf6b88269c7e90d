# SPDX-License-Identifier: GPL-2.0-or-later
"""The map of equations, from the code itself: number, formula, source, function, line of C++, tests.

`python -m epdem.equations > docs/equations.md` writes it from a checkout; a test keeps it true. A docstring states an
equation as `Eq. 8.84 [Thornton 1997]: v_y = ...`, to the end of the paragraph; a C++ header names it in a comment, and
the declaration below the comment is the place. A test calls the function by its name; for a method, whose name alone
tells nothing, it says so: `# equation: backbones.Backbone.unloading`.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .theory.sources import SOURCES

ROOT = Path(__file__).resolve().parents[2]
STATEMENT = re.compile(r"^Eq\. (8\.\d\d) \[(.+?)\]: (.+?)(?=\n\n|\Z)", re.DOTALL | re.MULTILINE)
MENTION = re.compile(r"\b8\.\d\d\b")
HEADERS, THEORY, TESTS = "cpp_contact/include/epdem", "python/epdem/theory", "tests"


@dataclass(frozen=True, order=True)
class Entry:
    """One equation in one function; `cpp` and `tests` are paths inside the project, with a line or a test's name."""

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


def _places(root: Path) -> dict[str, list[str]]:
    """Number -> header:line of the first declaration below each comment that names it."""
    found: dict[str, list[str]] = {}
    for path in sorted(root.glob("*.hpp")):
        lines = path.read_text().splitlines()
        for k, line in enumerate(lines):
            if line.lstrip().startswith("//"):
                code = (n for n in range(k, len(lines)) if re.match(r"\s*(template|struct|inline|real)\b", lines[n]))
                place = f"{path.name}:{next(code, k) + 1}"
                for number in MENTION.findall(line):
                    if place not in found.setdefault(number, []):
                        found[number].append(place)
    return found


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
    found = {}
    for path in sorted((ROOT / TESTS / "physics").glob("test_*.py")):
        text = path.read_text()
        body = ast.parse(text).body
        imports = "\n".join(ast.unparse(n) for n in body if isinstance(n, ast.Import | ast.ImportFrom))
        for node in body:
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                found[f"{path.name}::{node.name}"] = imports + "\0" + ast.get_source_segment(text, node)
    return found


def entries() -> list[Entry]:
    """All equations that docstrings of the theory state, by number. KeyError for a source that is not in SOURCES."""
    places, tests, rows = _places(ROOT / HEADERS), _test_functions(), []
    for path in sorted((ROOT / THEORY).glob("*.py")):
        for name, doc in _functions(path):
            for number, source, formula in STATEMENT.findall(doc):
                cpp = tuple(places.get(number, ()))
                rows.append(Entry(number, name, " ".join(formula.split()), source, cpp, _tests_of(name, tests)))
                SOURCES[source]
    return sorted(rows)


def page() -> str:
    """The page in Markdown."""
    lines = [
        "# Equations",
        "",
        'Numbers as in the chapter "Interaction of Elastic-Plastic Particles"; functions are in `epdem.theory`,',
        f"headers in `{HEADERS}`, tests in `{TESTS}/physics`. Made by `python -m epdem.equations > docs/equations.md`.",
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
    print(page(), end="")
