# SPDX-License-Identifier: GPL-2.0-or-later
"""Shared by all tests: repeatable hypothesis, and skips of engines that are not here."""

import fcntl
import os
import shutil
from functools import cache

import pytest
from hypothesis import HealthCheck, settings

import warm_yade
from epdem.engines.lammps import launcher as lammps

settings.register_profile("epdem", derandomize=True, deadline=None, suppress_health_check=list(HealthCheck))
settings.load_profile("epdem")

os.fsync = lambda file: None  # results of tests outlive no crash of the machine; a run waits five times for the disk
# ranks of MPICH that wait sleep: beside other tests a rank would wait for one that has no processor
os.environ |= {"MPIR_CVAR_CH4_PROGRESS_THROTTLE": "1", "MPIR_CVAR_CH4_PROGRESS_THROTTLE_NO_PROGRESS_COUNT": "16"}


def blank(chart):
    """The figure of a chart with empty axes, which is saved at once."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(1.0, 1.0))
    for _ in chart.panels:
        figure.add_axes((0.0, 0.0, 1.0, 1.0)).set_axis_off()
    return figure


@pytest.fixture(autouse=True)
def figures(request, monkeypatch):
    """Figures are empty but in tests with the mark `figures`: the drawing of a curve takes half a second."""
    if not request.node.get_closest_marker("figures"):
        monkeypatch.setattr("epdem.report.chart.draw", blank)
        monkeypatch.setattr("epdem.report.pictures.DPI", 10)


ENGINES = {"liggghts": "apt-get install liggghts libliggghts-dev libopenmpi-dev", "yade": "apt-get install yade"}


@pytest.fixture(scope="session")
def shared(tmp_path_factory):
    """once(name, make): the folder `name`, which `make` fills once for the processes of all workers."""
    base = tmp_path_factory.getbasetemp()
    common = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base

    def once(name, make):
        folder, ready = common / name, common / f"{name}.ready"
        with (common / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not ready.exists():
                folder.mkdir()
                make(folder)
                ready.touch()
        return folder

    return once


@pytest.fixture(scope="session")
def started_yade(tmp_path_factory):
    """The folder of the program `yade`; runs of planted faults take that of the test that calls them."""
    if folder := os.environ.get("STARTED_YADE"):
        yield folder
        return
    with warm_yade.warm_yade(tmp_path_factory.mktemp("yade")) as folder:
        yield folder


@pytest.fixture(autouse=True)
def one_yade(request, monkeypatch):
    """Scripts of YADE run in children of one YADE, but in tests with the mark `yade("alone")`."""
    mark = request.node.get_closest_marker("yade")
    if mark and "alone" not in mark.args:
        folder = str(request.getfixturevalue("started_yade"))
        monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
        monkeypatch.setenv("STARTED_YADE", folder)


def pytest_collection_modifyitems(items):
    """An engine test is skipped, with its reason, only where the engine is not installed; never in CI. A test of YADE's
    module is skipped where nothing can build it."""
    items[:] = in_shares(items, int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", 1)))
    for item in items:
        for name in ("lammps", *ENGINES):
            if item.get_closest_marker(name) and not os.environ.get("CI") and (reason := missing(name)):
                item.add_marker(pytest.mark.skip(reason=reason))
        if needs_module(item) and not {"YADE_SOURCE", "EPDEM_YADE_MODULE"} & {*os.environ}:
            item.add_marker(pytest.mark.skip(reason="YADE_SOURCE names no source of YADE; its headers are needed"))


@cache
def missing(name):
    """Why an engine cannot run here, or None."""
    if name == "lammps":
        return lammps.missing()
    return None if shutil.which(name) else f"{name} is not installed ({ENGINES[name]})"


def in_shares(items, processes):
    """The tests in an order of which each process takes an equal part.

    Tests that wait lead the part of the first process, so that it waits while the others compute. Slow tests lead the
    parts of the others, lest one of them be the last.
    """
    early, rest = {}, []
    for item in items:
        mark = next((mark for mark in ("waits", "slow") if item.get_closest_marker(mark)), None)
        (early.setdefault((mark != "waits", item.path), []) if mark else rest).append(item)
    shares = [[] for _ in range(processes)]
    for k, (computes, file) in enumerate(sorted(early)):  # by files: the tests of one share what it prepares
        shares[-1 - k % max(1, processes - 1) if computes else 0] += early[computes, file]
    size = -(-len(items) // processes)
    for share in shares:
        n = max(0, size - len(share))
        share += rest[:n]
        del rest[:n]
    return [item for share in shares for item in share]


def needs_module(item):
    """Whether a test runs YADE with the module epdem_yade."""
    mark = item.get_closest_marker("yade")
    return mark is not None and "module" in mark.args


@pytest.fixture(autouse=True)
def module_of_yade(request, monkeypatch):
    """Tests with the mark `yade("module")` run YADE with epdem_yade, in commands, too; other tests without it."""
    module = None
    if needs_module(request.node):
        from engines.yade_native import module_folder

        module = module_folder() / "epdem_yade.so"
    monkeypatch.setattr("epdem.engines.yade.launcher.module", lambda: module)
    if module:
        monkeypatch.setenv("EPDEM_YADE_MODULE", str(module.parent))
