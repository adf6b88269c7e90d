# SPDX-License-Identifier: GPL-2.0-or-later
"""Templates that others wrote: rendered from plain values, without Python, in a process with little time and memory."""

import dataclasses
import inspect
import multiprocessing
import os
import resource
import signal
import traceback
from collections.abc import Callable, Iterable, Mapping
from multiprocessing.connection import Connection
from pathlib import Path
from types import SimpleNamespace

import jinja2
import numpy as np
from jinja2 import meta
from jinja2.sandbox import ImmutableSandboxedEnvironment
from pydantic import BaseModel

from ..base import paths, rendering, stopping
from ..errors import CaseError

MOST_SOURCE, MOST_TEXT = 1_000_000, 20_000_000  # characters of a template, and of what it becomes
SECONDS, MEMORY = 2, 512_000_000  # of processor time; bytes beyond what the program itself has


class _TooLongError(Exception):
    def __str__(self) -> str:
        return f"becomes more than {MOST_TEXT} characters; does a loop end?"


class _TooSlowError(Exception):
    def __str__(self) -> str:
        return f"takes more than {SECONDS} s; does a loop end?"


class _OneFolder(jinja2.FileSystemLoader):
    """Templates of one folder; no link leads out of it."""

    def __init__(self, folder: Path):
        super().__init__(folder)
        self.folder = folder.resolve()

    def get_source(self, environment: jinja2.Environment, template: str) -> tuple[str, str, Callable[[], bool]]:
        path = (self.folder / template).resolve()
        if not path.is_relative_to(self.folder) or not path.is_file():
            raise jinja2.TemplateNotFound(template)
        if path.stat().st_size > MOST_SOURCE:
            raise CaseError(f"{template} has more than {MOST_SOURCE} bytes; a template is shorter")
        return super().get_source(environment, template)


def plain(value: object) -> object:
    """A value as numbers, texts, tuples, dicts and names with values alone: nothing of it can be called."""
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    for kind, numpy_kind in ((int, np.integer), (float, np.floating), (str, np.str_)):
        if isinstance(value, kind | numpy_kind):
            return kind(value)
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple | range | np.ndarray):
        return tuple(plain(v) for v in value)
    if isinstance(value, BaseModel):
        names = [*type(value).model_fields, *(value.model_extra or {})]
        return _names(value, names, [c for c in type(value).__mro__ if not issubclass(BaseModel, c)])
    if dataclasses.is_dataclass(value):
        return _names(value, [f.name for f in dataclasses.fields(value)], inspect.getmro(type(value)))
    return str(value)


def _names(value: object, names: list[str], classes: Iterable[type]) -> SimpleNamespace:
    properties = [n for c in classes for n, member in vars(c).items() if isinstance(member, property)]
    return SimpleNamespace(**{n: plain(getattr(value, n)) for n in [*names, *properties] if not n.startswith("_")})


def render(template: Path, values: Mapping[str, object]) -> tuple[str, set[str]]:
    """The text of a template, and the names of `values` which neither it nor a template that it includes uses.

    It has access to plain values, our templates and those of its own folder. Raises CaseError with file and line.
    """
    if not template.is_file():
        raise CaseError(f"{template}: there is no such file; name a template")
    reader, writer = multiprocessing.Pipe(duplex=False)
    child = multiprocessing.get_context("fork").Process(target=_work, args=(writer, template, values))
    with stopping.uninterrupted():
        child.start()
    writer.close()
    try:
        result = reader.recv()
    except EOFError:
        result = CaseError(f"{template}: needs more than {SECONDS} s or {MEMORY} bytes; does a loop end?")
    finally:
        child.kill()
        child.join()
    if isinstance(result, CaseError):
        raise result
    text, unused = result
    return text, unused


def _work(writer: Connection, template: Path, values: Mapping[str, object]) -> None:
    """The child: sends text and unused names, or a CaseError."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGXCPU, _too_slow)
    now = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[0]) * os.sysconf("SC_PAGE_SIZE")
    resource.setrlimit(resource.RLIMIT_AS, (now + MEMORY, now + MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    try:
        writer.send(_text(template, {name: plain(value) for name, value in values.items()}))
    except Exception as error:  # whatever a template of others does is its mistake
        writer.send(CaseError(_sentence(template, error)))


def _too_slow(number: int, frame: object) -> None:
    raise _TooSlowError


def _text(template: Path, values: dict[str, object]) -> tuple[str, set[str]]:
    folder = template.resolve().parent
    loader = jinja2.ChoiceLoader([_OneFolder(folder), jinja2.FileSystemLoader(paths.templates())])
    environment = rendering.prepared(ImmutableSandboxedEnvironment(loader=loader, **rendering.OPTIONS))
    name = template.resolve().name
    source = environment.loader.get_source(environment, name)[0] if environment.loader else ""
    parts = environment.get_template(name).generate(values)  # a mistake of syntax is found here, with its line
    tree = environment.parse(source, filename=str(template))
    taken_in = [n for n in meta.find_referenced_templates(tree) if n is None or not (paths.templates() / n).exists()]
    unused = set() if taken_in else set(values) - meta.find_undeclared_variables(tree)
    pieces: list[str] = []
    length = 0
    for part in parts:
        pieces.append(part)
        length += len(part)
        if length > MOST_TEXT:
            parts.throw(_TooLongError())  # type: ignore[attr-defined]  # a generator, with the line in its traceback
    return "".join(pieces), unused


def _sentence(template: Path, error: Exception) -> str:
    """FILE:LINE: what is wrong, as far as the line is known."""
    folder, place, line = template.resolve().parent, template, getattr(error, "lineno", None)
    if name := getattr(error, "filename", None):
        place = Path(name)
    for frame, number in traceback.walk_tb(error.__traceback__):
        path = Path(frame.f_code.co_filename)
        if (
            path.parent.is_relative_to(folder)
            and path.suffix == ".j2"
            and not isinstance(error, jinja2.TemplateSyntaxError)
        ):
            place, line = path, number
    place = template if place.resolve() == template.resolve() else place
    message = getattr(error, "message", None) or str(error) or type(error).__name__
    sentences = {
        jinja2.TemplateNotFound: f"{error} is not in {folder}, nor a template of ours",
        MemoryError: f"needs more than {MEMORY} bytes; does a loop end?",
        RecursionError: "calls itself without end",
    }
    what = next((text for kind, text in sentences.items() if isinstance(error, kind)), message)
    return f"{place}{f':{line}' if line else ''}: {' '.join(what.split())}"
