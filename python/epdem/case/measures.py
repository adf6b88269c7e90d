# SPDX-License-Identifier: GPL-2.0-or-later
"""Named numbers and curves of a scene's results. SI."""

from typing import Annotated, Literal

from pydantic import Field, Tag

from ..base.tables import Quantity
from .fields import Frozen, Name
from .sizes import Share
from .walls import Axis, PartName, Place, Room, Side, Span, Upright, has

Region = Annotated[Annotated[Upright, Tag("with")] | Annotated[Room, Tag("without")], has("diameter")]
Bins = Annotated[int, Field(ge=2, le=1000)]


class _Measure(Frozen):
    name: PartName


class _OfSpheres(_Measure):
    """A measure of the spheres whose centres are in a region (everywhere), of one material (of all)."""

    region: Region | None = None
    material: Name | None = None


class Amount(_OfSpheres):
    """Number or mass [kg] of spheres."""

    kind: Literal["count", "mass"]


class Flow(_Measure):
    """Mass per time [kg/s] through a plane in a direction, between frames.

    A sphere that leaves the room has passed the plane.
    """

    kind: Literal["flow"]
    direction: Side = "-z"
    at: Place
    material: Name | None = None


class Height(_OfSpheres):
    """Height [m] below which `share` of the mass has its centres."""

    kind: Literal["height"]
    share: Share = 0.95


class Repose(_OfSpheres):
    """Angle [rad] of the surface of a bed: its slope over the distance from an upright axis, or over x or y."""

    kind: Literal["repose"]
    over: Literal["distance", "x", "y"] = "distance"
    center: Span = Field(default_factory=lambda: [0.0, 0.0])


class CenterOfMass(_OfSpheres):
    """A coordinate of the centre of mass [m]."""

    kind: Literal["center_of_mass"]
    axis: Axis = "z"


class Load(_Measure):
    """A component of the mean force [N], or of the torque [N m], on a wall in a row, or its magnitude."""

    kind: Literal["force", "torque"]
    wall: PartName
    component: Literal["x", "y", "z", "magnitude"] = "magnitude"


class Porosity(_Measure):
    """Share of a region's volume that no sphere takes."""

    kind: Literal["porosity"]
    region: Region


class Histogram(_Measure):
    """Distribution at the end: of the plastic work of each sphere [J], or of the impact speed [m/s] of each contact.

    The impact speed belongs to the head-on impact that gives the largest overlap of the contact.
    """

    kind: Literal["plastic_work", "impact_speed"]
    bins: Bins = 30


Measure = Annotated[
    Amount | Flow | Height | Repose | CenterOfMass | Load | Porosity | Histogram, Field(discriminator="kind")
]

KINDS = {
    "count": Quantity("", "number of spheres"),
    "mass": Quantity("kg", "mass of the spheres"),
    "flow": Quantity("kg/s", "mass per time through a plane"),
    "height": Quantity("m", "height below which a share of the mass lies"),
    "repose": Quantity("rad", "angle of the surface of the bed"),
    "center_of_mass": Quantity("m", "coordinate of the centre of mass"),
    "force": Quantity("N", "force on a wall, mean over a row"),
    "torque": Quantity("N m", "torque on a wall, mean over a row"),
    "porosity": Quantity("", "void share of a region"),
    "plastic_work": Quantity("J", "plastic work of each sphere"),
    "impact_speed": Quantity("m/s", "speed of the head-on impact with the largest overlap of a contact"),
}
