# SPDX-License-Identifier: GPL-2.0-or-later
"""A case file with [scene]: units in, frozen SI values out. Every mistake is a CaseError that names its place."""

from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, Field, ValidationError, model_validator

from ..errors import CaseError
from .fields import (
    Coefficient,
    Frozen,
    Header,
    LawChoice,
    Length,
    Material,
    Name,
    Quantity,
    Restitution,
    Speed,
    Tangential,
    Viscous,
)
from .library import with_library
from .measures import Measure
from .messages import explain
from .motions import Rate, Time
from .parts import Parts
from .sizes import Particles, Share, context
from .toml import named, read_toml
from .walls import PartName

Gravity = Annotated[float, Quantity("m/s^2", ge=0.0)]


class SceneMaterial(Material):
    """A material; keys beside the elastic ones are the law's parameters for it (yield_pressure = "3 GPa")."""

    model_config = ConfigDict(frozen=True, extra="allow", strict=True)


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

    restitution: of impacts that do not yield, in place of that of [viscous].
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


class Output(Frozen):
    """Output of a scene. Zero or false: none, and the deck has no line for it."""

    rows: Annotated[int, Field(ge=1, le=100_000)] = 100
    particles: Annotated[int, Field(ge=0, le=10_000)] = 1
    contacts: Annotated[int, Field(ge=0, le=10_000)] = 0
    energy: bool = False  # the energy balance: particles and contacts of the same steps, plastic work of every contact
    loads: bool = False  # forces on the walls
    vtk: Annotated[int, Field(ge=0, le=10_000)] = 0
    pictures: Annotated[int, Field(ge=0, le=10_000)] = 0
    restarts: Annotated[int, Field(ge=0, le=1000)] = 0
    color: PartName = "speed"  # of the spheres in bed.png: a column of the frames, speed or energy

    @model_validator(mode="after")
    def _ledger_frames(self) -> Self:
        if self.energy and self.contacts and self.contacts != self.particles:
            raise ValueError("the energy ledger needs particles and contacts at the same steps; give the same number")
        return self


class SceneNumerics(Frozen):
    """`error`: limit of the error of e_n at speeds up to `highest_speed` (default: the highest of the scene).

    skin: by how much neighbour lists reach farther than contacts [m]. cut: axes along which ranks divide the room.
    Neither changes results beyond round-off; `epdem tune` measures which are fastest.
    """

    error: Annotated[float, Field(ge=1e-9, le=0.1)] = 1e-3
    highest_speed: Speed | None = None
    time_step: Time | None = None
    skin: Length | None = None
    cut: Literal["x", "y", "z", "xy", "xz", "yz", "xyz"] | None = None
    seed: Annotated[int, Field(ge=1, le=1000)] = 1


class Common(Frozen):
    """The keys of every kind of scene."""

    particles: Annotated[list[Particles], Field(min_length=1, max_length=64)]
    count: Annotated[int, Field(ge=1, le=100_000_000)]
    walls: Name  # material of the walls
    gravity: Gravity = 9.81
    measure: list[Measure] = Field(default_factory=list, max_length=64)

    @model_validator(mode="after")
    def _shares(self) -> Self:
        total = sum(p.share for p in self.particles)
        if abs(total - 1.0) > 1e-9:
            raise ValueError(f"the shares of 'particles' add up to {total:g}, must be 1")
        return self

    @property
    def filled(self) -> list[Particles]:
        """Everything that is filled in, in the order in which it comes."""
        return self.particles

    @property
    def leading(self) -> Particles:
        """The spheres whose impacts on a wall stand for the scene."""
        return self.particles[0]

    @property
    def wall_materials(self) -> list[str]:
        """Every material of a wall, once."""
        return [self.walls]

    @property
    def named_materials(self) -> list[tuple[str, str]]:
        """(place, material) of every name of a material."""
        return [("scene.walls", self.walls), *(("scene.particles.material", p.material) for p in self.filled)]


class Settle(Common):
    """Spheres poured into a box (x, y, z inside) with its floor at z = 0."""

    kind: Literal["settle"]
    duration: Time
    box: Annotated[list[Length], Field(min_length=3, max_length=3)]
    periodic: bool = False  # in x and y, instead of side walls
    rate: Rate | None = None  # spheres per second; none: all at once


class Hopper(Common):
    """Discharge of a round bin with a conical hopper of triangles; `fill` is the time before the outlet opens."""

    kind: Literal["hopper"]
    duration: Time
    bin_diameter: Length
    bin_height: Length
    outlet: Length
    half_angle: Annotated[float, Quantity("rad", above=0.0, le=1.5707963267948966)]
    drop: Length  # from the outlet to the floor
    fill: Time


class Drum(Common):
    """A drum of triangles turning about y, with flat ends.

    It is round, so its surface moves and its triangles stay: the same to a sphere, without rebuilding lists, and a
    continued run meets the wall's velocity at its first step, which LIGGGHTS's move/mesh has only a step later.
    """

    kind: Literal["drum"]
    duration: Time
    diameter: Length
    length: Length
    turn: Annotated[float, Quantity("rad/s", above=0.0)]  # "20 rpm"


class Compaction(Common):
    """Uniaxial loading and unloading between plates; sides periodic. No `duration`: strokes and speed give it."""

    kind: Literal["compaction"]
    gravity: Gravity = 0.0
    duration: Time | None = None
    box: Annotated[list[Length], Field(min_length=3, max_length=3)]
    height: Length  # of the gap between the plates at the end of loading
    back: Length  # stroke of unloading
    fall: Time | None = None  # before loading: the spheres fall on the lower plate
    speed: Speed  # of the upper plate, loading
    back_speed: Speed | None = None  # unloading; default: a tenth, because it ends within a short stroke

    @property
    def release(self) -> float:
        """Speed of the upper plate while unloading [m/s]."""
        return self.back_speed or 0.1 * self.speed

    @model_validator(mode="after")
    def _order(self) -> Self:
        if not self.height < self.box[2]:
            raise ValueError(f"height ({self.height:g} m) must be below the box's height ({self.box[2]:g} m)")
        if self.fall is not None and not self.gravity:
            raise ValueError("spheres fall under gravity; give gravity, or remove fall")
        if self.duration is not None:
            raise ValueError("duration: loading and unloading follow from height, back and speed; remove it")
        return self


class Peening(Common):
    """A stream of shot along -z on a plate of the walls' material, or on a bed of spheres that lies on it."""

    kind: Literal["peening"]
    duration: Time
    gravity: Gravity = 0.0
    side: Length  # of the square that the stream hits
    speed: Speed
    rate: Rate  # spheres per second
    bed: list[Particles] = Field(default_factory=list)
    bed_count: Annotated[int, Field(ge=0, le=10_000_000)] = 0
    bed_fill: Time | None = None

    @property
    def filled(self) -> list[Particles]:
        """The bed comes first: as long as it alone is there, the types in use begin at 1, which LIGGGHTS needs."""
        return [*self.bed, *self.particles]

    @model_validator(mode="after")
    def _bed(self) -> Self:
        if bool(self.bed) != bool(self.bed_count) or bool(self.bed) != (self.bed_fill is not None):
            raise ValueError("a bed needs 'bed', 'bed_count' and 'bed_fill'; give all three or none")
        if self.bed and not self.gravity:
            raise ValueError("a bed settles under gravity; give gravity")
        return self


Kinds = Settle | Hopper | Drum | Compaction | Peening | Parts


class SceneCase(Frozen):
    """One bulk scene."""

    case: Header
    materials: dict[Name, SceneMaterial]
    law: LawChoice
    scene: Annotated[Kinds, Field(discriminator="kind")]
    viscous: Viscous | None = None
    contact: Contact = Contact()
    output: Output = Output()
    numerics: SceneNumerics = SceneNumerics()

    @model_validator(mode="after")
    def _names(self) -> Self:
        for place, name in self.scene.named_materials:
            if name not in self.materials:
                raise ValueError(f"{place} = {name!r} is not defined; add [materials.{name}]")
        tangential = self.contact.tangential_restitution
        if self.viscous and tangential not in (None, self.viscous.restitution):
            raise ValueError(
                f"contact.tangential_restitution = {tangential:g}: LIGGGHTS has one restitution for both dashpots; "
                f"give that of viscous ({self.viscous.restitution:g}), or remove it (then no tangential dashpot)"
            )
        for pair in self.contact.pairs:
            for name in pair.between:
                if name not in self.materials and name != "wall":
                    raise ValueError(f"contact.pairs: {name!r} is neither a material nor 'wall'")
            if pair.restitution is not None and self.viscous is None:
                raise ValueError("contact.pairs.restitution: there is no dashpot; add [viscous], for all other pairs")
        return self

    @property
    def name(self) -> str:
        return self.case.name


def is_scene(data: dict[str, Any]) -> bool:
    """Whether TOML data describe a bulk scene."""
    return "scene" in data


def parse(data: dict[str, Any], path: object = "case") -> SceneCase:
    """A scene from TOML data; `path` names the place in messages. Raises CaseError."""
    data = with_library(data, path)
    try:
        return SceneCase.model_validate(data, context=context(path))
    except ValidationError as error:
        raise CaseError(explain(path, data, error, "scene")) from None


def load(path: Path | str) -> SceneCase:
    """The scene in a file. Raises CaseError."""
    data = read_toml(path)
    with named(path):
        return parse(data, path)
