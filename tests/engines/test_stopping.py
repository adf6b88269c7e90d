# SPDX-License-Identifier: GPL-2.0-or-later
"""Whoever stops a run (Ctrl-C, a batch system, a closed terminal): one sentence, exit code 130, no engine left."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

CASE = Path(__file__).parents[2] / "cases/steel_wall.toml"
SLEEPER = """#!/bin/sh
[ "$1" = -h ] && exit 0
echo $$ > "$EPDEM_TEST_PID.new"
mv "$EPDEM_TEST_PID.new" "$EPDEM_TEST_PID"
sleep 60
"""


def until(condition, seconds: float = 60.0) -> bool:
    """Whether `condition` comes true in time; generous, because it only bounds a test that fails."""
    end = time.monotonic() + seconds
    while not (found := condition()) and time.monotonic() < end:
        time.sleep(0.02)
    return bool(found)


def alive(process: int) -> bool:
    """False when the process is gone, or a zombie that waits for its parent."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.liggghts
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_stopped_run_says_so_and_leaves_no_engine_behind(how, tmp_path, monkeypatch):
    launcher, mark = tmp_path / "epdem-liggghts", tmp_path / "pid"
    launcher.write_text(SLEEPER)
    launcher.chmod(0o755)
    monkeypatch.setenv("EPDEM_LIGGGHTS", str(launcher))
    monkeypatch.setenv("EPDEM_TEST_PID", str(mark))
    run = subprocess.Popen(
        [sys.executable, "-m", "epdem.cli", "run", str(CASE), "-e", "liggghts"],
        cwd=tmp_path,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert until(mark.exists), "the engine was started"
        engine = int(mark.read_text())
        run.send_signal(how)
        _, words = run.communicate(timeout=60)
    finally:
        run.kill()
    assert run.returncode == 130 and words == "epdem: stopped; what was finished is stored\n"
    assert until(lambda: not alive(engine))
