# SPDX-License-Identifier: GPL-2.0-or-later
"""Arguments of the Python interface: pydantic checks them, and a wrong one is one sentence with its value and type."""

import inspect
import re
import reprlib
from collections.abc import Callable
from functools import wraps
from typing import Annotated, Any, ParamSpec, TypeVar

import numpy as np
from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError

from ..case.messages import text_of_problem
from ..errors import CaseError, EpdemError
from ..studies.sweep.points import MOST

Given = ParamSpec("Given")
Result = TypeVar("Result")
PLURALS = {"set": "settings"}  # and names with an s

Names = Annotated[list[str], BeforeValidator(lambda given: [given] if isinstance(given, str) else given)]
Many = Annotated[list[Any], BeforeValidator(lambda given: [given] if np.ndim(given) == 0 else list(given))]
Table = dict[str, Any]
# numpy's integers have `item`, which gives Python's
_Whole = Annotated[int, BeforeValidator(lambda given: given.item() if hasattr(given, "item") else given)]
Ranks = Annotated[_Whole, Field(ge=1, le=1024, strict=True)]
Count = Annotated[_Whole, Field(ge=1, le=MOST, strict=True)]
Seed = Annotated[_Whole, Field(ge=0, lt=2**63, strict=True)]


def names_arguments(function: Callable[Given, Result]) -> Callable[Given, Result]:
    """`function` with errors that name its arguments where the sentences of the commands name options."""
    known = inspect.signature(function).parameters
    rest = any(p.kind is p.VAR_KEYWORD for p in known.values())

    def argument(option: re.Match[str]) -> str:
        name = option[1].replace("-", "_")
        candidates = [c for c in (name, f"{name}s", PLURALS.get(name, name)) if c in known]
        return candidates[0] if candidates else name if rest else str(option[0])

    @wraps(function)
    def call(*args: Given.args, **kwargs: Given.kwargs) -> Result:
        try:
            return function(*args, **kwargs)
        except EpdemError as error:
            said = re.sub(r"(?<![\w-])--([a-z][a-z-]*)", argument, str(error))
            raise type(error)(said) from error.__cause__

    return call


def take(name: str, given: object, kind: Any) -> Any:
    """An argument as a value of its kind. Raises CaseError."""
    try:
        return TypeAdapter(kind).validate_python(given)
    except ValidationError as error:
        problem = error.errors()[0]
        raise type_error(name, problem["input"], text_of_problem(problem)) from None


def type_error(name: str, given: object, wanted: str) -> CaseError:
    """The error for an argument that is no such value."""
    return CaseError(f"{name} = {reprlib.repr(given)}: of type {type(given).__name__}; {wanted}")
