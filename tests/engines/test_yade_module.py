# SPDX-License-Identifier: GPL-2.0-or-later
"""The module epdem_yade: its build, its commands and what it refuses at import."""

import os
import re
import subprocess

import pytest
from yade_native import HEAD, ROOT, module_folder, yade

from epdem.engines import sources
from epdem.engines.yade.launcher import environment, module
from epdem.errors import EngineError

pytestmark = pytest.mark.yade("module")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("config.version = '1.0'", "is built for YADE 2"),
        ("config.highPrecisionBits = 80", "this YADE has 80"),
        ("config.features = config.features[1:] + ['SPH']", "this YADE has .*SPH"),
    ],
)
def test_a_module_for_another_yade_refuses_at_import(change, words, tmp_path):
    done = yade("", tmp_path, head="import sys\nfrom yade import config\n" + change + HEAD)
    lines = done.stderr.strip().splitlines()
    assert done.returncode == 1 and lines[-1].startswith("ImportError: epdem_yade ") and "make yade" in lines[-1]
    assert re.search(words, lines[-1]), lines[-1]


@pytest.mark.parametrize(
    ("source", "sentence"),
    [
        ("/nowhere", "YADE_SOURCE = /nowhere has no core/Scene.hpp; name the source folder of YADE 2"),
        ("", "copy a checkout of this tag to this machine and name its folder by YADE_SOURCE"),
    ],
)
def test_a_build_without_source_says_what_to_do(source, sentence, tmp_path):
    """Also without network: git is sent to an address that does not exist."""
    nowhere = {"GIT_CONFIG_COUNT": "1", "GIT_CONFIG_KEY_0": "url./nowhere/.insteadOf", "GIT_CONFIG_VALUE_0": "https://"}
    command = ["cmake", "-S", str(ROOT / "cpp_contact/yade"), "-B", str(tmp_path), f"-DYADE_SOURCE={source}"]
    done = subprocess.run(command, env=os.environ | nowhere, capture_output=True, text=True, check=False)
    assert done.returncode != 0 and sentence in " ".join(done.stderr.split())


def test_a_named_module_is_that_of_runs(tmp_path, monkeypatch):
    """By its file or its folder; another name is refused before anything runs."""
    built = tmp_path / "epdem_yade.so"
    built.write_bytes(b"")
    for named in (built, tmp_path):
        monkeypatch.setenv("EPDEM_YADE_MODULE", str(named))
        assert module() == built
    for named in (tmp_path / "none", tmp_path / "other.so"):
        monkeypatch.setenv("EPDEM_YADE_MODULE", str(named))
        with pytest.raises(EngineError, match=f"EPDEM_YADE_MODULE = {named}: there is no epdem_yade.so"):
            module()


@pytest.mark.slow  # builds the module
@pytest.mark.skipif("EPDEM_YADE_MODULE" in os.environ, reason="EPDEM_YADE_MODULE names another build")
def test_the_three_commands_of_an_exported_project_give_yade_the_module(tmp_path):
    """The first two have built the module of all tests here; the third one lets a script find it."""
    built = module_folder()
    (tmp_path / "script.py").write_text("import epdem_yade\nprint('FOUND', epdem_yade.__file__)\n")
    text = sources.commands("yade", built.parent)[2] + "\nyade -n -x script.py\n"
    done = subprocess.run(["bash", "-c", text], cwd=tmp_path, env=environment(), capture_output=True, text=True)
    assert f"FOUND {built}/epdem_yade.so" in done.stdout, done.stdout + done.stderr
