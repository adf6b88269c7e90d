# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps as jobs of a real Slurm: failed and cancelled points, a controller that restarts, requeued scenes, ranks."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest
from cluster import cluster, needs_slurm, until
from test_sweep_run import ball
from test_sweep_scenes import BED

from epdem.errors import CaseError
from epdem.studies.sweep import folder, run, slurm
from epdem.studies.sweep.slurm import execute, status, write_script

ROOT = Path(__file__).parents[2]
EPDEM = str(Path(sys.executable).parent / "epdem")
pytestmark = [pytest.mark.liggghts, pytest.mark.waits]


@pytest.fixture(scope="module")
def nodes(tmp_path_factory):
    with cluster(tmp_path_factory.mktemp("slurm")) as found:
        yield found


@pytest.fixture
def here(nodes, monkeypatch):
    for name in ("SLURM_CONF", "PATH"):
        monkeypatch.setenv(name, nodes.env[name])
    monkeypatch.setattr(slurm, "POLL", 0.2)
    return nodes


@pytest.fixture
def case(tmp_path):
    return ball(tmp_path, '["5 m/s"]')


def jobs(out: Path) -> dict[str, list[int]]:
    return json.loads((out / slurm.JOBS).read_text())


@needs_slurm
def test_50_points_one_fails_one_job_is_cancelled_and_the_controller_restarts(case, here, tmp_path, monkeypatch):
    monkeypatch.setattr(slurm, "TASKS", 10)
    out = tmp_path / "out"
    ratios = [-0.2, *(0.01 * n for n in range(1, 50))]  # LIGGGHTS takes none below 0
    planned = run.plan(case, {"materials.steel.poisson_ratio": ratios})
    cancelled = []

    def disturb(done, total):
        if not cancelled:
            cancelled.append(list(jobs(out))[-1])
            here.ask("scancel", cancelled[0])
            here.stop("slurmctld")
            here.start("slurmctld")

    found = slurm.run(planned, out, {"partition": "main"}, report=disturb).table
    lost = jobs(out)[cancelled[0]]
    assert len(lost) == 5 and sorted(n for points in jobs(out).values() for n in points) == list(range(1, 51))
    failed = found[found["status"] == "failed"].set_index("point")["reason"]
    assert sorted(failed.index) == [1, *lost] and "[0, 0.5]" in failed[1]
    assert [failed[n] for n in lost] == [f"its job {cancelled[0]} was cancelled before it began"] * 5
    assert (found["status"] == "done").sum() == 44
    before = {p: p.read_bytes() for p in out.glob("points/*/point.json")}
    again = slurm.run(planned, out, {}, retry_failed=True)
    assert again.ran == 6 and again.table["status"].tolist() == ["failed"] + ["done"] * 49
    redone = [folder.point_folder(planned, out, n) / "point.json" for n in (1, *lost)]
    assert all(p.read_bytes() == text for p, text in before.items() if p not in redone)
    local = run.run(planned, tmp_path / "local", jobs=1).table
    pd.testing.assert_frame_equal(again.table, local)
    assert slurm.run(planned, out, {}).ran == 0


def scene(tmp_path: Path, duration: str, count: int) -> folder.Sweep:
    """A bed that writes restart files."""
    path = tmp_path / "bed.toml"
    path.write_text(
        BED.replace("restarts = 0", "restarts = 50").replace("rows = 20", "rows = 50").replace("0.3 s", duration)
    )
    return run.plan(path, {"scene.count": str(count)})


def warned(here, out: Path) -> None:
    """The signal that Slurm sends before the end of the walltime."""
    here.ask("scancel", "-s", "USR2", *jobs(out))


def displaced(here, out: Path) -> None:
    """An urgent job takes the node, and Slurm stops ours and queues it again."""
    here.ask("sbatch", "-p", "urgent", "-c", "2", "-o", "/dev/null", "--wrap", "sleep 1")


@needs_slurm
@pytest.mark.parametrize("preempt", [warned, displaced])
def test_a_scene_that_is_preempted_is_queued_again_and_goes_on_from_its_restart_file(preempt, here, tmp_path):
    out, planned, sent = tmp_path / "out", scene(tmp_path, "0.5 s", 150), []

    def report(done, total):
        if not sent and len(list(out.glob("points/*/restart.*.bin"))) >= 2:
            assert status(out)["running"] == 1
            sent.append(preempt(here, out))

    found = slurm.run(planned, out, {"time": "10"}, report=report)
    assert sent and found.table[["status", "reason"]].fillna("").to_numpy().tolist() == [["done", ""]]
    assert (folder.point_folder(planned, out, 1) / "in.resume").exists()
    (job,) = jobs(out)
    restarts = re.search(r"Restarts=(\d+)", here.ask("scontrol", "show", "job", "-o", job))[1]
    assert restarts in ("1", "2")  # Slurm 24.11 queues a job that it displaced once more when the job ends


@needs_slurm
@pytest.mark.skipif("EPDEM_WALLTIME" not in os.environ, reason="takes minutes, for Slurm counts walltime in them")
def test_a_scene_longer_than_its_walltime_is_queued_again_in_time(here, tmp_path):
    out, planned = tmp_path / "out", scene(tmp_path, os.environ["EPDEM_WALLTIME"], 400)
    found = slurm.run(planned, out, {"time": "1"})
    assert found.table[["status", "reason"]].fillna("").to_numpy().tolist() == [["done", ""]]
    (job,) = jobs(out)
    restarts = int(re.search(r"Restarts=(\d+)", here.ask("scontrol", "show", "job", "-o", job))[1])
    assert restarts >= 1 and (folder.point_folder(planned, out, 1) / "in.resume").exists()


@needs_slurm
def test_ranks_of_a_point_lie_on_two_nodes(case, here, tmp_path, monkeypatch):
    monkeypatch.setenv("OMPI_MCA_btl_tcp_if_include", "lo")  # both nodes are this machine; Open MPI 5 leaves it out
    out, spread = tmp_path / "out", {"partition": "wide", "nodes": "2", "ntasks-per-node": "1"}
    found = slurm.run(run.plan(case, {"impact.body.radius": "1 mm"}, ranks=2), out, spread).table
    assert found["status"].tolist() == ["done"], found["reason"][0]
    (job,) = jobs(out)
    assert "NodeList=first,second" in here.ask("scontrol", "show", "job", "-o", job).replace(
        "[first-second]", "first,second"
    )
    (log,) = out.glob("points/*/thornton/liggghts/log.liggghts")
    assert " on 2 procs for " in log.read_text()
    alone = run.run(run.plan(case, {"impact.body.radius": "1 mm"}), tmp_path / "alone", jobs=1).table
    assert found["e_n"].to_numpy() == pytest.approx(alone["e_n"].to_numpy(), rel=1e-8)


def test_walltimes_are_read_as_slurm_reads_them():
    times = {"5": 300, "5:30": 330, "2:00:00": 7200, "1-12": 129600, "1-1:30": 91800, "1-0:0:1": 86401}
    assert {time: slurm.seconds(time) for time in times} == times
    assert slurm.seconds("UNLIMITED") > 1e7


@needs_slurm
def test_a_job_that_is_cancelled_while_it_runs_leaves_a_row_and_no_process(here, tmp_path):
    path, out = tmp_path / "bed.toml", tmp_path / "out"
    path.write_text(BED.replace("0.3 s", "30 s"))
    planned = run.plan(path, {"scene.count": "50"})

    def cancel(done, total):
        if list(out.glob("points/*/in.scene")):
            here.ask("scancel", *jobs(out))

    found = slurm.run(planned, out, {}, report=cancel).table
    (job,) = jobs(out)
    assert found["reason"].tolist() == [f"its job {job} ended as CANCELLED while it ran"]
    until(lambda: str(out) not in here.ask("ps", "ax", "-o", "args"), "the end of LIGGGHTS")


@needs_slurm
def test_a_batch_script_is_submitted_by_hand_and_ranks_go_through_srun(case, here, tmp_path):
    out, script = tmp_path / "out", tmp_path / "job.sh"
    lines = tmp_path / "mine.sh"
    lines.write_text("#!/bin/bash\n#SBATCH --partition=main\n#SBATCH --time=5\necho nothing of this\n")
    planned = run.plan(case, {"impact.body.radius": "1 mm,2 mm"}, ranks=2)
    write_script(planned, out, [str(lines)], script)
    assert "#SBATCH --partition=main\n" in script.read_text() and "echo" not in script.read_text()
    subprocess.check_output(["sbatch", "-o", str(tmp_path / "%A_%a.log"), str(script)])
    until(lambda: status(out)["done"] + status(out)["failed"] == 2, "the end of two points", seconds=200)
    said = subprocess.check_output([EPDEM, "status", str(out), "--table", "--json"])
    assert json.loads(said)["done"] == 2 and (out / "sweep.csv").exists()
    alone = run.run(run.plan(case, {"impact.body.radius": "1 mm,2 mm"}), tmp_path / "alone", jobs=1).table
    table = pd.read_csv(out / "sweep.csv")
    assert table["e_n"].to_numpy() == pytest.approx(alone["e_n"].to_numpy(), rel=1e-8)
    logs = [p.read_text() for p in out.glob("points/*/thornton/liggghts/log.liggghts")]
    assert len(logs) == 2 and all(" on 2 procs for " in text for text in logs)


@needs_slurm
def test_a_batch_script_that_is_warned_queues_its_scene_again(here, tmp_path):
    out, planned, script = tmp_path / "out", scene(tmp_path, "0.5 s", 150), tmp_path / "job.sh"
    write_script(planned, out, ["time=10"], script)
    job = here.ask("sbatch", "--parsable", "-o", str(tmp_path / "log"), str(script)).strip()
    until(lambda: len(list(out.glob("points/*/restart.*.bin"))) >= 2, "two restart files", seconds=200)
    here.ask("scancel", "-b", "-s", "USR2", f"{job}_1")
    until(lambda: status(out)["done"] + status(out)["failed"] == 1, "the end of the scene", seconds=200)
    assert status(out)["done"] == 1 and (folder.point_folder(planned, out, 1) / "in.resume").exists()
    assert "Restarts=1 " in here.ask("scontrol", "show", "job", "-o", f"{job}_1")


def test_parameters_are_read_from_words_and_from_lines(tmp_path):
    lines = tmp_path / "mine.sh"
    lines.write_text("#!/bin/bash\n#SBATCH --account=sand\n#SBATCH --exclusive\n")
    assert slurm.parameters(["partition=long,time=2:00:00", str(lines)]) == {
        "partition": "long",
        "time": "2:00:00",
        "account": "sand",
        "exclusive": "",
    }
    for wrong in ("array=1-5", "output=x", ""):
        with pytest.raises(CaseError, match="--slurm"):
            slurm.parameters([wrong])


def test_executors_refuse_what_they_do_not_know(case, tmp_path):
    planned = run.plan(case, {"impact.body.radius": "1 mm"}, engines=["embedded"])
    for executor, given, words in (("pbs", [], "there are local, slurm"), ("local", ["time=5"], "goes with")):
        with pytest.raises(CaseError, match=words):
            execute(planned, tmp_path / "out", executor, given)
    assert slurm.share(range(1, 8), 2, 3) == [2, 5]
