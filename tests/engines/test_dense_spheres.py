# SPDX-License-Identifier: GPL-2.0-or-later
"""Option compaction of cavity and cavity_adhesive: forces, order, energy, contacts alone, ranks, restart."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from dense_spheres import CLUSTER, GAMMA, GAPS, LIKE, MOVES, RADII, SPEEDS, STICKY, WAYS, E, cluster, exact, scene
from dense_spheres import NU as POISSON
from dense_spheres import alone as contacts_alone
from free_spheres import ELASTIC, FORCE, HOSTS, PLASTIC, VELOCITY, frames
from hosts import CLASSES, LAMMPS, LIGGGHTS

from epdem.theory.cavity import Cavity
from marks import thorough

OF_HOST = {"liggghts": None, "lammps": 1e-3, "yade": None}  # skins; that of LAMMPS is below the gaps of growth
every_host = pytest.mark.parametrize("host", HOSTS)
with_adhesion_too = pytest.mark.parametrize("more", [{}, STICKY], ids=["cavity", "cavity_adhesive"])


@pytest.fixture(scope="module")
def pressed(tmp_path_factory):
    """pressed(host, steps, **changes): frames of the cluster, run once."""

    @cache
    def run(host, steps, **changes):
        return frames(host, tmp_path_factory.mktemp(host), cluster(steps, skin=OF_HOST[host], **changes))

    return run


@every_host
def test_forces_are_those_of_grown_spheres_with_an_error_of_second_order(host, pressed):
    """No step knows of a jump: after the turn, which the extrapolated screening and retreat overrun, the error is of
    first order, and where a contact begins or ends it does so a step early or late."""
    errors = []
    for steps in (200, 800):
        F, largest = exact(steps)
        difference = np.abs(pressed(host, steps)[..., FORCE] - F).max(axis=(1, 2)) / largest
        assert np.delete(difference, steps + 1).max() < 1e-3 and difference[steps + 1] < 0.4 / steps
        assert np.median(difference[steps + 3 :]) < 0.04 / steps
        errors.append(np.median(difference[steps // 2 : steps - 2]))
    assert errors[1] < 1e-5
    assert np.log2(errors[0] / errors[1]) / 2 > 1.9, errors


@every_host
def test_forces_with_adhesion_are_those_of_a_superposed_punch(host, pressed):
    """F_b - 2 E* a d at alpha_b - d, F_b with growth, solved with the sums of each step itself. The step in which a
    contact yields scatters the order: 1.77 between these steps."""
    errors = []
    for steps in (200, 800):
        F, largest = exact(steps, **STICKY)
        difference = np.abs(pressed(host, steps, **STICKY)[..., FORCE] - F).max(axis=(1, 2)) / largest
        errors.append(np.median(difference[steps // 2 : steps - 2]))
        assert np.delete(difference, steps + 1).max() < 1e-3
        assert np.median(difference[steps + 3 :]) < 0.04 / steps
    assert errors[1] < 1e-5
    assert np.log2(errors[0] / errors[1]) / 2 > 1.6, errors


@every_host
def test_without_attraction_the_adhesive_law_is_cavity(host, pressed):
    """Where contacts part and form again, too: to the round-off of another formula of the opening."""
    plain, none = (pressed(host, 200, **more)[..., FORCE] for more in ({}, {"Gamma": 0.0}))
    assert np.abs(plain - none).max() <= 1e-11 * np.abs(plain).max()


@every_host
def test_growth_alone_brings_two_spheres_into_contact(host, pressed):
    """The upper sphere stays 3e-3 away and is pressed all the same; without compaction it is not."""
    assert GAPS[5] - SPEEDS[5] > 0
    assert pressed(host, 200)[200, 5, FORCE][2] > 0 == pressed(host, 200, compaction=False)[200, 5, FORCE][2]


@pytest.mark.liggghts
@pytest.mark.parametrize("host", [LAMMPS, CLASSES])
@pytest.mark.parametrize("more", [{}, STICKY, {"Gamma": GAMMA}], ids=["cavity", "cavity_adhesive", "parting"])
def test_forces_are_those_of_liggghts(more, host, pressed):
    """YADE: areas of contacts that have just yielded, under a root, make more of round-off."""
    found, other = (pressed(name, 200, **more)[..., FORCE] for name in (host, "liggghts"))
    assert np.abs(found - other).max() <= {"lammps": 1e-12, "yade": 1e-8}[host] * np.abs(other).max()


@every_host
@with_adhesion_too
def test_plastic_work_and_elastic_energy_are_the_work_of_the_spheres(more, host, pressed):
    """The floor rests. What adhesion loses at touch is below the limit."""
    found = pressed(host, 800, **more)
    F, energy = found[..., FORCE], found[..., [PLASTIC, ELASTIC]].sum(axis=(1, 2))
    rate = np.where(np.arange(1600) < 800, 1.0, -more.get("back", 0.3))[:, None, None] * MOVES / 800
    work = -np.cumsum((0.5 * (F[1:] + F[:-1]) * rate).sum(axis=(1, 2)))
    assert np.abs(work - energy[1:] + energy[0]).max() < 2e-4 * work.max()


CHANGES = {  # and the largest difference of forces
    "liggghts-loop": (LIGGGHTS, {"loop": "generic"}, 0.0),
    "liggghts-ranks": (LIGGGHTS, {"ranks": 2}, 1e-12),
    "lammps-ranks": (LAMMPS, {"ranks": 2}, 1e-12),
    "yade-threads": (CLASSES, {"ranks": 2}, 1e-12),
    "yade-facet": (CLASSES, {"floor": "facet"}, 1e-10),
    "yade-box": (CLASSES, {"floor": "box"}, 1e-10),
}


@pytest.mark.parametrize(
    ("host", "change", "limit"),
    [pytest.param(*host.values, change, x, marks=host.marks, id=k) for k, (host, change, x) in CHANGES.items()],
)
@with_adhesion_too
def test_loops_ranks_threads_and_shapes_of_the_floor_change_no_force(more, host, change, limit, pressed):
    one, other = pressed(host, 200, **more)[..., FORCE], pressed(host, 200, **more, **change)[..., FORCE]
    assert np.abs(one - other).max() <= limit * np.abs(one).max()


@pytest.mark.liggghts
def test_friction_and_growth_of_contacts_that_part_are_those_of_liggghts_own_loop(pressed):
    """A body that lies loose in its dent begins anew in friction, not in growth."""
    more = {"Gamma": GAMMA, "tangential": "history", "friction": 0.3}
    ours, own = (pressed("liggghts", 200, loop=loop, **more)[..., FORCE] for loop in ("", "generic"))
    assert np.array_equal(ours, own) and ours.any()


@pytest.mark.parametrize("host", [LIGGGHTS, LAMMPS])
@pytest.mark.parametrize("Gamma", [None, GAMMA])
def test_two_runs_and_a_restart_are_one_run(Gamma, host, tmp_path):
    """After a restart frame 151 is the evaluation before the first step of the run."""
    more = {"plane": 0, "steps": 300, "skin": OF_HOST[host], "Gamma": Gamma}
    whole = scene(CLUSTER, MOVES, radius=RADII, dt=1.0 / 300, **more)
    parts = replace(whole, piece=150)
    scenes = whole, parts, replace(parts, restart=True)
    once, two, again = (frames(host, tmp_path / str(k), s)[..., FORCE] for k, s in enumerate(scenes))
    assert np.array_equal(again[150], again[151]) and np.array_equal(np.delete(again, 151, axis=0), two)
    assert np.abs(two - once).max() < 1e-12 * np.abs(once).max()


@every_host
def test_a_body_without_contacts_forgets_its_pressure(host, tmp_path):
    """Spheres press another one, leave it and press it again: the forces are the same."""
    press = -SPEEDS[:, None] * WAYS
    moves = (press, 200), (-press, 300), (press, 300)
    F = frames(host, tmp_path, scene(CLUSTER, press, radius=RADII, dt=1 / 200, moves=moves))[..., FORCE]
    assert np.abs(F[-201:] - F[:201]).max() < 1e-9 * np.abs(F).max() > 0


ALONE = {
    "liggghts": (LIGGGHTS, {}),
    "liggghts, ranks": (LIGGGHTS, {"ranks": 2}),
    "liggghts, loop": (LIGGGHTS, {"loop": "generic"}),
    "liggghts, loop, ranks": (LIGGGHTS, {"loop": "generic", "ranks": 2}),
    "lammps": (LAMMPS, {}),
    "lammps, ranks": (LAMMPS, {"ranks": 2}),
    **{f"yade, {floor}": (CLASSES, {"floor": floor}) for floor in ("plane", "facet", "box")},
}


@pytest.mark.parametrize(
    ("host", "more"),
    [thorough(*h.values, m, unless=k.count(",") != 1 or "y" in k, marks=h.marks, id=k) for k, (h, m) in ALONE.items()],
)
@pytest.mark.parametrize("Gamma", [None, GAMMA / 10])
def test_contacts_alone_keep_every_bit(Gamma, host, more, tmp_path):
    """Pairs and spheres at the floor, elastic to fully plastic, with second impacts on the floor after the first."""
    x, radius, v = contacts_alone(12)
    more = more | {"Gamma": Gamma}
    falls = scene(x, v, radius=radius, density=2000.0, dt=1e-4, steps=3000, every=20, plane=0, gravity=20.0, **more)
    on, off = (frames(host, tmp_path / str(c), replace(falls, compaction=c)) for c in (True, False))
    assert np.array_equal(on[..., :6], off[..., :6])
    # with compaction by the forces at both ends of a step, else in closed form
    assert np.abs(on[..., PLASTIC] - off[..., PLASTIC]).max() <= 3e-6 * off[..., PLASTIC].max()
    touches = (np.diff((off[..., ELASTIC] != 0).astype(int), axis=0) == 1).sum(axis=0)
    assert touches.min() == 1 < touches.max() and (off[-1, :, PLASTIC] > 0).sum() > 12


def overlapping():
    """Places and velocities of a pair that overlaps beyond yield through the faces x = -4 and 4 and turns."""
    apart = 1.93
    x = np.array([[4.0 - 0.48 * apart, 0.1, 0.2], [-4.0 + 0.52 * apart, 0.13, 0.11]])
    return x, np.array([[1.5, 0.9, -0.4], [-1.2, -1.1, 0.7]])


@pytest.mark.parametrize("host", [LIGGGHTS, LAMMPS])
@pytest.mark.parametrize("face", ["f", "p"])
def test_a_pair_that_overlaps_at_the_start_keeps_its_law_through_a_periodic_face_too(face, host, tmp_path):
    """No growth by its own dent in the first step, and none by what its two copies differ in: areas by round-off, of
    which the root is 1e-8."""
    (x, v), room = overlapping(), {"boundary": f"{face} f f", "half": 4.0 if face == "p" else 8.0}
    x[0, 0] -= 8.0 * (face == "f")
    pair = scene(x, v, radius=[1.0, 1.1], density=2000.0, dt=2e-4, steps=60, **room)
    on, off = (frames(host, tmp_path / str(c), replace(pair, compaction=c)) for c in (True, False))
    assert off[5, 0, FORCE][0] != 0
    for part in (FORCE, VELOCITY):
        largest = np.abs(off[..., part]).max(axis=(0, 1))
        assert (np.abs(on - off)[..., part].max(axis=(0, 1)) <= 1e-12 * largest).all()


@pytest.mark.liggghts
def test_a_pair_beyond_the_reach_of_growth_meets_before_the_next_lists(tmp_path):
    """The gap is narrower than the skin, and growth could not close it. Without ghosts LIGGGHTS's own loop runs."""
    x, v = (np.array([[-side, 0.0, 0.0], [side, 0.0, 0.0]]) for side in (1.14, -1.0))
    pair = scene(x, v, density=1000.0, dt=1e-3, steps=148, every=148, boundary="p p p", half=3.0, skin=0.3)
    on, off = (frames("liggghts", tmp_path / str(c), replace(pair, compaction=c))[-1] for c in (True, False))
    assert np.array_equal(on[:, :6], off[:, :6]) and np.abs(off[:, 3]).max() < 1.0


@every_host
@pytest.mark.parametrize("steps", [7, 200])
def test_plastic_work_of_the_steps_sums_up_to_that_of_the_law(steps, host, tmp_path):
    """A heavy pair that reaches an overlap of 0.2 R in few long steps and in short ones, without compaction."""
    x, v = np.array([[-1.0, 0, 0], [1.0, 0, 0]]), np.array([[0.1, 0, 0], [-0.1, 0, 0]])
    pair = scene(x, v, density=1e20, compaction=False, dt=1.0 / steps, steps=steps, every=steps)
    end = frames(host, tmp_path, pair)[-1]
    law = Cavity(E_star=E / (1 - POISSON**2) / 2, R_star=0.5, Y=LIKE["yieldStress"], c_strain=0.82, share=0.5)
    assert end[:, PLASTIC].sum() == pytest.approx(law.plastic_work(2 + end[0, 0] - end[1, 0]), rel=1e-9)


def rebound(steps, phase, **more):
    """Four free spheres press a fifth one and leave; phase: of the first touch in a step."""
    speed = np.array([0.0, 1.0, 0.8, 0.9, 0.7])[:, None]
    way = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 0, -1]])
    x = way * (2.0 + (0.001 + phase * 0.6 / steps) * speed)
    return scene(x, -speed * way, density=1000.0, dt=0.6 / steps, steps=steps, every=steps, **more)


@pytest.mark.liggghts
def test_rebound_speeds_of_free_spheres_converge_with_second_order(tmp_path):
    """The largest error of three phases. No contact bears a force when another one ends and its dent is forgotten. The
    last error, below 1e-6, is beside the order: it is near that of the fine steps."""

    def speeds(steps, phase):
        return frames("liggghts", tmp_path / f"{steps}{phase}", rebound(steps, phase))[-1, :, VELOCITY]

    fine, numbers = speeds(64000, 0.0), [500, 1000, 2000, 4000, 8000]
    errors = [max(np.abs(speeds(n, phase) - fine).max() for phase in (0.1, 0.45, 0.8)) for n in numbers]
    order = -np.polyfit(np.log(numbers[:-1]), np.log(errors[:-1]), 1)[0]
    assert order > 1.9 and errors[-1] < 1e-6, (order, errors)


@pytest.mark.parametrize("host", [LIGGGHTS, LAMMPS])
def test_a_run_that_begins_anew_at_each_step_is_the_whole_run(host, tmp_path):
    """LIGGGHTS computes the forces of the last step again, and moves the spheres by these: every bit."""
    once, anew = (frames(host, tmp_path / str(n), rebound(500, 0.45, piece=n))[-1, :, VELOCITY] for n in (0, 1))
    assert np.abs(once - anew).max() <= {"liggghts": 0.0, "lammps": 1e-10}[host] and once.any()


@every_host
def test_forces_stay_finite_far_beyond_solid(host, tmp_path):
    """Six neighbours that press a sphere by half of its radius each: S1 = 3."""
    x = np.concatenate([np.zeros((1, 3)), 2.0 * np.concatenate([np.eye(3), -np.eye(3)])])
    F = frames(host, tmp_path, scene(x, -x, dt=1e-3, moves=((-x, 500),)))[..., FORCE]
    assert np.isfinite(F).all()
    assert np.abs(F[-1, 1:]).max() > 2 * np.abs(F[100, 1:]).max()
    assert np.abs(F.sum(axis=1)).max() < 1e-12 * np.abs(F).max()  # momentum
