# SPDX-License-Identifier: GPL-2.0-or-later
"""Sweeps as tasks of a real Slurm: failed and cancelled points, a controller that restarts, requeued scenes, ranks."""

import json
import os
import re
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest
from cluster import cluster, needs_slurm, until
from test_sweep_run import ball
from test_sweep_scenes import BED

from epdem.errors import CaseError
from epdem.studies.sweep import folder, run, slurm, table

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
    return nodes


@pytest.fixture
def case(tmp_path):
    return ball(tmp_path, '["5 m/s"]')


def on_slurm(planned, here, out: Path, given: dict[str, str], during: Callable[[str], None] | None = None, **options):
    """The number of the array that ran the points, and the table when it has left the queue."""
    array = slurm.submit(planned, out, given, **options)

    def left() -> bool:
        if during:
            during(array)
        return not here.ask("squeue", "-h", "-j", array) and here.ask("sinfo", "-h") != ""

    until(left, "the end of the array", seconds=1800)
    return array, table.write(planned, out)


@needs_slurm
def test_50_points_one_fails_one_task_is_cancelled_and_the_controller_restarts(case, here, tmp_path, monkeypatch):
    monkeypatch.setattr(slurm, "TASKS", 10)
    out = tmp_path / "out"
    ratios = [-0.2, *(0.01 * n for n in range(1, 50))]  # LIGGGHTS takes none below 0
    planned = run.plan(case, {"materials.steel.poisson_ratio": ratios})
    cancelled = []

    def disturb(array):
        if not cancelled:
            cancelled.append(f"{array}_9")
            here.ask("scancel", *cancelled)
            here.stop("slurmctld")
            here.start("slurmctld")

    array, found = on_slurm(planned, here, out, {"partition": "main"}, disturb)
    failed = found[found["status"] == "failed"].set_index("point")["reason"]
    assert failed.index.tolist() == [1] and "[0, 0.5]" in failed[1]
    lost = [10, 20, 30, 40, 50]  # the tenth task of ten
    assert found[found["status"] == "waiting"]["point"].tolist() == lost and (found["status"] == "done").sum() == 44
    ends = dict(re.findall(r"ArrayTaskId=(\d+) .*?JobState=(\w+)", here.ask("scontrol", "show", "job", "-o", array)))
    assert ends["0"] == "FAILED" and {ends[str(n)] for n in range(1, 9)} == {"COMPLETED"}  # an exit code for each task
    before = {p: p.read_bytes() for p in out.glob("points/*/point.json")}
    _, again = on_slurm(planned, here, out, {}, retry_failed=True)
    assert again["status"].tolist() == ["failed"] + ["done"] * 49
    first = folder.point_folder(planned, out, 1) / "point.json"
    assert all(p.read_bytes() == text for p, text in before.items() if p != first)
    assert first.read_bytes() != before[first]
    local = run.run(planned, tmp_path / "local", jobs=1).table
    pd.testing.assert_frame_equal(again, local)
    assert slurm.submit(planned, out, {}) is None


@needs_slurm
def test_an_array_of_the_same_sweep_begins_after_the_one_before_it(here, tmp_path):
    """Two calls at once: no point has two tasks; the grown sweep has what the first array has not."""
    out = tmp_path / "out"
    slurm.submit(scene(tmp_path, "0.5 s", 100), out, {})
    until(lambda: list(out.glob("points/*/restart.*.bin")) != [], "a restart file")
    grown = run.plan(tmp_path / "bed.toml", {"scene.count": "100,50"})
    second = slurm.submit(grown, out, {})
    assert "unfulfilled" in here.ask("squeue", "-h", "-o", "%E", "-j", second)
    until(lambda: not here.ask("squeue", "-h"), "the end of both arrays")
    found = table.write(grown, out)
    assert found["status"].tolist() == ["done"] * 2
    ran = [json.loads((out / name / "point.json").read_text()) for name in found["folder"]]
    assert ran[1]["begin"] > ran[0]["begin"] + ran[0]["seconds"]


def scene(tmp_path: Path, duration: str, count: int) -> folder.Sweep:
    """A bed that writes restart files."""
    path = tmp_path / "bed.toml"
    path.write_text(
        BED.replace("restarts = 0", "restarts = 50").replace("rows = 20", "rows = 50").replace("0.3 s", duration)
    )
    return run.plan(path, {"scene.count": str(count)})


def warned(here, array: str) -> None:
    """The signal that Slurm sends before the end of the walltime."""
    here.ask("scancel", "-s", "USR2", array)


def displaced(here, array: str) -> None:
    """An urgent job takes the node, and Slurm stops ours and queues it again."""
    here.ask("sbatch", "-p", "urgent", "-c", "2", "-o", "/dev/null", "--wrap", "sleep 1")


@needs_slurm
@pytest.mark.parametrize("preempt", [warned, displaced])
def test_a_scene_that_is_preempted_is_queued_again_and_goes_on_from_its_restart_file(preempt, here, tmp_path):
    out, planned, sent = tmp_path / "out", scene(tmp_path, "0.5 s", 150), []

    def disturb(array):
        if not sent and len(list(out.glob("points/*/restart.*.bin"))) >= 2:
            assert folder.status(out)["running"] == 1
            sent.append(preempt(here, array))

    array, found = on_slurm(planned, here, out, {"time": "10"}, disturb)
    assert sent and found[["status", "reason"]].fillna("").to_numpy().tolist() == [["done", ""]]
    assert (folder.point_folder(planned, out, 1) / "in.resume").exists()
    restarts = re.search(r"Restarts=(\d+)", here.ask("scontrol", "show", "job", "-o", array))[1]
    assert restarts in ("1", "2")  # Slurm 24.11 queues a job that it displaced once more when the job ends


@needs_slurm
@pytest.mark.skipif("EPDEM_WALLTIME" not in os.environ, reason="takes minutes, for Slurm counts walltime in them")
def test_a_scene_longer_than_its_walltime_is_queued_again_in_time(here, tmp_path):
    out, planned = tmp_path / "out", scene(tmp_path, os.environ["EPDEM_WALLTIME"], 400)
    array, found = on_slurm(planned, here, out, {"time": "2"})  # warned after 30 s
    assert found[["status", "reason"]].fillna("").to_numpy().tolist() == [["done", ""]]
    restarts = int(re.search(r"Restarts=(\d+)", here.ask("scontrol", "show", "job", "-o", array))[1])
    assert restarts >= 1 and (folder.point_folder(planned, out, 1) / "in.resume").exists()


@needs_slurm
def test_ranks_of_a_point_lie_on_two_nodes(case, here, tmp_path, monkeypatch):
    monkeypatch.setenv("OMPI_MCA_btl_tcp_if_include", "lo")  # both nodes are this machine; Open MPI 5 leaves it out
    out, spread = tmp_path / "out", {"partition": "wide", "nodes": "2", "ntasks-per-node": "1"}
    array, found = on_slurm(run.plan(case, {"impact.body.radius": "1 mm"}, ranks=2), here, out, spread)
    assert found["status"].tolist() == ["done"], found["reason"][0]
    assert "NodeList=first,second" in here.ask("scontrol", "show", "job", "-o", array).replace(
        "[first-second]", "first,second"
    )
    (log,) = out.glob("points/*/thornton/liggghts/out.liggghts")
    assert " on 2 procs for " in log.read_text()
    alone = run.run(run.plan(case, {"impact.body.radius": "1 mm"}), tmp_path / "alone", jobs=1).table
    assert found["e_n"].to_numpy() == pytest.approx(alone["e_n"].to_numpy(), rel=1e-8)


@needs_slurm
def test_a_task_that_is_cancelled_while_it_runs_leaves_no_process(here, tmp_path):
    path, out = tmp_path / "bed.toml", tmp_path / "out"
    path.write_text(BED.replace("0.3 s", "30 s"))
    planned = run.plan(path, {"scene.count": "50"})

    def cancel(array):
        if list(out.glob("points/*/in.scene")):
            here.ask("scancel", array)

    on_slurm(planned, here, out, {}, cancel)
    until(lambda: str(out) not in here.ask("ps", "ax", "-o", "args"), "the end of LIGGGHTS")


def test_parameters_are_read_from_words():
    found = slurm.parameters(["partition=long,time=2:00:00", "account=sand,exclusive"])
    assert found == {"partition": "long", "time": "2:00:00", "account": "sand", "exclusive": ""}
    for wrong in ("array=1-5", "output=x", "dependency=afterok:7", ""):
        with pytest.raises(CaseError, match="--slurm"):
            slurm.parameters([wrong])
