# SPDX-License-Identifier: GPL-2.0-or-later
"""A program `yade` whose scripts run in children of one YADE that has started; a start takes a second of a processor.

YADE itself runs other calls (another option, more threads, a preloaded library, another path of Python).
"""

import os
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

CLIENT = """#!/usr/bin/python3 -ISE
import json, os, signal, socket, sys

here, yade, (*options, script) = {here!r}, {yade!r}, sys.argv[1:]
plain = os.environ.get("OMP_NUM_THREADS", "1") == "1"
plain = plain and not (os.environ.get("LD_PRELOAD") or os.environ.get("PYTHONPATH"))
if not plain or [o for o in options if o != "-j1"] != ["-n", "-x"]:
    os.execv(yade, [yade, *options, script])
with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as server:
    server.connect(here + "/socket")
    socket.send_fds(server, [json.dumps([script, os.getcwd(), dict(os.environ)]).encode()], [0, 1, 2])
    code = int(server.recv(16))
if code < 0:
    signal.signal(-code, signal.SIG_DFL)
    os.kill(os.getpid(), -code)
sys.exit(code)
"""
# Runs in YADE. A child of the server keeps the connection and a grandchild runs the script, which ends with its client.
SERVER = """
def _work(here):
    import gc, json, os, select, signal, socket, sys
    server = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    server.bind(here + "/socket.new")
    server.listen()
    os.rename(here + "/socket.new", here + "/socket")
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    gc.freeze()
    while server in select.select([server, sys.stdin], [], [])[0]:
        connection, _ = server.accept()
        words, streams, _, _ = socket.recv_fds(connection, 1 << 20, 3)
        if os.fork():
            connection.close()
            for stream in streams:
                os.close(stream)
            continue
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        server.close()
        if child := os.fork():
            ended = os.pidfd_open(child)
            if connection in select.select([connection, ended], [], [])[0]:
                os.kill(child, signal.SIGKILL)
            connection.send(str(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])).encode())
            os._exit(0)
        connection.close()
        for k, stream in enumerate(streams):
            os.dup2(stream, k)
        script, folder, variables = json.loads(words)
        os.chdir(folder)
        os.environ.clear()
        os.environ.update(variables)
        sys.argv = [script]
        return script
    os._exit(0)

def _run(script):
    import ctypes, os, sys, traceback
    os.makedirs(os.path.dirname(O.tmpFilename()), exist_ok=True)  # a script may have removed it
    code = 0
    try:
        with open(script, encoding="utf-8") as text:
            program = compile(text.read(), script, "exec")
        exec(program, globals())
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else end.code is not None
    except BaseException:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    ctypes.CDLL(None).fflush(None)
    os._exit(code)

import sys
_run(_work(sys.argv[1]))
"""


@contextmanager
def warm_yade(folder: Path) -> Iterator[Path]:
    """The folder of such a program."""
    yade = shutil.which("yade")
    (folder / "yade").write_text(CLIENT.format(here=str(folder), yade=yade))
    (folder / "yade").chmod(0o755)
    (folder / "server.py").write_text(SERVER)
    kept = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON") and k != "DISPLAY"}
    with subprocess.Popen(
        [str(yade), "-n", "-x", "server.py", str(folder)],
        cwd=folder,
        env={"HOME": "/tmp", **kept, "OMP_NUM_THREADS": "1"},
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        while not (folder / "socket").exists():
            assert process.poll() is None, "YADE does not start"
            time.sleep(0.02)
        yield folder
        process.kill()
