# SPDX-License-Identifier: GPL-2.0-or-later
"""Kinds of scenes: files with keys, their units and limits at the head, and below them the TOML of a scene of parts.

The kinds of epdem are in templates/kinds; a case names a kind of the user by its path ("./mill.toml.j2").
"""

import math
import re
import tomllib
import traceback
from collections.abc import Callable
from functools import cache
from operator import mul
from pathlib import Path
from typing import Annotated, Any, ClassVar

import jinja2
from jinja2.sandbox import SandboxedEnvironment
from pydantic import (
    Field,
    PydanticUserError,
    TypeAdapter,
    ValidationError,
    ValidationInfo,
    create_model,
    model_validator,
)
from pydantic_core import PydanticKnownError, SchemaError

from ..base import paths
from ..base.rendering import OPTIONS, number
from ..errors import CaseError
from .fields import Frozen, Name, Quantity, Temperature
from .messages import explain
from .parts import Measure, Parts
from .sizes import Count, Mixture, Particles, refuse_shares
from .toml import KIND, text_of
from .units import refuse_unit

BODY = "[scene]"  # the line at which the TOML of parts begins
MOST = 32  # values of a key that is a list
LARGEST = 1_000_000  # values of a list or characters of a text that a template makes, digits of a number
MARK = "# line "  # of the kind's file, at the end of a line of a filled template
PREFIX = "key_"  # of the attributes of keys, so that a kind may give a key any name
HEAD = {"unit", "type", "above", "ge", "le", "values", "list", "default", "optional"}
TYPES: dict[str, Any] = {"particles": Mixture, "count": Count, "material": Name, "bool": bool}


class Keys(Frozen):
    """The keys of a kind, keys["count"]; `body`: template of the parts, below line `above` of its file.

    temperature: with which all spheres come; wall_temperature: of all walls. Every kind has them.
    """

    body: ClassVar[str]
    above: ClassVar[int]
    heads: ClassVar[dict[str, dict[str, Any]]]
    kind: str
    measure: list[Measure] = Field(default_factory=list, max_length=64)
    temperature: Temperature | None = None
    wall_temperature: Temperature | None = None

    def __getitem__(self, name: str) -> Any:
        if name not in self.heads:
            raise KeyError(name)
        return getattr(self, PREFIX + name)

    def of_type(self, wanted: str) -> dict[str, Any]:
        """The given values of the keys of a type."""
        names = [name for name, head in self.heads.items() if head.get("type") == wanted]
        return {name: value for name in names if (value := self[name]) is not None}

    @model_validator(mode="after")
    def _shares(self) -> "Keys":
        for mixture in self.of_type("particles").values():
            refuse_shares(mixture)
        return self

    @property
    def named_materials(self) -> list[tuple[str, str]]:
        """(place, material) of every name of a material."""
        found = [(f"scene.{key}", name) for key, name in self.of_type("material").items()]
        mixtures = self.of_type("particles").items()
        return [*found, *((f"scene.{key}.material", p.material) for key, mixture in mixtures for p in mixture)]


class _Mixture(list[Particles]):
    """A mixture with the name of its key, for which the TOML of parts holds the name alone."""

    def __init__(self, key: str, particles: list[Particles]):
        super().__init__(particles)
        self.key = key


def names() -> list[str]:
    """The names of the kinds of epdem, and of a scene of parts."""
    files = (paths.beside("templates") / "kinds").glob(f"*{KIND}")
    return [*sorted(path.name.removesuffix(KIND) for path in files), "parts"]


def _annotation(head: dict[str, Any]) -> tuple[Any, Any]:
    """(type, default) of a key for pydantic."""
    limits = {name: head[name] for name in ("above", "ge", "le") if name in head}
    found: Any = TYPES[head["type"]] if "type" in head else Annotated[float, Quantity(head["unit"], **limits)]
    if "values" in head:
        found = Annotated[list[found], Field(min_length=head["values"], max_length=head["values"])]
    if head.get("list"):
        found = Annotated[list[found], Field(min_length=1, max_length=MOST)]
    if head.get("optional"):
        return found | None, None
    return found, head.get("default", ...)


def _refuse(text: str) -> None:
    raise CaseError(text if text.startswith("scene.") else f"scene: {text}")


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "refuse": _refuse,
    "rounded": lambda x: float(f"{x:.10g}"),
    **{name: getattr(math, name) for name in ("pi", "tan", "sqrt", "hypot")},
}


def _mistake(path: Path, text: str, key: str, problem: object) -> CaseError:
    line = next((n for n, x in enumerate(text.split("\n"), 1) if re.match(rf"[\s\"']*{re.escape(key)}\b", x)), 1)
    return CaseError(f"{path}, line {line}: [keys] {key}: {problem}")


def _refuse_head(name: str, head: Any, *, own: bool) -> None:
    """Raise ValueError for the head of a key that has no meaning; `own`: of a user."""
    if not name.isidentifier() or name in {*FUNCTIONS, "largest", "output", *Keys.model_fields}:
        raise ValueError("the name is taken or no name in a template; give the key another one")
    if not isinstance(head, dict) or ("unit" in head) == ("type" in head):
        raise ValueError('must be a table with one of unit and type, as { unit = "m" }')
    if unknown := sorted(head.keys() - HEAD):
        raise ValueError(f"{unknown[0]!r} is unknown; there are {', '.join(sorted(HEAD))}")
    if "type" in head and head["type"] not in [*TYPES]:
        raise ValueError(f"type = {head['type']!r}, must be one of {', '.join(TYPES)}")
    if own and "unit" in head and head["unit"] != "1":  # takes half a second
        refuse_unit(str(head["unit"]))


@cache
def keys_of(path: Path, text: str) -> type[Keys]:
    """The model of the keys of a kind, from the text of its file. Raises CaseError that names the line of a mistake."""
    head, line, below = text.partition(f"\n{BODY}\n")
    try:
        heads = tomllib.loads(head).get("keys")
    except tomllib.TOMLDecodeError as error:
        raise CaseError(f"{path}: the head is not valid TOML: {error}") from None
    if not line or not isinstance(heads, dict):
        raise CaseError(
            f"{path}: a kind has the line [keys], its keys, the line {BODY} and a template; add what is missing"
        )
    fields: dict[str, Any] = {}
    own = not path.is_relative_to(paths.beside("templates"))
    for name, key in heads.items():
        try:
            _refuse_head(name, key, own=own)
            kind, default = _annotation(key)
            fields[PREFIX + name] = (kind, Field(default, alias=name))
            TypeAdapter(kind)
        except (ValueError, TypeError, PydanticUserError, SchemaError) as error:
            raise _mistake(path, text, name, error) from None
    said = head.partition("\n")[0].removeprefix("# ")
    model = create_model(path.name.removesuffix(KIND), __base__=Keys, __doc__=said, **fields)
    model.body, model.above, model.heads = line + below, head.count("\n"), heads
    return model


def model_of(kind: object, folder: Path = Path()) -> type[Keys] | None:
    """The model of the keys of a kind by its name, or by its path from `folder`; None for an unknown kind."""
    if not isinstance(kind, str):
        return None
    if kind.endswith(KIND):
        path = folder / kind
    elif kind in names()[:-1]:
        path = paths.beside("templates") / "kinds" / f"{kind}{KIND}"
    else:
        return None
    return keys_of(path, text_of(path))


def read_scene(value: object, info: ValidationInfo) -> Keys | Parts:
    """The keys of a kind, or the scene of parts, from the table [scene] of a case."""
    if isinstance(value, Keys | Parts):
        return value
    if not isinstance(value, dict):
        raise PydanticKnownError("model_attributes_type")
    kind = value.get("kind")
    if kind is None:
        raise PydanticKnownError("union_tag_not_found", {"discriminator": "'kind'"})
    context: dict[str, Any] = info.context or {}
    if kind == "parts":
        return Parts.model_validate(value, context=context)
    model = model_of(kind, Path(context.get("folder", ".")))
    if model is None:
        tags = {"discriminator": "'kind'", "tag": str(kind), "expected_tags": ", ".join(map(repr, names()))}
        raise PydanticKnownError("union_tag_invalid", tags)
    return model.model_validate(value, context=context)


def _as_toml(value: Any) -> Any:
    """A value as text of TOML."""
    match value:
        case bool():
            return str(value).lower()
        case float():
            return number(value)
        case _Mixture():
            return f'"{value.key}"'
    return value


class _Sandbox(SandboxedEnvironment):
    """A kind may come from other people: what it makes is bounded, too."""

    intercepted_binops = frozenset(["*", "**"])

    def call_binop(self, context: Any, operator: str, left: Any, right: Any) -> Any:
        whole = isinstance(left, int) and isinstance(right, int)
        size = abs(right) * left.bit_length() if operator == "**" and whole else 0
        if operator == "*" and not whole:
            size = max((mul(len(x), n) for x, n in ((left, right), (right, left)) if hasattr(x, "__len__")), default=0)
        if size > LARGEST:
            raise ValueError(f"a list, text or number of more than {LARGEST} values, characters or digits")
        return super().call_binop(context, operator, left, right)


@cache
def _sandbox() -> _Sandbox:
    env = _Sandbox(**OPTIONS, finalize=_as_toml)
    env.globals.update(FUNCTIONS)
    return env


@cache  # compiling takes far longer than filling
def _template(body: str) -> jinja2.Template:
    return _sandbox().from_string(body)


def _numbered(body: str) -> str:
    """The template with the number of each of its lines as a comment at its end."""
    found = []
    for first, kind, text in _sandbox().lex(body):
        *lines, last = text.split("\n") if kind == "data" else [text]
        found += [f"{line} {MARK}{first + n}\n" for n, line in enumerate(lines)] + [last]
    return "".join(found)


def _line(text: str, said: str) -> str:
    """The mark of the line that gives the key with which a message begins ("wall.0.kind = ..."), or of the line where
    its part begins, in a filled template; a part goes by its number or name. "": there is none."""
    key = str(re.split(r"[^\w.]", said)[0])
    kind, which, *rest = f"{key}.".split(".")
    tables = re.split(r"^(?=\[)", text, flags=re.M)
    found = [table for table in tables if re.match(rf"\[+scene\.{kind}\]", table)]
    part = next((table for table in found if re.search(rf'^name = "{which}"', table, re.M)), "")
    part = part or (found[int(which)] if which.isdigit() and int(which) < len(found) else "")
    keys = [key for key in (reversed(rest) if part else [kind]) if key and not key.isdigit()]
    lines = [line for key in keys for line in re.findall(rf"^{key}\b.*", part or text, re.M)]
    return next(iter([*lines, *part.splitlines()]), "").rpartition(MARK)[2]


FAILURES = (jinja2.TemplateError, ValueError, TypeError, ArithmeticError, LookupError, AttributeError, MemoryError)


def _filled_in(keys: Keys, values: dict[str, Any], place: str, *, body: str = "") -> str:
    """The text of the parts by the template of a kind, or another `body` of the same lines.

    Raises CaseError that names the line of the kind's file.
    """
    try:
        return _template(body or keys.body).render(values)
    except CaseError:
        raise
    except (*FAILURES, RecursionError) as error:
        frames = [n for frame, n in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == "<template>"]
        line = error.lineno if isinstance(error, jinja2.TemplateSyntaxError) else frames[-1] if frames else 1
        said = str(error) or type(error).__name__
        raise CaseError(f"{place}, line {keys.above + line}: {said}") from None


def _tables(keys: Keys, values: dict[str, Any], place: str) -> dict[str, Any]:
    """The table [scene] of the template, filled in. Raises CaseError that shows the line and what it has there."""
    text = _filled_in(keys, values, place)
    try:
        scene = tomllib.loads(text)["scene"]
    except tomllib.TOMLDecodeError as error:
        at = re.search(r" \(at line (\d+), column (\d+)\)", str(error))
        if at is None:  # at the end of the text
            raise CaseError(f"{place}: {error}") from None
        row, column = int(at[1]) - 1, int(at[2]) - 1
        line = _filled_in(keys, values, place, body=_numbered(keys.body)).splitlines()[row].rpartition(MARK)[2]
        shown = text.splitlines()[row][max(column - 30, 0) : column + 20].strip()
        place = f"{place}, line {keys.above + int(line)}" if line else place
        raise CaseError(f"{place}: {str(error).replace(at[0], '')} near {shown!r}; a text has quotes") from None
    for name in ("fill", "measure", "wall", "body", "row"):
        if not (isinstance(x := scene.get(name, []), list) and all(isinstance(part, dict) for part in x)):
            raise CaseError(f"{place}: {name} must be a list of tables; write [[scene.{name}]]")
    assert isinstance(scene, dict)
    return scene


def _give_temperatures(keys: Keys, scene: dict[str, Any], places: dict[str, str]) -> None:
    """Gives spheres and walls the temperatures of the keys, and each wall that is always there a row of its heat."""
    wanted = {"fill": keys.temperature, "body": keys.temperature, "wall": keys.wall_temperature}
    for kind, T in wanted.items():
        for part in scene.get(kind, []):
            places[f"scene.{kind}.{part.get('name')}.temperature"] = f"scene.{'wall_' * (kind == 'wall')}temperature"
            if T is not None:
                part.setdefault("temperature", f"{number(T)} K")
    always = [w.get("name") for w in scene.get("wall", []) if "phases" not in w and keys.wall_temperature is not None]
    flows = [{"name": f"heat_{x}", "wall": x, "heat_flow": True, "title": f"heat flow into the {x}"} for x in always]
    if flows:
        scene["row"] = [*scene.get("row", []), *flows]


def _values(keys: Keys, output: object) -> dict[str, Any]:
    """What the template of a kind knows."""
    mixtures = {key: _Mixture(key, found) for key, found in keys.of_type("particles").items()}
    largest = {key: max(p.radii()[1] for p in mixture) for key, mixture in mixtures.items()}
    return {name: keys[name] for name in keys.heads} | mixtures | {"largest": largest, "output": output}


def in_file(keys: Keys | Parts, output: object, said: str) -> str:
    """A sentence on a key of the parts ("wall.0.kind = ..."), behind the kind and the line of its file."""
    if isinstance(keys, Parts):
        return f"scene: {said}"
    place = f"scene of kind {keys.kind!r}"
    line = _line(_filled_in(keys, _values(keys, output), place, body=_numbered(keys.body)), said)
    return f"{place}{f', line {keys.above + int(line)}' if line else ''}: {said}"


def parts(keys: Keys | Parts, output: object) -> Parts:
    """The scene of parts that the keys of a kind make, with the tables of `output`. Raises CaseError for values that do
    not fit together."""
    if isinstance(keys, Parts):
        return keys
    place, values = f"scene of kind {keys.kind!r}", _values(keys, output)
    scene = _tables(keys, values, place)
    mixtures = {key: mixture for key, mixture in values.items() if isinstance(mixture, _Mixture)}
    places: dict[str, str] = {}
    for fill in scene.get("fill", []):
        key = fill.get("particles")
        if isinstance(key, str):
            if key not in mixtures:
                known = ", ".join(mixtures) or "none"
                raise CaseError(f"{place}: fill.particles = {key!r} is no key of type particles; there are {known}")
            fill["particles"] = list(mixtures[key])
            places[f"scene.fill.{fill.get('name')}.particles"] = f"scene.{key}"
        amounts = [name for name, count in keys.of_type("count").items() if count == fill.get("count")]
        if len(amounts) == 1:
            places[f"scene.fill.{fill.get('name')}"] = f"scene.{amounts[0]}"
    _give_temperatures(keys, scene, places)
    given = scene.get("places")
    scene["places"] = places | given if isinstance(given, dict) else given or places
    try:
        return Parts.model_validate({"kind": "parts", **scene, "measure": [*scene.get("measure", []), *keys.measure]})
    except ValidationError as error:
        said = explain(place, scene, error, "scene").removeprefix(f"{place}: ")
        raise CaseError(in_file(keys, output, said)) from None
