# SPDX-License-Identifier: GPL-2.0-or-later
"""How the plugin is started, what it prints, and what a wrong deck is told."""

import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from plugin_decks import LAWS, YIELDING, Bodies, contact, good, head, launcher, materials, run

pytestmark = pytest.mark.liggghts

BOX = ((-0.05, 0.05), (-0.05, 0.05), (-0.01, 0.1))
NAMES = "ep/hertz ep/thornton ep/johnson ep/cavity"


def library():
    """The plugin as a library: EPDEM_PLUGIN, beside the launcher (a build tree), or in the installed package."""
    if path := os.environ.get("EPDEM_PLUGIN"):
        return path
    beside = Path(launcher()).with_name("libepdem_liggghts.so")
    if beside.exists():
        return str(beside)
    import epdem

    found = [p for base in epdem.__path__ for p in Path(base).rglob("libepdem_liggghts.so")]
    found += list(Path(launcher()).parent.parent.rglob("site-packages/epdem/native/libepdem_liggghts.so"))
    return str(found[0])


def bodies():
    x = np.array([[0.0, 0, 0.0049], [0.02, 0, 0.0049], [0.0, 0.02, 0.0049]])
    return Bodies(np.array([1, 2, 3]), np.full(3, 5e-3), x, np.tile([0.3, 0, -1.0], (3, 1)))


def deck(
    model="ep/thornton",
    *,
    edit=lambda text: text,
    properties=None,
    models="",
    settings="",
    tangential="history",
    steps=50,
):
    text = (
        head()
        + "read_data box.data\nneighbor 1e-3 bin\n"
        + (properties or materials("ep/any"))
        + contact(model, wall="primitive", models=models, settings=settings, tangential=tangential)
        + f"timestep 1e-7\nfix move all nve/sphere\nthermo_modify lost error norm no\nrun {steps}\n"
    )
    return edit(text)


def told(folder, text, **kwargs):
    """The error of a deck that must fail."""
    result = run(folder, text, files={"box.data": bodies().data(BOX)}, **kwargs)
    assert result.code == 1, result.text[-500:]
    return result.error


def started(folder, text, **kwargs):
    return good(folder, text, files={"box.data": bodies().data(BOX)}, **kwargs)


def test_one_line_names_models_and_version_and_nothing_else_is_printed(tmp_path):
    own = started(tmp_path / "own", deck("ep/hertz")).text.splitlines()
    lines = [k for k, line in enumerate(own) if line.startswith("epdem ")]
    assert len(lines) == 1 and re.fullmatch(rf"epdem \d+\.\d+\.\d+: {NAMES}", own.pop(lines[0]))
    hertz = deck("hertz", properties=materials("hertz"))
    plain = started(tmp_path / "plain", hertz, command="liggghts").text.splitlines()

    def shape(lines):  # numbers and dates differ from run to run
        return [" ".join(re.sub(r"[\d.e+-]+|\w{3} \w{3} [ \d]\d [\d:]+ \d{4}", "#", line).split()) for line in lines]

    assert shape(own) == shape(plain)


def test_under_mpirun_the_line_comes_once(tmp_path):
    text = started(tmp_path, deck(edit=lambda t: t.replace("1 1 1", "2 1 1")), ranks=2).text
    assert text.count("epdem ") == 1


def test_the_library_can_be_preloaded_into_an_unmodified_liggghts(tmp_path):
    text = started(tmp_path, deck(), command="liggghts", preload=library()).text
    assert text.count("epdem ") == 1 and "Loop time" in text


def test_many_launches_at_once_all_start(tmp_path):
    """Open MPI's shared session directory made one of thirty fail."""
    (tmp_path / "in.nothing").write_text("units si\n")
    line = [launcher(), "-in", "in.nothing", "-log", "none"]

    def code(_):
        return subprocess.run(line, cwd=tmp_path, capture_output=True, check=False).returncode

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(code, range(60))) == [0] * 60


def test_an_error_on_one_rank_is_not_lost_on_a_pipe(tmp_path):
    """error->one ends in MPI_Abort: must 12. A missing input file is such an error."""
    done = subprocess.run([launcher(), "-in", "nowhere"], cwd=tmp_path, capture_output=True, check=False)
    assert done.returncode == 1 and b"ERROR" in done.stdout and b"nowhere" in done.stdout


@pytest.mark.parametrize("preloaded", [False, True])
def test_a_wrong_name_is_told_what_exists(tmp_path, preloaded):
    how = {"command": "liggghts", "preload": library()} if preloaded else {}
    assert NAMES in told(tmp_path / "a", deck("ep/thorton"), **how)
    wrong_wall = deck(edit=lambda t: t.replace("wall/gran model ep/thornton", "wall/gran model ep/x"))
    assert NAMES in told(tmp_path / "b", wrong_wall, **how)
    assert "Invalid model" in told(tmp_path / "c", deck("hertzz"), **how)


@pytest.mark.parametrize(
    "extra", ["rolling_friction luding", "cohesion washino/capillary/viscous", "surface superquadric"]
)
def test_a_combination_that_does_not_exist_is_refused_with_those_that_do(tmp_path, extra):
    assert "epdem's models combine with" in told(tmp_path, deck(models=extra))


COMBINATIONS = [
    (t, c, r, s)
    for t in ("off", "no_history", "history")
    for c in ("off", "sjkr", "sjkr2")
    for r in ("off", "cdt", "epsd", "epsd2", "epsd3")
    for s in ("default", "multicontact")
]


def test_all_combinations_run_for_pair_and_wall(tmp_path):
    """Must 9: 90 combinations; the law changes from one to the next, so that each law meets most of them."""
    more = materials("ep/any") + "".join(
        f"fix {k} all property/global {name} peratomtypepair 3 {' '.join([str(value)] * 9)}\n"
        for k, (name, value) in enumerate(
            {
                "coefficientRestitution": 0.8,
                "cohesionEnergyDensity": 1e4,
                "coefficientRollingFriction": 0.1,
                "coefficientRollingViscousDamping": 0.1,
            }.items()
        )
    )
    more += "fix s all property/global rollingStiffness scalar 2.25\n"

    def attempt(number):
        t, c, r, s = COMBINATIONS[number]
        law = LAWS[number % len(LAWS)]
        words = f"cohesion {c} rolling_friction {r} surface {s}"
        fix = "fix mc all multicontact/halfspace\n" if s == "multicontact" else ""
        text = deck(f"ep/{law}", models=words, tangential=t, properties=more, steps=20)
        text = text.replace("timestep", fix + "timestep")
        result = run(tmp_path / str(number), text, files={"box.data": bodies().data(BOX)})
        return number, result.code, result.error, "not located in any whitelist" in result.text

    with ThreadPoolExecutor(2) as pool:
        outcomes = list(pool.map(attempt, range(len(COMBINATIONS))))
    failed = [(COMBINATIONS[n], error) for n, code, error, _ in outcomes if code]
    assert not failed and not any(warned for *_, warned in outcomes)


def test_rolling_friction_acts_because_kn_is_set(tmp_path):
    """Must 3: without sidata.kn rolling_friction cdt changes nothing."""
    spin = (
        materials("ep/any")
        + "fix r all property/global coefficientRollingFriction peratomtypepair 3"
        + " 0.3" * 9
        + "\n"
    )

    def final(name, settings):
        text = deck(models=settings, properties=spin, steps=100)
        text += "dump d all custom 1 out.bin id omegax omegay omegaz\nrun 0\n"
        return started(tmp_path / name, text).last

    assert not np.array_equal(final("on", "rolling_friction cdt"), final("off", "rolling_friction off"))


RANGES = {
    "youngsModulus": ("m1", {"0": "0", "-5e9": "-5e+09", "1e400": "inf"}, "> 0"),
    "poissonsRatio": ("m2", {"-0.1": "-0.1", "0.6": "0.6", "1e400": "inf"}, "[0, 0.5]"),
    "yieldPressure": ("p1", {"0": "0", "-3e9": "-3e+09", "1e400": "inf"}, "> 0"),
}


@pytest.mark.parametrize("name", RANGES)
def test_an_absurd_property_is_refused_with_model_property_value_and_range(tmp_path, name):
    """Must 7: unchecked, a negative yield pressure shoots a 1 m/s sphere off at 18 m/s."""
    fix, values, limits = RANGES[name]
    for value, said in values.items():
        text = re.sub(rf"(fix {fix} .* peratomtype \S+) \S+", rf"\1 {value}", materials("ep/any"))
        error = told(tmp_path / value, deck(properties=text))
        assert "model ep/thornton" in error and f"{name} = {said}" in error and limits in error and "type 2" in error


@pytest.mark.parametrize(
    ("law", "name"), [("thornton", "yieldPressure"), ("johnson", "yieldPressure"), ("cavity", "yieldStress")]
)
def test_a_missing_property_is_named_with_the_line_to_write(tmp_path, law, name):
    without = "\n".join(line for line in materials("ep/any").splitlines() if name not in line) + "\n"
    error = told(tmp_path, deck(f"ep/{law}", properties=without))
    assert f"model ep/{law}" in error and f"property/global {name} peratomtype" in error


def test_parameters_that_create_energy_are_refused(tmp_path):
    odd = materials("ep/any") + "fix q all property/global firstYieldRatio scalar 1.1\n"
    error = told(tmp_path, deck("ep/cavity", properties=odd))
    assert "firstYieldRatio = 1.1" in error and "do not go together" in error


def test_a_pair_value_must_be_symmetric(tmp_path):
    pairs = "\n".join(line for line in materials("ep/any").splitlines() if "yieldPressure" not in line)
    pairs += "\nfix q all property/global yieldPressure peratomtypepair 3 1e9 2e9 1e9 1e9 1e9 1e9 1e9 1e9 1e9\n"
    error = told(tmp_path, deck(properties=pairs))
    assert "symmetric" in error or "Symmetric" in error


def test_no_history_without_restitution_says_why_it_is_needed(tmp_path):
    error = told(tmp_path, deck(tangential="no_history"))
    assert "no_history needs coefficientRestitution" in error


def test_moduli_keep_the_limits_that_hold_for_all_models(tmp_path):
    soft_only = deck(edit=lambda t: t.replace("hard_particles yes\n", ""))
    assert "hard_particles" in told(tmp_path, soft_only)


@pytest.mark.parametrize(
    "setting",
    [
        "tangential_damping off",
        "limitForce on",
        "heating_tracking on",
        "heating_normal_hertz off",
        "computeElasticPotential off",
    ],
)
@pytest.mark.parametrize("law", ("hertz", "cavity"))
def test_settings_of_hertz_in_an_existing_deck_are_accepted(tmp_path, law, setting):
    started(tmp_path, deck(f"ep/{law}", settings=setting))


@pytest.mark.parametrize(
    "setting", ["heating_normal_hertz", "computeElasticPotential", "computeDissipatedEnergy", "disableNormalWhenBonded"]
)
def test_other_settings_of_hertz_are_refused_by_name(tmp_path, setting):
    error = told(tmp_path, deck(settings=f"{setting} on"))
    assert setting in error and "not available" in error


def test_an_unused_type_costs_nothing(tmp_path):
    """Must 4: properties are sized by the types in use; a box with a fourth, unused type must run."""
    four = re.sub(r"(peratomtype .*)", r"\1 1e9", materials("ep/any")).replace("0.4 1e9", "0.4 0.3")
    four = re.sub(r"peratomtypepair 3 .*", "peratomtypepair 4" + " 0.3" * 16, four)
    good(tmp_path, deck(properties=four), files={"box.data": bodies().data(BOX, types=4)})


@pytest.mark.parametrize("law", YIELDING)
def test_properties_may_change_between_runs(tmp_path, law):
    """Must 5: the registry frees everything at each init."""
    text = deck(f"ep/{law}") + materials("ep/any") + "run 50\n"
    started(tmp_path, text)


def test_the_plugin_exports_only_the_function_that_explains_wrong_names():
    """Must 10: with default visibility 298 of LIGGGHTS's own symbols would be interposed."""
    lines = subprocess.run(["nm", "-D", "--defined-only", library()], capture_output=True, text=True, check=True).stdout
    names = [line.split()[-1] for line in lines.splitlines()]
    ours = [n for n in names if "epdem" in n or "LIGGGHTS" in n or "LAMMPS" in n]
    assert len(ours) == 1 and ours[0].startswith("_ZN8LIGGGHTS13ContactModels7Factory6select")


def test_library_and_launcher_stay_small():
    assert Path(library()).stat().st_size < 3e6 and Path(launcher()).stat().st_size < 3e6


def test_the_deck_of_the_user_page_prints_what_the_page_says(tmp_path):
    page = (Path(__file__).resolve().parents[2] / "docs" / "liggghts.md").read_text()
    text = re.search(r"```deck\n(.*?)```", page, re.S).group(1)
    said = re.search(r"It prints (\S+),", page).group(1)
    got = re.search(r"^restitution (\S+)", good(tmp_path, text).text, re.M).group(1)
    assert f"{float(got):.4f}" == said == "0.9476"
