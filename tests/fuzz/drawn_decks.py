# SPDX-License-Identifier: GPL-2.0-or-later
"""Decks of 60 to 200 spheres in a cube with features drawn from a table; files and words of a run of an engine."""

import os
import random
import re
import subprocess
import tomllib
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from hypothesis import Phase, settings

# Of runs of engines: fewer than of other random input, and none to shrink a deck.
ONE_BY_ONE = settings(
    max_examples=int(os.environ.get("EPDEM_FUZZ", "10")), phases=[Phase.explicit, Phase.reuse, Phase.generate]
)
LISTS = ("head", "materials", "meshes", "fixes", "output", "between")
ADDED = ("thermo", "columns", "mesh_words", "wall_words")


def read_features(engine: str) -> dict[str, dict[str, Any]]:
    """Features of the decks of an engine by name."""
    return tomllib.loads(Path(__file__).with_name(f"{engine}_features.toml").read_text())


def merge(rng: random.Random, features: list[dict[str, Any]]) -> dict[str, Any]:
    """One table of several features; of `one_of` one is drawn."""
    found: dict[str, Any] = {key: [] for key in LISTS} | dict.fromkeys(ADDED, "") | {"stl": {}}
    for feature in features:
        for table in (feature, rng.choice(feature.get("one_of", [{}]))):
            for key, value in table.items():
                if key in LISTS or key in ADDED:
                    found[key] = found[key] + value
                elif key == "stl":
                    found["stl"] = found["stl"] | value
                elif key != "one_of":
                    found[key] = value
    return found


def stl(half: float, cells: int, sides: str) -> str:
    """Sides of a cube as triangles, normals inward; X is the side at +half of x, x the side at -half."""
    edges = [2 * half * k / cells - half for k in range(cells + 1)]
    text = "solid s\n"
    for side in sides:
        axis, at = "xyz".index(side.lower()), half if side.isupper() else -half
        for u0, u1 in pairwise(edges):
            for v0, v1 in pairwise(edges):
                quad = [[u0, v0], [u1, v0], [u1, v1], [u0, v1]]
                for point in quad:
                    point.insert(axis, at)
                for corners in ((0, 1, 2), (0, 2, 3)):
                    lines = "\n".join("vertex {:.17g} {:.17g} {:.17g}".format(*quad[k]) for k in corners)
                    text += f"facet normal 0 0 0\nouter loop\n{lines}\nendloop\nendfacet\n"
    return text + "endsolid s\n"


def spheres(rng, cells, pitch, box, types, diameters, tilt="", head="Atoms"):
    """Text of a data file: a cube of spheres, jittered and stirred, some places empty; `box`: bounds of each axis."""
    keep, rows, velocities = rng.choice((1.0, 0.9, 0.6)), [], []
    for place in ((i, j, k) for i in range(cells) for j in range(cells) for k in range(cells)):
        if rng.random() > keep:
            continue
        kind, n = rng.randint(1, types), len(rows) + 1
        x = [(c - cells / 2 + 0.5) * pitch + rng.uniform(-0.015, 0.015) * pitch for c in place]
        density = (2500.0, 4000.0, 1200.0)[kind - 1]
        rows.append(" ".join(map(repr, (n, kind, diameters(rng, kind), density, *x))))
        motion = [rng.uniform(-3, 3) for _ in range(3)] + [rng.uniform(-300, 300) for _ in range(3)]
        velocities.append(" ".join(map(repr, (n, *motion))))
    bounds = "".join(f"{low!r} {high!r} {axis}lo {axis}hi\n" for axis, (low, high) in zip("xyz", box, strict=True))
    text = f"spheres\n\n{len(rows)} atoms\n{types} atom types\n{bounds}{tilt}\n{head}\n\n"
    return text + "\n".join(rows) + "\n\nVelocities\n\n" + "\n".join(velocities) + "\n"


@dataclass
class Deck:
    """Text of a deck, its files by name, and the number of ranks."""

    text: str
    files: dict[str, str] = field(default_factory=dict)
    ranks: int = 1
    features: tuple[str, ...] = ()


def run(deck: Deck, command: list[str], folder: Path, environment: dict[str, str]) -> tuple[int, str, dict[str, bytes]]:
    """(exit code, words, files that the run wrote); the code of a run of half a minute is that of `timeout`, 124."""
    folder.mkdir(parents=True)
    for name, text in (deck.files | {"in.deck": deck.text}).items():
        (folder / name).write_text(text)
    done = subprocess.run(
        ["timeout", "30", *command],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    written = {p.name: p.read_bytes() for p in folder.iterdir() if p.name not in deck.files and p.name != "in.deck"}
    return done.returncode, done.stdout.decode(errors="replace"), written


def difference(one: np.ndarray, two: np.ndarray) -> float:
    """Largest distance of a row of one table from the nearest row of the other, over the largest value."""
    if len(one) != len(two):
        return np.inf
    distance = np.abs(one[:, None] - two[None]).max(axis=2)
    far = max(distance.min(axis=k).max(initial=0.0) for k in (0, 1))
    return float(far / np.abs(one).max(initial=1e-300))


def rows(words: str) -> list[str]:
    """Thermo rows, errors, warnings and counts of neighbours of a run; no times."""
    kept = ("ERROR", "WARNING", "Total # of neigh", "Neighbor list builds", "Dangerous")
    lines = sorted(words.splitlines())  # ranks print warnings in any order
    return [line for line in lines if "%" not in line and (re.match(r" *\d+ +[-\d]", line) or line.startswith(kept))]
