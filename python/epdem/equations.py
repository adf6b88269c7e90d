# SPDX-License-Identifier: GPL-2.0-or-later
"""The map of equations, from the code itself: number, what it says, function, C++ header, tests.

`python -m epdem.equations > docs/equations.md` writes it from a checkout; a test keeps it true.
"""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NUMBERS = re.compile(r"\b8\.\d\d\b")
RANGES = re.compile(r"\b(8\.(\d\d)) to 8\.(\d\d)\b|\b8\.(\d\d)-8\.(\d\d)\b")


def _numbers(text: str) -> set[str]:
    text = re.sub(r"figures? 8\.\d\d( to 8\.\d\d|(, 8\.\d\d)* and 8\.\d\d)?", "", text)
    found = set(NUMBERS.findall(text))
    for match in RANGES.finditer(text):
        low, high = (int(g) for g in ((match[2], match[3]) if match[1] else (match[4], match[5])))
        found |= {f"8.{n}" for n in range(low, high + 1)}
    return found


def _functions(path: Path):
    """(qualified name, docstring) of every public function and class of a module."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            yield node.name, ast.get_docstring(node) or ""


def _tests_of(name: str) -> list[str]:
    """Test files that name a function, as `module.name` or imported."""
    pattern = re.compile(rf"\b{re.escape(name)}\b")
    files = sorted((ROOT / "tests").rglob("test_*.py"))
    return [f"{p.parent.name}/{p.name}" for p in files if pattern.search(p.read_text())]


def entries() -> list[tuple[str, str, str, str, str]]:
    """(number, statement, function, C++ header, tests), by number."""
    headers: dict[str, list[str]] = {}
    for path in sorted((ROOT / "cpp_contact/include/epdem").glob("*.hpp")):
        for number in _numbers(path.read_text()):
            headers.setdefault(number, []).append(path.name)
    rows = []
    for path in sorted((ROOT / "python/epdem/theory").glob("*.py")):
        for name, doc in _functions(path):
            first = " ".join(doc.split("\n\n")[0].split())
            for number in sorted(_numbers(doc)):
                cpp, tests = ", ".join(headers.get(number, [])), ", ".join(_tests_of(name))
                rows.append((number, first, f"{path.stem}.{name}", cpp, tests))
    return sorted(rows)


def page() -> str:
    """The page in Markdown."""
    lines = [
        "# Equations",
        "",
        'Numbers as in the chapter "Interaction of Elastic-Plastic Particles"; functions are in `epdem.theory`.',
        "Made by `python -m epdem.equations > docs/equations.md`.",
        "",
        "| eq. | statement | function | C++ | tests |",
        "|---|---|---|---|---|",
    ]
    for number, statement, function, cpp, tests in entries():
        text = statement.replace("|", "\\|")
        lines.append(f"| {number} | {text} | `{function}` | {cpp or '-'} | {tests or '-'} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(page(), end="")
