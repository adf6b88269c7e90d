# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages of impacts and scenes, and the parts that several pages have."""

import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..base import __version__
from ..base.files import claim
from ..base.paths import product_hash
from ..base.readable import in_words
from ..engines import texts_with_reasons
from ..engines.citations import citations
from ..impacts.experiment import Body, Experiment
from ..impacts.measurement import CHECKED, UNITS
from ..impacts.plan import Plan
from ..impacts.prediction_report import yielding
from ..impacts.run import Outcome
from ..impacts.summary import against_measured, largest_errors
from ..laws.strengths import find_law
from ..scenes.judge.summary import FIRST, SceneOutcome, checked, results, stages_shown
from ..scenes.plan.plan import ScenePlan
from ..scenes.plan.quantities import STRAINS
from ..scenes.tables.columns import units
from ..scenes.tables.stages import against_measured as against_measured_densities
from ..theory.validity import SMALL_DEFORMATION
from . import impacts, scenes
from .page import NAME, Facts, Lines, Page, Part, Rows, write


def command() -> str:
    """The command line of this process, if it is a command of epdem."""
    name = Path(sys.argv[0]).name
    return shlex.join(["epdem", *sys.argv[1:]]) if name == "epdem" else ""


def case_lines(text: str) -> Lines:
    """The case file."""
    return Lines("Case file", [(line, "") for line in text.splitlines()])


def decks(engine: str, job: Plan | ScenePlan | None, stored: Mapping[str, str], of: str = "") -> list[Lines]:
    """The `stored` scripts of a deck by name, line by line with their comments; with the reasons of the engine's
    templates if the job is known. of: end of the titles."""
    texts = {name: text for name, text in stored.items() if name.startswith("in.") or name.endswith((".in", ".py"))}
    texts |= {name: text for name, text in (texts_with_reasons(engine, job) if job else {}).items() if name in texts}
    return [
        Lines(f"Deck {name}{of}", [(command.rstrip(), why) for command, _, why in split])
        for name, text in texts.items()
        for split in [[line.partition("  # ") for line in text.splitlines()]]
    ]


def origin(about: Mapping[str, object], hashes: Mapping[str, object]) -> Facts:
    """Versions of epdem and the engines, and hashes of the inputs; `about`: attributes of a results file."""
    versions = {k.removeprefix("version_"): str(v) for k, v in about.items() if k.startswith("version_")}
    ours = {"epdem": f"{__version__}, sources and compiled parts {product_hash()[:16]}"}
    return Facts("Versions and hashes", ours | versions | {f"inputs of {k}": str(v) for k, v in hashes.items()})


def page_of(
    outcome: Outcome | SceneOutcome,
    sentences: list[str],
    parts: Sequence[Part],
    *,
    hashes: Mapping[str, object],
    laws: Sequence[str],
    engines: Sequence[str],
) -> Page:
    """The page of a case: these parts, then versions, `hashes` of the inputs by run, and what to cite."""
    cited = Facts("What to cite", citations(outcome.case, laws, engines))
    every = [*parts, origin(outcome.results.attributes, hashes), cited]
    said = command() or f"epdem verify rerun {outcome.folder}/results.h5"
    passed = outcome.passed if isinstance(outcome, Outcome) or len(outcome.results.tables["checks"]) else None
    return Page(outcome.case.case.title, sentences, every, passed=passed, command=said, warnings=outcome.warnings)


def write_study_page(page: Page, folder: Path, formats: Sequence[str] = ()) -> Path:
    """Write a page into the folder of its study, with files of each of `formats` of its charts; its path."""
    with claim(folder, force=True):
        return write(folder / NAME, page, formats)


def write_page(outcome: Outcome | SceneOutcome, formats: Sequence[str] = ()) -> Path:
    """Write report.html, and its figures in each of `formats`, into the folder of a run; the path of the page."""
    with claim(outcome.folder, force=True):  # the picture of a bed is drawn for the page
        page = impacts_page(outcome) if isinstance(outcome, Outcome) else scene_page(outcome)
        return write_study_page(page, outcome.folder, formats)


COMPARED = ("engine", "law", "speed", *(f"{n}{k}" for n in CHECKED for k in ("", "_theory", "_error")))
OBLIQUE = ("angle", "spin_before", "e_t", "e_t_theory", "psi_1", "psi_2", "psi_2_theory", "psi_2_error", "spin")


def impacts_page(outcome: Outcome) -> Page:
    """The page of a run."""
    results, several = outcome.results, len(outcome.plans) > 1
    parts: list[Part] = [*impacts.charts(outcome), impacts_table(outcome)]
    for law, p in outcome.plans.items():
        parts.append(Facts("Bodies and law" + f" {law}" * several, _impact_facts(p.experiment)))
    allowed = {name: f"{value:g}" for name, value in outcome.case.tolerances.model_dump().items()}
    parts += [Facts("Tolerances of the case", allowed), case_lines(results.case_text), *impacts_decks(outcome)]
    return page_of(
        outcome,
        impacts_sentences(outcome),
        parts,
        hashes={key: run["inputs"] for key, run in results.runs.items()},
        laws=list(outcome.plans),
        engines=list(dict.fromkeys(results.comparison["engine"])),
    )


def impacts_sentences(outcome: Outcome) -> list[str]:
    """Summary sentences."""
    rows, said = outcome.results.comparison, []
    for law, p in outcome.plans.items():
        speed, prediction = p.experiment.speed, outcome.predictions[law]
        span = f"{speed.min():.4g} to {speed.max():.4g} m/s" if speed.size > 1 else f"{speed[0]:.4g} m/s"
        said.append(
            f"Law {law}: {speed.size} impacts at {span}, each from {p.phases} starting phases within a step of "
            f"{p.time_step:.4g} s; {yielding(prediction)}. e_n of theory goes from {prediction.e_n.max():.4f} to "
            f"{prediction.e_n.min():.4f}."
        )
        if (share := prediction.wave_share) is not None:
            span = " to ".join(dict.fromkeys(f"{100 * s:.2g}" for s in (share.min(), share.max())))
            said.append(
                f"Elastic waves take an estimated {span} % of the kinetic energy (section 8.2.4), which no law of "
                "force loses."
            )
    said += [f"Engine {line}." for line in largest_errors(outcome)]
    said += [line[0].upper() + line[1:] + "." for line in against_measured(outcome)]
    residual = rows["energy_residual"].abs().max()
    if residual == residual:
        said.append(f"The energy balance of an impact closes within {residual:.1e} of its kinetic energy.")
    return said


def impacts_table(outcome: Outcome) -> Rows:
    """All rows of the comparison."""
    rows = outcome.results.comparison
    columns = [*COMPARED[:3], *(k for k in OBLIQUE if k in rows), *COMPARED[3:], "steps_in_contact", "passed"]
    note = "Means over the phases; errors are the largest over the phases. A click on a heading sorts."
    return Rows("Measured and predicted", rows[columns], UNITS, note)


def _impact_facts(x: Experiment) -> dict[str, str]:
    facts = {"body": _body(x.body), "target": _body(x.target), "law": x.law.name}
    units = {p.name: p.unit for p in find_law(x.law.name).parameters if p.unit != "1"}
    facts |= {name: in_words(value, units.get(name, ""), 6) for name, value in x.law.shown().items()}
    facts |= {"E*": in_words(x.E_star, "Pa", 6), "R*": in_words(x.R_star, "m", 6), "m*": f"{x.m_star:.6g} kg"}
    v_y0 = impacts.first_yield(x)
    facts |= {"speed of first yield (8.84, 1.60 Y)": f"{v_y0:.4g} m/s"} if v_y0 == v_y0 else {}
    return facts | {"source": x.source}


def _body(b: Body) -> str:
    shape = f"sphere, R = {in_words(b.radius, 'm', 6)}" if b.radius < float("inf") else "wall"
    if b.rigid:
        return f"{shape}, rigid"
    strength = "" if b.yield_stress is None else f", Y = {in_words(b.yield_stress, 'Pa')}"
    strength += "" if b.hardness is None else f", hardness {in_words(b.hardness, 'Pa')}"
    strength += "" if b.yield_ratio is None else f", first yield at an overlap of {b.yield_ratio:.4g} diameters"
    return f"{shape}, {b.material}: E = {in_words(b.young_modulus, 'Pa')}, nu = {b.poisson_ratio:g}{strength}"


def impacts_decks(outcome: Outcome) -> list[Lines]:
    """Every deck that ran, line by line, with the reasons that the templates of the engine state."""
    stored: dict[tuple[str, str], dict[str, str]] = {}
    for key, text in outcome.results.decks.items():
        law, engine, name = key.split("/", 2)
        stored.setdefault((law, engine), {})[name] = text
    return [
        lines
        for (law, engine), texts in stored.items()
        for lines in decks(engine, outcome.plans.get(law), texts, f" of {engine}, law {law}")
    ]


AFTER_RELEASE = (
    "After a release the force on the sides is 0.8 to 1.3 times that of finite elements from a relative density of 0.8 "
    "on, and too large below."
)
TABLES = [
    ("energy_balance", "Energy balance", "One row for each frame."),
    ("measures", "Measures", "One row for each frame."),
    ("histograms", "Histograms", ""),
    ("rows", "Rows", ""),
]


def scene_page(outcome: SceneOutcome) -> Page:
    """The page of a scene."""
    tables, about = outcome.results.tables, outcome.results.attributes
    shown = scenes.charts(outcome)
    engine = str(about["engine"])
    parts: list[Part] = []
    if "stages" in tables:
        table, known = stages_shown(tables["stages"])
        parts.append(Rows("Stages", table[[*FIRST]], known, "The end of each phase."))
    parts += [*shown[:1], *scenes.bed(outcome), *shown[1:]]
    if "stages" in tables:
        more = table.drop(columns=[*FIRST[1:]])
        parts.append(Rows("Plates, sides and energies at the end of each phase", more, known, AFTER_RELEASE))
    if len(tables["checks"]):
        parts.append(Rows("Checks", checked(tables["checks"]), note="Each number against its expected value."))
    for name, title, note in TABLES:
        table = tables.get(name)
        if table is not None and not table.drop(columns=["step", "time"], errors="ignore").empty:
            parts.append(Rows(title, table, units(table), note))
    listings = decks(engine, outcome.plan, outcome.results.decks)
    parts += [_scene_facts(outcome), case_lines(outcome.results.case_text), *listings]
    return page_of(
        outcome,
        scene_sentences(outcome),
        parts,
        hashes={engine: about["inputs"]},
        laws=[outcome.plan.model.law],
        engines=[engine],
    )


def scene_sentences(outcome: SceneOutcome) -> list[str]:
    """Summary sentences."""
    p, tables = outcome.plan, outcome.results.tables
    last, checks = tables["rows"].iloc[-1], tables["checks"]
    failed = ", ".join(checks["check"][~checks["passed"].astype(bool)])
    about = outcome.results.attributes
    said = results(p, tables)
    said += [
        f"A scene of kind {outcome.case.kind} with law {p.model.law} in {about['engine']} (MPI ranks: "
        f"{about['ranks']}): {p.steps} steps of {p.time_step:.4g} s took {float(str(about['seconds'])):.3g} s.",
        f"At the end, at {last['time']:.4g} s, {int(last['particles'])} spheres are in the room and their kinetic "
        f"energy is {last['kinetic_energy']:.4g} J.",
    ]
    radius, overlap = (last[name] for name in STRAINS)
    said.append(
        f"With w, the share of the weaker body, the contacts reach a strain w a/R* of {radius:.3g} and w delta/R* of "
        f"{overlap:.3g}; small strain ends at w a/R* = {SMALL_DEFORMATION}."
    )
    said += [line[0].upper() + line[1:] + "." for line in against_measured_densities(p, tables)]
    verdict = {0: "This scene has no check.", 1: "The check holds."}.get(len(checks), f"All {len(checks)} checks hold.")
    return [*said, f"These checks fail: {failed}." if failed else verdict]


def _scene_facts(outcome: SceneOutcome) -> Facts:
    p = outcome.plan
    facts = {"kind": outcome.case.kind, "law": p.model.law, "time step": f"{p.time_step:.6g} s"}
    facts |= {"steps": str(p.steps), "smallest radius": in_words(p.smallest, "m"), "materials": ", ".join(p.types)}
    phases = [f"{x.name} up to step {x.end}" + f" (until {x.reached})" * bool(x.reached) for x in p.phases]
    return Facts("The scene", facts | {"phases": ", ".join(phases)})
