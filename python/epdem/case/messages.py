# SPDX-License-Identifier: GPL-2.0-or-later
"""The first mistake of a case file as one sentence: place, value, limit, next step."""

import copy
import difflib
import functools
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ..errors import CaseError

PART_NAME = r"^[A-Za-z][A-Za-z0-9_]{0,31}$"
LONGEST = 80  # characters of a value that a message shows
TEXTS = {
    "extra_forbidden": "unknown key",
    "missing": "is missing; add it",
    "string_pattern_mismatch": "must be 1 to 64 of the characters a-z, A-Z, 0-9, - and _, the first of them not -",
    "string_type": "must be a text in quotes",
    "int_type": "must be a whole number",
    "float_type": "must be a number",
    "bool_type": "must be true or false",
    "list_type": "must be a list; write it in [ ]",
    "dict_type": "must be a table of keys and values",
    "path_type": "must be the path of a file or folder",
    "too_long": "has {actual_length} values, must have at most {max_length}",
    "less_than_equal": "must be at most {le}",
    "greater_than_equal": "must be at least {ge}",
    "literal_error": "must be {expected}",
}
OTHER_KIND = {
    "impact": "is a bulk scene ([scene]) and this needs impacts ([impact]); "
    "run, deck, cite, view, soften, sweep and calibrate --target take scenes",
    "scene": "is a case of impacts ([impact]) and this needs a bulk scene ([scene])",
}


def shorten(text: str) -> str:
    """The text, cut at LONGEST characters."""
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def cut_quotes(text: str) -> str:
    """The text with each of its quoted parts cut at LONGEST characters."""
    most = LONGEST - 3
    return re.sub(rf"'([^']{{{most}}})[^']{{4,}}'", r"'\1...'", text)


def shown_key(key: object) -> str:
    """A key as messages show it: in quotes where it is no plain word."""
    return str(key) if re.fullmatch(r"[\w-]{1,80}", str(key), re.ASCII) else shorten(repr(key))


def _place(data: Any, problem: Any) -> tuple[tuple[Any, ...], Any]:
    """(keys, value) of a problem in TOML data; names of types, which pydantic puts among the keys, are left out."""
    keys = []
    for n, key in enumerate(problem["loc"]):
        if (isinstance(data, dict) and key in data) or (isinstance(data, list) and isinstance(key, int)):
            keys.append(key)
            data = data[key]
        elif problem["type"] == "missing" and n == len(problem["loc"]) - 1:
            return (*keys, key), None
    return tuple(keys), data


def nearest(key: str, names: Iterable[str]) -> str:
    """The nearest names to a key that does not exist, as text: by spelling, and those with the same last word."""
    names = list(names)
    last = [name for name in names if name.split(".")[-1] == key.split(".")[-1]]
    return ", ".join(list(dict.fromkeys([*difflib.get_close_matches(key, names, n=1, cutoff=0.0), *last]))[:4])


def text_of_problem(problem: Any) -> str:
    """What a value must be, for one of the errors that pydantic reports."""
    if problem.get("ctx", {}).get("pattern") == PART_NAME:
        return "must be 1 to 32 of the characters a-z, A-Z, 0-9 and _, the first of them a letter"
    text = TEXTS.get(problem["type"])
    return text.format(**problem.get("ctx", {})) if text else str(problem["msg"])


def _real_key(place: str, data: dict[str, Any], kind: str, other: str, path: object) -> str:
    """What to write in place of an unknown key of a case of one `kind`, "impact" or "scene", and not the `other`."""
    from .keys import keys_of  # it has the models, which have messages
    from .toml import with_whole_paths

    if kind not in data:  # the parts of a kind
        return "; remove it or correct its spelling"
    try:
        data = with_whole_paths(copy.deepcopy(data), Path(str(path)).parent)
        here, there = ([*keys_of(data, scene=scene == "scene")] for scene in (kind, other))
    except CaseError:  # of a file that is not there
        return "; remove it or correct its spelling"
    if any(f"{name}.".startswith(f"{place}.") for name in there):
        return f" of {'an impact' if kind == 'impact' else 'a scene'}; it belongs to {other}s"
    return f"; the nearest: {nearest(place, here)}"


def explain(path: object, data: dict[str, Any], error: ValidationError, kind: str) -> str:
    """The sentence about `error` in `data`, which `path` holds; `kind`: the expected table, "impact" or "scene"."""
    other = "scene" if kind == "impact" else "impact"
    if kind not in data and other in data:
        return f"{path} {OTHER_KIND[kind]}"
    if kind in data and other in data:
        return f"{path}: both [impact] and [scene] are given; keep one"
    problems = error.errors()
    problem = next((p for p in problems if p["type"] == "extra_forbidden"), problems[0])  # a misspelt key first
    keys, value = _place(data, problem)
    context = problem.get("ctx", {})
    if problem["type"].startswith("union_tag"):
        keys, value = (*keys, "kind"), value.get("kind") if isinstance(value, dict) else None
    place = ".".join(map(shown_key, keys))
    if problem["type"].startswith("union_tag"):
        known = context.get("expected_tags")
        text = f"must be one of {known}" if known else "is missing; add it"
    elif problem["type"] == "too_short":
        least, given = context["min_length"], context["actual_length"]
        text = f"has {given} values, must have at least {least}" if given else "is empty; give at least one value"
    elif problem["type"] in ("model_type", "model_attributes_type", "dict_type"):
        text = f"must be a table; write [{place}] and its keys below"
    elif problem["type"] == "extra_forbidden":
        text = f"unknown key{_real_key(place, data, kind, other, path)}"
    else:
        text = text_of_problem(problem)
        table = functools.reduce(lambda part, key: part[key], keys[:-1], data) if problem["type"] == "missing" else {}
        if near := difflib.get_close_matches(str(keys[-1]), map(str, table), n=1, cutoff=0.8) if table else []:
            text = f"{text}, or correct the spelling of {near[0]}"
    text = cut_quotes(text.removeprefix("Value error, "))
    shown = "" if value is None or isinstance(value, dict | list) else f" = {shorten(repr(value))}"
    if shown:
        return f"{path}: {place}{shown}, {text}"
    link = " " if text.startswith(("is ", "has ", "must ")) else ": "
    return f"{path}: {place}{link if place else ''}{text}"
