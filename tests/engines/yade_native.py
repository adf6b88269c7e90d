# SPDX-License-Identifier: GPL-2.0-or-later
"""The module epdem_yade built once for all tests, scripts that import it, and impacts in it."""

import fcntl
import json
import os
import shlex
import shutil
import subprocess
import tempfile
from functools import cache
from math import isfinite, isinf
from pathlib import Path

import numpy as np

from epdem.base.declarations import declarations
from epdem.cli.main import app
from epdem.engines import sources
from epdem.engines.yade.deck import body_tables
from epdem.engines.yade.launcher import environment
from epdem.engines.yade.tables import trajectory
from epdem.impacts.engine import Trajectory
from epdem.impacts.plan import Plan

ROOT = Path(__file__).resolve().parents[2]
EXPORTED = ROOT / "build/yade_exported"


def title(law: str) -> str:
    """The C++ name of a law: thornton_ning -> ThorntonNing."""
    return law.title().replace("_", "")


@cache
def module_folder() -> Path:
    """The folder of epdem_yade.so, built as `epdem export yade` says; the first test builds it, others wait."""
    if named := os.environ.get("EPDEM_YADE_MODULE"):
        return Path(named)
    EXPORTED.mkdir(parents=True, exist_ok=True)
    with (EXPORTED / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with tempfile.TemporaryDirectory() as scratch:
            new = Path(scratch) / "new"
            app(["export", "yade", "--out", str(new)], standalone_mode=False)
            for file in (f for f in new.rglob("*") if f.is_file()):
                place = EXPORTED / file.relative_to(new)
                if not place.exists() or place.read_bytes() != file.read_bytes():  # else nothing is built again
                    place.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(file, place)
        for command in sources.commands("yade", EXPORTED)[:2]:
            text = command.replace("/path/to/yade", shlex.quote(os.environ["YADE_SOURCE"]))
            done = subprocess.run(["bash", "-c", text], capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return EXPORTED / "build"


HEAD = """
import json, sys
import numpy as np
sys.path.insert(0, {module!r})
from yade import O
from yade.wrapper import *
from yade.utils import sphere, wall, facet, box
from epdem_yade import *
"""


def yade(text: str, folder: Path, threads: int = 1, head: str = HEAD) -> subprocess.CompletedProcess[str]:
    """Run a script in YADE."""
    folder.mkdir(parents=True, exist_ok=True)
    script = folder / "script.py"
    script.write_text(head.format(module=str(module_folder())) + text, encoding="utf-8")
    return subprocess.run(
        ["yade", "-n", f"-j{threads}", "-x", script.name],
        cwd=folder,
        env=environment() | {"OMP_NUM_THREADS": str(threads), "LD_PRELOAD": os.environ.get("EPDEM_YADE_PRELOAD", "")},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def result(text: str, folder: Path, threads: int = 1) -> dict:
    """What a script writes by json to `result.json`."""
    done = yade(text, folder, threads)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-3000:]
    return json.loads((folder / "result.json").read_text())


IMPACTS = """
job = json.load(open("job.json"))
number = {k: float(v) for k, v in job["properties"].items()}
friction = np.arctan(job["friction"])
body, target = (EpMat(young=float(b["young"]), poisson=b["poisson"], density=b["density"], frictionAngle=friction,
                      **number) for b in job["bodies"])
O.materials.append([body, target])
groups = [np.load("%d.npy" % k) for k in range(len(job["radii"]))]
if len(groups) == 1:
    O.bodies.append(wall(0, axis=2, material=target))
moving = []
for rows, radius, material in zip(groups, job["radii"], (body, target)):
    for row in rows:
        b = sphere(row[:3], radius, material=material)
        b.state.vel = (row[4] if len(row) > 4 else 0, 0, row[3])
        if len(row) > 5:
            b.state.angVel = (0, row[5], 0)
        moving.append(O.bodies.append(b))
states = [O.bodies[k].state for k in moving]
axes = (0, 2) if job["oblique"] and len(groups) > 1 else (2,)
samples = np.empty((job["samples"], 3, len(axes), len(moving)))

def record():
    now = samples[O.iter]
    for n, axis in enumerate(axes):
        now[0][n] = [s.pos[axis] for s in states]
        now[1][n] = [s.vel[axis] for s in states]
        now[2][n] = [O.forces.f(k)[axis] for k in moving]

O.dt = job["dt"]
ip2 = Ip2_EpMat_EpMat_EpPhys(**{k: MatchMaker(algo="val", val=v) for k, v in job["pair"].items()})
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.1 * min(job["radii"])),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [ip2],
                    [globals()["Law2_ScGeom_EpPhys_" + job["law"]](**job["options"])]),
    PyRunner(command="record()", iterPeriod=1, initRun=True),
    NewtonIntegrator(damping=0),
]
for _ in range(job["samples"]):
    O.step()
with open("path.bin", "wb") as file:
    np.save(file, samples)
    if job["oblique"]:
        np.save(file, [[s.vel[0] for s in states], [s.angVel[1] for s in states]])
"""


def impacts(plan: Plan, folder: Path, **options: object) -> Trajectory:
    """The impacts of a plan with the native classes; options of the law's functor."""
    folder.mkdir(parents=True, exist_ok=True)
    x = plan.experiment
    groups = body_tables(plan)
    for k, table in enumerate(groups):
        np.save(folder / f"{k}.npy", table)
    declared = {p.name: p for p in declarations()[x.law.name].parameters}
    values = {declared[name]: value for name, value in x.law.parameters.items()}
    pair = {p.property: v for p, v in values.items() if p.of_pair}
    if x.viscous_restitution is not None:
        pair["en"] = x.viscous_restitution
    job = {
        "law": title(x.law.name),
        "bodies": [
            {
                "young": repr(b.young_modulus),
                "poisson": b.poisson_ratio,
                "density": b.density if isfinite(b.density) else 1.0,
            }
            for b in (x.body, x.target)
        ],
        "radii": [x.body.radius] if isinf(x.target.radius) else [x.body.radius, x.target.radius],
        "properties": {p.property: repr(v) for p, v in values.items() if not p.of_pair},
        "pair": pair,
        "friction": x.oblique.friction if x.oblique else 0.0,
        "oblique": x.oblique is not None,
        "dt": plan.time_step,
        "samples": plan.steps + 2,
        "options": options,
    }
    (folder / "job.json").write_text(json.dumps(job))
    done = yade(IMPACTS, folder)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-3000:]
    return trajectory(plan, folder, {})
