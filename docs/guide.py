# SPDX-License-Identifier: GPL-2.0-or-later
"""The guide as a site of static pages in runs/guide/site, from docs/*.md; no page needs a network.

Run: make guide      (installs mkdocs-material and latex2mathml; 15 s)

Equations become MathML, which browsers draw themselves; the reference of commands and of the Python interface is
written from the code.
"""

import inspect
import os
import re
import shutil
import subprocess
import sys
import types
from collections.abc import Callable
from math import inf
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import typer
from pydantic import BaseModel

import epdem.api
from epdem.base.declarations import declarations
from epdem.case import kinds
from epdem.case.fields import Quantity
from epdem.case.impact import Case
from epdem.case.law import law_keys
from epdem.case.scene import SceneCase
from epdem.verification.commands import app

ROOT = Path(__file__).parents[1]
PAGES = ROOT / "runs/guide/pages"
BLOCK, INLINE = re.compile(r"\$\$(.+?)\$\$", re.S), re.compile(r"(?<![\\$`\w])\$([^$`\n]+(?:\n[^$`\n]+)?)\$(?![\w`])")
CODE = re.compile(r"(^```[\s\S]*?^```$|^(?: {4}[^\n]*\n)+|`[^`\n]+`)", re.M)
OUTSIDE = re.compile(r"\[([^\]]*)\]\(\.\./([^)#]+)(?:#[^)]*)?\)")

OF_OTHER_KEYS = {  # symbol, range and default of keys that are no parameters of a law
    "compaction": ("", "`true`, `false`", "`false`"),
    "meyer_index": ("n", "[2, 3), in place of x = n - 2", "2"),
}


def mathematics(text: str, convert: Callable[..., str]) -> str:
    """A page with its LaTeX as MathML; code stays as it is."""
    parts = CODE.split(text)
    for k in range(0, len(parts), 2):
        part = BLOCK.sub(lambda m: f"\n\n<p>{convert(m[1].strip(), display='block')}</p>\n\n", parts[k])
        parts[k] = INLINE.sub(lambda m: f"<span>{convert(m[1])}</span>", part)
    return "".join(parts)


def languages(text: str) -> str:
    """A page whose blocks name their language alone, without what a test reads after it."""
    return re.sub(r"^(```\w+) .*$", r"\1", text, flags=re.M)


def names() -> set[str]:
    """The commands of epdem."""
    return {name for name, command in _commands().items() if not command.hidden}


def _commands() -> dict[str, Any]:
    top: dict[str, Any] = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    found = {}
    for name, command in top.items():
        members = getattr(command, "commands", None)
        found |= {f"{name} {member}": c for member, c in members.items()} if members else {name: command}
    return found


def commands() -> str:
    """Every command with its arguments and options, from the command itself."""
    text = ["# Commands\n"]
    for name, command in sorted(_commands().items()):
        if command.hidden:
            continue
        text.append(f"## epdem {name}\n\n{inspect.cleandoc(command.help or '')}\n\n| option | meaning |\n|---|---|")
        text += [f"| {_named(p)} | {_cell(getattr(p, 'help', '') or '')} |" for p in command.params]
        text.append("")
    return "\n".join(text)


def _named(parameter: Any) -> str:
    if parameter.param_type_name == "argument":
        return f"`{_cell(parameter.metavar or parameter.name.upper())}`"
    return ", ".join(f"`{name}`" for name in [*parameter.opts, *parameter.secondary_opts])


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def python() -> str:
    """The public names of the package with their signatures and docstrings."""
    text, package = ["# Python\n"], {name: getattr(epdem, name) for name in sorted(epdem.api.__all__)}
    for name, thing in [*package.items()]:
        if inspect.ismodule(thing):
            package |= {f"{name}.{part}": getattr(thing, part) for part in thing.__all__}
    for name, thing in package.items():
        if not callable(thing):
            said = inspect.getdoc(thing) if inspect.ismodule(thing) else f"The laws {', '.join(thing)} as classes."
            text.append(f"## {name}\n\n{said}\n")
            continue
        text.append(f"## {name}\n\n```python\n{name}{_signature(thing)}\n```\n\n{inspect.getdoc(thing) or ''}\n")
        for member, function in inspect.getmembers(thing, inspect.isfunction) if inspect.isclass(thing) else []:
            if not member.startswith("_") and (said := inspect.getdoc(function)):
                text.append(f"### {name}.{member}\n\n```python\n{member}{_signature(function)}\n```\n\n{said}\n")
    return "\n".join(text)


def cases() -> str:
    """Every key of case files with unit, limits and default, from the models that read them."""
    text = [
        "# Keys of case files\n",
        "Quantities are texts with a unit; the unit here is that of the limits and in Python.\n",
    ]
    for whole, title in ((Case, "Impacts"), (SceneCase, "Bulk scenes")):
        text.append(f"## {title}\n\n{_tables(whole, '', seen := set())}")
    for name in kinds.names()[:-1]:
        model = kinds.model_of(name)
        assert model is not None  # a name of its own list
        text.append(f'## scene.kind = "{name}"\n\n{_tables(model, "scene.", seen)}')
    return "\n".join([*text, laws()])


def laws() -> str:
    """Every law with its parameters, from the declarations."""
    head = "| law.name | key | symbol | range | default | LIGGGHTS property |\n|---|---|---|---|---|---|"
    rows, texts = [], []
    for law in declarations().values():
        condition = f" Condition: {law.condition}." if law.condition else ""
        texts.append(f"- `{law.name}`: {law.title} ({'; '.join(law.sources)}).{condition}")
        for p in law.parameters:
            unit = "" if p.unit == "1" else f" {p.unit}"
            times = "" if law.default_ratio == 1.0 else f"{law.default_ratio:g} times "
            ratio = f"{times}the yield stress" if p.name == law.strength else "required"
            default = ratio if p.default is None else f"{p.default:g}"
            row = (law.name, f"`law.{p.name}`", p.symbol, f"{p.limits()}{unit}", default, f"`{p.property}`")
            rows.append(f"| {' | '.join(row)} |")
        known = [p.name for p in law.parameters]
        ratio = ("", f"`{law.strength}` over the yield stress of the material", f"{law.default_ratio:g}")
        for key in (key for key in law_keys(law) if key not in known):
            rows.append(f"| {law.name} | `law.{key}` | {' | '.join(OF_OTHER_KEYS.get(key, ratio))} | |")
    return "\n".join(["## Laws\n", *texts, "", head, *rows, ""])


def _tables(model: type[BaseModel], place: str, seen: set[type[BaseModel]]) -> str:
    """A table of the keys of a model, and below it those of the models within that are not `seen` yet."""
    rows, below = [], []
    seen.add(model)
    for name, field in model.model_fields.items():
        key = f"{place}{field.alias or name}"
        kinds = [k for k in _kinds(field.annotation, field.metadata) if k is not type(None)]
        inner = [k for k in kinds if isinstance(k, type) and issubclass(k, BaseModel)]
        inside = f"{key}.NAME." if name == "materials" else f"{key}."
        below += [_tables(k, inside, seen) for k in inner if k not in seen]
        said = ", ".join(dict.fromkeys(_said(k) for k in kinds if k not in inner))
        known = isinstance(field.default, str | int | float)
        default = "required" if field.is_required() else f"`{field.default}`" if known else ""
        if said:
            rows.append(f"| `{key}` | {_cell(said)} | {default} |")
    head = f"{_cell((model.__doc__ or '').strip())}\n\n| key | what | default |\n|---|---|---|\n" if rows else ""
    return head + "\n".join(rows) + "\n\n" + "\n".join(below)


def _kinds(kind: Any, metadata: Any = ()) -> list[Any]:
    """What a field can be: quantities, plain types, choices and models."""
    if found := [m for m in metadata if isinstance(m, Quantity)]:
        return found
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return _kinds(arguments[0], arguments[1:])
    if origin in (Union, types.UnionType):
        return [k for part in arguments for k in _kinds(part)]
    if origin in (list, dict, tuple):
        return [k for part in arguments[-1:] for k in _kinds(part)]
    return [kind]


def _said(kind: Any) -> str:
    if isinstance(kind, Quantity):
        unit = "a number" if kind.si == "1" else f"[{kind.si}]"
        low = f"> {kind.above:g}" if kind.above > -inf else f">= {kind.ge:g}" if kind.ge > -inf else ""
        high = f"<= {kind.le:g}" if kind.le < inf else ""
        return ", ".join(filter(None, (unit, low, high)))
    if get_origin(kind) is Literal:
        return ", ".join(f"`{value}`" for value in get_args(kind))
    return {str: "a text", int: "a whole number", float: "a number", bool: "true or false", Path: "a file"}.get(
        kind, ""
    )


def _signature(thing: Any) -> str:
    array = "numpy.ndarray[tuple[typing.Any, ...], numpy.dtype[numpy.float64]]"
    return str(inspect.signature(thing)).replace("epdem.", "").replace(array, "Array").replace("float | Array", "Real")


def main() -> None:
    """Write the pages, and build the site; a warning of mkdocs is an error."""
    from latex2mathml.converter import convert

    shutil.rmtree(PAGES.parent, ignore_errors=True)
    PAGES.mkdir(parents=True)
    for page in (ROOT / "docs").glob("*.md"):
        text = OUTSIDE.sub(r"\1 (`\2`)", page.read_text(encoding="utf-8"))
        text = re.sub(r"\]\(\w+\.ipynb\)", "](#)", mathematics(languages(text), convert))
        (PAGES / page.name).write_text(text, encoding="utf-8")
    for folder in ("figures", "data"):
        shutil.copytree(ROOT / "docs" / folder, PAGES / folder)
    (PAGES / "reference_commands.md").write_text(commands(), encoding="utf-8")
    (PAGES / "reference_cases.md").write_text(cases(), encoding="utf-8")
    (PAGES / "reference_python.md").write_text(python(), encoding="utf-8")
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "-f", str(ROOT / "docs/mkdocs.yml")]
    sys.exit(subprocess.run(words, env=os.environ | {"NO_MKDOCS_2_WARNING": "1"}).returncode)


if __name__ == "__main__":
    main()
