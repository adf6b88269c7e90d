# SPDX-License-Identifier: GPL-2.0-or-later
"""A contact that overlaps already at t = 0: LIGGGHTS keeps nothing of its first evaluation."""

import numpy as np
import pytest

from epdem.engines import engine
from epdem.impacts.plan import Plan
from epdem.verification.stability.cases import build
from epdem.verification.stability.running import setting

SHARE = 0.01  # of the stability limit


def rebounds(s, speed, *, kept: bool, steps: int) -> float:
    """Speed at which a sphere leaves a wall that it overlaps by alpha_max at t = 0 [m/s]; velocity Verlet. `speed`
    [m/s] is that towards the wall at t = 0; `kept`: whether the law remembers its evaluation at t = 0."""
    x, law, dt = s.x, s.x.native_law(), SHARE * s.limit
    u, v = s.overlap_max, speed
    force, _, memory = law.step(R_star=x.R_star, delta_max=0.0, delta=u)
    memory = memory if kept else 0.0
    for _ in range(steps):
        v = v - 0.5 * dt * force / x.m_star
        u = u + dt * v
        force, _, memory = law.step(R_star=x.R_star, delta_max=memory, delta=np.maximum(u, 0.0))
        v = v - 0.5 * dt * force / x.m_star
    return -float(v[0])


@pytest.mark.liggghts
@pytest.mark.parametrize(("share", "gain"), [(0.0, 1.2e-4), (-1.0, 7.4e-3), (1.0, 0.0)])
def test_liggghts_learns_of_an_overlap_at_the_start_one_step_later(share, gain, tmp_path):
    """Speeds at t = 0 over the elastic rebound's: at rest, parting, approaching; what the page for users says of each.
    The steps are those of a law that forgets its first evaluation to 1e-9, the round-off of positions over 300 steps;
    the gain over theory is stated to two digits, where velocity Verlet itself leaves 2e-5."""
    s = setting(build("start"), "thornton")
    theory, x = s.x.theory(), s.x
    elastic = float(np.sqrt(2 * theory.recovered_work(np.array([s.overlap_max]))[0] / x.m_star))
    speed, steps = share * elastic, int(1.5 * s.contact_time / (SHARE * s.limit)) + 20
    p = Plan(x, SHARE * s.limit, steps, 1, np.array([speed]), np.array([-s.overlap_max]))
    tool = engine("liggghts")
    tool.write(p, tmp_path)
    left = -float(tool.run(p, tmp_path).velocity[0, -1])
    assert left == pytest.approx(rebounds(s, speed, kept=False, steps=steps), rel=1e-9)
    kept = rebounds(s, speed, kept=True, steps=steps)
    assert left / kept - 1 == pytest.approx(gain, abs=0.15 * gain + 1e-9)
    if share <= 0.0:  # nothing yields after t = 0: what is stored comes back
        assert kept == pytest.approx(elastic * np.sqrt(1 + share**2), rel=2e-5)
