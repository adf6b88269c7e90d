# SPDX-License-Identifier: GPL-2.0-or-later
"""A case file with [scene]: units in, frozen SI values out. Every mistake is a CaseError that names its place."""

from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, PlainValidator, model_validator

from .fields import Coefficient, Frozen, Length, Name, Quantity, Restitution, Speed, Tangential, Viscous
from .kinds import Keys, parts, read_scene
from .law import AnyCase, LawChoice, check_law
from .outputs import MeasuredDensities
from .parts import Parts
from .places import PartName
from .sizes import Share
from .toml import KIND, read_toml
from .walls import Time


class Rolling(Frozen):
    """A rolling friction model of LIGGGHTS with its numbers."""

    model: Literal["cdt", "epsd", "epsd2"] = "epsd2"
    coefficient: Annotated[float, Quantity("1", above=0.0)]
    damping: Annotated[float, Quantity("1", ge=0.0)] | None = None  # epsd only: share of the critical one

    @model_validator(mode="after")
    def _damping(self) -> Self:
        if (self.damping is not None) != (self.model == "epsd"):
            raise ValueError("'damping' belongs to model = 'epsd' and only to it")
        return self


class Between(Frozen):
    """Values of one pair of materials that differ from the common ones; "wall" names the walls.

    restitution: of elastic impacts, in place of the restitution in [viscous].
    """

    between: Annotated[list[Name], Field(min_length=2, max_length=2)]
    friction: Coefficient | None = None
    restitution: Restitution | None = None

    @model_validator(mode="after")
    def _some(self) -> Self:
        if self.friction is None and self.restitution is None:
            raise ValueError("give friction, restitution or both, or remove the pair")
        return self


class Contact(Frozen):
    """Parts of a contact beside its normal law; parts that are left out are not compiled into the loop."""

    friction: Coefficient = 0.0
    wall_friction: Coefficient | None = None
    pairs: list[Between] = Field(default_factory=list)
    tangential: Tangential = "history"
    tangential_restitution: Share | None = None  # of the dashpot beside the tangential spring
    rolling: Rolling | None = None
    cohesion: Annotated[float, Quantity("J/m^3", above=0.0)] | None = None  # energy density (sjkr)
    bond_strength: Annotated[float, Quantity("Pa", above=0.0)] | None = None  # of spheres that have dented each other
    heat_share: Share = 0.9  # of the plastic and frictional work, which becomes heat in a scene with temperatures


class Output(Frozen):
    """Output of a scene. Zero or false: none, and the deck has no line for it."""

    rows: Annotated[int, Field(ge=1, le=100_000)] = 100
    particles: Annotated[int, Field(ge=0, le=10_000)] = 1
    contacts: Annotated[int, Field(ge=0, le=10_000)] = 0
    energy: bool = False  # the energy balance: particles and contacts of the same steps, plastic work of every contact
    loads: bool = False  # forces on the walls
    pictures: Annotated[int, Field(ge=0, le=10_000)] = 0
    restarts: Annotated[int, Field(ge=0, le=1000)] = 0
    color: PartName = "speed"  # of the spheres in bed.png: a column of the frames, speed or energy

    @model_validator(mode="after")
    def _ledger_frames(self) -> Self:
        if self.energy and not self.particles:
            raise ValueError("energy: the energy balance is taken from the frames; give output.particles")
        if self.energy and self.contacts and self.contacts != self.particles:
            raise ValueError("the energy balance needs particles and contacts at the same steps; give the same number")
        return self


class SceneNumerics(Frozen):
    """`error`: limit of the error of e_n at speeds up to `highest_speed` (default: the highest of the scene).

    skin: by how much neighbour lists reach farther than contacts [m]. processors: axes along which ranks divide the
    room. balance: steps after which the borders of ranks move so that all have as many spheres. sort_interval: steps
    after which the next search sorts the spheres in memory by their positions.
    None of them changes results beyond round-off (docs/speed.md).
    """

    error: Annotated[float, Field(ge=1e-9, le=0.1)] = 1e-3
    highest_speed: Speed | None = None
    time_step: Time | None = None
    skin: Length | None = None
    processors: Literal["x", "y", "z", "xy", "xz", "yz", "xyz"] | None = None
    balance: Annotated[int, Field(ge=1)] | None = None
    sort_interval: Annotated[int, Field(ge=1)] | None = None
    seed: Annotated[int, Field(ge=1, le=1000)] = 1


class SceneCase(AnyCase):
    """One bulk scene."""

    law: LawChoice
    scene: Annotated[Keys | Parts, PlainValidator(read_scene)]
    viscous: Viscous | None = None
    contact: Contact = Contact()
    output: Output = Output()
    numerics: SceneNumerics = SceneNumerics()
    measured: MeasuredDensities | None = None

    @model_validator(mode="after")
    def _names(self) -> Self:
        for place, name in self.scene.named_materials:
            if name not in self.materials:
                raise ValueError(f"{place} = {name!r} is not defined; add [materials.{name}]")
        tangential = self.contact.tangential_restitution
        if self.viscous and tangential not in (None, self.viscous.restitution):
            raise ValueError(
                f"contact.tangential_restitution = {tangential:g}: LIGGGHTS has one restitution for both dashpots; "
                f"give {self.viscous.restitution:g} as in viscous, or remove it (then no tangential dashpot)"
            )
        for pair in self.contact.pairs:
            for name in pair.between:
                if name not in self.materials and name != "wall":
                    raise ValueError(f"contact.pairs: {name!r} is neither a material nor 'wall'")
            if pair.restitution is not None and self.viscous is None:
                raise ValueError("contact.pairs.restitution: there is no dashpot; add [viscous], for all other pairs")
        check_law(self.law, self.materials)
        for place, name in self.parts.named_materials:  # values that do not fit together are refused here
            if name not in self.materials:
                raise ValueError(f"{place} = {name!r} is not defined; name a key of the kind or add [materials.{name}]")
        return self

    @property
    def kind(self) -> str:
        """The name of the kind of scene."""
        return Path(self.scene.kind).name.removesuffix(KIND)

    @cached_property
    def parts(self) -> Parts:
        """The scene as a scene of parts. Raises CaseError for values that do not fit together."""
        return parts(self.scene, self.output)


def is_scene(data: dict[str, Any]) -> bool:
    """Whether TOML data describe a bulk scene."""
    return "scene" in data


def parse(data: dict[str, Any], path: object = "case") -> SceneCase:
    """A scene from TOML data; `path` names the place in messages. Raises CaseError."""
    return SceneCase.read(data, path, "scene")


def load(path: Path | str) -> SceneCase:
    """The scene in a file. Raises CaseError."""
    return parse(read_toml(path), path)
