# SPDX-License-Identifier: GPL-2.0-or-later
"""Six tutorials of LIGGGHTS's source as decks with our models.

The source comes from Debian (`apt-get source --download-only liggghts`, with lists of its own) and is kept in
~/.cache/epdem; nothing of it is part of this project.
"""

import os
import re
import shutil
import subprocess
import tarfile
from functools import cache
from pathlib import Path

import pytest

CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "epdem"
KEYS = "/usr/share/keyrings/debian-archive-keyring.gpg"
SOURCE = f"deb-src [signed-by={KEYS}] http://deb.debian.org/debian bookworm main\n"
FOLDER = "LIGGGHTS-PUBLIC-3.8.0/examples/LIGGGHTS/Tutorials_public"
STEPS = {  # of each run of the deck at most; steps between two rows
    "chute_wear/in.chute_wear": (16000, 2000),
    "packing/in.packing": (800, 50),
    "cohesion/in.cohesion": (6000, 1000),
    "meshGran/in.meshGran": (5000, 1000),
    "heatTransfer_1/in.heatGran": (800, 50),
    "insert_stream/in.insert_stream": (4000, 500),
}


@cache
def archive() -> Path | None:
    """LIGGGHTS's source archive, from the cache or from Debian; None if it cannot be had."""
    kept = CACHE / "liggghts_3.8.0+repack1.orig.tar.xz"
    if kept.exists():
        return kept
    lists = CACHE / "apt"
    (lists / "lists/partial").mkdir(parents=True, exist_ok=True)
    (lists / "sources.list").write_text(SOURCE)
    places = [f"Dir::Etc::SourceList={lists}/sources.list", "Dir::Etc::SourceParts=/dev/null"]
    places += [f"Dir::State::Lists={lists}/lists", f"Dir::Cache={lists}", "APT::Sandbox::User=root"]
    apt = ["apt-get", "-qq", *(word for place in places for word in ("-o", place))]
    for words in (["update"], ["source", "--download-only", "liggghts"]):  # the part of Debian's own is not needed
        try:
            subprocess.run([*apt, *words], cwd=CACHE, capture_output=True, timeout=120)
        except (OSError, subprocess.TimeoutExpired):
            return None
    return kept if kept.exists() else None


def need_source() -> None:
    """Skip a test without LIGGGHTS's source."""
    if archive() is None:
        pytest.skip("LIGGGHTS's source is not in the cache and cannot be had from Debian (apt-get source liggghts)")


def decks() -> dict[str, str]:
    """The text of every tutorial's deck by its name."""
    with tarfile.open(archive()) as tar:
        members = [m for m in tar if m.name.startswith(FOLDER) and Path(m.name).name.startswith("in.")]
        return {m.name: tar.extractfile(m).read().decode() for m in members}


def unpacked(name: str, folder: Path) -> str:
    """The deck `name`, its meshes beside it in `folder`."""
    place = f"{FOLDER}/{name.split('/')[0]}"
    with tarfile.open(archive()) as tar:
        tar.extractall(folder, [m for m in tar.getmembers() if m.name.startswith(place + "/")])
    shutil.copytree(folder / place, folder, dirs_exist_ok=True)
    shutil.rmtree(folder / FOLDER.split("/")[0])
    return (folder / name.split("/")[1]).read_text()


def rewritten(deck: str, model: str, steps: int, every: int, *, extra: str = "", restitution: float = 1.0) -> str:
    """The deck with another model and restitution, short runs, rows of full precision, no dumps. Lists are made anew at
    every step: `hertz` keeps the springs of contacts that have ended until its next list. Cohesion is a tenth of the
    tutorial's: its 0.3 MPa would pull spheres that yield at 0.1 MPa into each other."""
    deck = re.sub(r"&\s*\n", " ", deck)
    deck = re.sub(r"model (hertz|hooke)\b", f"model {model}", deck)
    deck = re.sub(r"(coefficientRestitution peratomtypepair 1) \S+", rf"\1 {restitution}", deck)
    deck = deck.replace("cohesionEnergyDensity peratomtypepair 1 300000", "cohesionEnergyDensity peratomtypepair 1 3e4")
    deck = re.sub(r"(?m)^neigh_modify.*", "neigh_modify delay 0 every 1 check no", deck)
    deck = re.sub(r"(?m)^(dump|write_restart|postscript)\b.*", "", deck)
    deck = re.sub(r"(?m)^thermo\s.*", f"thermo {every}", deck)
    deck = re.sub(r"(?m)^(thermo_modify.*)", r"\1 format float %.15g", deck)
    deck = re.sub(r"(?m)^run\s+(?!1\s*$).*", f"run {steps}", deck)
    return deck.replace("pair_style", f"{extra}pair_style", 1)
