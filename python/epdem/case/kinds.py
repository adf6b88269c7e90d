# SPDX-License-Identifier: GPL-2.0-or-later
"""Kinds of scenes: files with keys, their units and limits at the head, and below them the TOML of a scene of parts.

The kinds of epdem are in templates/kinds; a case names a kind of the user by its path ("./mill.toml.j2").
"""

import math
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Annotated, Any, ClassVar

import jinja2
from jinja2.sandbox import SandboxedEnvironment
from pydantic import Field, ValidationError, ValidationInfo, create_model, model_validator
from pydantic_core import PydanticKnownError

from ..base import paths
from ..base.rendering import OPTIONS, number
from ..errors import CaseError
from .fields import Frozen, Name, Quantity
from .messages import explain
from .parts import Measure, Parts
from .sizes import Count, Mixture, Particles, refuse_shares
from .toml import KIND, text_of

BODY = "[scene]"  # the line at which the TOML of parts begins
MOST = 32  # values of a key that is a list
TYPES: dict[str, Any] = {"particles": Mixture, "count": Count, "material": Name, "bool": bool}


class Keys(Frozen):
    """The keys of a kind; `body`: template of the parts."""

    body: ClassVar[str]
    heads: ClassVar[dict[str, dict[str, Any]]]
    kind: str
    measure: list[Measure] = Field(default_factory=list, max_length=64)

    def of_type(self, wanted: str) -> dict[str, Any]:
        """The given values of the keys of a type."""
        names = [name for name, head in self.heads.items() if head.get("type") == wanted]
        return {name: value for name in names if (value := getattr(self, name)) is not None}

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


@cache
def keys_of(path: Path, text: str) -> type[Keys]:
    """The model of the keys of a kind, from the text of its file. Raises ValueError for an invalid head."""
    head, line, below = text.partition(f"\n{BODY}\n")
    try:
        heads = tomllib.loads(head)["keys"]
        fields: dict[str, Any] = {name: _annotation(key) for name, key in heads.items()}
    except (tomllib.TOMLDecodeError, KeyError, TypeError) as error:
        raise ValueError(f"{path}: [keys] at the head has a mistake: {error}") from None
    said = head.partition("\n")[0].removeprefix("# ")
    model = create_model(path.name.removesuffix(KIND), __base__=Keys, __doc__=said, **fields)
    model.body, model.heads = line + below, heads
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


def _refuse(text: str) -> None:
    raise CaseError(text if text.startswith("scene.") else f"scene: {text}")


FUNCTIONS: dict[str, Callable[..., Any]] = {
    "refuse": _refuse,
    "rounded": lambda x: float(f"{x:.10g}"),
    **{name: getattr(math, name) for name in ("pi", "tan", "sqrt", "hypot")},
}


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


@cache  # compiling takes far longer than filling
def _template(body: str) -> jinja2.Template:
    env = SandboxedEnvironment(**OPTIONS, finalize=_as_toml)  # a kind may come from other people
    env.globals.update(FUNCTIONS)
    return env.from_string(body)


def parts(keys: Keys | Parts, output: object) -> Parts:
    """The scene of parts that the keys of a kind make, with the tables of `output`. Raises CaseError for values that do
    not fit together."""
    if isinstance(keys, Parts):
        return keys
    mixtures = {key: _Mixture(key, found) for key, found in keys.of_type("particles").items()}
    largest = {key: max(p.radii()[1] for p in mixture) for key, mixture in mixtures.items()}
    values = {name: getattr(keys, name) for name in keys.heads} | mixtures
    place = f"scene of kind {keys.kind!r}"
    try:
        text = _template(keys.body).render(values, largest=largest, output=output)
        scene = tomllib.loads(text)["scene"]
    except (jinja2.TemplateError, tomllib.TOMLDecodeError, TypeError, ArithmeticError) as error:
        raise CaseError(f"{place}: {error}") from None
    for fill in scene.get("fill", []):
        if isinstance(fill.get("particles"), str):
            fill["particles"] = list(mixtures[fill["particles"]])
    try:
        return Parts.model_validate({"kind": "parts", **scene, "measure": [*scene.get("measure", []), *keys.measure]})
    except ValidationError as error:
        raise CaseError(explain(place, scene, error, "scene")) from None
