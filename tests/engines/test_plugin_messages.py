# SPDX-License-Identifier: GPL-2.0-or-later
"""What LIGGGHTS says to a deck that the plugin refuses: an edit of a good deck, and the words of the only error."""

import re

import numpy as np
import pytest
from plugin_decks import ADHESIVE, Bodies, head, materials, per_pair, run

pytestmark = pytest.mark.liggghts


def good_deck(model, tangential="history"):
    """Three spheres of three types on a wall; GAMMA stands for works of adhesion of the laws that have them."""
    words = f"model {model} tangential {tangential}"
    text = head() + "read_data box.data\nneighbor 1e-3 bin\n" + materials("ep/any")
    text += f"pair_style gran {words}\npair_coeff * *\nfix wall all wall/gran {words} primitive type 2 zplane 0.0\n"
    return text + "timestep 1e-7\nfix move all nve/sphere\nthermo_modify lost error norm no\nrun 5\n"


def value(name, new):
    """Another value of the second type."""
    return rf"(property/global {name} peratomtype \S+) \S+", rf"\1 {new}"


def without(*names):
    return rf"(?m)^fix .*({'|'.join(names)}).*\n", ""


def more(line, fix="more"):
    return "pair_style", f"fix {fix} all property/global {line}\npair_style"


def with_pairs(name, x):
    return "pair_style", per_pair(name, x) + "pair_style"


GAMMA = "pair_style", materials("ep/jkr").splitlines()[-1] + "\npair_style"
SURFACE = more("surfaceEnergy peratomtype 1 1 1")
RATIO_NAME = "yieldPressureRatio"
RATIO = more(f"{RATIO_NAME} scalar 2.9")


def models(words):
    return "tangential history", f"tangential history {words}"


def setting(words):
    return r"(tangential \S+)\n", rf"\1 {words}\n"


RANGES = {
    "youngsModulus": ({"0": "0", "-5e9": "-5e+09", "1e400": "inf"}, "> 0"),
    "poissonsRatio": ({"-0.1": "-0.1", "0.6": "0.6", "1e400": "inf"}, "[0, 0.5]"),
    "yieldPressure": ({"0": "0", "-3e9": "-3e+09", "1e400": "inf"}, "> 0"),
    "hardeningExponent": ({"-0.1": "-0.1", "1": "1", "1e400": "inf"}, "[0, 1)"),
}
NAMES = "ep/hertz ep/thornton ep/johnson ep/cavity ep/jkr ep/thornton_ning ep/meyer ep/cavity_adhesive"
NO_STRENGTH = without("yieldPressure", "yieldStress")
# name: (model, edits, words)
REFUSED = {
    f"{name} {given}": ("ep/meyer", [value(name, given)], ["model ep/meyer", f"{name} = {said}", limits, "type 2"])
    for name, (values, limits) in RANGES.items()
    for given, said in values.items()
}
for law, name in (("thornton", "yieldPressure"), ("johnson", "yieldPressure"), ("cavity", "yieldStress")):
    missing = [f"model ep/{law}", f"property/global {name} peratomtype"]
    REFUSED[f"{law} without {name}"] = f"ep/{law}", [without(name, "yieldStress")], missing
for law, ratio in (("thornton", 2.8), ("johnson", 3)):
    REFUSED |= {
        f"{law}, strength twice": (f"ep/{law}", [RATIO], ["both yieldPressure and yieldPressureRatio are given"]),
        f"{law}, ratio of nothing": (f"ep/{law}", [NO_STRENGTH, RATIO], ["property/global yieldStress peratomtype"]),
        f"{law}, no strength": (
            f"ep/{law}",
            [NO_STRENGTH],
            ["yieldPressure peratomtype", "yieldStress", f"is {ratio} times, or yieldPressureRatio"],
        ),
    }
for law, instead in {"hertz": "jkr", "thornton": "thornton_ning", "cavity": "cavity_adhesive"}.items():
    REFUSED[f"adhesion of {law}"] = f"ep/{law}", [GAMMA], [f"has no adhesion; take ep/{instead}"]
REFUSED["adhesion of johnson"] = "ep/johnson", [SURFACE], ["no theory of adhesion exists for it"]
for law in ADHESIVE:
    edits = [GAMMA, with_pairs("cohesionEnergyDensity", 1e6), models("cohesion sjkr")]
    REFUSED[f"cohesion beside {law}"] = f"ep/{law}", edits, ["has its attraction already"]
for other in ("heating_normal_hertz", "computeElasticPotential", "computeDissipatedEnergy", "disableNormalWhenBonded"):
    REFUSED[other] = "ep/thornton", [setting(f"{other} on")], [other, "not available"]
for words in ("rolling_friction luding", "cohesion washino/capillary/viscous", "surface superquadric"):
    REFUSED[words] = "ep/thornton", [models(words)], ["epdem's models combine with"]
REFUSED |= {
    "negative ratio": (
        "ep/thornton",
        [without("yieldPressure"), more("yieldPressureRatio scalar -2")],
        ["yieldPressureRatio = -2 of all types, must be > 0"],
    ),
    "no yield stress": (
        "ep/thornton",
        [without("yieldPressure"), value("yieldStress", 0)],
        ["yieldStress = 0 [Pa] of type 2, must be > 0"],
    ),
    "softer of a pair": (
        "ep/thornton",
        [
            NO_STRENGTH,
            more("yieldStress peratomtypepair 3" + " 1e9" * 9),
            more("yieldPressureRatio peratomtype 2.8 3 2.8", "q"),
        ],
        ["yieldPressureRatio per type and yieldStress per pair leave open which body"],
    ),
    "creates energy": (
        "ep/cavity",
        [more("firstYieldRatio scalar 1.1")],
        ["firstYieldRatio = 1.1", "do not go together"],
    ),
    "not symmetric": (
        "ep/thornton",
        [without("yieldPressure"), more("yieldPressure peratomtypepair 3 1e9 2e9" + " 1e9" * 7)],
        ["ymmetric"],
    ),
    "no_history": (
        "ep/thornton",
        [("tangential history", "tangential no_history")],
        ["no_history needs coefficientRestitution"],
    ),
    "soft particles": ("ep/thornton", [("hard_particles yes\n", "")], ["hard_particles"]),
    "newton": ("ep/thornton", [("newton off", "newton on")], ["newton"]),
    "unit": ("ep/thornton", [value("yieldPressure", 0)], ["yieldPressure = 0 [Pa] of type 2"]),
    "unit of cgs": (
        "ep/thornton",
        [value("yieldPressure", 0), ("units si", "units cgs")],
        ["yieldPressure = 0 [units cgs] of type 2"],
    ),
    "adhesion twice": ("ep/jkr", [GAMMA, SURFACE], ["both workOfAdhesion and surfaceEnergy are given"]),
    "no adhesion": ("ep/jkr", [], ["property/global workOfAdhesion peratomtypepair", "surfaceEnergy"]),
    "negative adhesion": (
        "ep/jkr",
        [GAMMA, (r"(workOfAdhesion peratomtypepair 3) 600", r"\1 -600")],
        ["workOfAdhesion = -600 [J/m^2] of types 1 and 1"],
    ),
    "limitForce": ("ep/jkr", [GAMMA, setting("limitForce on")], ["limitForce"]),
    "wrong name": ("ep/thorton", [], [NAMES]),
    "wrong name at the wall": ("ep/thornton", [("wall/gran model ep/thornton", "wall/gran model ep/x")], [NAMES]),
    "wrong name of LIGGGHTS": ("hertzz", [], ["Invalid model"]),
    "slip beside hertz": (
        "hertz",
        [("tangential history", "tangential ep/partial_slip")],
        ["tangential ep/partial_slip goes with the normal models of epdem only"],
    ),
    "unknown slip": (
        "ep/hertz",
        [("tangential history", "tangential ep/slip")],
        ["unknown tangential model: the models of epdem are ep/partial_slip ep/partial_slip_2"],
    ),
    "unknown law beside slip": (
        "ep/hurtz",
        [("tangential history", "tangential ep/partial_slip")],
        ["unknown normal model"],
    ),
    "works of a wall alone": (
        "ep/thornton",
        [("zplane 0.0", "zplane 0.0 computePlasticWork on")],
        ["computePlasticWork", "pair style"],
    ),
    "compaction of another law": (
        "ep/thornton",
        [setting("compaction on")],
        ["setting compaction on is not available", "only ep/cavity and ep/cavity_adhesive have it"],
    ),
    "compaction beside cohesion": (
        "ep/cavity",
        [with_pairs("cohesionEnergyDensity", 1e6), models("cohesion sjkr compaction on")],
        ["setting compaction on is not available", "without cohesion"],
    ),
    "compaction of a wall alone": (
        "ep/cavity",
        [("zplane 0.0", "zplane 0.0 compaction on")],
        ["compaction on of a wall needs it for the pair style as well"],
    ),
    "strain of a wall alone": (
        "ep/thornton",
        [("zplane 0.0", "zplane 0.0 computeContactStrain on")],
        ["computeContactStrain", "pair style"],
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_wrong_deck_ends_with_one_sentence(what, tmp_path):
    model, edits, words = REFUSED[what]
    text = good_deck(model)
    for old, new in edits:
        text, count = re.subn(old, new, text)
        assert count, old
    x = np.array([[0.0, 0, 0.0049], [0.02, 0, 0.0049], [0.0, 0.02, 0.0049]])
    spheres = Bodies(np.array([1, 2, 3]), np.full(3, 5e-3), x, np.tile([0.3, 0, -1.0], (3, 1)))
    done = run(tmp_path, text, files={"box.data": spheres.data(((-0.05, 0.05), (-0.05, 0.05), (-0.01, 0.1)))})
    assert done.code == 1 and all(word in done.error for word in words), done.error
