# SPDX-License-Identifier: GPL-2.0-or-later
"""What an engine could not run, or would run otherwise than it is meant, is said before anything is written."""

import pytest
from scene_runs import run, write_case
from stored_runs import CASES

from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError
from epdem.scenes.plan import plan

BEYOND = {  # case, table, key, value, what the sentence must hold
    "steps": ("settle_glass", "scene", "duration", "1e9 s", r"1e\+14 steps of 1e-05 s, at most 2e\+09"),
    "time step": ("settle_glass", "numerics", "time_step", "1e-30 s", r"5e\+29 steps"),
    "no step": ("settle_glass", "scene", "duration", "1e-9 s", "output.rows: 100 rows .* only 0.0001 steps"),
    "rows": ("settle_glass", "output", "rows", 100_000, r"100000 rows .* only 5e\+04 steps"),
    "box": ("settle_glass", "scene", "box", ["1 km", "1 km", "80 mm"], "1000 x 1000 x 0.12 m has .* LIGGGHTS takes"),
    "rate": ("settle_glass", "scene", "rate", "1e15 Hz", r"scene.rate = 1e\+15 Hz: the 1000 spheres .* at most 26%"),
    "slow rate": ("settle_glass", "scene", "rate", "1e-9 Hz", "ends before all are poured"),
    "thin stream": ("peening_steel", "scene", "rate", "1e-9 Hz", r"6e\+12 m has .* check the units"),
    "speed": ("peening_steel", "scene", "speed", "1e9 m/s", r"speeds reach 1e\+09 m/s, faster than sound in shot"),
    "gravity": ("settle_glass", "scene", "gravity", "1e12 m/s^2", r"sound in glass \(sqrt\(E/rho\) = 141 m/s\)"),
    "turn": ("drum_beads", "scene", "angular_velocity", "1e9 rpm", "faster than sound in beads"),
    "drop": ("hopper_beads", "scene", "outlet_height", "10 km", "faster than sound in beads"),
}


@pytest.mark.parametrize("name", BEYOND)
def test_beyond_a_limit_one_sentence_names_place_value_and_limit(name, tmp_path):
    case, table, key, value, said = BEYOND[name]
    data = read_toml(CASES / f"{case}.toml")
    path = write_case(data | {table: data.get(table, {}) | {key: value}}, tmp_path)
    with pytest.raises(CaseError, match=f"case.toml: .*{said}") as refused:
        run(path, out=tmp_path / "out")
    assert "\n" not in str(refused.value) and not (tmp_path / "out").exists()


def test_a_rate_is_taken_up_to_the_layer_s_filling():
    """A layer 12.8 mm deep on 30 mm x 30 mm falls out of itself in sqrt(2 h/g) = 51.1 ms; 0.26 of it are spheres."""
    data = read_toml(CASES / "settle_glass.toml")
    radii = [1.4e-3, 1.45e-3, 1.5e-3, 1.55e-3, 1.6e-3]
    volume = 4.18879 * sum(r**3 for r in radii) / len(radii)
    most = 0.26 * 30e-3 * 30e-3 * 12.8e-3 / volume / (2 * 12.8e-3 / 9.81) ** 0.5
    for rate in (0.999 * most, 1.001 * most):
        case = parse(data | {"scene": data["scene"] | {"rate": f"{rate:.9g} Hz"}})
        if rate < most:
            assert plan(case).insertions[0].rate == pytest.approx(rate)
        else:
            with pytest.raises(CaseError, match="rate"):
                plan(case)
