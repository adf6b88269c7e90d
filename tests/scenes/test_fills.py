# SPDX-License-Identifier: GPL-2.0-or-later
"""The spheres of a fill have the requested masses, or a sentence says which have not."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from parts_cases import BED, GLASS, STEEL, own, parts

from epdem.case.scene import parse
from epdem.errors import CaseError
from epdem.scenes.judge.warnings import planned_warnings
from epdem.scenes.plan.plan import plan

DENSITY = {"glass": 2500.0, "steel": 7800.0}
SETTLE = {"kind": "settle", "box": ["40 mm"] * 3, "count": 12, "duration": "20 ms", "walls": "steel"}


def ball(material, radius):
    return DENSITY[material] * 4 / 3 * math.pi * radius**3


def filled(particles, **amount):
    bed = {key: value for key, value in BED.items() if key != "count"}
    return parts(fill=[bed | {"particles": particles} | amount])


def component(material, radius, share):
    return {"material": material, "radius": radius if isinstance(radius, dict) else f"{radius!r} m", "share": share}


@given(
    share=st.floats(0.01, 0.99),
    radii=st.tuples(st.floats(0.2e-3, 3e-3), st.floats(0.2e-3, 3e-3)),
    mass=st.floats(1e-6, 3e-4),
)
def test_a_fill_by_mass_has_the_mass_of_every_component_or_says_so(share, radii, mass):
    """Independent count: mass of a component over the mass of one of its spheres."""
    wanted = {"glass": share * mass, "steel": (1.0 - share) * mass}
    numbers = {m: wanted[m] / ball(m, r) for m, r in zip(wanted, radii, strict=True)}
    data = filled([component("glass", radii[0], share), component("steel", radii[1], 1.0 - share)], mass=f"{mass!r} kg")
    try:
        p = plan(parse(data))
    except CaseError as error:
        assert (min(numbers.values()) < 1.0 and "one sphere" in str(error)) or "would fill" in str(error)
        return
    filled_in = [(f.particles[0], f.count) for f in p.insertions]
    got = {m: sum(n * ball(m, x.radius) for x, n in filled_in if x.material == m) for m in wanted}
    assert min(got.values()) > 0.0
    wrong = any(abs(got[m] - wanted[m]) > 0.01 * mass for m in wanted)
    assert wrong == any("requested" in said for said in planned_warnings(p))


@pytest.mark.parametrize("first", [0, 1])
def test_a_component_below_half_a_sphere_is_refused(first):
    rare = component("steel", 2e-3, 0.1)  # 0.26 g, and 10 % of 0.6 g are requested
    both = [component("glass", 1e-3, 0.9), rare]
    with pytest.raises(CaseError, match=rf"scene.fill.bed.particles.{1 - first}: .* is 0.23 of one sphere of steel"):
        plan(parse(filled(both[::-1] if first else both, mass="0.6 g")))


@pytest.mark.parametrize("kind", ["parts", "poured", "settle"])
def test_a_size_below_half_a_sphere_is_named(kind, tmp_path):
    (tmp_path / "sieve.csv").write_text("opening [mm],retained [%]\n6,0\n4,2\n1,98\n")
    sieve = [component("glass", {"sieve": "sieve.csv"}, 1.0)]  # 5 mm: 1 sphere for 388 of 2.5 mm
    data = filled(sieve, count=12)
    if kind == "poured":
        data = filled(sieve, count=12, rate="1000 Hz")
    elif kind == "settle":
        data = filled(sieve, count=12) | {"scene": SETTLE | {"particles": sieve}}
        data["output"] = {"rows": 10, "particles": 2}
    said = planned_warnings(plan(parse(data, tmp_path / "case.toml")))
    place = "scene.particles.0" if kind == "settle" else "scene.fill.bed.particles.0"
    assert any(s.startswith(f"{place}: 0 spheres with radius 0.0025 m") for s in said)
    assert GLASS != STEEL


@pytest.mark.parametrize("kind", ["compaction", "drum", "hopper", "settle", "peening"])
def test_mixtures_of_a_kind_have_exact_numbers(kind):
    """Numbers in the ratio of share over the mass of a sphere, whole, of their given sum, with every seed."""
    names = {"compaction": "compaction_powder", "drum": "drum_beads", "hopper": "hopper_beads"}
    data = own(names.get(kind, {"settle": "settle_glass", "peening": "peening_steel"}.get(kind, "")))
    material = data["scene"]["particles"][0]["material"]
    radius = parse(data).parts.filled[0].radii()[1]
    shares = {radius: 0.37, 0.7 * radius: 0.5, 0.5 * radius: 0.13}
    data["scene"]["particles"] = [component(material, r, share) for r, share in shares.items()]
    data["scene"]["count"] = 101
    weights = {r: share / r**3 for r, share in shares.items()}
    wanted = {r: 101 * w / sum(weights.values()) for r, w in weights.items()}
    p = plan(parse(data))
    found = {f.particles[0].radius: f.count for f in p.insertions}
    assert all(len(f.particles) == 1 for f in p.insertions) and sum(found.values()) == 101
    assert all(abs(found[r] - n) < 1 for r, n in wanted.items())
