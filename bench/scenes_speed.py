# SPDX-License-Identifier: GPL-2.0-or-later
"""Four scenes of cases/ from end to end, over the same decks with LIGGGHTS's own `hertz`.

    .venv/bin/python bench/scenes_speed.py [--repeats 3] [--cases settle_glass,...]

Both decks have the same output; that of `hertz` has no plastic work, and a coefficient of restitution of 0.5 where the
case has none. Times are those of the whole process: processor time, which other loads of the machine disturb least, and
wall time. The models take turns, the shortest counts; runs are kept in runs/bench: a bench goes on.
"""

import argparse
import re
import resource
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import store

from epdem.base import rendering
from epdem.base.files import write_texts
from epdem.case.scene import load
from epdem.engines.liggghts import launcher, scene_deck, stl
from epdem.engines.liggghts.properties import per_pair
from epdem.scenes.plan import plan

LIMITS = {"settle_glass": 0.5, "compaction_powder": 0.5, "hopper_beads": 0.6, "drum_beads": 0.6}
MODELS = ("hertz", "ep")


def files(case: Path, model: str) -> dict[str, str]:
    """The deck of a case with its own law, or with LIGGGHTS's hertz."""
    p = plan(load(case))
    if model == "ep":
        return scene_deck.files(p)
    d = scene_deck.deck(p)
    properties = d.properties
    if not any(x.name == "coefficientRestitution" for x in properties):
        properties = (*properties, per_pair("coefficientRestitution", d.n_types, 0.5, "-"))
    settings = tuple(s for s in d.settings if s != "computePlasticWork on")
    columns = scene_deck.contact_columns(0, 0)
    unused = dict(yields=False, writes_plastic_work=False, writes_friction_work=False, history_columns=())
    columns_of = dict(contact_columns=columns, wall_contact_columns=columns)
    d = replace(d, model="hertz", properties=properties, settings=settings, **unused, **columns_of)
    names = {"in.scene": "liggghts/scene.in.j2", "setup.in": "liggghts/scene_setup.in.j2"}
    texts = {name: rendering.render(template, deck=d) for name, template in names.items()}
    return texts | {f"{name}.stl": stl.text(name, triangles) for name, triangles in p.triangles.items()}


def measure(texts: dict[str, str]) -> dict[str, float]:
    """Seconds of one run, and its share of pairs and lists by LIGGGHTS's own clock."""
    with tempfile.TemporaryDirectory(prefix="epdem_scenes_") as name:
        folder = Path(name)
        write_texts(folder, texts)
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        launcher.run("in.scene", folder)
        after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic() - start
        text = (folder / launcher.OUT).read_text(errors="replace")
    found = {"wall": wall, "processor": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}
    loop = sum(float(x) for x in re.findall(r"^Loop time of (\S+)", text, re.MULTILINE))
    for part in ("Pair", "Neigh", "Comm", "Outpt", "Other"):
        seconds = sum(float(x) for x in re.findall(rf"^{part} *time \(%\) = (\S+)", text, re.MULTILINE))
        found[part] = seconds / loop
    return found


def main() -> int:
    """Run every case with both models and print the table; 1 if one of ours takes longer than hertz."""
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--repeats", type=int, default=3)
    ask.add_argument("--cases", default=",".join(LIMITS))
    options = ask.parse_args()
    best: dict[tuple[str, str], dict[str, float]] = {}
    for repeat in range(options.repeats):
        for case in options.cases.split(","):
            for model in MODELS:
                texts = files(store.ROOT / "cases" / f"{case}.toml", model)
                now = store.once(f"scene_{case}_{model}_{repeat}", texts, lambda t=texts: measure(t))
                old = best.get((case, model), now)
                best[case, model] = {k: min(old[k], now[k]) if k in ("wall", "processor") else now[k] for k in now}
                print(f"{case} {model} {repeat}: {now['processor']:.2f} s ({now['wall']:.2f} s wall)", flush=True)
    print("\n| case | model | processor s | x hertz | wall s | x hertz | pairs | lists | walls, integration, rest |")
    print("|---|---|---|---|---|---|---|---|---|")
    rows = []
    for case in options.cases.split(","):
        for model in MODELS:
            r, hertz = best[case, model], best[case, "hertz"]
            shares = (r["Pair"], r["Neigh"], 1.0 - r["Pair"] - r["Neigh"])
            times = " | ".join(f"{r[k]:.2f} | {r[k] / hertz[k]:.2f}" for k in ("processor", "wall"))
            print(f"| {case} | {model} | {times} | " + " | ".join(f"{s:.0%}" for s in shares) + " |")
        rows.append((f"{case}, end to end", best[case, "ep"]["processor"] / hertz["processor"], LIMITS[case]))
    store.report("scenes_speed", rows)
    return int(any(ratio > 1.0 for _, ratio, _ in rows))


if __name__ == "__main__":
    sys.exit(main())
