# SPDX-License-Identifier: GPL-2.0-or-later
"""A real Slurm on this machine: munged, slurmctld and slurmd of Debian, started in a folder and stopped at the end."""

import contextlib
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

ROOT_ALONE = "Slurm's daemons are started by root alone"
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue")
NODES = ("first", "second")
CONF = """
ClusterName=local
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={socket},cred_expire=5
StateSaveLocation={place}/state
SlurmdSpoolDir={place}/spool.%n
SlurmctldLogFile={place}/slurmctld.log
SlurmdLogFile={place}/slurmd.%n.log
SlurmctldPidFile={place}/slurmctld.pid
SlurmdPidFile={place}/slurmd.%n.pid
SlurmctldPort={port}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MpiDefault=none
TmpFS={place}/t.%n
KillWait=5
SchedulerParameters=sched_interval=1
MailProg=/bin/true
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
NodeName=first NodeHostname={host} NodeAddr=127.0.0.1 Port={port1} CPUs=2 RealMemory=1000 State=UNKNOWN
NodeName=second NodeHostname={host} NodeAddr=127.0.0.1 Port={port2} CPUs=1 RealMemory=1000 State=UNKNOWN
PartitionName=main Nodes=first Default=YES MaxTime=INFINITE State=UP PriorityTier=1 GraceTime=3
PartitionName=urgent Nodes=first MaxTime=INFINITE State=UP PriorityTier=9
PartitionName=wide Nodes=first,second MaxTime=INFINITE State=UP PriorityTier=1
"""


def absent() -> str | None:
    """Why there can be no cluster here, or None."""
    missing = [name for name in PROGRAMS if shutil.which(name, path=f"{os.environ['PATH']}:/usr/sbin") is None]
    if missing:
        return f"{missing[0]} is not installed (make slurm)"
    return ROOT_ALONE if os.geteuid() else None


MISSING = absent()
needs_slurm = pytest.mark.skipif(MISSING is not None, reason=str(MISSING))


def until(true: Callable[[], bool], what: str, seconds: float = 60.0) -> None:
    """Wait until a condition holds."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, f"{what} did not happen within {seconds:g} s"
        time.sleep(0.05)


class Cluster:
    """Daemons by name; the environment in which Slurm's commands find them."""

    def __init__(self, place: Path, port: int, socket: Path):
        for name in ("state", *(f"{kind}.{node}" for node in NODES for kind in ("spool", "t"))):
            (place / name).mkdir()
        host = os.uname().nodename.split(".")[0]
        conf = place / "slurm.conf"
        conf.write_text(CONF.format(host=host, place=place, socket=socket, port=port, port1=port + 1, port2=port + 2))
        self.place, self.env = place, os.environ | {"SLURM_CONF": str(conf)}
        self.env["PATH"] += ":/usr/sbin"
        # slurmd of Debian 13 initializes control groups even where no plugin uses them, and a chroot has none; slurmd
        # of Debian 12 does neither and knows no "disabled"
        if int(self.ask("slurmd", "-V").split()[1].split(".")[0]) > 22:
            (place / "cgroup.conf").write_text("CgroupPlugin=disabled\n")
        self.daemons: dict[str, subprocess.Popen[bytes]] = {}

    def start(self, name: str) -> None:
        """Start slurmctld, or the slurmd of a node."""
        program = ["slurmd", "-D", "-N", name] if name in NODES else [name, "-D"]
        with (self.place / f"{name}.out").open("ab") as out:
            self.daemons[name] = subprocess.Popen(program, env=self.env, stdout=out, stderr=out)

    def stop(self, name: str) -> None:
        """Stop it."""
        process = self.daemons.pop(name)
        process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(timeout=10)
        process.kill()
        process.wait()

    def ask(self, *command: str) -> str:
        """What a command of Slurm says; nothing if it fails."""
        return subprocess.run(command, env=self.env, capture_output=True, text=True).stdout

    def idle(self) -> bool:
        """Whether all nodes take work."""
        return self.ask("sinfo", "-h", "-N", "-p", "wide", "-o", "%T").split() == ["idle"] * len(NODES)


@contextlib.contextmanager
def cluster(place: Path) -> Iterator[Cluster]:
    """A cluster of two nodes, both on this machine, the first with two cores; jobs in "main" give way to "urgent"."""
    keys = Path(tempfile.mkdtemp(prefix="munge-"))  # of this cluster alone: another one may end before it
    shutil.chown(keys, "munge", "munge")
    socket, files = keys / "socket", (f"--{name}-file={keys / name}" for name in ("log", "pid", "seed"))
    user = ["setpriv", "--reuid=munge", "--regid=munge", "--clear-groups"]
    munged = ["/usr/sbin/munged", "--foreground", "--force", f"--socket={socket}", *files]
    munge = subprocess.Popen([*user, *munged], stderr=subprocess.DEVNULL)
    found = Cluster(place, 20000 + os.getpid() % 20000, socket)
    try:
        until(lambda: subprocess.run(["munge", "-n", "-S", socket], capture_output=True).returncode == 0, "munged")
        found.start("slurmctld")
        for node in NODES:
            found.start(node)
        until(found.idle, "two idle nodes")
        yield found
    finally:
        found.ask("scancel", "--user=root")
        with contextlib.suppress(AssertionError):  # a step that cannot tell the controller of its end waits for ever
            until(lambda: not found.ask("squeue", "-h"), "the end of all jobs", seconds=20)
        for name in reversed(list(found.daemons)):  # slurmd first: it tells the controller
            found.stop(name)
        munge.terminate()
        munge.wait()
        shutil.rmtree(keys)
