# SPDX-License-Identifier: GPL-2.0-or-later
"""Stability on stiff and extreme cases: the set, its judges and LIGGGHTS's stiff bulk scenes."""

import csv
import json
import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from typer.testing import CliRunner

from epdem.engines import scene_engine
from epdem.engines.embedded import Embedded
from epdem.engines.liggghts.engine import Liggghts
from epdem.errors import CaseError, EngineError
from epdem.laws.library import Law
from epdem.verification import native, stability
from epdem.verification.commands import app
from epdem.verification.models import engine
from epdem.verification.stability import bulk, kinds, suite
from epdem.verification.stability.cases import extremes
from epdem.verification.stability.kinds import balance, path, stored
from epdem.verification.stability.running import Bench, impact, judge, ladder, setting
from marks import thorough
from scripts import script

LAWS = ("hertz", "thornton", "johnson", "cavity", "meyer")
page = script("stability")
BY_NAME = {e.name: e for e in extremes()}


def test_the_set_holds_at_least_sixty_cases_and_spans_what_it_promises():
    assert len(extremes()) == len(BY_NAME) >= 60
    data = [e.experiment("thornton") for e in extremes()]
    ratio = [x.E_star / x.law.parameters["yield_pressure"] for x in data]
    moduli, radii = [x.body.young_modulus for x in data], [x.body.radius for x in data]
    speeds = [x.speed[0] for x in data]
    assert min(moduli) == 1e3 and max(moduli) == 1e13 and min(radii) == 1e-7 and max(radii) == 10
    assert min(ratio) == pytest.approx(3) and max(ratio) == pytest.approx(1e7)
    assert min(speeds) < 1e-9 and max(speeds) >= 1e4
    pairs = [x for x in data if np.isfinite(x.target.radius)]
    assert max(x.target.radius / x.body.radius for x in pairs) == pytest.approx(1e4)
    assert max(x.target.mass / x.body.mass for x in pairs) == pytest.approx(1e12)
    assert {0.0, 0.5} <= {x.body.poisson_ratio for x in data} and any(x.target.rigid for x in data)


@pytest.mark.parametrize("law", [thorough(law, unless=law in ("thornton", "cavity")) for law in LAWS])
def test_every_extreme_impact_is_finite_second_order_and_creates_no_energy(law, tmp_path):
    """Embedded engine, all dt from 1e-4 to 1.5 of the stability limit: the judges' own tolerances."""
    bench = Bench(Embedded(), tmp_path)
    verdicts = [suite.verdict(x, law, bench) for e in extremes() if e.kind == "impact" for x in e.variants(law)]
    assert [(v["case"], v["reason"]) for v in verdicts if v["status"] != "passed"] == []
    assert any(v["large_deformation"] for v in verdicts)
    # an explicit scheme must break somewhere at or below 1.5 times its limit, or the search for it is blind
    assert all(np.isfinite(v["useless_at"]) for v in verdicts)


@pytest.mark.parametrize("law", LAWS)
def test_one_contact_bounced_reloaded_and_held_between_walls_neither_gains_nor_drifts(law, tmp_path):
    """1e6 steps here, 1e9 in `epdem verify stability`; drift goes with dt^3 and is 6e-11 a bounce at this step."""
    bench, chosen = Bench(Embedded(), tmp_path), [e for e in extremes() if e.kind != "impact"]
    verdicts = [suite.verdict(e, law, bench, steps=10**6, reloaded=300) for e in chosen]
    assert len(verdicts) == 5 and [(v["case"], v["reason"]) for v in verdicts if v["status"] != "passed"] == []


class Springy(Embedded):
    """A planted fault: every rebound comes back 0.1 % too fast."""

    def run(self, job, folder, **named):
        path = super().run(job, folder, **named)
        return replace(path, velocity=1.001 * path.velocity)


class Blind(Embedded):
    """A planted fault: after the peak, and at large steps alone, numbers that are none."""

    def run(self, job, folder, **named):
        path = super().run(job, folder, **named)
        late = np.arange(job.steps + 1) > np.nanargmax(path.force, axis=1)[:, None]
        coarse = job.time_step > setting(BY_NAME["modulus_1e11"], "thornton").limit
        return replace(path, force=np.where(late, np.nan, path.force)) if coarse else path


class Sluggish(Embedded):
    """A planted fault: an integrator of first order."""

    def run(self, job, folder, **named):
        path = super().run(job, folder, **named)
        share = job.time_step / setting(BY_NAME["modulus_1e11"], "thornton").limit
        return replace(path, velocity=path.velocity * (1 - 0.05 * share))


@pytest.mark.parametrize(("fault", "word"), [(Springy, "created"), (Blind, "not finite"), (Sluggish, "order")])
def test_the_judge_sees_energy_from_nothing_a_number_that_is_none_and_a_lower_order(fault, word, tmp_path):
    verdict = suite.verdict(BY_NAME["modulus_1e11"], "thornton", Bench(fault(), tmp_path))
    assert verdict["status"] == "failed" and word in verdict["reason"]


def test_stored_energy_is_the_work_along_loading_and_back_to_the_dent():
    """Quadrature of the branch against closed forms: all work at the top, plastic work alone at the dent; 1e-12."""
    for law in LAWS:
        s = setting(BY_NAME["modulus_1e11"], law)
        theory, top = s.x.theory(), np.array([s.overlap_max])
        assert stored(theory, top, top) == pytest.approx(theory.work(top), rel=1e-12)
        if top > theory.yield_overlap:
            dent = top - theory.recovered_overlap(top)
            plastic = theory.work(top) - theory.recovered_work(top)
            assert stored(theory, dent, top) == pytest.approx(plastic, rel=1e-12)


def test_a_sphere_between_two_walls_keeps_its_energy_but_not_with_a_wrong_mass(tmp_path):
    s = setting(BY_NAME["two_walls_3e0"], "thornton")
    samples = path(s, Bench(Embedded(), tmp_path), 0.01)
    assert np.abs(balance(s, *samples) - 1).max() < 1e-4
    wrong = replace(s, x=replace(s.x, body=replace(s.x.body, mass=1.01 * s.x.body.mass)))
    assert np.abs(balance(wrong, *samples) - 1).max() > 1e-3


ENGINES = [pytest.param(name, marks=getattr(pytest.mark, name)) for name in ("liggghts", "yade")]


@pytest.mark.parametrize("name", ENGINES)
def test_engines_take_the_steps_of_the_embedded_one_with_a_sphere_between_two_walls(name, tmp_path):
    """Same scheme: without memory only the round-off of positions differs; with it the balance of both holds."""
    own, bench = Bench(Embedded(), tmp_path), Bench(engine(name), tmp_path)
    s = setting(BY_NAME["two_walls_3e0"], "hertz")
    ours, theirs = path(s, own, 0.05), path(s, bench, 0.05)
    assert np.abs(ours[0][-theirs[0].size :] - theirs[0]).max() < 1e-9 * s.overlap_max
    s = setting(BY_NAME["two_walls_3e0"], "cavity")
    assert np.abs(balance(s, *path(s, bench, 0.01)) - 1).max() < 1e-4


@pytest.mark.parametrize("name", ENGINES)
def test_reloads_in_an_engine_repeat_the_laws_force_to_the_last_bit(name, tmp_path):
    """100 here, 10^4 in the command; a carried sphere has the same overlaps, bit for bit, in every cycle."""
    verdict = suite.verdict(BY_NAME["reloads_1e4"], "cavity", Bench(engine(name), tmp_path), reloaded=100)
    assert (verdict["status"], verdict["reason"]) == ("passed", "")
    assert verdict["cycles"] == 100 and verdict["drift"] == 0 and verdict["off"] < 1e-8


@pytest.mark.parametrize(("fault", "word"), [(1e-15, "drift ="), (0.0, "off ="), (None, "work =")])
def test_the_judge_of_reloads_sees_a_last_bit_a_wrong_branch_and_a_loop(fault, word, monkeypatch, tmp_path):
    """Planted in what the embedded engine gives: a change per cycle, a force of another law, a hysteresis."""
    good = kinds.embedded_cycles

    def wrong(s, cycles):
        overlap, force = good(s, cycles)
        if fault is None:
            return overlap, force * np.where(np.arange(force.shape[1]) > force.shape[1] // 2, 1 + 1e-9, 1.0)
        return overlap, force * (1.0 + fault * np.arange(cycles)[:, None]) * (1.0 if fault else 1 + 1e-7)

    monkeypatch.setattr(kinds, "embedded_cycles", wrong)
    verdict = suite.verdict(BY_NAME["reloads_1e4"], "thornton", Bench(Embedded(), tmp_path), reloaded=10)
    assert verdict["status"] == "failed" and word in verdict["reason"]


def test_double_and_long_double_agree_to_a_few_eps_per_thousand_steps():
    """Round-off of the law itself: 200 to 2000 steps, at most 1e-13 of e_n; and long double is not just double."""
    law = Law("cavity", E_star=1.1428571428571429e11, yield_stress=1e9)
    some = dict(R_star=0.01, m_star=0.0329, speed=[0.2, 1.0, 5.0, 20.0], time_step=5e-8, steps=5000)
    double, extended = law.impacts(**some)["rebound_speed"], native.impacts_long_double(law, **some)["rebound_speed"]
    assert np.abs(double / extended - 1).max() < 1e-13
    assert np.any(double != extended)


def test_round_off_of_positions_stays_below_its_formula_and_above_a_tenth_of_it():
    """0.5 sqrt(N) eps R/delta_e is two standard deviations: 8 phases lie within a factor of ten below it."""
    table = kinds.floors("hertz", [], times=(1e-4, 1e-2, 1.0, 1e2))
    assert np.all(table["positions"] < table["formula"]) and np.all(table["positions"] > 0.1 * table["formula"])
    assert table["double"].max() < 1e-14


@pytest.mark.parametrize("name", ["embedded", *ENGINES])
def test_overlap_at_the_start_stores_its_work(name, tmp_path):
    """Energy: a contact that starts at 2 alpha_max comes back faster than it was thrown, by the elastic share."""
    s = setting(BY_NAME["start_overlap_2"], "hertz")
    assert s.e_n == pytest.approx(np.sqrt(1 + 2**2.5), rel=1e-9)
    assert ladder(s, Bench(engine(name), tmp_path), [0.01])["error"].item() < 1e-3


@pytest.mark.parametrize(("error", "status"), [(CaseError, "not representable"), (EngineError, "failed")])
def test_a_set_up_that_an_engine_cannot_be_given_has_not_failed(error, status, tmp_path):
    def measure(s, bench):
        raise error("no such wall")

    found = judge(BY_NAME["corner_02"], "thornton", Bench(Embedded(), tmp_path), measure)
    assert (found["status"], found["reason"]) == (status, "no such wall")


@pytest.mark.lammps
def test_a_set_up_that_lammps_cannot_be_given_has_not_failed(tmp_path):
    found = suite.verdict(BY_NAME["two_walls_1em1"], "thornton", Bench(engine("lammps"), tmp_path))
    assert found["status"] == "not representable" and "cannot be made into this set-up" in found["reason"]


@pytest.mark.liggghts
def test_liggghts_passes_extreme_cases_and_says_what_it_cannot_represent(tmp_path):
    bench, measures = Bench(engine("liggghts"), tmp_path), partial(impact, coarse=(1.0, 1.5))
    chosen = ("modulus_1e3", "modulus_1e13", "radius_1em7", "radius_ratio_1e4", "mass_ratio_1e12", "corner_02")
    verdicts = [judge(BY_NAME[name], "thornton", bench, measures) for name in chosen]
    assert [(v["case"], v["reason"]) for v in verdicts if v["status"] not in ("passed", "not representable")] == []
    assert sum(v["status"] == "passed" for v in verdicts) >= 4
    assert judge(BY_NAME["ratio_1e7"], "thornton", bench)["status"] == "not representable"
    assert judge(BY_NAME["ratio_3e0"], "thornton", bench)["status"] == "not representable"


@pytest.mark.liggghts
def test_round_off_of_liggghts_is_that_of_positions_and_of_nothing_else(tmp_path):
    """Same statements in another order: equal to the digits that order leaves, 1e-3 of the deviation itself."""
    table = kinds.floors("thornton", [Bench(engine("liggghts"), tmp_path)], times=(1e-2, 1e2))
    assert table["liggghts"].to_numpy() == pytest.approx(table["positions"].to_numpy(), rel=1e-3)


@pytest.mark.liggghts
@pytest.mark.parametrize("name", list(bulk.SCENES))
def test_energy_of_stiff_bulk_scenes_never_rises_none_is_lost_and_ranks_agree(name, tmp_path):
    """Some 150 spheres for half the time here, 2,000 in the command; the tolerances are those of full size."""
    small = {"plate": (5, 5, 6), "mixture": (6, 5, 5), "shock": (4, 4, 10)}[name]
    case = bulk.scene_case(name, "cavity", tmp_path, lattice=small, duration=0.5)
    verdict = bulk.judge_scene(case, scene_engine("liggghts"), tmp_path)
    assert verdict["passed"], verdict["reason"]
    assert verdict["plastic"] > 0.02 and max(verdict["rise"], verdict["off"]) < 2e-5


class Quick(Liggghts):
    """A planted fault: velocities 1 % too high in the second half of the frames."""

    def run(self, job, folder, **named):
        tables = super().run(job, folder, **named)
        late = tables["particles"]["step"] > job.steps / 2
        tables["particles"].loc[late, ["vx", "vy", "vz"]] *= 1.01
        return tables


class Stiffer(Liggghts):
    """A planted fault: a modulus 5 % too high."""

    def run(self, job, folder, **named):
        words = folder / "setup.in"
        assert "208000000000.0" in words.read_text()
        words.write_text(words.read_text().replace("208000000000.0", "218400000000.0"))
        return super().run(job, folder, **named)


class Ending(Liggghts):
    """A planted fault: several ranks keep half of the motion of the last frame, and lose a sphere before it."""

    def run(self, job, folder, *, ranks=1, **named):
        tables = super().run(job, folder, ranks=ranks, **named)
        last = tables["particles"]["step"] == job.steps
        if ranks > 1:
            tables["particles"].loc[last, ["x", "vx", "vy", "vz"]] *= 0.5
        return tables | {"particles": tables["particles"][~(last & (tables["particles"]["id"] == 1))]}


@pytest.mark.liggghts
@pytest.mark.parametrize(
    ("fault", "words"),
    [(Quick, ["rise", "off"]), (Stiffer, ["off"]), (Ending, ["lost = 1, at most 0", "growth", "energy_difference"])],
)
def test_the_judge_of_bulk_scenes_sees_energy_from_nothing_lost_spheres_and_ranks_that_differ(fault, words, tmp_path):
    case = bulk.scene_case("shock", "thornton", tmp_path, lattice=(4, 4, 8))
    verdict = bulk.judge_scene(case, fault(), tmp_path)
    assert not verdict["passed"] and all(word in verdict["reason"] for word in words), verdict["reason"]


def test_the_page_of_the_documentation_names_its_command_and_every_case(monkeypatch):
    """Verdicts without runs: the tests above run the same cases."""

    def judged(extreme, law, bench, **named):
        names = {"case": extreme.name, "group": extreme.group, "engine": bench.name, "law": law}
        return names | {"status": "passed", "strain": 0.1, "large_deformation": False}

    monkeypatch.setattr(suite, "verdict", judged)
    outcome = stability.run(["embedded"], ["thornton"])
    found = page.tables(outcome)
    assert {e.name for e in extremes() if e.adhesion is None} == set(found["stability"]["case"])
    text = page.document(found | {"stability_bulk": page.load("stability_bulk")}, page.load(page.MAP))
    assert "`.venv/bin/python docs/stability.py`" in text
    assert outcome.passed and json.dumps(outcome.verdicts.to_dict("list"))


def test_the_page_has_the_numbers_of_its_tables():
    """Counts and limits by loops over the lines of docs/data/stability.csv."""
    with (page.DOCS / "data/stability.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    text = (page.DOCS / "stability.md").read_text()
    assert text == page.document({key: page.load(key) for key in page.NAMES}, page.load(page.MAP))
    for name in ("embedded", "liggghts", "yade"):
        own = [r for r in rows if r["engine"] == name and r["group"] != "adhesion"]
        passed = sum(r["status"] == "passed" for r in own)
        absent = sum(r["status"] == "not representable" for r in own)
        assert f"| without adhesion | {name} | {passed} | 0 | {absent} |" in text
    limits = [float(r["breaks_at"]) for r in rows if r["breaks_at"]]
    assert f"from {min(limits):g} on an impact" in text.replace("\n", " ")


def test_the_map_over_steps_has_the_numbers_of_its_table():
    """Maxima by loops over the lines of docs/data/stability_map.csv."""
    with (page.DOCS / f"data/{page.MAP}.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    (table,) = re.findall(r"\| engine \| 5 \|.*?\n\n", (page.DOCS / "stability.md").read_text(), re.S)
    shown = {line.split("|")[1].strip(): line.split("|")[2:-1] for line in table.strip().splitlines()[2:]}
    assert set(shown) == {row["engine"] for row in rows} == {"embedded", "liggghts", "lammps", "yade"}
    for name, cells in shown.items():
        for steps, cell in zip(page.STEPS, cells, strict=False):
            own = [r for r in rows if r["engine"] == name and r["steps"] and float(r["steps"]) == steps]
            assert float(cell) == pytest.approx(max(0.0, *(float(r["created"]) for r in own)), rel=0.01)
        assert int(cells[len(page.STEPS)]) == sum(r["engine"] == name and r["status"] == "diverges" for r in rows) == 0


@pytest.mark.parametrize("law", LAWS)
def test_impacts_of_the_map_are_passive_from_fifty_steps_on_and_gains_of_energy_are_seen(law, tmp_path, monkeypatch):
    """Velocity Verlet: the energy gained falls with the square of the steps."""
    created = {r["steps"]: r["created"] for r in page.passivity("embedded", law, tmp_path, {"ratio": 1e2})}
    assert created[5] < 0.2 and created[50] < 1e-3 and created[400] < 1e-5
    monkeypatch.setattr(page, "find_engine", lambda name: Springy())
    *_, last = page.passivity("embedded", law, tmp_path, {"ratio": 1e2})
    assert last["created"] > 1e-4


def test_the_command_names_the_groups_there_are(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    wrong = CliRunner().invoke(app, ["verify", "stability", "--group", "nogroup"])
    assert isinstance(wrong.exception, CaseError)
    assert "'nogroup' does not exist; there are modulus, ratio" in str(wrong.exception)
    done = CliRunner().invoke(app, ["verify", "stability", "-g", "poisson", "-l", "hertz", "--every", "2", "--json"])
    assert done.exit_code == 0
    assert [row["case"] for row in json.loads(done.stdout)["rows"]] == ["poisson_0"]
    for group in ("reloads", "two_walls"):  # which lack some of the numbers of impacts
        done = CliRunner().invoke(app, ["verify", "stability", "-g", group, "-l", "hertz", "--every", "5", "-o", group])
        assert done.exit_code == 0 and "1 passed" in (tmp_path / group / "report.html").read_text(), done.output


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["-l", "jkr", "--every", "60"], "--engine embedded: --law, --group and --every leave it no case"),
        (["-e", "yade", "-g", "adhesion"], "--engine yade: --law, --group and --every leave it no case"),
        (["-e", "liggghts-hertz", "-l", "cavity"], "engine liggghts-hertz has hertz only"),
    ],
)
def test_a_choice_that_leaves_nothing_to_run_is_refused(words, says, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["verify", "stability", *words])
    assert isinstance(done.exception, CaseError) and says in str(done.exception) and not list(tmp_path.iterdir())


@pytest.mark.liggghts
def test_an_engine_is_tested_with_the_laws_that_it_has():
    rows = stability.run(["liggghts-hertz", "embedded"], [], groups=["rigid"], every=2).verdicts
    found = rows.groupby("engine")["law"].unique().map(list).to_dict()
    assert found == {"liggghts-hertz": ["hertz"], "embedded": [*LAWS]}


def test_extreme_cases_are_the_same_on_every_call():
    assert extremes() == extremes.__wrapped__()
