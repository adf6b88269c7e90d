# SPDX-License-Identifier: GPL-2.0-or-later
"""Stiff bulk scenes of `bulk.toml`: their energy balance, and the same scene on several ranks."""

import math
import tempfile
import tomllib
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ...api.files import Scene
from ...base.tables import write_csv
from ...case.scene import SceneCase
from ...laws.strengths import default_numbers, yields_by_stress
from ...scenes.judge.energy_balance import energy_balance, kinetic
from ...scenes.plan.model import pair_law
from ...scenes.plan.plan import SceneEngine, ScenePlan, plan
from ...scenes.plan.timestep import stable_step
from ...scenes.run import run_plan
from ...scenes.tables.columns import last_frame
from ...theory.backbones import LAWS
from ..runner import STUDIES, Progress, Row, silent
from .kinds import stored

SCENES: dict[str, dict[str, Any]] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
RADIUS, DENSITY, POISSON = 5e-3, 7800.0, 0.3
SHARE = 0.02  # of the stability limit at the highest speed: e_n within 1e-4
FRAMES = 40
LATTICE = (8, 8, 8)  # of the convergence of the dissipated energy
SHARES = (0.4, 0.2, 0.1, 0.05, 0.025)  # of the stability limit at the highest speed
FINEST = 0.25  # share of the finest step, of the run that errors are against: an error of order 2 is known to 1/16


def _spheres(about: dict[str, Any], lattice: tuple[int, int, int]) -> pd.DataFrame:
    """The spheres of a scene: places [m], radius [m], materials and velocities [m/s]."""
    spacing, rng = about["spacing"], np.random.default_rng(about["seed"])
    axes = [spacing * (np.arange(k) + 0.5) for k in lattice]
    place = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    velocity = rng.normal(0.0, 1.0 / np.sqrt(3.0), place.shape)
    velocity -= velocity.mean(axis=0)
    height, half = spacing * lattice[2], about.get("meeting_speed", 0.0) / 2
    if half:
        velocity[:, 2] += np.where(place[:, 2] < height / 2, half, -half)
        place[:, 2] += height / 2  # room before and behind
    kind = np.indices(lattice).sum(axis=0).reshape(-1) % len(about["materials"])
    table = pd.DataFrame(place, columns=[*"xyz"]).assign(radius=RADIUS, material=[f"m{k}" for k in kind])
    return table.join(pd.DataFrame(velocity, columns=["vx", "vy", "vz"]))


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
    write_csv(folder / "spheres.csv", _spheres(about, lattice))
    lx, ly, lz = (about["spacing"] * n for n in lattice)
    high = lz * about.get("heights", 1)
    flat = {"kind": "plane", "axis": "z", "material": "m0"}
    walls = [flat | {"name": wall, "at": {"floor": 0.0, "lid": high}[wall]} for wall in about.get("walls", [])]
    phase: dict[str, Any] = {"name": "run", "duration": about["duration"] * duration}
    if speed := about.get("plate_speed"):
        walls.append(flat | {"name": "plate", "kind": "plate", "center": [lx / 2, ly / 2, lz], "size": [lx, ly]})
        phase["move"] = [{"wall": "plate", "kind": "linear", "velocity": [0.0, 0.0, -speed]}]
        high += RADIUS
    scene = {"kind": "parts", "periodic": True, "gravity": 0.0, "wall": walls, "phase": [phase]}
    scene |= {"room": {"x": [0.0, lx], "y": [0.0, ly], "z": [0.0, high]}}
    scene |= {"fill": [{"name": "lattice", "file": str(folder / "spheres.csv")}]}
    solid = {"poisson_ratio": POISSON, "density": DENSITY}
    materials = {
        f"m{k}": solid | {"young_modulus": E, "yield_stress": _strength(law, p_y)}
        for k, (E, p_y) in enumerate(about["materials"])
    }
    case: SceneCase = Scene(
        case={"name": name, "title": about["title"]},
        materials=materials,
        law={"name": law},
        scene=scene,
        output=output or {"rows": 1, "particles": FRAMES, "contacts": FRAMES, "energy": True},
        numerics={"highest_speed": about["highest_speed"]},
    ).model
    return case


def with_step(case: SceneCase, time_step: float) -> ScenePlan:
    """The plan of a scene with a time step [s]."""
    return plan(case.model_copy(update={"numerics": case.numerics.model_copy(update={"time_step": time_step})}))


def differences(one: pd.DataFrame, two: pd.DataFrame) -> np.ndarray:
    """Largest distance of the same sphere in two runs, over the radius, per frame."""
    places = [t.set_index(["step", "id"])[["x", "y", "z"]] for t in (one, two)]
    off = (places[0] - places[1]).abs().max(axis=1) / RADIUS
    return np.asarray(off.groupby("step").max())


def _elastic(p: ScenePlan, contacts: pd.DataFrame) -> np.ndarray:
    """Elastic energy [J] of each contact, by theory from its overlaps now and at the most, shape (contacts,)."""
    material = np.array([sphere.material for sphere in p.scene.table])
    flat = (contacts["wall"] != "").to_numpy()
    first, second = (material[contacts[side].to_numpy() - 1] for side in "ij")
    pairs = pd.DataFrame({"a": first, "b": np.where(flat, "m0", second), "flat": flat})
    alpha, energy = contacts["overlap"].to_numpy(), np.zeros(len(contacts))
    top = np.maximum(contacts["delta_max"].to_numpy(), alpha)
    for (one, other, plane), at in pairs.groupby(["a", "b", "flat"]).indices.items():
        spec, E_star = pair_law(p.case, one, other)
        theory = spec.backbone(E_star=E_star, R_star=RADIUS if plane else RADIUS / 2, radius=RADIUS)
        energy[at] = stored(theory, alpha[at], top[at]) - theory.plastic_work(top[at])
    return energy


def balance(p: ScenePlan, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """The energy balance [J] with elastic energies of theory, which no law computes, and work of a plate by trapezoids.

    A row has the mean power of the steps up to its end, of which the last counts half; the force at the end is that of
    the contacts of the frame.
    """
    contacts = tables["contacts"].assign(elastic_energy=lambda table: _elastic(p, table))
    table = energy_balance(p, tables | {"contacts": contacts})
    for wall in p.scene.meshes:
        force = contacts[contacts["wall"] == wall].groupby("step")["force"].sum().reindex(table["step"], fill_value=0.0)
        table["balance"] -= 0.5 * p.time_step * p.phases[-1].velocity(wall)[2] * force.to_numpy()
    return table


def judge_scene(case: SceneCase, tool: SceneEngine, folder: Path) -> Row:
    """Run a scene on 1 and on 2 ranks and judge it. Raises EngineError if the engine fails.

    rise: largest rise of the total energy, plastic work included, between two frames; off: largest distance of the
    total from that at the start; plastic: work lost for good, all over the energy brought in. first_difference,
    last_difference: between 1 and 2 ranks, largest over the spheres, over the radius, a quarter through the scene and
    at the end; growth: the largest from frame to frame.
    """
    p = with_step(case, SHARE * stable_step(case, 0.0))
    one = run_plan(p, tool, folder)
    table = balance(p, one)
    frames = one["particles"], run_plan(p, tool, folder / "ranks", ranks=2)["particles"]
    brought = table["kinetic"].iloc[0] + table["work"].iloc[-1]
    apart = differences(*frames)
    ends = [last_frame(frame) for frame in frames]
    energies = [kinetic(end).sum() for end in ends]
    count = len(case.parts.table)
    return STUDIES["bulk"].judged(
        {
            "scene": case.name,
            "law": case.law.name,
            "spheres": count,
            "steps": p.steps,
            "lost": count - len(ends[0]),
            "rise": float(table["balance"].diff().max() / brought),
            "off": float(table["balance"].abs().max() / brought),
            "plastic": float(table["plastic"].iloc[-1] / brought),
            "first_difference": float(apart[len(apart) // 4]),
            "last_difference": float(apart[-1]),
            "growth": float((apart[1:] / np.maximum(apart[:-1], 1e-16)).max()),
            "energy_difference": float(abs(energies[1] / energies[0] - 1)),
        }
    )


def run(laws: list[str], tool: SceneEngine, *, progress: Progress = silent) -> pd.DataFrame:
    """Every scene with every law, one row each. Raises EngineError."""
    rows = []
    for name, law in product(SCENES, laws):
        progress(f"{name}, {law}")
        with tempfile.TemporaryDirectory(prefix="epdem-bulk-") as scratch:
            rows.append(judge_scene(scene_case(name, law, Path(scratch)), tool, Path(scratch)))
    return pd.DataFrame(rows)


def _dissipated(law: str, time_step: float, tool: SceneEngine, folder: Path) -> np.ndarray:
    """Plastic work of every sphere of two blocks that have met [J], shape (spheres,)."""
    case = scene_case("shock", law, folder, lattice=LATTICE, rows=1, particles=1, energy=True)
    last = last_frame(run_plan(with_step(case, time_step), tool, folder)["particles"])
    return np.asarray(last.sort_values("id")["plastic_work"])


def convergence(laws: list[str], tool: SceneEngine, *, shares: tuple[float, ...] = SHARES) -> pd.DataFrame:
    """Error of the mean dissipated energy, and `rms` error of a sphere's, both over the mean; a row per law and share.

    The blocks meet for about two collisions a sphere: long enough to be a bulk, too short for round-off to grow. All
    laws take the same steps, shares of the smallest of their stability limits at the highest speed. The mean's error
    may pass through zero, as those of single spheres have either sign; `order` is that of the rms between neighbouring
    shares. Raises EngineError.
    """
    tables = []
    with tempfile.TemporaryDirectory(prefix="epdem-bulk-") as scratch:
        folder = Path(scratch)
        least = min(stable_step(scene_case("shock", law, folder, lattice=LATTICE), 0.0) for law in laws)
        for law in laws:
            reference = _dissipated(law, FINEST * min(shares) * least, tool, folder)
            deviations = [_dissipated(law, share * least, tool, folder) / reference.mean() for share in shares]
            off = np.array(deviations) - reference / reference.mean()
            table = pd.DataFrame({"model": f"{tool.name}, {law}", "spheres": math.prod(LATTICE), "share": list(shares)})
            table["error"], table["rms"] = np.abs(off.mean(axis=1)), np.sqrt((off**2).mean(axis=1))
            table["order"] = np.log(table["rms"]).diff() / np.log(table["share"]).diff()
            tables.append(table)
    return pd.concat(tables, ignore_index=True)
