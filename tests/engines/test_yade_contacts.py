# SPDX-License-Identifier: GPL-2.0-or-later
"""The module for production decks, inside YADE: forces, history, restart, growing and shrinking lists of contacts."""

import json
import os
import subprocess
from pathlib import Path

import pytest

from epdem.engines.yade.launcher import write_deck_modules

LAWS = ("thornton", "johnson", "cavity")

# What every script starts from: a law, two materials of different strength, and a check of every contact against the
# law's own numbers (test_yade_law.py holds these against the theory).
PREAMBLE = """
import json, math, random, sys
sys.path.insert(0, {python!r})
from yade import O
from yade.utils import sphere, wall, facet
from yade.wrapper import *
from epdem.yade.deck_modules.contacts import Contacts
from epdem.yade.deck_modules import law as numbers

name = {law!r}
options = {options!r}
contacts = Contacts(name, **options)
STRENGTH = dict(thornton=2.8, johnson=3.0, cavity=1.0, hertz=None)[name]
DATA = dict(steel=(208e9, 0.3, 7850.0, 1.0e9), brass=(100e9, 0.35, 8500.0, 0.3e9))

def material(label, friction=0.0):
    E, nu, rho, Y = DATA[label]
    strength = {{contacts.strength_name: STRENGTH * Y}} if STRENGTH else {{}}
    return contacts.material(label, young_modulus=E, poisson_ratio=nu, density=rho, friction=friction, **strength)

def pair(a, b):
    (E, m, _, X), (F, n, _, Z) = DATA[a], DATA[b]
    strength = STRENGTH * min(X, Z) if STRENGTH else math.inf
    share = 0.5 if a == b else 1.0  # brass is too weak to make steel yield
    return numbers.Law(name, 1 / ((1 - m * m) / E + (1 - n * n) / F), strength, share, **options)

def engines(*more, skin=1e-3):
    bounds = [Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()]
    return [ForceResetter(), InsertionSortCollider(bounds, verletDist=skin), *contacts.engines(), *more,
            NewtonIntegrator(damping=0)]

def watch(command):
    return PyRunner(command=command, iterPeriod=1, initRun=True)

def answer(**values):
    print("ANSWER " + json.dumps(values))
"""


def yade(folder: Path, law: str, script: str, **options) -> dict:
    """Run a script in YADE: what it gave to `answer`, and its words under "log"."""
    path = folder / "script.py"
    write_deck_modules(folder, classes=False)
    path.write_text(PREAMBLE.format(python=str(folder), law=law, options=options) + script)
    done = subprocess.run(
        ["yade", "-n", "-x", path.name],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        stdin=subprocess.DEVNULL,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
    )
    log = done.stdout + done.stderr
    assert done.returncode == 0, log[-2000:]
    lines = [t for t in log.splitlines() if t.startswith("ANSWER ")]
    return json.loads(lines[-1].removeprefix("ANSWER ")) | {"log": log}


PATH = """
steel, R = material("steel"), 0.01
O.bodies.append([wall(0, axis=2, material=steel), sphere((0, 0, 1.1 * R), R, material=steel)])
ball = O.bodies[1]
ball.state.blockedDOFs = "xyzXYZ"
law, chance, alpha_max, worst = pair("steel", "steel"), random.Random(7), 0.0, {"load": 0.0, "elastic": 0.0}
stay = 0

def check():
    global alpha_max
    contact = next(iter(O.interactions), None)
    if contact is None:
        return
    u, F = contact.geom.penetrationDepth, O.forces.f(1)[2]
    kind = "load" if u > alpha_max else "elastic"
    expected, _, alpha_max = law.step(R, alpha_max, u)
    peak = law.step(R, alpha_max, alpha_max)[0]
    worst[kind] = max(worst[kind], abs(F - expected) / peak, abs(contact.phys.normalForce[2] - expected) / peak)

O.engines, O.dt = engines(watch("check()")), 1e-12
top = 0.0
for n in range(3000):
    if n % 50 == 0:
        top = max(top, 1e-7) * chance.choice([1.05, 1.3])
    if n % 7 < 5:  # at times it rests, or moves by less than any force can show
        u = top * chance.choice([chance.random(), 1.0, 1.0 - 1e-3 * chance.random(), 1e-6 + 0.05 * chance.random()])
    ball.state.pos = (0, 0, R - min(u, 5e-4) * (1 + 1e-9 * chance.random()))
    O.step()
answer(**worst, alpha_max=alpha_max, yielded=alpha_max / (law.yield_ratio * R), visits=contacts.visits)
"""


@pytest.mark.yade
@pytest.mark.parametrize(
    ("law", "ratios"),
    [("hertz", {}), ("thornton", {}), ("johnson", {}), ("cavity", {}), ("cavity", {"finite_strain": 0.82})],
)
def test_any_path_of_overlaps_gives_the_force_of_the_law(law, ratios, tmp_path):
    """Jumps, rests, reloads and dents left and touched again; the limit is relative to the largest force so far."""
    found = yade(tmp_path, law, PATH, **ratios)
    assert found["elastic"] <= (1e-8 if law == "cavity" else 1e-12) and found["load"] <= 1e-12
    assert law == "hertz" or found["yielded"] > 3
    assert found["visits"] < 3000


SOUP = """
chance, box = random.Random(3), 0.05
materials = {m: material(m, friction=0.2) for m in DATA}
kinds = {}

def add(label, shape):
    kinds[O.bodies.append(shape)] = label

def ball(x, y, z, label, speed):
    add(label, sphere((x, y, z), chance.uniform(0.004, 0.0078), material=materials[label]))
    O.bodies[len(O.bodies) - 1].state.vel = [chance.uniform(-speed, speed) for _ in range(3)]

for axis in (0, 1, 2):
    for place in (0, box):
        if (axis, place) != (2, 0):
            add("steel", wall(place, axis=axis, material=materials["steel"]))
for a, b, c in (((0, 0), (box, 0), (0, box)), ((box, box), (box, 0), (0, box))):  # the floor is two facets
    add("brass", facet([(*p, 0.0) for p in (a, b, c)], material=materials["brass"]))
for i in range(3):
    for j in range(3):
        for k in range(2):
            ball(*(0.009 + 0.016 * n for n in (i, j, k)), chance.choice(list(DATA)), 40.0)
first, second = (sphere((x, 0.025, 0.04), 0.004, material=materials["steel"]) for x in (0.022, 0.028))
for k in O.bodies.appendClumped([first, second])[1]:
    kinds[k] = "steel"

laws = {(a, b): pair(a, b) for a in DATA for b in DATA}
memory, worst = {}, {"force": 0.0, "sum": 0.0}
total = {"contacts": set(), "yielded": set(), "steps": 0}

def check():
    sums = {}
    for i in O.interactions:
        key, u = (i.id1, i.id2, i.iterMadeReal), i.geom.penetrationDepth
        radii = [O.bodies[k].shape.radius if isinstance(O.bodies[k].shape, Sphere) else math.inf for k in key[:2]]
        R, law = 1 / sum(1 / r for r in radii), laws[kinds[i.id1], kinds[i.id2]]
        F, _, memory[key] = law.step(R, memory.get(key, 0.0), u)
        peak = law.step(R, memory[key], memory[key])[0]
        worst["force"] = max(worst["force"], abs(i.phys.normalForce.norm() - F) / peak)
        for k, sign in ((i.id1, -1), (i.id2, 1)):
            sums[k] = sums.get(k, Vector3.Zero) + sign * (i.phys.normalForce + i.phys.shearForce)
        total["contacts"].add(key)
        if memory[key] > law.yield_ratio * R:
            total["yielded"].add(key)
    for k, f in sums.items():
        worst["sum"] = max(worst["sum"], (O.forces.f(k) - f).norm() / f.norm() if f.norm() > 1e-3 else 0.0)
    total["steps"] += 1

O.engines, O.dt = engines(watch("check()")), 1e-7
for part in range(6):
    O.run(1000, True)
    ball(0.007 + 0.007 * part, 0.041, 0.041, "brass", 5.0)  # one comes, one goes
    known = [O.bodies[k] for k in kinds if O.bodies[k]]
    O.bodies.erase([b.id for b in known if isinstance(b.shape, Sphere) and not b.isClumpMember][-4])
answer(**worst, steps=total["steps"], **{k: len(total[k]) for k in ("contacts", "yielded")})
"""


@pytest.mark.yade
@pytest.mark.parametrize("law", LAWS)
def test_every_contact_of_a_changing_crowd_follows_the_law(law, tmp_path):
    """Two materials, many sizes, walls, facets, a clump, bodies that come and go: each force in each step, and that
    the sum of the contact forces is what moves the bodies."""
    found = yade(tmp_path, law, SOUP)
    assert found["contacts"] > 30 and found["yielded"] > 20 and found["steps"] == 6000
    assert found["force"] <= (1e-8 if law == "cavity" else 1e-11)  # overlaps are differences of positions
    assert found["sum"] <= 1e-9


SAVED = """
path = []

def record():
    path.append([x.hex() for k in range(1, len(O.bodies)) for x in (*O.forces.f(k), O.bodies[k].state.vel[2])])
"""
SAVING = """
materials = {m: material(m) for m in DATA}
O.bodies.append(wall(0, axis=2, material=materials["steel"]))
for k in range(8):  # eight moments of an impact on the wall, and of one on each other
    label, speed = list(DATA)[k % 2], 2.0 * 1.5**k
    for y, z, r, m in ((0, 0.01, 0.01, label), (0.1, 0.11, 0.01, label), (0.1, 0.126, 0.006, "brass")):
        ball = sphere((0.1 * k, y, z + (1e-7 * speed if z != 0.11 else 0)), r, material=materials[m])
        ball.state.vel = (0, 0, -speed if z != 0.11 else 0)
        O.bodies.append(ball)
O.engines, O.dt = engines(watch("record()")), 1e-7
for n in range(40):
    O.run(20, True)
    if n % 13 == 1:
        O.save(f"{n}.yade.bz2")
straight = path[:]
again = {}
for n in (1, 14, 27):
    O.load(f"{n}.yade.bz2")
    path.clear()
    start = O.iter
    O.run(150, True)
    again[n] = path == straight[start : start + 150]
force = [[abs(float.fromhex(p[4 * k + 2])) for k in range(24)] for p in straight]
moves = [[sum(x > y for x, y in zip(force[n], force[n - 1])), sum(x < y for x, y in zip(force[n], force[n - 1]))]
         for n in (40, 300, 560)]
answer(straight=straight, again=again, moves=moves)
"""
LOADING = """
later = {}
for n in (1, 14, 27):
    path.clear()
    O.load(f"{n}.yade.bz2")
    start = O.iter
    for _ in range(150):
        O.step()
    later[start] = path[:]
answer(later=later)
"""


@pytest.mark.yade("alone")
@pytest.mark.parametrize("law", LAWS)
def test_a_saved_scene_goes_on_to_the_last_bit_here_and_in_another_process(law, tmp_path):
    """Saved while contacts load and unload; the other process knows nothing but the file. (Where a body has several
    contacts a loaded scene may add their forces in another order: then the last digit differs.)"""
    here = yade(tmp_path, law, SAVED + SAVING)
    assert all(here["again"].values())
    assert all(sum(moves) > 3 for moves in zip(*here["moves"], strict=True))  # contacts that load, and that unload
    there = yade(tmp_path, law, SAVED + LOADING)
    for start, path in there["later"].items():
        assert path == here["straight"][int(start) : int(start) + len(path)], start


FAST = """
steel, R, v = material("steel"), 0.01, 20.0
O.bodies.append([wall(0, axis=2, material=steel), sphere((0, 0, R + 1e-7), R, material=steel)])
O.bodies[1].state.vel = (0, 0, -v)
O.engines, O.dt = engines(), 1e-7
while O.bodies[1].state.vel[2] < 0 or O.interactions.countReal():
    O.step()
answer(e_n=O.bodies[1].state.vel[2] / v)
"""


@pytest.mark.yade
@pytest.mark.parametrize(("speed", "e_n"), [("20.0", 0.4830544367755), ("1.0", 0.9476311322744)])
def test_a_contact_is_found_in_its_first_step(speed, e_n, tmp_path):
    """v = 20 m/s passes the yield overlap within 8 steps; e_n is that of eq. 8.83."""
    found = yade(tmp_path, "thornton", FAST.replace("20.0", speed))
    assert abs(found["e_n"] / e_n - 1) < 2e-5
