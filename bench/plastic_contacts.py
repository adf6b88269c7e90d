# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes data/plastic_contacts: ten tests of plastic contacts with their references, which call no contact law.

The closed forms are below; the states during an impact come from scipy's integrator with them. docs/evidence.md
explains the files.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import OptimizeResult, brentq

from epdem.theory.partial_slip import rebound
from epdem.theory.thornton import Thornton

FOLDER = Path(__file__).parents[1] / "data/plastic_contacts"
# two spheres of one steel, in the last test one of them of brass
RADIUS, DENSITY, YOUNG, POISSON, P_Y, FRICTION = 5e-3, 7850.0, 208e9, 0.3, 2.8e9, 0.3
R_STAR, MASS = RADIUS / 2, DENSITY * 4 / 3 * np.pi * RADIUS**3
BRASS = dict(emod2=100e9, poisson2=0.35, pyield2=0.84e9)  # density of steel, so that both move alike
E_STAR, G_STAR = YOUNG / 2 / (1 - POISSON**2), YOUNG / 4 / (2 - POISSON) / (1 + POISSON)
STEPS = 500  # of a contact
# from sphere j to sphere i, and along the shear: no axis of any code
NORMAL, ALONG = np.array([1.0, 2.0, 2.0]) / 3, np.array([2.0, 1.0, -2.0]) / 3


@dataclass(frozen=True)
class Law:
    """Thornton's law, exponent = 0, or one whose pressure grows as p_y (a/a_y)^exponent [N, m, J]."""

    exponent: float = 0.0
    E_star: float = E_STAR
    p_y: float = P_Y

    @property
    def yield_overlap(self) -> float:
        return R_STAR * (np.pi * self.p_y / (2 * self.E_star)) ** 2

    @property
    def _at_yield(self) -> tuple[float, float]:
        force = 4 / 3 * self.E_star * np.sqrt(R_STAR) * self.yield_overlap**1.5
        return force, 0.4 * force * self.yield_overlap

    def force(self, overlap: float) -> float:
        """While the contact loads."""
        n, q = 2 + self.exponent, np.sqrt(overlap / self.yield_overlap)
        return self._at_yield[0] * (q**3 if q <= 1 else 1 + 3 / n * (q**n - 1))

    def work(self, overlap: float) -> float:
        n, q = 2 + self.exponent, np.sqrt(overlap / self.yield_overlap)
        more = (1 - 3 / n) * (q**2 - 1) + 6 / n / (n + 2) * (q ** (n + 2) - 1)
        return self._at_yield[1] * (q**5 if q <= 1 else 1 + 2.5 * more)

    def recovered(self, peak: float) -> float:
        """Overlap that is recovered from a peak, elastically with the radius a^2 = R* peak."""
        return 0.75 * self.force(peak) / (self.E_star * np.sqrt(R_STAR * peak))

    def unloading(self, overlap: float, peak: float) -> float:
        """Force on the way back from a peak: Hertz with the radius that fits force and contact radius at the peak."""
        left = 1 - (peak - overlap) / self.recovered(peak)
        return self.force(peak) * max(left, 0.0) ** 1.5

    @property
    def yield_speed(self) -> float:
        return float(np.sqrt(4 * self._at_yield[1] / MASS))


@dataclass(frozen=True)
class Impact:
    """A head-on impact of both spheres at this relative speed [m/s], from first touch at t = 0."""

    law: Law
    speed: float

    @cached_property
    def peak(self) -> float:
        work = MASS * self.speed**2 / 4
        return float(brentq(lambda d: self.law.work(d) - work, 0.0, RADIUS, xtol=1e-18, rtol=1e-14))

    @property
    def e_n(self) -> float:
        """In closed form: half-ellipse of pressure, work 0.4 F times the recovered overlap."""
        given_back = 0.4 * self.law.force(self.peak) * self.law.recovered(self.peak)
        return float(np.sqrt(given_back / self.law.work(self.peak)))

    @cached_property
    def _branches(self) -> tuple:
        def path(force: Callable[[float], float], start: tuple[float, float], end: Callable) -> OptimizeResult:
            end.terminal = True  # type: ignore[attr-defined]
            found = solve_ivp(
                lambda t, y: (y[1], -force(y[0]) / (MASS / 2)),
                (0.0, 1e-3),
                start,
                "DOP853",
                dense_output=True,
                events=end,
                rtol=1e-12,
                atol=1e-16,
                max_step=np.pi * self.peak / self.speed / 50,
            )
            return found

        residual = self.peak - self.law.recovered(self.peak)
        load = path(lambda d: self.law.force(max(d, 0.0)), (0.0, self.speed), lambda t, y: y[1])
        back = path(
            lambda d: self.law.unloading(d, self.peak),
            (self.peak, 0.0),
            lambda t, y: y[0] - residual - 1e-9 * self.peak,
        )
        return load, back

    @property
    def loading_time(self) -> float:
        return float(self._branches[0].t[-1])

    @property
    def contact_time(self) -> float:
        return self.loading_time + float(self._branches[1].t[-1])

    def state(self, time: float) -> tuple[float, float]:
        """Overlap [m], negative while apart, and speed of approach [m/s]."""
        load, back = self._branches
        if time < 0:
            return self.speed * time, self.speed
        if time < self.loading_time:
            return tuple(load.sol(time))
        if time < self.contact_time:
            return tuple(back.sol(time - self.loading_time))
        left = self.peak - self.law.recovered(self.peak)
        return left - self.e_n * self.speed * (time - self.contact_time), -self.e_n * self.speed


@dataclass(frozen=True)
class Grazing:
    """An impact in a plane that slides throughout, `tangent` times as fast across as along, from first touch at t = 0.

    The line of centres turns. A state is the place (2) [m] of sphere i against j, its velocity (2) [m/s] and the spin
    [rad/s] of both; the first axis is the first normal, from j to i.
    """

    law: Law
    speed: float
    tangent: float

    def overlap(self, state: np.ndarray) -> np.ndarray:
        return 2 * RADIUS - np.hypot(state[0], state[1])

    def loads(self, state: np.ndarray, peak: float | None) -> tuple[np.ndarray, float]:
        """Force (2) [N] on sphere i and torque [N m] on both; peak: overlap [m] from which the contact unloads."""
        overlap = float(self.overlap(state))
        n = state[:2] / (2 * RADIUS - overlap)
        along, arm = np.array([-n[1], n[0]]), RADIUS - 0.5 * overlap
        force = self.law.force(max(overlap, 0.0)) if peak is None else self.law.unloading(overlap, peak)
        friction = FRICTION * force * np.sign(state[2:4] @ along - 2 * arm * state[4])
        return force * n - friction * along, arm * friction

    @cached_property
    def _branches(self) -> tuple:
        def path(start: np.ndarray, peak: float | None, end: Callable) -> OptimizeResult:
            def rates(t: float, state: np.ndarray) -> np.ndarray:
                force, torque = self.loads(state, peak)
                return np.array([*state[2:4], *(2 * force / MASS), torque / (0.4 * MASS * RADIUS**2)])

            end.terminal, end.direction = True, 1  # type: ignore[attr-defined]
            scale = np.array([RADIUS, RADIUS, self.speed, self.speed, self.speed / RADIUS])
            limit = Impact(self.law, self.speed).contact_time
            return solve_ivp(
                rates, (0.0, 3 * limit), start, "DOP853", dense_output=True, events=end, rtol=1e-12,
                atol=1e-15 * scale, max_step=limit / 100,
            )  # fmt: skip

        start = np.array([2 * RADIUS, 0.0, -self.speed, self.tangent * self.speed, 0.0])
        load = path(start, None, lambda t, y: y[:2] @ y[2:4])
        peak = float(self.overlap(load.y[:, -1]))
        residual = peak - self.law.recovered(peak) + 1e-9 * peak
        return load, path(load.y[:, -1], peak, lambda t, y: residual - self.overlap(y)), peak

    @property
    def loading_time(self) -> float:
        return float(self._branches[0].t[-1])

    @property
    def contact_time(self) -> float:
        return self.loading_time + float(self._branches[1].t[-1])

    def state(self, time: float) -> np.ndarray:
        load, back, _ = self._branches
        if time <= self.loading_time:
            state = load.sol(max(time, 0.0))
        else:
            state = back.sol(min(time, self.contact_time) - self.loading_time)
        free = time - min(max(time, 0.0), self.contact_time)
        return state + free * np.array([*state[2:4], 0.0, 0.0, 0.0])

    def motion(self) -> str:
        """The prescribed motion, a peak at a sample."""
        dt, peak = self.contact_time / 100, self._branches[2]
        steps = np.arange(-int(self.loading_time / dt) - 10, int((self.contact_time - self.loading_time) / dt) + 10)
        rows, up = [], np.cross(NORMAL, ALONG)
        for k in steps:
            time = self.loading_time + k * dt
            state = self.state(time)
            apart = not 0 < time < self.contact_time
            force, torque = (np.zeros(2), 0.0) if apart else self.loads(state, peak if k > 0 else None)
            x, v, f = (0.5 * (a[0] * NORMAL + a[1] * ALONG) for a in (state[:2], state[2:4], 2 * force))
            spin, turning = state[4] * up, torque * up
            rows.append([(k - steps[0]) * dt, *x, *-x, *v, *-v, *spin, *spin, *f, *-f, *turning, *turning])
        return table(np.array(rows))


@dataclass
class Motion:
    """Prescribed overlap and shear [m] of every step [s], with normal force and friction [N] on sphere i."""

    time_step: float
    overlap: np.ndarray
    force: np.ndarray
    closing: np.ndarray | None = None  # speed of approach; None: steps of the path over the time step
    shear: np.ndarray = field(default_factory=lambda: np.zeros(1))
    friction: np.ndarray = field(default_factory=lambda: np.zeros(1))

    def text(self) -> str:
        n = len(self.overlap)
        shear, friction = np.broadcast_to(self.shear, n)[:, None], np.broadcast_to(self.friction, n)[:, None]
        closing = self.closing if self.closing is not None else np.diff(self.overlap, prepend=self.overlap[0])
        closing = closing if self.closing is not None else closing / self.time_step
        half = 0.5 * ((2 * RADIUS - self.overlap)[:, None] * NORMAL + shear * ALONG)
        slip = np.diff(shear, axis=0, prepend=shear[:1]) / self.time_step
        speed = 0.5 * (slip * ALONG - closing[:, None] * NORMAL)
        force = self.force[:, None] * NORMAL - friction * ALONG
        torque = (RADIUS - 0.5 * self.overlap)[:, None] * friction * np.cross(NORMAL, ALONG)
        still = np.zeros((n, 3))
        time = self.time_step * np.arange(n)[:, None]
        return table(np.hstack([time, half, -half, speed, -speed, still, still, force, -force, torque, torque]))


def table(rows: np.ndarray) -> str:
    """A CSV file of the motion of spheres i and j with forces and torques."""
    names = "t,x_i,x_j,v_i,v_j,omega_i,omega_j,F_i,F_j,T_i,T_j\n"
    return names + "".join(",".join(f"{x:.15g}" for x in row) + "\n" for row in (rows + 0.0).tolist())


def of_impacts(impacts: list[Impact]) -> Motion:
    """The motion of impacts in a row, a peak at a sample; the second impact begins anew."""
    overlap, closing, force = [], [], []
    dt = impacts[0].contact_time / 100
    for impact in impacts:
        before = int(impact.loading_time / dt) + 10
        times = impact.loading_time + dt * np.arange(
            -before, int((impact.contact_time - impact.loading_time) / dt) + 10
        )
        for t in times:
            d, v = impact.state(float(t))
            d = impact.peak if abs(t - impact.loading_time) < 1e-3 * dt else d
            loads = impact.law.force(max(d, 0.0)) if t <= impact.loading_time else 0.0
            overlap.append(d)
            closing.append(v)
            force.append(loads if t <= impact.loading_time else impact.law.unloading(d, impact.peak))
    return Motion(dt, np.array(overlap), np.array(force), np.array(closing))


def of_unloading(law: Law, peak: float) -> Motion:
    """To the peak, half-way back, to the peak again, and apart."""
    back = law.recovered(peak)
    corners = [-0.05 * peak, peak, peak - 0.5 * back, peak, peak - 1.2 * back]
    steps = np.cumsum([0, 50, 20, 20, 40])
    overlap = np.interp(np.arange(steps[-1] + 1), steps, corners)
    force = [law.force(max(d, 0.0)) if k <= steps[1] else law.unloading(d, peak) for k, d in enumerate(overlap)]
    return Motion(1e-6, overlap, np.array(force))


def of_shear(law: Law, overlap: float) -> Motion:
    """Under constant load shear forth and back by 0.6 of the shear that slides everywhere (Mindlin, Deresiewicz)."""
    load, radius = law.force(overlap), np.sqrt(R_STAR * overlap)
    limit = 3 * FRICTION * load / (16 * G_STAR * radius)
    turn, steps = 0.6 * limit, np.cumsum([0, 40, 30, 60, 30])
    shear = np.interp(np.arange(steps[-1] + 1), steps, [0.0, 0.0, turn, -turn, 0.0])
    depth = np.interp(np.arange(steps[-1] + 1), steps[:2], [-0.05 * overlap, overlap])

    def from_rest(s: np.ndarray) -> np.ndarray:
        return FRICTION * load * (1 - (1 - s / limit) ** 1.5)

    at_turn = from_rest(np.array(turn))
    forth = from_rest(np.maximum(shear, 0.0))
    back = at_turn - 2 * from_rest((turn - shear) / 2)
    again = -at_turn + 2 * from_rest((turn + shear) / 2)
    step = np.arange(len(shear))
    friction = np.where(step <= steps[2], forth, np.where(step <= steps[3], back, again))
    force = np.array([law.force(max(d, 0.0)) for d in depth])
    return Motion(1e-6, depth, force, shear=shear, friction=friction)


def number(x: float) -> str:
    return f"{x:.12g}"


def rows(values: list[tuple[np.ndarray, np.ndarray]]) -> str:
    """Lines of vectors of both spheres after each segment."""
    return "".join(
        f"    {segment} {body + 1:3d} " + " ".join(f"{x + 0.0:24.16e}" for x in vector) + "\n"
        for segment, both in enumerate(values)
        for body, vector in enumerate(both)
    )


def yaml(
    description: str,
    *,
    law: str,
    variables: dict[str, float],
    segments: list[int],
    states: dict[str, list[tuple[np.ndarray, np.ndarray]]],
    epsilon: float,
    closed: bool = True,
    start: str = "-${vin} 0.0 0.0",
    walls: str = "",
) -> str:
    """A test in the form of LAMMPS's unittest/granular."""
    common = dict(diam=2 * RADIUS, radius=RADIUS, dens=DENSITY, emod=YOUNG, poisson=POISSON, pyield=P_Y)
    given = "".join(f"  {name} {number(value)}\n" for name, value in (common | variables).items())
    lift = "${lift}" if "lift" in variables else "0.0"
    types = 2 if "emod2" in variables else 1
    return f"""---
# {description}
lammps_version: 22 Jul 2025
tags: granular, plastic
date_generated: Mon Nov 23 2026
epsilon: {epsilon:g}
skip_tests:
prerequisites: |
  atom sphere
  pair ep
pre_commands: |
  units si
  dimension 3
  boundary f f f
  atom_style sphere
  region box block -0.05 0.05 -0.03 0.03 -0.03 0.03 units box
  create_box {types} box
  create_atoms 1 single -${{sep}} -{lift} 0.0 units box
  create_atoms {types} single  ${{sep}} {lift} 0.0 units box
  set group all diameter ${{diam}} density ${{dens}}
  group left id 1
  group right id 2
  velocity left set {start.replace("-", "")}
  velocity right set {start}
  comm_modify vel yes
  neighbor 0.001 bin
  neigh_modify delay 0
  timestep ${{dt}}
post_commands: |
  fix integr all nve/sphere
{walls}input_file:
natoms: 2
variables: |
{given}pair_style: ep
pair_coeff: |
  {law}
run_segments: |-
  {" ".join(map(str, np.diff([0, *segments])))}
analytic_enable: {"yes" if closed else "no"}
analytic_model: collision_restitution
analytic_tol: 1e-4
analytic_segment: {len(segments) - 1}
{"".join(f"run_{name}: |2{chr(10)}{rows(values)}" for name, values in states.items())}...
"""


def head_on(law: Law, speeds: list[float], text: str, description: str) -> str:
    """Impacts in a row: between two of them a plane that reflects the centres sends each sphere back."""
    first = Impact(law, speeds[0])
    impacts = [Impact(law, v) for v in speeds]
    dt = float(f"{first.contact_time / STEPS:.3g}")
    gap = 20.5 * first.speed * dt
    begins = [gap / first.speed]
    variables = dict(exponent=law.exponent) if law.exponent else {}
    e_n = float(np.prod([impact.e_n for impact in impacts]))
    variables |= dict(vin=speeds[0] / 2, sep=RADIUS + gap / 2, dt=dt, en=e_n, force_tol=1e-8)
    walls = ""
    if len(impacts) > 1:
        # the spheres are apart by `away` when their centres reach the planes, and go back to first touch
        speed, left = first.e_n * first.speed, first.peak - law.recovered(first.peak)
        away = 0.3 * first.contact_time * speed
        variables["xplane"] = RADIUS + away / 2
        begins.append(begins[0] + first.contact_time + (left + 2 * away) / speed)
        walls = "  fix planes all wall/reflect xlo -${xplane} xhi ${xplane}\n"
    variables |= dict(v_y=law.yield_speed, force_max=law.force(first.peak), overlap_max=first.peak)
    variables |= dict(residual_overlap=first.peak - law.recovered(first.peak), contact_time=first.contact_time)
    segments, positions, velocities = [], [], []
    for impact, start in zip(impacts, begins, strict=True):
        unloading = impact.contact_time - impact.loading_time
        for at in (0.5 * impact.loading_time, impact.loading_time + 0.5 * unloading, 1.05 * impact.contact_time):
            segments.append(round((start + at) / dt))
            overlap, v = impact.state(segments[-1] * dt - start)
            positions.append(tuple(np.array([side * (RADIUS - overlap / 2), 0, 0]) for side in (-1, 1)))
            velocities.append(tuple(np.array([-side * v / 2, 0, 0]) for side in (-1, 1)))
    states = dict(pos=positions, vel=velocities)
    return yaml(description, law=text, variables=variables, segments=segments, states=states, epsilon=1e-4, walls=walls)


def oblique(law: Law, speed: float, tangent: float, text: str, description: str) -> str:
    """Both spheres also pass each other; velocities and spins afterwards from 400 springs with partial slip."""
    impact, vt = Impact(law, speed), speed * tangent
    (slip,) = rebound(
        Thornton(E_star=E_STAR, R_star=R_STAR, p_y=P_Y), m_star=MASS / 2, m_tangential=MASS / 7, mu=FRICTION,
        G_star=G_STAR, v_n=speed, slip=np.array([vt]),
    )  # fmt: skip
    dt = float(f"{impact.contact_time / STEPS:.3g}")
    gap = 20.5 * speed * dt
    variables = dict(xmu=FRICTION, vn_in=speed / 2, vt_in=vt / 2, sep=RADIUS + gap / 2, lift=gap / 2 * tangent, dt=dt)
    variables |= dict(en=impact.e_n, slip_out=float(slip), force_tol=0.01, v_y=law.yield_speed)
    lost = (vt - float(slip)) / 7  # the impulse, m_tangential times the change of slip, over the mass
    velocity = np.array([-impact.e_n * speed / 2, vt / 2 - lost, 0.0])
    spin = np.array([0.0, 0.0, -2.5 * lost / RADIUS])
    states = dict(vel=[(velocity, -velocity)], omega=[(spin, spin)])
    segments = [round((gap / speed + 1.05 * impact.contact_time) / dt)]
    start = "-${vn_in} -${vt_in} 0.0"
    return yaml(
        description, law=text, variables=variables, segments=segments, states=states, epsilon=0.01, closed=False,
        start=start,
    )  # fmt: skip


def grazing(impact: Grazing, text: str, description: str, more: dict[str, float]) -> str:
    """Both spheres slide over each other throughout and turn; places, velocities and spins afterwards."""
    speed, dt = impact.speed, float(f"{impact.contact_time / STEPS:.3g}")
    gap = 20.5 * speed * dt
    lift = gap / 2 * impact.tangent
    variables = dict(xmu=FRICTION, vn_in=speed / 2, vt_in=speed / 2 * impact.tangent, sep=RADIUS + gap / 2, lift=lift)
    variables |= dict(dt=dt, force_tol=1e-8, v_y=impact.law.yield_speed) | more
    segments = [round((gap / speed + 1.05 * impact.contact_time) / dt)]
    state = impact.state(segments[0] * dt - gap / speed)
    place, velocity = (0.5 * np.array([-a[0], a[1], 0.0]) for a in (state[:2], state[2:4]))  # the first normal is -x
    spin = np.array([0.0, 0.0, -state[4]])
    states = dict(pos=[(place, -place)], vel=[(velocity, -velocity)], omega=[(spin, spin)])
    start = "-${vn_in} -${vt_in} 0.0"
    return yaml(
        description, law=text, variables=variables, segments=segments, states=states, epsilon=1e-4, closed=False,
        start=start,
    )  # fmt: skip


def cases() -> dict[str, tuple[str, str]]:
    """(YAML, CSV) of each case."""
    thornton, hard = Law(), Law(0.25)
    plain, hardening = "* * thornton ${emod} ${poisson} ${pyield}", "* * meyer ${emod} ${poisson} ${pyield} ${exponent}"
    slips, v_y = plain + " tangential partial_slip ${xmu}", thornton.yield_speed
    found = {}
    for name, ratio in (
        ("below_yield", 0.5),
        ("at_yield", 1.0),
        ("ten_times_yield", 10.0),
        ("hundred_times_yield", 100.0),
    ):
        speed = [ratio * v_y]
        said = f"impact at {ratio:g} v_y"
        found[name] = head_on(thornton, speed, plain, said), of_impacts([Impact(thornton, ratio * v_y)])
    first = Impact(thornton, 10 * v_y)
    pair = [first, Impact(thornton, first.e_n * first.speed)]
    said = "two impacts in a row, each a new contact, the first one at 10 v_y"
    found["two_impacts"] = head_on(thornton, [x.speed for x in pair], plain, said), of_impacts(pair)
    said = "unloading from the peak of an impact at 30 v_y"
    deep = Impact(thornton, 30 * v_y)
    found["unloading"] = head_on(thornton, [deep.speed], plain, said), of_unloading(thornton, deep.peak)
    said = "oblique impact at 5 v_y with partial slip"
    found["oblique"] = (
        oblique(thornton, 5 * v_y, 0.4, slips, said),
        of_shear(thornton, Impact(thornton, 5 * v_y).peak),
    )
    said = "impact at 30 v_y of a metal that hardens"
    strong = Impact(hard, 30 * hard.yield_speed)
    found["hardening"] = head_on(hard, [strong.speed], hardening, said), of_impacts([strong])
    written = {name: (text, motion.text()) for name, (text, motion) in found.items()}
    graze = Grazing(thornton, 2 * v_y, np.tan(np.radians(88)))
    slides = plain + " tangential history ${xmu}"
    written["grazing"] = grazing(graze, slides, "impact at 2 v_y, 88 degrees from the normal", {}), graze.motion()
    moduli = ((1 - nu**2) / E for E, nu in ((YOUNG, POISSON), (BRASS["emod2"], BRASS["poisson2"])))
    soft = Law(E_star=1 / sum(moduli), p_y=BRASS["pyield2"])
    graze = Grazing(soft, 5 * soft.yield_speed, np.tan(np.radians(76)))
    words = "thornton ${emod} ${poisson} ${pyield}\n  2 2 thornton ${emod2} ${poisson2} ${pyield2}\n  1 2 mixed"
    words = f"1 1 {words} tangential partial_slip ${{xmu}}"
    said = "impact of steel and brass at 5 v_y, 76 degrees from the normal"
    written["two_materials"] = grazing(graze, words, said, BRASS), graze.motion()
    return {f"{k}_{name}": both for k, (name, both) in enumerate(written.items(), 1)}


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, (text, table) in cases().items():
        (FOLDER / f"{name}.yaml").write_text(text)
        (FOLDER / f"{name}.csv").write_text(table)
