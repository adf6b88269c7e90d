# SPDX-License-Identifier: GPL-2.0-or-later
"""Setting compaction of ep/cavity in LIGGGHTS: forces, order, energy, contacts alone, restart, refusals."""

import numpy as np
import pytest
from plugin_compaction import alone, data, deck, forces, overlapping, run
from plugin_decks import run as any_run
from plugin_loop import SAID, Scene, outcome

from marks import thorough

pytestmark = pytest.mark.liggghts

HEAVY = 1e15  # density [kg/m^3] of spheres that no contact slows down
# A sphere, five neighbours that press it at unlike speeds and one that only its growth reaches; a wall below all.
RADII = np.array([1.0, 0.8, 1.2, 0.9, 1.1, 1.0])
WAYS = np.array([[0, 0, 0], [1, 0, 0], [-1, 0.05, 0], [0, 1, 0.1], [0, -1, 0], [0.02, 0, 1]], float)
WAYS[1:] /= np.linalg.norm(WAYS[1:], axis=1)[:, None]
GAPS = np.array([0.0, 0.002, 0.003, 0.001, 0.004, 0.004])
SPEEDS = np.array([0.0, 0.13, 0.16, 0.11, 0.15, 0.001])
MOVES = -SPEEDS[:, None] * WAYS - [0.0, 0.0, 0.25]  # all come down to the floor, which nothing touches at the start
FLOOR = -1.205
CLUSTER = WAYS * (RADII[0] + RADII + GAPS)[:, None]


def velocities(v):
    """Lines that set velocities (spheres, 3)."""
    return "".join(f"set atom {k + 1} vx {x!r} vy {y!r} vz {z!r}\n" for k, (x, y, z) in enumerate(v.tolist()))


BACK = velocities(-0.3 * MOVES)


def cluster(folder, steps, *, ranks=1, settings="compaction on", loop=""):
    """Forces at `steps` loading and as many unloading steps, shape (2 steps + 1, 6, 3); one second each."""
    spheres = data(CLUSTER, RADII, MOVES, HEAVY)
    runs = f"run {steps}\n{BACK}run {steps}\n"
    head = "processors 2 1 1\n" if ranks == 2 else ""
    text = deck(settings, walls=[f"zplane {FLOOR!r}"], runs=runs, dt=1.0 / steps, head=head)
    return run(folder, text, spheres, ranks=ranks, env={"EPDEM_LOOP": loop} if loop else None)[:, :, 1:]


def exact(steps):
    """The same by numpy, and the largest force."""
    t = np.concatenate([np.arange(steps + 1) / steps, np.arange(1, steps + 1) / steps])
    first = np.arange(2 * steps + 1) <= steps
    x = CLUSTER + np.where(first, t, 1.0 - 0.3 * t)[:, None, None] * MOVES
    F = forces(x, RADII, [(2, FLOOR)])
    return F, np.abs(F).max()


def assert_second_order(measured):
    """Forces by the number of steps, of which the last is four times the first.

    No step knows of a jump: after the turn, which the extrapolated screening overruns, the error is of first order, and
    where a contact begins or ends it does so a step early or late.
    """
    errors = []
    for steps, found in measured.items():
        F, largest = exact(steps)
        difference = np.abs(found - F).max(axis=(1, 2)) / largest
        assert difference.max() < 1e-3
        assert np.median(difference[steps + 3 :]) < 0.04 / steps
        errors.append(np.median(difference[steps // 2 : steps - 2]))
    assert errors[-1] < 1e-5
    assert np.log2(errors[0] / errors[-1]) / 2 > 1.9, errors


def test_forces_are_those_of_grown_spheres_with_an_error_of_second_order(tmp_path):
    assert_second_order({steps: cluster(tmp_path / str(steps), steps) for steps in (200, 800)})


def test_a_body_without_contacts_forgets_its_pressure(tmp_path):
    """Spheres press another one, leave it and press it again: the forces are the same."""
    press = -SPEEDS[:, None] * WAYS
    runs = f"run 200\n{velocities(-press)}run 300\n{velocities(press)}run 300\n"
    F = run(tmp_path, deck("compaction on", runs=runs, dt=1 / 200), data(CLUSTER, RADII, press, HEAVY))[:, :, 1:]
    assert np.abs(F[-201:] - F[:201]).max() < 1e-9 * np.abs(F).max()


def test_growth_alone_brings_two_spheres_into_contact(tmp_path):
    """The upper sphere stays 3e-3 away and is pressed all the same; without compaction it is not."""
    assert GAPS[5] - SPEEDS[5] > 0
    assert cluster(tmp_path / "on", 400)[400, 5, 2] > 0
    assert cluster(tmp_path / "off", 400, settings="")[400, 5, 2] == 0


def test_both_loops_and_two_ranks_give_the_same_forces(tmp_path):
    ours = cluster(tmp_path / "ours", 200)
    assert np.array_equal(ours, cluster(tmp_path / "generic", 200, loop="generic"))
    assert np.allclose(ours, cluster(tmp_path / "ranks", 200, ranks=2), rtol=1e-12, atol=1e-12 * np.abs(ours).max())


def test_the_two_copies_of_a_pair_at_a_periodic_face_screen_nothing(tmp_path):
    """Their areas differ by round-off, of which the root is 1e-8."""
    x, radius, v = overlapping()
    ends = []
    for settings in ("", "compaction on"):
        text = deck(settings, runs="run 60\n", dt=2e-4, columns="fx fy fz vx vy vz").replace(
            "boundary f f f", "boundary p f f"
        )
        ends.append(run(tmp_path / (settings or "off"), text, data(x, radius, v, 2000.0))[:, :, 1:])
    assert ends[0][5, 0, 0] != 0
    assert (np.abs(ends[1] - ends[0]).max(axis=(0, 1)) <= 1e-12 * np.abs(ends[0]).max(axis=(0, 1))).all()


PACKINGS = [
    Scene(law="cavity", tangential="ep/partial_slip", types=3, settings=("computePlasticWork on", "compaction on")),
    Scene(
        law="cavity",
        rolling="epsd2",
        types=3,
        loose=True,
        ranks=2,
        rebuild=True,
        settings=("viscous on", "compaction on"),
    ),
    Scene(
        law="cavity",
        rolling="cdt",
        freeze=True,
        loose=True,
        walls=True,
        settings=("computePlasticWork on", "compaction on"),
    ),
]


@pytest.mark.parametrize("scene", PACKINGS, ids=str)
def test_the_pair_loop_gives_the_bits_of_liggghts_loop(tmp_path, scene):
    theirs, _ = outcome(tmp_path / "generic", scene, loop="generic")
    ours, text = outcome(tmp_path / "ours", scene)
    assert SAID not in text and np.array_equal(ours, theirs)
    off = Scene(**{**vars(scene), "settings": tuple(s for s in scene.settings if s != "compaction on")})
    without, _ = outcome(tmp_path / "off", off)
    assert not np.array_equal(without[-1][:, :4], ours[-1][:, :4])


@pytest.mark.parametrize(("loop", "ranks"), [("", 1), thorough("", 2), thorough("generic", 1), ("generic", 2)])
def test_contacts_alone_keep_every_bit(tmp_path, ranks, loop):
    """Pairs and spheres at a wall, elastic to fully plastic, with a second impact after the first."""
    order = np.random.default_rng(6).permutation(72)
    spheres = data(*(rows[order] for rows in alone(24)), 2000.0, half=64.0)
    head = "processors 2 1 1\n" if ranks == 2 else ""
    ends = []
    for settings in ("", "compaction on"):
        text = deck(
            settings, walls=["zplane -1.0"], runs="run 3000\n", dt=1e-4, head=head, columns="x y z vx vy vz", every=50
        )
        folder = tmp_path / f"{settings or 'off'}"
        ends.append(run(folder, text, spheres, ranks=ranks, env={"EPDEM_LOOP": loop} if loop else None))
    assert np.array_equal(*ends)
    assert np.abs(ends[0][-1][:, 4:] - ends[0][0][:, 4:]).max(axis=1).min() > 1e-3 * 0.05  # of the slowest


def test_a_pair_beyond_the_reach_of_growth_meets_before_the_next_lists(tmp_path):
    """The gap is narrower than the skin, and growth could not close it."""
    x, v = (np.array([[-side, 0.0, 0.0], [side, 0.0, 0.0]]) for side in (1.14, -1.0))
    ends = []
    for settings in ("", "compaction on"):
        text = deck(settings, runs="run 148\n", dt=1e-3, columns="x y z vx vy vz", every=148)
        text = text.replace("boundary f f f", "boundary p p p")  # without ghosts LIGGGHTS's own loop runs
        ends.append(run(tmp_path / f"{settings or 'off'}", text, data(x, np.ones(2), v, 1000.0, half=3.0))[-1])
    assert np.array_equal(*ends) and np.abs(ends[0][:, 4]).max() < 1.0


def test_a_restart_in_mid_compaction_continues_bit_by_bit(tmp_path):
    spheres = data(CLUSTER, RADII, MOVES, HEAVY)
    walls = [f"zplane {FLOOR!r}"]
    text = deck("compaction on", walls=walls, runs="run 150\nwrite_restart x.restart\nrun 150\n", dt=1 / 300)
    whole = run(tmp_path, text, spheres)
    rest = run(
        tmp_path / "rest",
        deck("compaction on", walls=walls, runs="run 150\n", dt=1 / 300, restart=tmp_path / "x.restart"),
        "",
    )
    assert np.array_equal(whole[-150:], rest[-150:]) and np.abs(rest[-1][:, 1:]).max() > 0


def rebound(folder, steps, phase, every=""):
    """Velocities after four free spheres have pressed a fifth one and left; phase: of the first touch in a step."""
    speed = np.array([0.0, 1.0, 0.8, 0.9, 0.7])[:, None]
    way = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 1], [-1, 0, 0], [0, 0, -1]])
    x = way * (2.0 + (0.001 + phase * 0.6 / steps) * speed)
    text = deck("compaction on", runs=f"run {steps}{every}\n", dt=0.6 / steps, columns="vx vy vz", every=steps)
    return run(folder, text, data(x, np.ones(5), -speed * way, 1000.0))[-1][:, 1:]


def test_rebound_speeds_of_free_spheres_converge_with_second_order(tmp_path):
    """The largest error of three phases. No contact bears a force when another one ends and its dent is forgotten.

    The last error, below 1e-6, is beside the order: it is near that of the fine steps.
    """
    exact_speeds = rebound(tmp_path / "exact", 64000, 0.0)
    numbers = np.array([500, 1000, 2000, 4000, 8000])
    errors = [
        max(np.abs(rebound(tmp_path / f"{n}{phase}", n, phase) - exact_speeds).max() for phase in (0.1, 0.45, 0.8))
        for n in numbers.tolist()
    ]
    order = -np.polyfit(np.log(numbers[:-1]), np.log(errors[:-1]), 1)[0]
    assert order > 1.9 and errors[-1] < 1e-6, (order, errors)


def test_a_run_that_begins_anew_at_each_step_keeps_every_bit(tmp_path):
    """At the begin of a run LIGGGHTS computes the forces of the last step again, and moves the spheres by these."""
    once = rebound(tmp_path / "once", 500, 0.45)
    assert np.array_equal(once, rebound(tmp_path / "anew", 500, 0.45, every=" every 1 NULL"))


def walks(folder, steps, *, count, seed=7):
    """Work, elastic and plastic energy of `count` random walks of six spheres about a seventh: (steps + 1, count).

    A walk approaches by 0.05 R, and oscillates by three sines of up to 0.03 R.
    """
    rng = np.random.default_rng(seed)
    places = 8.0 * np.stack(np.meshgrid(*[np.arange(5.0)] * 3, indexing="ij"), -1).reshape(-1, 3)[:count] - 16.0
    faces = np.concatenate([np.zeros((1, 3)), np.eye(3), -np.eye(3)])
    swing = rng.uniform(0.0, 0.03, (3, count, 7))
    phase = rng.uniform(0.0, 2 * np.pi, (3, count, 7))
    rate = 2 * np.pi * np.array([1.0, 2.3, 4.1])
    x = (places[:, None] + 2.001 * faces).reshape(-1, 3)
    text = "fix way all property/atom way vector no no no" + " 0.0" * 9 + "\nrun 0\n"
    for c in range(count):
        for k in range(7):
            values = [*faces[k].tolist(), *swing[:, c, k].tolist(), *phase[:, c, k].tolist()]
            text += f"set atom {7 * c + k + 1} property/atom way {' '.join(map(repr, values))}\n"
    sines = "+".join(
        f"f_way[{4 + n}]*(sin({w!r}*v_t+f_way[{7 + n}])-sin(f_way[{7 + n}]))" for n, w in enumerate(rate.tolist())
    )
    slopes = "+".join(f"f_way[{4 + n}]*{w!r}*cos({w!r}*v_t+f_way[{7 + n}])" for n, w in enumerate(rate.tolist()))
    text += (
        f"variable t equal step*{1.0 / steps!r}\nvariable s atom -0.05*v_t+{sines}\nvariable u atom -0.05+{slopes}\n"
    )
    for n, axis in enumerate("xyz", 1):
        text += f"variable d{axis} atom f_way[{n}]*v_s\nvariable w{axis} atom f_way[{n}]*v_u\n"
    text += f"unfix move\nfix move all move variable v_dx v_dy v_dz v_wx v_wy v_wz\nrun {steps}\n"
    columns = "x y z fx fy fz f_elasticEnergy f_plasticWork"
    text = deck("compaction on computePlasticWork on", runs=text, dt=1.0 / steps, columns=columns)
    frames = run(folder, text, data(x, np.ones(len(x)), 0 * x, HEAVY, half=22.0))
    frames = frames.reshape(len(frames), count, 7, -1)[:, :, 1:]
    power = -0.5 * ((frames[1:, ..., 4:7] + frames[:-1, ..., 4:7]) * np.diff(frames[..., 1:4], axis=0)).sum((-1, -2))
    work = np.concatenate([np.zeros((1, count)), np.cumsum(power, axis=0)])
    return work, 2 * frames[..., 7].sum(-1), 2 * frames[..., 8].sum(-1)


def falls(work, elastic):
    """Largest fall of the dissipation over the largest work of all walks."""
    lost = work - elastic
    return ((np.maximum.accumulate(lost, axis=0) - lost).max(axis=0) / work.max(axis=0)).max()


def test_random_walks_create_no_energy(tmp_path):
    """Half of the energies of a contact belong to the neighbour, so that twice its share is that of the contact.

    A contact that ends takes its growth from the others, which then store up to 6e-6 of the work more, at any step.
    """
    found, ledger = [], []
    for steps in (3000, 6000):
        work, elastic, plastic = walks(tmp_path / str(steps), steps, count=20)
        found.append(falls(work, elastic))
        ledger.append(np.abs(work - elastic - plastic).max() / work.max())
    assert max(found) < 1e-5, found
    assert ledger[0] < 1e-5 and ledger[1] < ledger[0] / 3, ledger


REFUSED = {
    "law": ("pair_style gran model ep/thornton tangential off compaction on\n", "only ep/cavity has it"),
    "cohesion": ("pair_style gran model ep/cavity tangential off cohesion sjkr compaction on\n", "without cohesion"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_has_no_compaction_is_refused(tmp_path, what):
    line, said = REFUSED[what]
    text = deck("", runs="run 1\n", dt=1e-3).replace("pair_style gran model ep/cavity tangential off \n", line)
    done = any_run(tmp_path, text, files={"spheres.data": data(CLUSTER, RADII, 0 * CLUSTER, 1000.0)})
    assert done.code != 0 and "setting compaction on is not available" in done.error and said in done.error


def test_a_wall_needs_the_setting_of_the_pairs(tmp_path):
    text = deck("", runs="run 1\n", dt=1e-3, walls=["zplane -3 compaction on"])
    done = any_run(tmp_path, text, files={"spheres.data": data(CLUSTER, RADII, 0 * CLUSTER, 1000.0)})
    assert done.code != 0 and "compaction on of a wall needs it for the pair style as well" in done.error


def test_forces_stay_finite_far_beyond_solid(tmp_path):
    """Six neighbours that press a sphere by half of its radius each: S1 = 3."""
    x = np.concatenate([np.zeros((1, 3)), 2.0 * np.concatenate([np.eye(3), -np.eye(3)])])
    frames = run(tmp_path, deck("compaction on", runs="run 500\n", dt=1e-3), data(x, np.ones(7), -x, HEAVY))
    assert np.isfinite(frames).all()
    assert np.abs(frames[-1, 1:, 1:]).max() > 2 * np.abs(frames[100, 1:, 1:]).max()
    assert np.abs(frames[:, :, 1:].sum(axis=1)).max() < 1e-12 * np.abs(frames[..., 1:]).max()  # momentum
