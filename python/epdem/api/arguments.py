# SPDX-License-Identifier: GPL-2.0-or-later
"""Arguments of the Python interface: pydantic checks them, and a wrong one is one sentence with its value and type."""

import reprlib
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError

from ..case.messages import text_of_problem
from ..errors import CaseError
from ..studies.sweep.points import MOST

Names = Annotated[list[str], BeforeValidator(lambda given: [given] if isinstance(given, str) else given)]
Table = dict[str, Any]
# numpy's integers have `item`, which gives Python's
_Whole = Annotated[int, BeforeValidator(lambda given: given.item() if hasattr(given, "item") else given)]
Ranks = Annotated[_Whole, Field(ge=1, le=1024, strict=True)]
Count = Annotated[_Whole, Field(ge=1, le=MOST, strict=True)]
Seed = Annotated[_Whole, Field(ge=0, lt=2**63, strict=True)]


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
