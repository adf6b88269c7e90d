# SPDX-License-Identifier: GPL-2.0-or-later
"""Stiff bulk scenes of `bulk.toml`: their energy balance, and the same scene on several ranks."""

import shutil
import tempfile
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ...base.files import write_texts
from ...case.scene import SceneCase, parse
from ...case.units import to_si
from ...laws.strengths import default_numbers, yields_by_stress
from ...scenes.checks import energy_balance
from ...scenes.engine import SceneEngine
from ...scenes.plan import ScenePlan, plan
from ...scenes.run import run_plan
from ...scenes.timestep import stable_step
from ...theory.backbones import LAWS

SCENES: dict[str, dict[str, Any]] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
RADIUS, DENSITY, POISSON = 5e-3, 7800.0, 0.3
SHARE = 0.02  # of the stability limit at the highest speed: e_n within 1e-4
FRAMES = 40
# Of the energy brought in, what the total may move: velocity Verlet lets the energy of a contact in progress swing by
# (omega dt)^2/4 = share^2 of the stability limit, 4e-4 at 2 %.
SWING = 4e-4
GROWTH = 1e6  # by which a difference may grow from frame to frame: exponential, no jump
AGREE = 0.02  # of the kinetic energy, in which ranks may differ when paths have nothing in common any more


def _spheres(about: dict[str, Any], lattice: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places [m] and velocities [m/s], (n, 3), and numbers of the materials, (n,)."""
    spacing, rng = float(to_si(about["spacing"], "m")), np.random.default_rng(about["seed"])
    axes = [spacing * (np.arange(k) + 0.5) for k in lattice]
    place = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    velocity = rng.normal(0.0, 1.0 / np.sqrt(3.0), place.shape)
    velocity -= velocity.mean(axis=0)
    height = spacing * lattice[2]
    if "meeting_speed" in about:
        half = float(to_si(about["meeting_speed"], "m/s")) / 2
        velocity[:, 2] += np.where(place[:, 2] < height / 2, half, -half)
        place[:, 2] += height / 2  # room before and behind
    return place, velocity, np.indices(lattice).sum(axis=0).reshape(-1) % len(about["materials"])


def _strength(law: str, p_y: float) -> float:
    """Yield stress [Pa] of a material whose contacts yield at p_y [Pa], or whose cavities have this stress."""
    pressure_over_stress = LAWS["thornton"].declaration().default_ratio
    return p_y / (pressure_over_stress if yields_by_stress(law) else default_numbers(law).ratio)


def scene_case(
    name: str,
    law: str,
    folder: Path,
    *,
    lattice: tuple[int, int, int] | None = None,
    duration: float = 1.0,
    **output: Any,
) -> SceneCase:
    """A scene of SCENES as a case, with its spheres in a file of `folder`; duration: share of the scene's own.

    output: of the case; none: what the verdict needs.
    """
    about = SCENES[name]
    lattice = lattice or tuple(about["lattice"])
    place, velocity, kind = _spheres(about, lattice)
    rows = [
        f"{','.join(map(repr, [*p.tolist(), RADIUS]))},m{k},{','.join(map(repr, v.tolist()))}"
        for p, v, k in zip(place, velocity, kind, strict=True)
    ]
    write_texts(folder, {"spheres.csv": "\n".join(["x,y,z,radius,material,vx,vy,vz", *rows, ""])})
    lx, ly, lz = (float(to_si(about["spacing"], "m")) * n for n in lattice)
    high, time_ = lz * (2 if "meeting_speed" in about else 1), float(to_si(about["duration"], "s")) * duration
    phase: dict[str, Any] = {"name": "run", "duration": f"{time_!r} s"}
    walls: list[dict[str, Any]] = []
    if about.get("closed") or "plate_speed" in about:
        walls.append({"name": "floor", "kind": "plane", "axis": "z", "at": "0 m", "material": "m0"})
    if about.get("closed"):
        walls.append({"name": "lid", "kind": "plane", "axis": "z", "at": f"{high!r} m", "material": "m0"})
    if "plate_speed" in about:
        plate = {"name": "plate", "kind": "plate", "axis": "z", "material": "m0"}
        walls.append(plate | {"center": [f"{x!r} m" for x in (lx / 2, ly / 2, lz)], "size": [f"{lx!r} m", f"{ly!r} m"]})
        phase["move"] = [
            {"wall": "plate", "kind": "linear", "velocity": ["0 m/s", "0 m/s", f"-{about['plate_speed']}"]}
        ]
        high += RADIUS
    room = {axis: ["0 m", f"{length!r} m"] for axis, length in zip("xyz", (lx, ly, high), strict=True)}
    scene = {"kind": "parts", "room": room, "periodic": True, "gravity": "0 m/s^2", "wall": walls, "phase": [phase]}
    scene["fill"] = [{"name": "lattice", "file": str(folder / "spheres.csv")}]
    materials = {
        f"m{k}": {
            "young_modulus": f"{E!r} Pa",
            "poisson_ratio": POISSON,
            "density": f"{DENSITY} kg/m^3",
            "yield_stress": f"{_strength(law, p_y)!r} Pa",
        }
        for k, (E, p_y) in enumerate(about["materials"])
    }
    return parse(
        {
            "case": {"name": name, "title": about["title"], "source": "generated by rule"},
            "materials": materials,
            "law": {"name": law},
            "scene": scene,
            "output": output or {"rows": 1, "particles": FRAMES, "contacts": FRAMES, "energy": True},
            "numerics": {"highest_speed": about["highest_speed"]},
        }
    )


def limit(case: SceneCase) -> float:
    """The stability limit [s] of the contacts of a scene at its highest speed."""
    return stable_step(case, 0.0)


def with_step(case: SceneCase, time_step: float) -> ScenePlan:
    """The plan of a scene with a time step [s]."""
    return plan(case.model_copy(update={"numerics": case.numerics.model_copy(update={"time_step": time_step})}))


@dataclass
class BulkVerdict:
    """One scene with one law. Energies over the energy brought in, differences over the radius."""

    scene: str
    law: str
    spheres: int
    steps: int
    lost: int
    rise: float  # largest rise of the total energy, plastic work included, between two frames
    off: float  # largest distance of the total from that at the start
    plastic: float  # work lost for good
    first_difference: float  # between 1 and 2 ranks, largest over the spheres, a quarter through the scene
    last_difference: float
    energy_difference: float
    passed: bool = True
    reason: str = ""


def differences(one: pd.DataFrame, two: pd.DataFrame) -> np.ndarray:
    """Largest distance of the same sphere in two runs, over the radius, per frame."""
    places = [t.set_index(["step", "id"])[["x", "y", "z"]] for t in (one, two)]
    off = (places[0] - places[1]).abs().max(axis=1) / RADIUS
    return np.asarray(off.groupby("step").max())


def balance(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """The energy balance [J], with the work of a plate by trapezoids.

    A row has the mean power of the steps up to its end, of which the last counts half; the force at the end is that of
    the contacts of the frame.
    """
    table, contacts = energy_balance(p, tables), tables["contacts"]
    for wall in p.scene.meshes:
        force = contacts[contacts["wall"] == wall].groupby("step")["force"].sum().reindex(table["step"], fill_value=0.0)
        table["balance"] -= 0.5 * p.time_step * p.phases[-1].velocity(wall)[2] * force.to_numpy()
    return table


def judge_scene(case: SceneCase, tool: SceneEngine, folder: Path, *, ranks: int = 2) -> BulkVerdict:
    """Run a scene on 1 and on `ranks` ranks and check it. Raises EngineError if the engine fails."""
    p = with_step(case, SHARE * limit(case))
    one = run_plan(p, tool, folder)
    table = balance(p, one)
    frames = one["particles"], run_plan(p, tool, folder / "ranks", ranks=ranks)["particles"]
    last = frames[0]["step"].max()
    brought = table["kinetic"].iloc[0] + table["work"].iloc[-1]
    apart = differences(*frames)
    ends = [frame[frame["step"] == last] for frame in frames]
    kinetic = [(0.5 * end["mass"] * (end[["vx", "vy", "vz"]] ** 2).sum(axis=1)).sum() for end in ends]
    count = len(case.parts.table)
    v = BulkVerdict(
        case.name,
        case.law.name,
        count,
        p.steps,
        count - len(ends[0]),
        float(table["balance"].diff().max() / brought),
        float(table["balance"].abs().max() / brought),
        float(table["plastic"].iloc[-1] / brought),
        float(apart[len(apart) // 4]),
        float(apart[-1]),
        float(abs(kinetic[1] / kinetic[0] - 1)),
    )
    growth = apart[1:] / np.maximum(apart[:-1], 1e-16)
    reasons = {
        f"{v.lost} spheres lost": not v.lost,
        f"total energy rises by {v.rise:.2g}": v.rise <= SWING,
        f"total energy is off by {v.off:.2g}": v.off <= SWING,
        f"ranks part by a factor {growth.max():.2g} from one frame to the next": growth.max() <= GROWTH,
        f"kinetic energies of the ranks differ by {v.energy_difference:.2g}": v.energy_difference <= AGREE,
    }
    v.reason = "; ".join(reason for reason, holds in reasons.items() if not holds)
    v.passed = not v.reason
    return v


def run(laws: list[str], tool: SceneEngine, *, progress: Callable[[str], None] = lambda text: None) -> pd.DataFrame:
    """The verdicts on every scene with every law, one row each. Raises EngineError."""
    rows = []
    with tempfile.TemporaryDirectory(prefix="epdem-bulk-") as scratch:
        for name, law in product(SCENES, laws):
            progress(f"{name}, {law}")
            case = scene_case(name, law, Path(scratch))
            rows.append(vars(judge_scene(case, tool, Path(scratch))))
            shutil.rmtree(scratch)
            Path(scratch).mkdir()
    return pd.DataFrame(rows)
