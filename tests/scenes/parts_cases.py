# SPDX-License-Identifier: GPL-2.0-or-later
"""Small scenes of parts for tests, as TOML data."""

from copy import deepcopy
from pathlib import Path

import numpy as np

from epdem.case.toml import read_toml
from epdem.scenes.plan.meshes import stl_text


def mm(*lengths: object) -> list[str]:
    """Lengths in millimetres."""
    return [f"{x} mm" for x in lengths]


def mps(*speeds: object) -> list[str]:
    """A velocity in metres per second."""
    return [f"{v} m/s" for v in speeds]


def timed(name: str, duration: str, **keys: object) -> dict:
    """A phase."""
    return {"name": name, "duration": duration} | keys


def bead(name: str, position: list, radius: str = "1.5 mm", material: str = "glass", **keys: object) -> dict:
    """A single sphere."""
    return {"name": name, "material": material, "radius": radius, "position": position} | keys


def flat(name: str, center: list, size: list, axis: str = "z", **keys: object) -> dict:
    """A plate of steel."""
    shape = {"kind": "plate", "axis": axis, "center": center, "size": size}
    return {"name": name, "material": "steel"} | shape | keys


def pipe(name: str, low: str, high: str, diameter: str, **keys: object) -> dict:
    """A cylinder of steel."""
    ends = {"kind": "cylinder", "from": low, "to": high, "diameter": diameter}
    return {"name": name, "material": "steel"} | ends | keys


def linear(wall: str, *velocity: object) -> dict:
    """A motion at constant velocity [m/s]."""
    return {"wall": wall, "kind": "linear", "velocity": mps(*velocity)}


def vibrating(wall: str, amplitude: list, frequency: str) -> dict:
    """A sinusoidal motion."""
    return {"wall": wall, "kind": "vibrate", "amplitude": amplitude, "frequency": frequency}


def driven(wall: str, direction: object, force: str, highest_speed: str) -> dict:
    """A wall that a force drives."""
    return {"wall": wall, "kind": "press", "direction": direction, "force": force, "highest_speed": highest_speed}


CASES = Path(__file__).parents[2] / "cases"
GLASS = {"young_modulus": "10 MPa", "poisson_ratio": 0.25, "density": "2500 kg/m^3", "yield_stress": "0.05 MPa"}
STEEL = {"young_modulus": "100 MPa", "poisson_ratio": 0.3, "density": "7800 kg/m^3", "yield_stress": "1 MPa"}
BOX = {"name": "box", "kind": "box", "x": mm(-9, 9), "y": mm(-9, 9), "z": mm(0, 40), "material": "steel"}
FLOOR = {"name": "floor", "kind": "plane", "axis": "z", "at": "0 mm", "material": "steel"}
BED = {
    "name": "bed",
    "region": {"x": ["-9 mm", "9 mm"], "y": ["-9 mm", "9 mm"], "z": ["0 mm", "38 mm"]},
    "particles": [{"material": "glass", "radius": "1.5 mm"}],
    "count": 40,
}
CASE = {
    "case": {"name": "parts", "title": "parts", "source": "a test"},
    "materials": {"glass": GLASS, "steel": STEEL},
    "law": {"name": "thornton"},
    "scene": {
        "kind": "parts",
        "room": {"x": ["-10 mm", "10 mm"], "y": ["-10 mm", "10 mm"], "z": ["-5 mm", "40 mm"]},
        "wall": [FLOOR],
        "fill": [BED],
        "phase": [{"name": "fall", "duration": "20 ms"}],
    },
    "output": {"rows": 20, "particles": 4, "energy": True, "loads": True},
    "numerics": {"time_step": "2e-5 s"},
}


def parts(**scene: object) -> dict:
    """The case with these keys of [scene] instead."""
    data = deepcopy(CASE)
    data["scene"] |= deepcopy(scene)
    return data


def own(name: str) -> dict:
    """The data of a case of the project."""
    return read_toml(CASES / f"{name}.toml")


def tetrahedron(size: float) -> np.ndarray:
    """Four triangles, their normals outwards, shape (4, 3, 3)."""
    a, b, c, d = size * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    return np.array([[a, c, b], [a, b, d], [b, c, d], [a, d, c]])


def write_stl(path: Path, triangles: np.ndarray) -> None:
    """An STL file."""
    with np.errstate(invalid="ignore"):  # a degenerate one has no normal
        path.write_text(stl_text("wall", triangles))
