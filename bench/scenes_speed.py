# SPDX-License-Identifier: GPL-2.0-or-later
"""Four scenes of cases/ from end to end, over the same decks with LIGGGHTS's own `hertz`.

    .venv/bin/python bench/scenes_speed.py [--repeats 3 | --quick] [--before LAUNCHER] [--cases settle_glass,...]

Both decks have the same output; that of `hertz` has neither plastic work nor the largest strain, and a coefficient of
restitution of 0.5 where the case has none. `hertz` runs with LIGGGHTS's own lists, walls and integration
(EPDEM_LOOP=generic). Beside the widest instruction set of the processor the case runs with AVX2, in LAMMPS if LAMMPS is
there, and with `--before` by another epdem-liggghts, such as that of an earlier commit: its rows give the ratio to that
one. Times are of the whole process on one core: processor time, which other loads of the machine disturb least,
and wall time. The models take turns, the shortest counts; runs are kept in runs/bench: a bench goes on. `--quick`
measures once, in five minutes.
"""

import argparse
import os
import re
import resource
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import store

from epdem.base import paths, rendering
from epdem.base.files import write_texts
from epdem.case.scene import parse
from epdem.case.toml import read_toml
from epdem.engines.lammps import deck as lammps_deck
from epdem.engines.lammps import launcher as lammps_launcher
from epdem.engines.liggghts import deck as scene_deck
from epdem.engines.liggghts import launcher
from epdem.engines.liggghts.properties import per_pair
from epdem.scenes.plan.meshes import stl_text
from epdem.scenes.plan.plan import plan

# processor time over that of hertz, over that with AVX2, and over that of the launcher before
LIMITS = {
    "settle_glass": (0.45, 0.48, 0.88),
    "compaction_powder": (1.05, 1.18, 0.92),  # growth, screening and retreat of dense beds: 0.85 is the goal
    "hopper_beads": (0.50, 0.55, 0.75),
    "drum_beads": (0.36, 0.48, 0.92),
}
LAMMPS = "LAMMPS"
LIMIT_OF_LAMMPS = 1.15  # processor time over that of LIGGGHTS with the plugin
ENVIRONMENT = {"hertz": {"EPDEM_LOOP": "generic"}, "ep": {}, "ep, AVX2": {"EPDEM_SIMD": "avx2"}}


def files(case: Path, model: str) -> dict[str, str]:
    """The deck of a case as it is, for LIGGGHTS or LAMMPS, or with LIGGGHTS's hertz and the same time step."""
    data = read_toml(case)
    p = plan(parse(data, case))
    if model == "hertz" and p.model.compaction:  # whose words hertz does not know
        dry = data | {"law": {"name": "thornton"}, "numerics": {"time_step": f"{p.time_step!r} s"}}
        p = plan(parse(dry, case))
    if model == LAMMPS:
        return lammps_deck.files(p)
    if model != "hertz":
        return scene_deck.files(p)
    d = scene_deck.deck(p)
    properties, settings = d.contact.properties, d.contact.settings
    if not any(x.name == "coefficientRestitution" for x in properties):
        properties = (*properties, per_pair("coefficientRestitution", len(p.types), 0.5, "-"))
    of_hertz = replace(
        d,
        contact=replace(
            d.contact,
            model="hertz",
            properties=properties,
            settings=tuple(
                s for s in settings if not re.match("computePlasticWork|computeElasticEnergy|computeContactStrain", s)
            ),
        ),
        row_words=tuple(word for word in d.row_words if not word.startswith("c_ratio")),
        contact_columns=scene_deck.contact_columns((), 0),
        wall_contact_columns=scene_deck.contact_columns((), 0, points=2),
        history={},
        wall_history={},
        work_words=(),
    )
    names = {"in.scene": "liggghts/scene.in.j2", "setup.in": "liggghts/scene_setup.in.j2"}
    texts = {name: rendering.render(template, deck=of_hertz) for name, template in names.items()}
    texts["setup.in"] = re.sub(r"^compute ratio .*\n", "", texts["setup.in"], flags=re.MULTILINE)
    return texts | {f"{name}.stl": stl_text(name, triangles) for name, triangles in p.triangles.items()}


def measure(texts: dict[str, str], model: str, environment: dict[str, str]) -> dict[str, float]:
    """Seconds of one run, and its share of pairs and lists by the engine's own clock."""
    engine = lammps_launcher if model == LAMMPS else launcher
    with patch.dict(os.environ, environment), tempfile.TemporaryDirectory(prefix="epdem_scenes_") as name:
        folder = Path(name)
        write_texts(folder, texts)
        paths.launcher.cache_clear()  # EPDEM_LIGGGHTS differs between the models
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        engine.run("in.scene", folder)
        after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic() - start
        text = (folder / engine.OUT).read_text(errors="replace")
    found = {"wall": wall, "processor": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}
    loop = sum(float(x) for x in re.findall(r"^Loop time of (\S+)", text, re.MULTILINE))
    for part in ("Pair", "Neigh"):
        seconds = sum(float(x) for x in re.findall(rf"^{part} *(?:time \(%\) =|\|) *(\S+)", text, re.MULTILINE))
        found[part] = seconds / loop
    return found


def main() -> int:
    """Run every case with both models and print the table; 1 if one of ours takes longer than hertz."""
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--repeats", type=int, default=3)
    ask.add_argument("--quick", action="store_true", help="one repeat")
    ask.add_argument("--before", type=Path, help="an epdem-liggghts to compare with")
    ask.add_argument("--cases", default=",".join(LIMITS))
    options = ask.parse_args()
    models = dict(ENVIRONMENT)
    if lammps_launcher.missing() is None:
        models[LAMMPS] = {}
    if options.before:
        models["before"] = {"EPDEM_LIGGGHTS": str(options.before.resolve())}
    best: dict[tuple[str, str], dict[str, float]] = {}
    for repeat in range(1 if options.quick else options.repeats):
        for case in options.cases.split(","):
            for model, environment in models.items():
                texts = files(store.ROOT / "cases" / f"{case}.toml", model)
                key = re.sub(r"\W+", "_", f"scene {case} {model} {repeat}")
                now = store.once(key, (texts, environment), lambda t=texts, m=model, e=environment: measure(t, m, e))
                old = best.get((case, model), now)
                best[case, model] = {k: min(old[k], now[k]) if k in ("wall", "processor") else now[k] for k in now}
                print(f"{case} {model} {repeat}: {now['processor']:.2f} s ({now['wall']:.2f} s wall)", flush=True)
    print("\n| case | model | processor s | x hertz | wall s | x hertz | pairs | lists | walls, integration, rest |")
    print("|---|---|---|---|---|---|---|---|---|")
    rows = []
    for case in options.cases.split(","):
        for model in models:
            r, hertz = best[case, model], best[case, "hertz"]
            shares = (r["Pair"], r["Neigh"], 1.0 - r["Pair"] - r["Neigh"])
            times = " | ".join(f"{r[k]:.2f} | {r[k] / hertz[k]:.2f}" for k in ("processor", "wall"))
            print(f"| {case} | {model} | {times} | " + " | ".join(f"{s:.0%}" for s in shares) + " |")
        seconds = {model: best[case, model]["processor"] for model in models}
        over = [("ep", "hertz"), ("ep, AVX2", "hertz"), ("ep", "before"), (LAMMPS, "ep")]
        for (model, other), limit in zip(over, (*LIMITS[case], LIMIT_OF_LAMMPS), strict=True):
            if model in seconds and other in seconds:
                rows.append((f"{case}, end to end: {model} over {other}", seconds[model] / seconds[other], limit))
    store.report("scenes_speed", rows)
    print(f"\n{store.table('scenes_speed')}")
    return int(any(ratio > 1.0 for _, ratio, _ in rows))


if __name__ == "__main__":
    sys.exit(main())
