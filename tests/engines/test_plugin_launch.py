# SPDX-License-Identifier: GPL-2.0-or-later
"""How the plugin is started, what it prints, and which combinations of models run."""

import ctypes
import os
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from plugin_decks import LAWS, Bodies, deck_of, good, launcher, materials, run

from marks import thorough

pytestmark = pytest.mark.liggghts

BOX = ((-0.05, 0.05), (-0.05, 0.05), (-0.01, 0.1))
NAMES = "ep/hertz ep/thornton ep/johnson ep/cavity ep/jkr ep/thornton_ning ep/meyer ep/cavity_adhesive"


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


def deck(model="ep/thornton", *, edit=lambda text: text, properties=None, steps=50, **of_contact):
    properties = properties or materials("ep/any")
    return edit(deck_of(model, f"run {steps}\n", properties=properties, wall="primitive", **of_contact))


def refusal(folder, text, **kwargs):
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


def test_each_simulation_of_a_program_names_the_models(tmp_path):
    text = started(tmp_path, deck() + "clear\n" + deck()).text
    assert text.count("epdem ") == 2 and text.count("Loop time") == 2


def test_the_library_can_be_preloaded_into_an_unmodified_liggghts(tmp_path):
    text = started(tmp_path, deck(), command="liggghts", preload=library()).text
    assert text.count("epdem ") == 1 and "Loop time" in text


def test_the_preloaded_library_names_its_models(tmp_path):
    assert NAMES in refusal(tmp_path, deck("ep/thorton"), command="liggghts", preload=library())


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


COMBINATIONS = [
    (t, c, r, s)
    for t in ("off", "no_history", "history", "ep/partial_slip")
    for c in ("off", "sjkr", "sjkr2")
    for r in ("off", "cdt", "epsd", "epsd2", "epsd3")
    for s in ("default", "multicontact")
]


@pytest.mark.parametrize("every", [7, thorough(1)])
def test_all_combinations_run_for_pair_and_wall(every, tmp_path):
    """Must 9: 120 combinations, or every seventh; the law changes from one to the next: each meets most of them."""
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
        outcomes = list(pool.map(attempt, range(0, len(COMBINATIONS), every)))
    failed = [(COMBINATIONS[n], error) for n, code, error, _ in outcomes if code]
    assert not failed and not any(warned for *_, warned in outcomes)


def test_the_deck_of_the_user_page_prints_what_the_page_says(tmp_path):
    page = (Path(__file__).resolve().parents[2] / "docs" / "liggghts.md").read_text()
    text = re.search(r"```deck\n(.*?)```", page, re.S).group(1)
    printed = re.search(r"The deck prints (\S+),", page).group(1)
    got = re.search(r"^restitution (\S+)", good(tmp_path, text).text, re.M).group(1)
    assert f"{float(got):.4f}" == printed == "0.9476"
    micro = {  # pg, um, us: lengths and times have 1e6 times their numbers, pressures and densities 1e-3
        "units si": "units micro",
        "-0.1 0.1 -0.1 0.1 -0.01 0.2": "-1e5 1e5 -1e5 1e5 -1e4 2e5",
        "neighbor 0.005": "neighbor 5000",
        "2.08e11": "2.08e8",
        "2.8e9": "2.8e6",
        "0 0 0.01001": "0 0 10010",
        "diameter 0.02 density 7850": "diameter 20000 density 7.85",
        "timestep 1e-7": "timestep 0.1",
    }
    for si, other in micro.items():
        assert text.count(si) == 1
        text = text.replace(si, other)
    scaled = re.search(r"^restitution (\S+)", good(tmp_path / "micro", text).text, re.M).group(1)
    assert float(scaled) == pytest.approx(float(got), rel=1e-10)


def test_nothing_follows_the_error_of_a_deck(tmp_path):
    """At some times of the clock LIGGGHTS prints a tip behind an error, from memory that it has freed."""
    libc = ctypes.CDLL(None)

    def tips(seconds):
        libc.srand(seconds)
        return libc.rand() % 10 < 2

    (tmp_path / "in.x").write_text("nonsense\n")
    for now in [seconds for seconds in range(1_700_000_000, 1_700_000_100) if tips(seconds)][:4]:
        (tmp_path / "clock.c").write_text(f"long time(long* t) {{ if (t) *t = {now}; return {now}; }}\n")
        subprocess.run(["cc", "-shared", "-fPIC", "-o", "clock.so", "clock.c"], cwd=tmp_path, check=True)
        words = [launcher(), "-in", "in.x", "-log", "none"]
        env = os.environ | {"LD_PRELOAD": str(tmp_path / "clock.so")}
        done = subprocess.run(words, cwd=tmp_path, env=env, capture_output=True, check=False)
        assert done.stdout.splitlines()[-1].startswith(b"ERROR: Unknown command: nonsense"), done.stdout
