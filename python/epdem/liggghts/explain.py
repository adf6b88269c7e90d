# SPDX-License-Identifier: GPL-2.0-or-later
"""Why each line of a deck is in it. A line that no rule explains is a defect (a test looks for it)."""

import re

# (pattern of the line, reason); the first that matches counts. Impacts and scenes share the list.
_REASONS = (
    (r"# ?guard:|.*# guard: (?P<own>.*)", "guard: {own}"),
    (r"atom_style granular", "spheres with radius, density and spin"),
    (r"boundary p p f", "x and y repeat: the case has no side walls"),
    (r"boundary", "nothing repeats; what leaves the room is lost, so walls must hold it"),
    (r"newton off", "LIGGGHTS keeps contact histories only with newton off"),
    (r"communicate single vel yes", "contact models read velocities of ghost particles"),
    (r"region box ", "the room that is simulated"),
    (r"create_box", "as many atom types as there are materials (and walls with values of their own)"),
    (r"include setup\.in", "what a continued run needs too stands in a file of its own"),
    (r"read_restart", "positions, velocities, step number and all contact histories"),
    (r"read_data", "positions and velocities of the impacts"),
    (r"hard_particles", "the case's Young's modulus is above 1e9 Pa, which LIGGGHTS takes only when told"),
    (r"soft_particles", "the case's Young's modulus is below 5e6 Pa, which LIGGGHTS takes only when told"),
    (r"fix \S+ all property/global youngsModulus", "stiffness of every contact"),
    (r"fix \S+ all property/global poissonsRatio", "E* and G* follow from E and Poisson's ratio"),
    (r"fix \S+ all property/global (yieldPressure|yieldStress)", "the law yields; the softer body's value counts"),
    (r"fix \S+ all property/global coefficientFriction", "contact.friction: limit of the tangential force"),
    (
        r"fix \S+ all property/global coefficientRestitution.*do not yield",
        "viscous.restitution, on the elastic branches",
    ),
    (
        r"fix \S+ all property/global coefficientRestitution",
        "contact.tangential_restitution: dashpot beside the tangential spring; the normal law needs none",
    ),
    (r"fix \S+ all property/global coefficientRolling", "contact.rolling"),
    (r"fix \S+ all property/global cohesionEnergyDensity", "contact.cohesion"),
    (r"fix \S+ all property/global", "a parameter of the law that differs from its default"),
    (r"pair_style gran .*", "contact model of particles: {models}"),
    (r"pair_coeff", "LIGGGHTS wants it for every pair style"),
    (r"fix shutter all wall/gran", "closes the outlet while the bin is filled"),
    (r"fix (?P<id>\S+) all wall/gran .* primitive .*store_force yes", "wall; output.loads asks for its force"),
    (r"fix (?P<id>\S+) all wall/gran .* primitive", "flat wall, the same model as the pairs"),
    (r"fix \S+ all wall/gran .* mesh ", "contacts with the triangles, the same model as the pairs"),
    (r"fix drum all mesh.*surface_ang_vel", "triangles of the drum, whose surface turns"),
    (r"fix plate all mesh/surface/stress", "the moving plate; its force is the result"),
    (r"fix \S+ all mesh/surface", "triangles of the wall, an STL file beside the deck"),
    (r"fix gravity", "scene.gravity"),
    (r"fix motion", "moves the particles"),
    (r"timestep", "from numerics.error and the highest speed of the scene"),
    (r"region fill", "room that is filled"),
    (r"fix template", "one size of spheres of one material"),
    (r"fix mix", "shares of the sizes"),
    (r"fix fill\S+ all insert/pack", "scene.count spheres, at random places without overlap"),
    (r"fix fill\S+ all insert/rate", "scene.count spheres at scene.rate"),
    (r"fix press all move/mesh", "the plate moves"),
    (r"unfix shutter", "opens the outlet"),
    (r"unfix press", "loading ends"),
    (r"compute load|fix load ", "output.loads: mean force on the floor between two rows"),
    (r"fix torque", "mean torque on the drum between two rows: the work it does"),
    (r"fix press_z", "mean force on the plate between two rows"),
    (r"thermo_style", "what the rows of the table hold"),
    (r"thermo_modify lost ignore", "shot that rebounds leaves the room, which is no error here"),
    (r"thermo ", "output.rows; progress is read from these lines"),
    (r"dump path ", "the trajectory, from which everything is measured"),
    (r"dump particles", "output.particles"),
    (r"compute contacts|compute \S+ all (pair|wall)/gran/local|dump (\S+_)?contacts", "output.contacts, output.energy"),
    (r"dump vtk", "output.vtk"),
    (r"dump picture", "output.pictures"),
    (r"dump_modify", "every digit, so that sums of energies close"),
    (r"fix work|fix plastic|compute plastic|compute work|variable", "output.energy: a term of the ledger"),
    (r"restart", "output.restarts: files from which an interrupted run continues"),
    (r"run ", "steps of this part of the scene"),
)
_RULES = [(re.compile(pattern), reason) for pattern, reason in _REASONS]


def why(line: str) -> str | None:
    """The reason of one line of a deck; '' for blank lines and comments, None if no rule knows it."""
    text = line.strip()
    if not text or text.startswith("#"):
        return ""
    for pattern, reason in _RULES:
        if found := pattern.match(text):
            groups = {k: v or "" for k, v in found.groupdict().items()}
            return reason.format(models=_models(text), **groups)
    return None


def _models(text: str) -> str:
    words = text.split()
    parts = []
    for key, none in (("model", ""), ("tangential", "off"), ("cohesion", "off"), ("rolling_friction", "off")):
        value = words[words.index(key) + 1] if key in words else "off"
        if value != none:
            parts.append(f"{key} {value}")
    return ", ".join(parts) + ("" if len(parts) == 4 else "; nothing that the case does not ask for")


def explain(texts: dict[str, str]) -> list[tuple[str, str, str | None]]:
    """(file, line, reason) of every line that does something."""
    return [(name, line, why(line)) for name, text in texts.items() for line in text.splitlines() if why(line) != ""]
