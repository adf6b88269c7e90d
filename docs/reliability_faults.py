# SPDX-License-Identifier: GPL-2.0-or-later
"""Faults for docs/reliability.py: each takes (folder of the cases, folder for results) and returns what is wrong."""

import os
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

EPDEM = str(Path(sys.executable).with_name("epdem"))
REAL = str(Path(sys.executable).with_name("epdem-liggghts"))
SCENE = ["run", "scene.toml"]
IMPACTS = ["run", "steel.toml", "-e", "liggghts"]


def call(work: Path, words: list[str], out: Path, **environment: str) -> tuple[int, str]:
    """(exit code, standard error)."""
    done = subprocess.run(
        [EPDEM, *words, "-o", out], cwd=work, env=os.environ | environment, capture_output=True, text=True, timeout=600
    )
    return done.returncode, done.stderr


def wrong(got: tuple[int, str], code: int, *words: str) -> str:
    """What differs from the exit code and one sentence with these words; '' if nothing."""
    lines = [line for line in got[1].splitlines() if not line.startswith("warning: ")]
    if got[0] != code:
        return f"exit code {got[0]} instead of {code}: {got[1][-200:]}"
    if code and (len(lines) != 1 or not all(word in got[1] for word in words)):
        return f"said: {got[1][-300:]}"
    return ""


def engine(work: Path, script: str) -> str:
    """The path of a launcher that is a shell script; $REAL in it is ours."""
    path = work / "launcher"
    path.write_text(f"#!/bin/bash\nREAL={REAL}\n{script}\n")
    path.chmod(0o755)
    return str(path)


OURS = (".epdem.json", ".epdem.lock")  # hidden files that a results folder keeps
VERSION = 'case "$*" in *-in\\ in.*) ;; *) exec $REAL "$@" ;; esac\n'  # a question for the version goes to ours


def error_with_exit_0(work: Path, out: Path) -> str:
    """exit code 3 with the engine's last words"""
    script = engine(work, VERSION + "echo 'ERROR: out of luck'; exit 0")
    return wrong(call(work, SCENE, out, EPDEM_LIGGGHTS=script), 3, "out of luck") or wrong(
        call(work, IMPACTS, out.with_name("fault2"), EPDEM_LIGGGHTS=script), 3, "out of luck"
    )


def ended_half_way(work: Path, out: Path) -> str:
    """exit code 3; a run without the last steps is not taken for a whole one"""
    half = VERSION + "sed -i 's/^run .*/run 1000/' in.scene\n" + 'exec $REAL "$@"'
    return wrong(call(work, SCENE, out, EPDEM_LIGGGHTS=engine(work, half)), 3)


def lost_sphere(work: Path, out: Path) -> str:
    """exit code 1: the check of the number of spheres fails"""
    lines = "run 25000\\ngroup gone id 5\\ndelete_atoms group gone compress no\\nrun 25000"
    script = VERSION + f"sed -i 's/^run .*/{lines}/' in.scene\n" + 'exec $REAL "$@"'
    code, said = call(work, SCENE, out, EPDEM_LIGGGHTS=engine(work, script))
    return "" if code == 1 else f"exit code {code} instead of 1: {said[-200:]}"


def not_a_number(work: Path, out: Path) -> str:
    """exit code 3: the frame with the NaN is named"""
    poison = "import struct,sys; p='particles.50000.bin'; b=bytearray(open(p,'rb').read()); "
    poison += "b[-24:-16]=struct.pack('<d', float('nan')); open(p,'wb').write(b)"
    script = VERSION + f'$REAL "$@"; code=$?; {sys.executable} -c "{poison}"; exit $code'
    return wrong(call(work, SCENE, out, EPDEM_LIGGGHTS=engine(work, script)), 3, "50000")


def died(work: Path, out: Path) -> str:
    """exit code 3 with the signal"""
    script = VERSION + "kill -SEGV $$"
    return wrong(call(work, SCENE, out, EPDEM_LIGGGHTS=engine(work, script)), 3, "signal 11")


def hangs(work: Path, out: Path) -> str:
    """exit code 3 with the limit in seconds, and the hanging process is stopped"""
    got = call(work, IMPACTS, out, EPDEM_LIGGGHTS=engine(work, VERSION + "sleep 12345"))
    left = subprocess.run(["pgrep", "-f", "^sleep 12345$"], capture_output=True, check=False).stdout
    return wrong(got, 3, "did not end within") or ("the engine stays behind" if left else "")


def _killed_half_way(work: Path, out: Path) -> None:
    process = subprocess.Popen([EPDEM, *SCENE, "-o", out], cwd=work, start_new_session=True)
    while not (out / "restart.20000.bin").exists() and process.poll() is None:
        time.sleep(0.01)
    process.kill()
    process.wait()
    time.sleep(2.0)  # the engine hears of it and ends


def clock_jumps(work: Path, out: Path) -> str:
    """`--resume` takes the newest restart file by its step, not by its time; a stored run stays stored"""
    years = iter(range(2001, 2025))  # the newest file is the oldest by its time
    _killed_half_way(work, out)
    for path in sorted(out.glob("*.bin"), key=lambda p: -int(p.name.split(".")[1])):
        subprocess.run(["touch", "-d", f"{min(next(years, 2024), 2024)}-01-01", path], check=True)
    if bad := wrong(call(work, [*SCENE, "--resume"], out), 0):
        return bad
    taken = re.search(r"restart\.(\d+)\.bin", (out / "in.resume").read_text())
    if taken is None or int(taken[1]) < 20000:
        return "not resumed from the newest restart file"
    subprocess.run(["touch", "-d", "2099-01-01", *out.iterdir()], check=True)
    before = (out / "results.h5").read_bytes()
    return wrong(call(work, SCENE, out), 0) or ("" if before == (out / "results.h5").read_bytes() else "run anew")


def _full(work: Path, out: Path, words: list[str]) -> str:
    out.mkdir(parents=True)
    for kilobytes in (64, 128, 256, 512, 1024):
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k", "none", out], check=True)
        try:
            got = call(work, words, out / "here")
            left = [p.name for p in out.rglob(".*") if p.is_file() and p.name not in OURS]
        finally:
            subprocess.run(["umount", out], check=True)
        if got[0] not in (0, 2, 3) or "Traceback" in got[1] or (got[0] and got[1].count("\n") != 1):
            return f"{kilobytes} kB: exit code {got[0]}: {got[1][-300:]}"
        if left:
            return f"{kilobytes} kB: {left} stay behind"
    return ""


def full_disk_scene(work: Path, out: Path) -> str:
    """64 kB to 1 MB: exit code 2 or 3 with one sentence, no temporary file stays"""
    return _full(work, out, SCENE)


def full_disk_impacts(work: Path, out: Path) -> str:
    """64 kB to 1 MB: exit code 2 or 3 with one sentence, no temporary file stays"""
    return _full(work, out, IMPACTS)


def read_only(work: Path, out: Path) -> str:
    """exit code 2 with the folder's name"""
    out.mkdir(parents=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "ro", "none", out], check=True)
    try:
        return wrong(call(work, SCENE, out / "here"), 2, "here")
    finally:
        subprocess.run(["umount", out], check=True)


def _damaged(work: Path, out: Path, words: list[str], name: str, then: list[str], code: int, *said: str) -> str:
    if first := wrong(call(work, words, out), 0):
        return first
    path = sorted(out.rglob(name))[-1]
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    return wrong(call(work, [*then, "--force"], out), code, *said)


def half_a_results_file(work: Path, out: Path) -> str:
    """the next call runs anew"""
    return _damaged(work, out, IMPACTS, "results.h5", IMPACTS, 0)


def half_a_restart_file(work: Path, out: Path) -> str:
    """exit code 3 with the engine's last words"""
    _killed_half_way(work, out)
    for path in out.glob("restart.*.bin"):
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    return wrong(call(work, [*SCENE, "--resume"], out), 3)


def half_a_dump(work: Path, out: Path) -> str:
    """`--resume` leaves the frame out and names it, or writes it again"""
    return _damaged(work, out, SCENE, "particles.25000.bin", [*SCENE, "--resume"], 0)


def half_a_log(work: Path, out: Path) -> str:
    """`--resume` continues from a restart file that the log names, or refuses if there is none"""
    got = _damaged(work, out, SCENE, "out.liggghts", [*SCENE, "--resume"], 0)
    return "" if "no restart file" in got else got


FAULTS: dict[str, Callable[[Path, Path], str]] = {
    "engine prints ERROR and exits with 0": error_with_exit_0,
    "engine ends half-way with exit code 0": ended_half_way,
    "engine ends by a segmentation fault": died,
    "a sphere is lost half-way": lost_sphere,
    "NaN in a frame": not_a_number,
    "engine that never ends": hangs,
    "clock that jumps by years": clock_jumps,
    "disk full, scene": full_disk_scene,
    "disk full, impacts": full_disk_impacts,
    "read-only disk": read_only,
    "half a results.h5": half_a_results_file,
    "half a restart file": half_a_restart_file,
    "half a dump": half_a_dump,
    "half a log": half_a_log,
}
