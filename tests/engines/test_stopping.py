# SPDX-License-Identifier: GPL-2.0-or-later
"""Whoever stops a run (Ctrl-C, a batch system, a closed terminal): one sentence, exit code 130, no engine left."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from epdem.base import processes
from epdem.errors import Stopped

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


# Signals in a callback, where Python drops what their handler raises, before a new process is known, and when a process
# has ended but its exit code is not stored: no further wait finds it.
IN_FORK = "os.register_at_fork(after_in_parent=signalled)\n"
CALL = "processes.call(['sleep', '60'], Path.cwd(), log='out')"
STOPPED_IN = {
    "fork of a program": IN_FORK + CALL,
    "fork of a pool": IN_FORK + "list(each(time.sleep, deque([60.0]), 1))",
    "end of a worker": """found = os.waitpid
def reaped(*words):
    ended = found(*words)
    signalled()
    return ended
os.waitpid = reaped
list(each(abs, deque([1.0]), 1))
""",
    "start of a program": """class Late(subprocess.Popen):
    def __init__(self, *words, **options):
        super().__init__(*words, **options)
        signalled()
subprocess.Popen = Late
"""
    + CALL,
    "destructor": """class Gone:
    def __del__(self):
        signalled()
Gone()
time.sleep(60.0)
""",
}
SCRIPT = """import atexit, os, signal, subprocess, time
from collections import deque
from pathlib import Path
from epdem.base import processes
from epdem.studies.sweep.run import each
def signalled():
    os.kill(os.getpid(), signal.SIGTERM)
def at_end():
    children = Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
    print("children:", [c for c in children if ") Z " not in Path(f"/proc/{c}/stat").read_text()])
atexit.register(at_end)
processes.install_signal_handlers()
"""


@pytest.mark.parametrize("place", STOPPED_IN)
def test_no_signal_is_lost_and_no_process_stays(place, tmp_path):
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT + STOPPED_IN[place]], cwd=tmp_path, capture_output=True, text=True, timeout=50
    )
    assert run.stderr.splitlines()[-1].startswith("epdem.errors.Stopped") and "ignored" not in run.stderr
    assert run.stdout == "children: []\n"


def test_a_second_ctrl_c_does_not_interrupt_the_end_of_a_run(monkeypatch):
    """The engine is stopped and the list of files written before the command ends."""
    handlers = {}
    monkeypatch.setattr("signal.signal", handlers.__setitem__)
    with pytest.raises(Stopped):
        processes._stop(signal.SIGINT, None)
    assert handlers == dict.fromkeys((signal.SIGINT, signal.SIGTERM, signal.SIGHUP), signal.SIG_IGN)


@pytest.mark.liggghts
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_stopped_run_says_so_and_leaves_no_engine_behind(how, tmp_path, monkeypatch):
    launcher, mark = tmp_path / "epdem-liggghts", tmp_path / "pid"
    launcher.write_text(SLEEPER)
    launcher.chmod(0o755)
    monkeypatch.setenv("EPDEM_LIGGGHTS", str(launcher))
    monkeypatch.setenv("EPDEM_TEST_PID", str(mark))
    run = subprocess.Popen(
        [sys.executable, "-m", "epdem", "run", str(CASE), "-e", "liggghts"],
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
