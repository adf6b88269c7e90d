# SPDX-License-Identifier: GPL-2.0-or-later
"""A test that cannot fail is a defect: each fault planted here must turn the named test red.

A fault is an exact replacement of text in a copy of the project, which is then built and tested. Text that is not
there any more fails the test. Nothing in the product knows of faults.
"""

import shutil
from dataclasses import dataclass

import pytest
from workshop import LAWS, PLUGIN, PYTHON, build, pytest_in


@dataclass(frozen=True)
class Fault:
    """`file`: `old` becomes `new`; `test` (pytest node, then -k expression) must fail."""

    name: str
    file: str
    old: str
    new: str
    test: str
    only: str = ""


STEP, IMPACTS = "tests/battery/test_step.py", "tests/engines/test_impacts.py"
FAULTS = [
    Fault("plastic line starts at the wrong force", f"{LAWS}/thornton.hpp", "slope_ratio * yield_ratio / 3.0",
          "slope_ratio * yield_ratio / 2.0", STEP, "continuous"),
    Fault("unloading is too stiff", f"{LAWS}/unloading.hpp", "E_star / (0.75 * peak.force)",
          "E_star / (0.70 * peak.force)", STEP, "stiffness_of_the_peak"),
    Fault("fully plastic unloading is too stiff", f"{LAWS}/unloading.hpp", "u = 1.0 - 0.5 * pi * w",
          "u = 1.0 - 0.51 * pi * w", STEP, "stiffness_of_the_peak"),
    Fault("flat unloading lost its factor", f"{LAWS}/unloading.hpp", "A = 0.75 * (1.0 - tau), B = 2.0 / pi * tau;",
          "A = 0.75 * (1.0 - tau), B = 1.0 / pi * tau;", STEP, "stiffness_of_the_peak"),
    Fault("one digit of the segment function", f"{LAWS}/unloading.hpp", "0.15627588828780442", "0.15627588928780442",
          "tests/battery", "agree"),
    Fault("history forgotten on the way back", f"{LAWS}/law.hpp", "after.delta_max = select(touches, delta_max, before.delta_max);",
          "after.delta_max = select(touches, delta, before.delta_max);", STEP, "retrace"),
    Fault("memory grows although the step is elastic", f"{LAWS}/law.hpp", "const T delta_max = select(falls, before.delta_max, delta);",
          "const T delta_max = select(falls, before.delta_max, 2.0 * delta);", STEP, "largest_overlap"),
    Fault("work of the fully plastic phase", f"{LAWS}/cavity.hpp", "pi * R_star * c_P * Y * x * (delta + delta_P)",
          "pi * R_star * c_P * Y * x * delta", STEP, "slope_of_the_work"),
    Fault("forward Euler instead of velocity Verlet", f"{LAWS}/impact.hpp", "if (n > 0) v -= half * F;",
          "if (n > 0) v -= 0 * F;", IMPACTS, "restitution_of_thornton and embedded"),
    Fault("the dashpot acts while the contact yields", f"{LAWS}/viscous.hpp", "grows = now.after.delta_max > before.delta_max",
          "grows = now.after.delta_max > 2.0 * before.delta_max", "tests/engines/test_laws.py", "dashpot and embedded and thornton"),
    Fault("the dashpot attracts", f"{LAWS}/viscous.hpp", "const T damped = max(T{}, force);",
          "const T damped = force;", "tests/battery/test_embedded.py", "never_attracts"),
    Fault("the dashpot grows with a instead of its root", f"{LAWS}/viscous.hpp", "sqrt(2.0 * law.E_star * now.radius * m_star)",
          "2.0 * law.E_star * now.radius * sqrt(m_star)", "tests/battery/test_embedded.py", "that_of_the_dashpot"),
    Fault("theory of the dashpot forgets the elastic work", f"{PYTHON}/theory/viscous.py", "law.overlap_of_work(law.work(y) + kinetic)",
          "law.overlap_of_work(kinetic)", "tests/physics/test_viscous.py", "plain_time"),
    Fault("(1-nu)^2 for 1-nu^2 in the plugin", f"{LAWS}/pair.hpp", "(1.0 - i.poisson_ratio * i.poisson_ratio)",
          "(1.0 - i.poisson_ratio) * (1.0 - i.poisson_ratio)", IMPACTS, "agree_with_theory and liggghts"),
    Fault("pressure of the harder body", f"{PYTHON}/experiment.py", "parameters[p.name] = min(strengths)",
          "parameters[p.name] = max(strengths)", "tests/decks/test_case_files.py", "softer"),
    Fault("error is a mean over the phases", f"{PYTHON}/compare.py", "deviation.max(axis=1), np.sqrt",
          "deviation.mean(axis=1), np.sqrt", "tests/decks/test_stages.py", "worst_phase"),
    Fault("contact ends with the overlap", f"{PYTHON}/measure.py", "loaded = sampled & (force > 0)",
          "loaded = sampled & (overlap > 0)", IMPACTS, "agree_with_theory and embedded"),
    Fault("the end of contact is not extrapolated", f"{PYTHON}/measure.py", "residual = overlap[row, last] - share *",
          "residual = overlap[row, last] + 0 * share *", "tests/decks/test_stages.py", "dent"),
    Fault("all impacts start at the same phase", f"{PYTHON}/plan.py", "(np.arange(numerics.phases) + 0.5) / numerics.phases",
          "(np.zeros(numerics.phases) + 0.5)", "tests/decks/test_stages.py", "phases"),
    Fault("numbers lose digits in the deck", f"{PYTHON}/deck.py", "else repr(float(x))", "else format(float(x), '.6g')",
          "tests/decks/test_decks.py", "digits"),
    Fault("a stored result is taken whatever changed", f"{PYTHON}/run.py", '.get("inputs") == inputs', '.get("inputs")',
          "tests/decks/test_stages.py", "stored"),
]  # fmt: skip

PLUGIN_TESTS = "tests/engines/test_plugin_invariance.py"
LOOP, LOOP_TEST = f"{PLUGIN}/loop", "tests/engines/test_plugin_loop.py"
FAULTS += [
    Fault("history changes its sign with the side", f"{PLUGIN}/normal.hpp", 'setup->add_history_value(slot, "0");',
          'setup->add_history_value(slot, "1");', PLUGIN_TESTS, "no_bit and thornton and not ning"),
    Fault("LIGGGHTS's loop does not notice that a pair parted", f"{PLUGIN}/normal.hpp", "if (now_ - history[stamp_] > 1.0)",
          "if (false)", LOOP_TEST, "same_bits and loose1"),
    Fault("the force on j is forgotten in LIGGGHTS's loop", f"{PLUGIN}/normal.hpp", "fj.delta_F[k] -= share * s.en[k];",
          "fj.delta_F[k] -= 0.0 * s.en[k];", LOOP_TEST, "same_bits and hertz"),
]  # fmt: skip

FAULTS += [
    Fault("2 ulp in the lever arm of the pair loop", f"{LOOP}/models.hpp", "c.cri = c.radi - 0.5 * c.deltan;",
          "c.cri = c.radi - 0.50000000000000022 * c.deltan;", LOOP_TEST, "same_bits and thornton"),
    Fault("2 ulp in the force that the pair loop adds", f"{LOOP}/loop.cpp", "fj[0] -= gx;",
          "fj[0] -= 1.0000000000000004 * gx;", LOOP_TEST, "same_bits and hertz"),
    Fault("the pair loop does not notice that a pair parted", f"{LOOP}/kernel.hpp", "value[last_step] > 1.0;",
          "value[last_step] > 1e9;", LOOP_TEST, "same_bits and loose1"),
]  # fmt: skip

THEORY, VALUES = f"{PYTHON}/theory", "tests/physics/test_reference_values.py"
FAULTS += [
    Fault("waves of the rebound grow with e_n", f"{THEORY}/energy.py", '0.811 / number("e_n"', '0.811 * number("e_n"',
          VALUES, "rebound"),
    Fault("a cut-off spring slides like a continuum", f"{THEORY}/oblique.py", "- 2 / 3 * e_n / kappa", "- e_n / kappa",
          VALUES, "cut_off_spring"),
    Fault("flat circle opens with Hertz's pressure", f"{THEORY}/backbones.py", "np.arccos(y) - y * np.sqrt(rest)",
          "np.arccos(y) - y * rest", VALUES, "integral_of_8_82"),
    Fault("a length too few in the yield speed", f"{THEORY}/printed.py", "8 * np.pi * R_star**3", "8 * np.pi * R_star**2",
          "tests/physics/test_units_of_measurement.py", "yield_speed"),
]  # fmt: skip


def needs_plugin(fault: Fault) -> bool:
    return fault.file.startswith(PLUGIN) or fault.file.endswith("pair.hpp")


@pytest.mark.parametrize("fault", FAULTS, ids=lambda f: f.name)
def test_a_planted_fault_turns_its_test_red(fault, copy):
    if needs_plugin(fault) and not shutil.which("liggghts"):
        pytest.skip("liggghts is not installed (apt-get install liggghts libliggghts-dev libopenmpi-dev)")
    path = copy / fault.file
    good = path.read_text()
    assert good.count(fault.old) >= 1, f"{fault.file} does not contain {fault.old!r} any more; update the fault"
    path.write_text(good.replace(fault.old, fault.new))
    try:
        if fault.file.startswith("cpp_contact") or not (copy / PYTHON / "native").exists():
            build(copy, needs_plugin(fault))
        done = pytest_in(copy, fault.test, fault.only)
        assert done.returncode == 1, f"the test did not fail:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
    finally:
        path.write_text(good)
        shutil.rmtree(copy / PYTHON / "native", ignore_errors=True)  # the next fault starts from sound parts
        shutil.rmtree(copy / "build", ignore_errors=True)


def test_without_a_fault_the_copy_is_green(copy):
    build(copy, plugin=False)
    done = pytest_in(copy, STEP, "")
    assert done.returncode == 0, done.stdout[-2000:]
