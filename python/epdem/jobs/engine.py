# SPDX-License-Identifier: GPL-2.0-or-later
"""The interface of an engine: a job goes in, a result comes out."""

import shutil
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Any, Protocol, TypeVar

from ..base.files import write_texts
from ..errors import CaseError, EngineError
from ..laws.strengths import find_law


class Feature(StrEnum):
    """A named ability of an engine; other code never tests the name of the engine."""

    ADHESION = "adhesion"  # laws with adhesion
    DASHPOT = "dashpot"  # [viscous] of a case of impacts
    FRICTION = "friction"  # oblique impacts on walls
    SPHERE_FRICTION = "friction of two spheres"  # oblique impacts of two spheres
    TANGENTIAL_DASHPOT = "tangential dashpot"  # contact.tangential_restitution of oblique impacts
    DECK = "deck"  # the engine reads a deck, which runs without epdem
    POSITIONS = "positions"  # an overlap is a difference of positions
    RESTART = "restart"  # an interrupted scene continues from a restart file


Report = Callable[[int], None]  # takes the step that a run has reached
Job = TypeVar("Job", contravariant=True)
Result = TypeVar("Result", covariant=True)


def silent(step: int) -> None:
    """Report nothing."""


class Tool(Protocol):
    """An engine of any kind: its laws, its features, and whether it can run here."""

    name: str
    laws: tuple[str, ...] | None  # the laws of epdem that the engine has; None: every one
    features: frozenset[Feature]

    def missing(self) -> str | None:
        """None if the engine can run here, else a sentence with the command that installs it."""


class Engine(Tool, Protocol[Job, Result]):
    """One way to run a job: the plan of impacts gives a trajectory, the plan of a scene gives tables."""

    ranks: int  # the largest number on this machine

    @property
    def mpirun(self) -> str:
        """The program that starts several ranks."""

    @property
    def mpi_package(self) -> str:
        """The step that installs `mpirun`."""
        return ""

    def version(self) -> str:
        """One line: the version of the engine and of epdem's part in it."""

    def parts(self) -> list[Path]:
        """The compiled parts of epdem that the engine loads."""

    def check(self, job: Job) -> list[str]:
        """Sentences on what the engine leaves out or replaces. Raises CaseError for a job that it cannot run."""

    def files(self, job: Job) -> dict[str, str]:
        """The texts of the deck and its data files by their paths, the deck first.

        Raises CaseError for a job that the engine cannot run.
        """

    def put(self, files: dict[str, str], folder: Path) -> list[Path]:
        """Write the files of a deck into `folder`, where they run without epdem; their paths."""
        return write_texts(folder, files)

    def write(self, job: Job, folder: Path) -> list[Path]:
        """Write the deck of a job into `folder`; the paths of its files. Raises CaseError."""
        return self.put(self.files(job), folder)

    def run(self, job: Job, folder: Path, *, ranks: int = 1, report: Report = silent) -> Result:
        """Run the deck that is in `folder`. Raises EngineError with the end of the engine's log."""


KINDS: dict[type, dict[str, Any]] = {}  # the engines of each type of job by name; the room `engines` fills it


class Unsupported(CaseError):
    """A job that an engine does not have as it is. advice: the next step beside another engine; "": none."""

    def __init__(self, reason: str, advice: str = ""):
        super().__init__(f"{reason}; {advice}" if advice else reason)
        self.advice = advice


def check(tool: Engine[Job, Any], job: Job) -> list[str]:
    """Sentences on what `tool` leaves out or replaces. Raises CaseError, which names the engines that take the job."""
    try:
        return tool.check(job)
    except Unsupported as error:
        raise refusal(tool, job, str(error), advice=error.advice) from None


def refusal(
    tool: Engine[Job, Any],
    job: Job,
    reason: str,
    *,
    advice: str = "",
    fits: Callable[[frozenset[Feature]], bool] = lambda features: True,
) -> CaseError:
    """The error of a job that `tool` does not run: its reason, and the other engines that take the job as it is.

    advice: what `reason` ends with. fits: of the features of another engine.
    """
    others = [kind() for name, kind in KINDS.get(type(job), {}).items() if name != tool.name]
    names = [other.name for other in others if fits(other.features) and _takes(other, job)]
    if not names:
        return CaseError(reason if advice else f"{reason}; no engine has it")
    return CaseError(f"{reason}{' or' if advice else ';'} use --engine {' or '.join(names)}")


def _takes(tool: Engine[Job, Any], job: Job) -> bool:
    try:
        tool.check(job)
    except CaseError:
        return False
    return True


def require(*tools: Tool) -> None:
    """Raise EngineError for the first of `tools` that cannot run here."""
    for tool in tools:
        if reason := tool.missing():
            raise EngineError(f"engine {tool.name}: {reason}")


def has_law(tool: Tool, law: str) -> bool:
    """Whether an engine has a law of epdem."""
    named = tool.laws is None or law in tool.laws
    return named and (Feature.ADHESION in tool.features or not find_law(law).adheres)


def check_law(tool: Tool, law: str) -> None:
    """Raise Unsupported for a law that an engine does not have."""
    if not has_law(tool, law):
        known = "no law with adhesion" if tool.laws is None else f"{', '.join(tool.laws)} only"
        raise Unsupported(f"law.name = {law!r}: engine {tool.name} has {known}")


def refuse_ranks(tool: Engine[Any, Any], ranks: int) -> None:
    """Raise CaseError for a number of ranks that an engine does not have, EngineError without its `mpirun`."""
    if ranks < 1:
        raise CaseError(f"--ranks {ranks}: must be at least 1; leave it out for one rank")
    if ranks > tool.ranks:
        limit = "one rank; leave it out" if tool.ranks == 1 else f"at most {tool.ranks} ranks here; ask for no more"
        raise CaseError(f"--ranks {ranks}: engine {tool.name} runs on {limit}")
    if ranks > 1 and shutil.which(tool.mpirun) is None:
        raise EngineError(f"--ranks needs {tool.mpirun}, which was not found; {tool.mpi_package}")
