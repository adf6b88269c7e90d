# SPDX-License-Identifier: GPL-2.0-or-later
"""Prescribed motions: forces of each engine, the same in all of them, and files of motions."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engines.hosts import CLASSES, LAMMPS
from epdem.case.toml import read_toml
from epdem.errors import CaseError, EngineError
from epdem.verification.motion import paths as motions
from epdem.verification.motion.compare import compare, touch_of
from epdem.verification.motion.hosts import EmbeddedMotions
from epdem.verification.motion.prescribed import check_motion, read, text
from marks import thorough

CASES = Path(__file__).parents[2] / "cases"
OWN = {make.__name__: make for make in motions.MOTIONS}


def touch(*, law="hertz", tangential="history", **changes):
    return replace(touch_of(CASES / "steel_wall.toml", law), tangential=tangential, **changes)


def embedded(pair, name):
    motion = OWN[name](pair)
    return motion, EmbeddedMotions().loads(pair, motion, Path())


def components(motion, force):
    """(overlap of equal spheres [m], force along the normal [N], the rest of it (n, 3) [N]) in each step."""
    apart = motion.place[:, 0] - motion.place[:, 1]
    distance = np.linalg.norm(apart, axis=1)
    normal = np.einsum("nk,nk->n", force, apart) / distance
    return 0.02 - distance, normal, force - (normal / distance)[:, None] * apart


def test_loading_follows_hertz():
    """F = 4/3 E* sqrt(R*) alpha^(3/2); E* = E/(2 (1 - nu^2)), R* = R/2, steel of the case."""
    motion, loads = embedded(touch(), "normal_loading")
    overlap, normal, _ = components(motion, loads.force[:, 0])
    expected = 4 / 3 * (208e9 / (2 * 0.91)) * np.sqrt(5e-3) * np.maximum(overlap, 0) ** 1.5
    assert np.abs(normal - expected).max() < 1e-11 * expected.max()
    assert expected.max() > 0 and (overlap < 0).sum() > 10
    assert np.array_equal(loads.force[:, 0], -loads.force[:, 1]) and not loads.torque.any()


def test_a_dent_is_left_by_yield():
    motion, loads = embedded(touch(law="thornton"), "normal_loading")
    overlap, normal, _ = components(motion, loads.force[:, 0])
    down, up = slice(370, 430), slice(75, 150)  # the last unloading, the first loading
    assert np.interp(2e-5, overlap[down][::-1], normal[down][::-1]) < 0.2 * np.interp(2e-5, overlap[up], normal[up])


def test_a_contact_that_parts_forgets_its_dent():
    pair = touch(law="thornton")
    once = OWN["normal_loading"](pair)
    twice = replace(once, **{k: np.concatenate([getattr(once, k)] * 2) for k in ("place", "velocity", "spin")})
    force = EmbeddedMotions().loads(pair, twice, Path()).force
    assert np.array_equal(force[: once.steps], force[once.steps :])


def test_an_elastic_shear_is_a_spring_and_a_long_one_slides():
    """T = 8 G* a s with G* = G/(2 (2 - nu)) up to mu F; torques on both of the arm to the middle of the overlap."""
    pair = touch()
    motion, loads = embedded(pair, "shear_elastic")
    overlap, normal, rub = components(motion, loads.force[:, 0])
    G_star = 208e9 / 2.6 / (2 * 1.7)
    shear = 2 * (motion.place[160, 0] - motion.place[100, 0]) @ motions.ALONG
    reached = 8 * G_star * np.sqrt(5e-3 * overlap[160]) * shear
    assert rub[160] @ motions.ALONG == pytest.approx(-reached, rel=3e-3)
    assert reached > 0.05 * pair.friction * normal[160]
    to_i = motion.place[160, 0] / np.linalg.norm(motion.place[160, 0])
    torque = np.cross((0.01 - overlap[160] / 2) * to_i, -loads.force[160, 0])
    assert np.allclose(loads.torque[160], torque, rtol=0, atol=1e-9 * np.abs(torque).max())
    motion, loads = embedded(pair, "shear_slip")
    _, normal, rub = components(motion, loads.force[:, 0])
    length = np.linalg.norm(rub, axis=1)
    assert length[[160, 280, 400]] == pytest.approx(0.3 * normal[[160, 280, 400]], rel=1e-9)
    assert rub[160] @ motions.ALONG < -0.99 * length[160] and rub[280] @ motions.ALONG > 0.99 * length[280]
    assert rub[400] @ motions.ACROSS < -0.9 * length[400]


def test_rolling_rubs_nothing_and_sliding_spins_do():
    motion, loads = embedded(touch(), "rotation_in_plane")
    force = loads.force[:, 0]
    rolled = np.abs(force[-1] - force[-50]).max()
    slid = np.abs(force[140:-50] - force[140]).max()
    assert rolled < 1e-9 * loads.peak and slid > 0.1 * loads.peak


@pytest.mark.parametrize(("tangential", "low", "high"), [("partial_slip", 1e-7, 1e-3), ("history", 0.1, 1.0)])
def test_a_pair_that_turns_rigidly_takes_its_forces_along_but_with_one_spring(tangential, low, high):
    """LIGGGHTS's spring does not turn with the pair about its normal."""
    _, loads = embedded(touch(tangential=tangential), "rigid_rotation")
    assert low < motions.objectivity(loads) < high


def test_the_error_of_a_rigid_rotation_is_of_first_order_in_the_step(monkeypatch):
    errors = []
    for steps in (500, 1000, 2000):
        monkeypatch.setattr(motions, "TURN", steps)
        errors.append(motions.objectivity(embedded(touch(tangential="partial_slip"), "rigid_rotation")[1]))
    assert [errors[0] / errors[1], errors[1] / errors[2]] == pytest.approx([2, 2], abs=0.05)


LAWS = ("hertz", "thornton", "johnson", "cavity")


@pytest.mark.parametrize("laws", [["cavity"], thorough(LAWS)], ids=["cavity", "all"])
def test_the_engines_agree_on_every_law(laws, tmp_path):
    outcome = compare(CASES / "oblique_steel.toml", laws=laws, out=tmp_path)
    assert outcome.passed and len(outcome.rows) == 2 * 6 * len(laws)
    found = outcome.rows[outcome.rows["engine"] == "liggghts"]
    assert found[["normal", "force", "torque"]].to_numpy().max() < 1e-11
    stored = json.loads((tmp_path / "cavity/liggghts/shear_slip/motion.json").read_text())
    assert np.shape(stored["F_i"]) == np.shape(stored["x_j"]) == (441, 3) and np.abs(stored["T_j"]).max() > 1


@pytest.mark.parametrize("law", ["jkr", "thornton_ning", "cavity_adhesive"])
def test_the_engines_agree_on_adhesion(law, tmp_path):
    case = tmp_path / "case.toml"
    words = (CASES / "steel_wall.toml").read_text()
    words = words.replace("[materials.steel]", "[materials.steel]\nsurface_energy = '1000 J/m^2'")
    case.write_text(words.replace('name = "thornton"', f'name = "{law}"').replace("yield_pressure_ratio", "#"))
    read_toml(case)
    outcome = compare(case, out=tmp_path / "out")
    assert outcome.passed
    loads = json.loads((tmp_path / f"out/{law}/liggghts/normal_loading/motion.json").read_text())
    assert (np.array(loads["F_i"]) @ motions.NORMAL).min() < -1.0  # it pulls


@pytest.mark.parametrize("host", [LAMMPS, CLASSES])
def test_other_hosts_agree_on_two_laws_with_partial_slip(host, tmp_path):
    outcome = compare(CASES / "oblique_steel.toml", laws=LAWS[2:], engines=["embedded", host], out=tmp_path)
    found = outcome.rows[outcome.rows["engine"] == host]
    assert outcome.passed and len(outcome.rows) == 2 * 6 * 2 and set(found["friction"]) == {"partial_slip"}
    assert found[["normal", "force", "torque"]].to_numpy().max() < {"lammps": 1e-11, "yade": 1e-9}[host]


@pytest.mark.yade
def test_motions_in_yade_need_its_module(tmp_path):
    with pytest.raises(EngineError, match="motions need the module epdem_yade, which is not built; run 'make yade'"):
        compare(CASES / "oblique_steel.toml", engines=["yade"], out=tmp_path / "o")
    assert not (tmp_path / "o").exists()


def test_a_motion_comes_back_from_json_and_csv(tmp_path):
    motion = OWN["rotation_in_plane"](touch())
    path = tmp_path / "rotation_in_plane.json"
    path.write_text(text(motion.columns()))
    turned = {f"q_{side}": np.tile([1.0, 0.0, 0.0, 0.0], (motion.steps, 1)) for side in "ij"}
    t, x_i, x_j, *others = motion.columns().items()
    columns = dict([t, x_i, x_j, *turned.items(), *others])
    table = np.hstack([values.reshape(motion.steps, -1) for values in columns.values()])
    lines = [" ".join(map(repr, row)) for row in table.tolist()]
    for name, comma in (("spaces.csv", " "), ("commas.csv", ",")):
        heads = comma.join([*columns, "omega_b"])
        rows = [comma.join([*line.split(), "1", "2", "3"]) for line in lines]
        (tmp_path / name).write_text("\n".join([f"# {heads}", *rows]))
    for found in (read(path), *(read(tmp_path / f"{name}.csv") for name in ("spaces", "commas"))):
        assert np.array_equal(found.place, motion.place) and np.array_equal(found.spin, motion.spin)
        assert np.array_equal(found.velocity, motion.velocity) and found.time_step == pytest.approx(1e-6, rel=1e-12)


WRONG = {
    "v_j is missing; a motion has t, ": lambda c: c.pop("v_j"),
    "v_i has 441 x 2 values, must be 441 x 3": lambda c: c.update(v_i=c["v_i"][:, :2]),
    "t must grow by the same step": lambda c: c.update(t=c["t"] ** 2),
    "1 steps, must be from 2": lambda c: c.update({name: values[:1] for name, values in c.items()}),
}


@pytest.mark.parametrize("says", WRONG)
def test_a_wrong_file_is_named_with_what_is_wrong(says, tmp_path):
    columns = OWN["shear_slip"](touch()).columns()
    WRONG[says](columns)
    (tmp_path / "m.json").write_text(text(columns))
    with pytest.raises(CaseError, match=f"m.json: {says}"):
        read(tmp_path / "m.json")


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("m.json", '{"t": [[0], [1, 2]]}', "m.json: not JSON of lists of numbers"),
        ("m.json", '{"t": [], "x_i": 3}', "m.json: t is missing"),
        ("m.json", "[1, 2]", "m.json: t is missing"),
        ("m.csv", "t,x_i\n0,1,2\n", "m.csv line 2: 3 values, must be 4 or more"),
        ("m.csv", "t,x_i\n0,1,2,a\n", "m.csv line 2: could not convert"),
        ("m.csv", "# t x_i what v_i\n0 1 2 3\n", "m.csv: x_j is missing; a motion has t, x_i"),
        ("m.csv", "", "m.csv: no line of names"),
        ("n.csv", None, "n.csv: no such file"),
    ],
)
def test_text_that_is_no_motion_is_refused_in_words(name, content, says, tmp_path):
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(CaseError, match=says):
        read(tmp_path / name)


def test_a_motion_for_other_radii_is_refused():
    motion = OWN["shear_slip"](touch())
    small = replace(touch().experiment, body=replace(touch().experiment.body, radius=5e-3))
    with pytest.raises(CaseError, match=r"nothing touches, the least distance is 0\.01995 m and the radii are 0\.005"):
        check_motion(replace(touch(), experiment=small), motion)
    near = replace(motion, place=0.3 * motion.place)
    with pytest.raises(CaseError, match=r"the centres come as near as 0\.00598\d* m; the least is the smaller radius"):
        check_motion(touch(), near)


def test_two_files_of_one_name_are_refused(tmp_path):
    (tmp_path / "m.json").write_text(text(OWN["shear_slip"](touch()).columns()))
    with pytest.raises(CaseError, match="two motions have the name m"):
        compare(CASES / "steel_wall.toml", files=[tmp_path / "m.json"] * 2, engines=["embedded"], out=tmp_path / "o")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('target = { material = "steel" }', 'target = { material = "rigid" }', "no sphere is rigid"),
        ("[numerics]", "[viscous]\nrestitution = 0.9\n[numerics]", "motions are compared without a dashpot"),
        ("", "", "--engine abaqus: motions run on embedded"),
    ],
)
def test_a_case_that_has_no_two_spheres_is_refused(old, new, says, tmp_path):
    (tmp_path / "case.toml").write_text((CASES / "steel_wall.toml").read_text().replace(old, new, bool(old)))
    engines = ["embedded" if old else "abaqus"]
    with pytest.raises(CaseError, match=says):
        compare(tmp_path / "case.toml", engines=engines, out=tmp_path / "o")
    assert not (tmp_path / "o").exists()
