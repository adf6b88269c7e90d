# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps as jobs of a real Slurm: failed and cancelled points, a controller that restarts, requeued scenes, ranks."""

import json
import os
import re
from functools import partial
from pathlib import Path

import pandas as pd
import pytest
from cluster import cluster, needs_slurm, until
from test_sweep_run import ball
from test_sweep_scenes import BED

from epdem.errors import CaseError
from epdem.studies.sweep import folder, run, slurm
from epdem.studies.sweep.slurm import status

ROOT = Path(__file__).parents[2]
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


def on_slurm(planned, out: Path, given: dict[str, str], **options) -> run.SweepOutcome:
    """The points as jobs of Slurm."""
    return run.run(planned, out, by=partial(slurm.run_jobs, given=given), **options)


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
        if not cancelled and (out / slurm.JOBS).exists():
            cancelled.append(list(jobs(out))[-1])
            here.ask("scancel", cancelled[0])
            here.stop("slurmctld")
            here.start("slurmctld")

    found = on_slurm(planned, out, {"partition": "main"}, report=disturb).table
    lost = jobs(out)[cancelled[0]]
    assert len(lost) == 5 and sorted(n for points in jobs(out).values() for n in points) == list(range(1, 51))
    failed = found[found["status"] == "failed"].set_index("point")["reason"]
    assert sorted(failed.index) == [1, *lost] and "[0, 0.5]" in failed[1]
    assert [failed[n] for n in lost] == [f"its job {cancelled[0]} was cancelled before it began"] * 5
    assert (found["status"] == "done").sum() == 44
    before = {p: p.read_bytes() for p in out.glob("points/*/point.json")}
    again = on_slurm(planned, out, {}, retry_failed=True)
    assert again.ran == 6 and again.table["status"].tolist() == ["failed"] + ["done"] * 49
    redone = [folder.point_folder(planned, out, n) / "point.json" for n in (1, *lost)]
    assert all(p.read_bytes() == text for p, text in before.items() if p not in redone)
    local = run.run(planned, tmp_path / "local", jobs=1).table
    pd.testing.assert_frame_equal(again.table, local)
    assert on_slurm(planned, out, {}).ran == 0


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

    found = on_slurm(planned, out, {"time": "10"}, report=report)
    assert sent and found.table[["status", "reason"]].fillna("").to_numpy().tolist() == [["done", ""]]
    assert (folder.point_folder(planned, out, 1) / "in.resume").exists()
    (job,) = jobs(out)
    restarts = re.search(r"Restarts=(\d+)", here.ask("scontrol", "show", "job", "-o", job))[1]
    assert restarts in ("1", "2")  # Slurm 24.11 queues a job that it displaced once more when the job ends


@needs_slurm
@pytest.mark.skipif("EPDEM_WALLTIME" not in os.environ, reason="takes minutes, for Slurm counts walltime in them")
def test_a_scene_longer_than_its_walltime_is_queued_again_in_time(here, tmp_path):
    out, planned = tmp_path / "out", scene(tmp_path, os.environ["EPDEM_WALLTIME"], 400)
    found = on_slurm(planned, out, {"time": "2"})  # warned after 30 s
    assert found.table[["status", "reason"]].fillna("").to_numpy().tolist() == [["done", ""]]
    (job,) = jobs(out)
    restarts = int(re.search(r"Restarts=(\d+)", here.ask("scontrol", "show", "job", "-o", job))[1])
    assert restarts >= 1 and (folder.point_folder(planned, out, 1) / "in.resume").exists()


@needs_slurm
def test_ranks_of_a_point_lie_on_two_nodes(case, here, tmp_path, monkeypatch):
    monkeypatch.setenv("OMPI_MCA_btl_tcp_if_include", "lo")  # both nodes are this machine; Open MPI 5 leaves it out
    out, spread = tmp_path / "out", {"partition": "wide", "nodes": "2", "ntasks-per-node": "1"}
    found = on_slurm(run.plan(case, {"impact.body.radius": "1 mm"}, ranks=2), out, spread).table
    assert found["status"].tolist() == ["done"], found["reason"][0]
    (job,) = jobs(out)
    assert "NodeList=first,second" in here.ask("scontrol", "show", "job", "-o", job).replace(
        "[first-second]", "first,second"
    )
    (log,) = out.glob("points/*/thornton/liggghts/out.liggghts")
    assert " on 2 procs for " in log.read_text()
    alone = run.run(run.plan(case, {"impact.body.radius": "1 mm"}), tmp_path / "alone", jobs=1).table
    assert found["e_n"].to_numpy() == pytest.approx(alone["e_n"].to_numpy(), rel=1e-8)


@needs_slurm
def test_a_job_that_is_cancelled_while_it_runs_leaves_a_row_and_no_process(here, tmp_path):
    path, out = tmp_path / "bed.toml", tmp_path / "out"
    path.write_text(BED.replace("0.3 s", "30 s"))
    planned = run.plan(path, {"scene.count": "50"})

    def cancel(done, total):
        if list(out.glob("points/*/in.scene")):
            here.ask("scancel", *jobs(out))

    found = on_slurm(planned, out, {}, report=cancel).table
    (job,) = jobs(out)
    assert found["reason"].tolist() == [f"its job {job} ended as CANCELLED while it ran"]
    until(lambda: str(out) not in here.ask("ps", "ax", "-o", "args"), "the end of LIGGGHTS")


def test_parameters_are_read_from_words():
    found = slurm.parameters(["partition=long,time=2:00:00", "account=sand,exclusive"])
    assert found == {"partition": "long", "time": "2:00:00", "account": "sand", "exclusive": ""}
    for wrong in ("array=1-5", "output=x", ""):
        with pytest.raises(CaseError, match="--slurm"):
            slurm.parameters([wrong])
