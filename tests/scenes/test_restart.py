# SPDX-License-Identifier: GPL-2.0-or-later
"""An interrupted bulk run goes on from its last restart file; Ctrl-C leaves no process behind."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from test_lean import CASES, small
from toml_files import write_case

from epdem.case.impact import read_toml
from epdem.case.scene import is_scene, parse
from epdem.errors import CaseError
from epdem.liggghts import launcher, resume
from epdem.liggghts import scene_deck as deck
from epdem.liggghts import scene_tables as tables
from epdem.scenes import results
from epdem.scenes.run import last_restart, run

pytestmark = pytest.mark.liggghts
SCENES = [p for p in CASES if is_scene(read_toml(p))]


def short(path: Path):
    """A small scene with nine restart files on its way."""
    return parse(small(read_toml(path)) | {"output": {"rows": 20, "particles": 10, "restarts": 10}})


def last_frame(case, folder: Path) -> np.ndarray:
    d = deck.deck(case)
    table = tables.particles(folder, d)
    return table[table["step"] == d.steps].to_numpy()


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_a_continued_run_ends_bitwise_where_the_uninterrupted_one_does(path, tmp_path):
    case = short(path)
    deck.write(case, tmp_path)
    launcher.run("in.scene", tmp_path)
    whole = last_frame(case, tmp_path)
    steps = sorted(int(re.search(r"\d+", p.name).group()) for p in tmp_path.glob("restart.*.bin"))
    for step in (steps[2], steps[6]):
        for frame in tmp_path.glob("particles.*.bin"):
            frame.unlink()
        resume.write_resume(case, tmp_path, f"restart.{step}.bin", step)
        launcher.run("in.resume", tmp_path)
        continued = last_frame(case, tmp_path)
        assert continued.shape == whole.shape
        assert (continued == whole).all(), f"continued from {step}: largest difference {abs(continued - whole).max()}"


INTERRUPTED = """
import signal, sys
from pathlib import Path
from epdem.scenes.run import run
signal.signal(signal.SIGINT, signal.default_int_handler)  # the tests may run where Ctrl-C is ignored
print("started", flush=True)
run(Path(sys.argv[1]), out=Path(sys.argv[2]), ranks=int(sys.argv[3]), tell=lambda s, n: print(s, flush=True))
"""


def long_case(folder: Path) -> Path:
    """A case that runs for some ten seconds, in which it is certainly interrupted."""
    text = next(p for p in SCENES if p.stem.startswith("settle")).read_text()
    text = text.replace("[output]", "[output]\nrows = 1000\nrestarts = 500")
    text = re.sub(r"particles = 5", "particles = 10", text)
    path = folder / "case.toml"
    path.write_text(text)
    return path


def children(mark: str) -> list[int]:
    """Processes whose command line or working folder holds `mark`."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if mark in str((entry / "cwd").readlink()):
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


@pytest.mark.parametrize("ranks", [1, 2])
def test_ctrl_c_stops_liggghts_with_all_its_ranks_and_the_run_can_be_continued(ranks, tmp_path):
    case, out = long_case(tmp_path), tmp_path / "out"
    process = subprocess.Popen(
        [sys.executable, "-c", INTERRUPTED, str(case), str(out), str(ranks)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    try:
        for line in process.stdout:
            if line.strip().isdigit() and int(line) >= 240:
                break
        assert children(str(out)), "LIGGGHTS runs in its folder"
        os.kill(process.pid, signal.SIGINT)
        process.wait(timeout=60)
    finally:
        process.kill()
    end = time.monotonic() + 60
    while children(str(out)) and time.monotonic() < end:  # the kernel needs a moment to take the ended processes away
        time.sleep(0.1)
    assert not children(str(out))
    assert process.returncode != 0
    assert not (out / "results.h5").exists()
    step = last_restart(out)[1]
    assert step > 0
    assert list(out.glob("restart.*.bin"))


class Enough(Exception):
    """The moment at which a test stops a run."""


def stopped_run(path: Path, out: Path, share: float = 0.6) -> None:
    """Run a case until that share of its steps is done."""

    def stop(step, steps):
        if step > share * steps:
            raise Enough

    with pytest.raises(Enough):
        run(path, out=out, tell=stop)
    assert not children(str(out))


@pytest.mark.parametrize("path", SCENES, ids=lambda p: p.stem)
def test_every_table_of_a_continued_run_is_that_of_the_uninterrupted_one(path, tmp_path):
    data = read_toml(path)
    output = {"rows": 40, "particles": 20, "restarts": 20, "energy": True, "loads": True}
    path = write_case(small(data) | {"output": output}, tmp_path)
    whole = run(path, out=tmp_path / "whole")
    stopped_run(path, tmp_path / "parts")
    again = run(path, out=tmp_path / "parts", resume=True)
    assert 0 < again.resumed_from < again.deck.steps
    a, b = (results.read(tmp_path / name / "results.h5") for name in ("whole", "parts"))
    assert set(a.tables) == set(b.tables) == {"rows", "particles", "contacts", "ledger", "checks"}
    for name, table in a.tables.items():
        for column in table:
            assert table[column].equals(b.tables[name][column]), f"{name}.{column} differs"
    assert a.rows.drop(columns=["step", "time"]).any().all(), "no column of the rows is empty"
    assert whole.passed == again.passed


def test_a_changed_case_is_not_continued(tmp_path):
    path = long_case(tmp_path)
    with pytest.raises(CaseError, match="no restart file"):
        run(path, out=tmp_path / "out", resume=True)
    (tmp_path / "out").mkdir()
    (tmp_path / "out/out.liggghts").write_text("   240   10  0.1 \n   240  10  0.1 \n")
    (tmp_path / "out/restart.240.bin").write_bytes(b"")
    with pytest.raises(CaseError, match="the case has changed"):
        run(path, out=tmp_path / "out", resume=True)
