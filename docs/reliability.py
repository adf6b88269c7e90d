# SPDX-License-Identifier: GPL-2.0-or-later
"""The tables of reliability in docs/evidence.md: runs killed at random moments, faults in real engines and files.

Run: .venv/bin/python docs/reliability.py [N]      (N kills, default 200; root for the full and read-only disks)

Each trial is stored in runs/reliability/trials.jsonl as it ends; the same command goes on with those that are missing.
"""

import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pandas as pd
from pages import markdown, replace_tables, store
from reliability_faults import FAULTS

from epdem.impacts.store import read as read_results
from epdem.scenes.tables import results

ROOT = Path(__file__).parents[1]
WORK = ROOT / "runs/reliability"
EPDEM = [str(Path(sys.executable).with_name("epdem"))]
COMMANDS = {  # what is killed: the words of the command
    "impacts": ["run", "steel.toml", "-e", "liggghts", "-e", "embedded", "-l", "thornton", "-l", "cavity", "--fresh"],
    "scene": ["run", "scene.toml", "--fresh"],
    "scene on 2 ranks": ["run", "scene.toml", "--fresh", "--ranks", "2"],
    "resume": ["run", "scene.toml", "--resume"],
    "sweep": ["sweep", "steel.toml", "-e", "liggghts", "--set", "impact.body.radius=1 mm..9 mm:5", "-j", "2"],
}
WAYS = {  # how: exit codes that the command may have then
    "SIGKILL of the command": (-9,),
    "SIGTERM": (130, -15),  # by the signal itself while Python still starts
    "Ctrl-C": (130, -2),
    "Ctrl-C twice": (130, -2),
    "SIGKILL of an engine process": (3,),
}
PATIENCE = 60.0  # [s] until everything must have ended


def cases() -> None:
    """Small cases in the working folder."""
    steel = (ROOT / "cases/steel_wall.toml").read_text()
    (WORK / "steel.toml").write_text(re.sub("speeds = .*", 'speeds = ["1 m/s", "5 m/s"]', steel))
    scene = (ROOT / "cases/settle_glass.toml").read_text()
    scene = scene.replace("count = 1000", "count = 100").replace("0.4\nwall", "0.4\nwall")
    (WORK / "scene.toml").write_text(scene.replace("[output]", "[output]\nrows = 100\nrestarts = 50"))


def begin(words: list[str], out: Path) -> subprocess.Popen[bytes]:
    """Start a command of epdem with its results in `out`; its words go to files beside it."""
    with out.with_suffix(".out").open("wb") as said, out.with_suffix(".err").open("wb") as wrong:
        return subprocess.Popen(
            [*EPDEM, *words, "-o", str(out)], cwd=WORK, stdout=said, stderr=wrong, start_new_session=True
        )


def finish(words: list[str], out: Path) -> int:
    """Run a command to its end; its exit code."""
    return begin(words, out).wait(timeout=600)


def living(out: Path) -> list[int]:
    """Processes that work in a folder or below it."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if str((entry / "cwd").readlink()).startswith(str(out)):
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


def tables(kind: str, out: Path) -> dict[str, pd.DataFrame]:
    """The numbers of a finished command, which must not depend on what happened on the way."""
    if kind == "impacts":
        return read_results(out / "results.h5").impacts
    if kind == "sweep":
        found = pd.read_csv(out / "sweep.csv")
        return {"sweep": found[[c for c in found if not c.startswith("seconds")]]}
    return {n: t for n, t in results.read(out / "results.h5").tables.items() if n != "checks"}


def same(one: dict[str, pd.DataFrame], other: dict[str, pd.DataFrame]) -> bool:
    return set(one) == set(other) and all(one[name].equals(other[name]) for name in one)


def stop(process: subprocess.Popen[bytes], way: str, out: Path) -> bool:
    """Do it; False if there was nothing left to stop."""
    if way == "SIGKILL of an engine process":
        while not (engines := [pid for pid in living(out) if pid != process.pid]) and process.poll() is None:
            time.sleep(0.01)  # none has begun yet
        for pid in engines[-1:]:
            os.kill(pid, signal.SIGKILL)
        return bool(engines)
    if process.poll() is not None:
        return False
    sign = {"SIGKILL of the command": signal.SIGKILL, "SIGTERM": signal.SIGTERM}.get(way, signal.SIGINT)
    process.send_signal(sign)
    if way.endswith("twice"):
        time.sleep(random.uniform(0.0, 0.3))
        process.send_signal(sign)
    return True


def kill_once(kind: str, way: str, moment: float, reference: dict[str, pd.DataFrame], out: Path) -> str:
    """ "" if all is as it must be, "late" if the command had ended before, else what is wrong."""
    words = COMMANDS[kind]
    shutil.rmtree(out, ignore_errors=True)
    if kind == "resume":
        first = begin(COMMANDS["scene"], out)
        while not (out / "restart.20000.bin").exists() and first.poll() is None:
            time.sleep(0.01)
        first.kill()
        first.wait()
        settled(out)
    process = begin(words, out)
    time.sleep(moment)
    hit = stop(process, way, out)
    try:
        code = process.wait(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return f"did not end within {PATIENCE:g} s"
    said = out.with_suffix(".err").read_text(errors="replace")
    late = not hit or code == 0
    if not late and code not in WAYS[way] and not (kind == "sweep" and code == 1):
        return f"exit code {code}: {said[-200:]}"
    if "Traceback" in said:
        return f"traceback: {said[-200:]}"
    if not settled(out):
        return f"processes {living(out)} stay behind"
    if (wrong := went_on(kind, out)) or not same(tables(kind, out), reference):
        return wrong or "other numbers than without it"
    return "late" if late else ""


def settled(out: Path) -> bool:
    """Whether every process of a folder ends."""
    end = time.monotonic() + PATIENCE
    while living(out) and time.monotonic() < end:
        time.sleep(0.05)
    return not living(out)


def went_on(kind: str, out: Path) -> str:
    """Give the next command as its user would: continue where there is something to continue; "" if it succeeds."""
    words = [word for word in COMMANDS[kind] if word not in ("--fresh", "--resume")]
    if kind == "sweep":
        words.append("--retry-failed")
    if kind.startswith(("scene", "resume")) and finish([*words, "--resume"], out) == 0:
        return ""
    code = finish(words, out)
    said = out.with_suffix(".err").read_text(errors="replace")
    return "" if code == 0 else f"the next command ends with {code}: {said[-200:]}"


def stored() -> list[dict[str, object]]:
    path = WORK / "trials.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def keep(trial: dict[str, object]) -> None:
    with (WORK / "trials.jsonl").open("a") as stream:
        stream.write(json.dumps(trial) + "\n")
    print(trial, flush=True)


def references() -> tuple[dict[str, dict[str, pd.DataFrame]], dict[str, float]]:
    """(tables, seconds) of every command undisturbed."""
    found, seconds = {}, {}
    for kind, words in COMMANDS.items():
        if kind == "resume":
            found[kind], seconds[kind] = found["scene"], seconds["scene"]
            continue
        out, start = WORK / f"whole {kind}", time.monotonic()
        shutil.rmtree(out, ignore_errors=True)
        if finish(words, out):
            raise SystemExit(f"{kind}: {out.with_suffix('.err').read_text()}")
        found[kind], seconds[kind] = tables(kind, out), time.monotonic() - start
    return found, seconds


def trials(count: int) -> None:
    """The kills and faults that are not stored yet."""
    done = {(t["what"], t["how"], t["number"]) for t in stored()}
    plans = [(kind, way) for kind in COMMANDS for way in WAYS]
    missing = [(n, *plans[n % len(plans)]) for n in range(count)]
    missing = [m for m in missing if (m[1], m[2], m[0]) not in done]
    for name, fault in FAULTS.items():
        if ("fault", name, 0) not in done:
            keep({"what": "fault", "how": name, "number": 0, "wrong": tried(fault, WORK / "fault")})
    if not missing:
        return
    whole, seconds = references()
    for number, kind, way in missing:
        moment = random.Random(number).uniform(0.0, seconds[kind])
        while (wrong := kill_once(kind, way, moment, whole[kind], WORK / "out")) == "late":
            moment *= 0.7
        keep({"what": kind, "how": way, "number": number, "moment": round(moment, 3), "wrong": wrong})


def tried(fault: Callable[[Path, Path], str], out: Path) -> str:
    shutil.rmtree(out, ignore_errors=True)
    return fault(WORK, out)


def report() -> None:
    """Write the tables of docs/data and the table of docs/evidence.md."""
    found = stored()
    kills = [t for t in found if t["what"] != "fault"]
    count = Counter((t["what"], t["how"], not t["wrong"]) for t in kills)
    rows = [
        {
            "killed": kind,
            "how": way,
            "passed": count[kind, way, True],
            "trials": count[kind, way, True] + count[kind, way, False],
        }
        for kind in COMMANDS
        for way in WAYS
    ]
    faults = [
        {"fault": t["how"], "result": t["wrong"] or f"pass: {FAULTS[t['how']].__doc__}"}
        for t in found
        if t["what"] == "fault" and t["how"] in FAULTS
    ]
    trials, planted = pd.DataFrame(rows), pd.DataFrame(faults)
    store("reliability", trials)
    store("reliability_faults", planted)
    passed = trials["passed"].sum(), planted["result"].str.startswith("pass: ").sum()
    lines = [
        ("runs that are stopped", passed[0], trials["trials"].sum(), "[reliability.csv](data/reliability.csv)"),
        ("faults", passed[1], len(planted), "[reliability_faults.csv](data/reliability_faults.csv)"),
    ]
    table = pd.DataFrame(lines, columns=["what", "passed", "of", "each of them"])
    replace_tables("evidence", {"reliability": markdown(table)})


if __name__ == "__main__":
    WORK.mkdir(parents=True, exist_ok=True)
    cases()
    trials(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
    report()
    sys.exit(any(t["wrong"] for t in stored()))
