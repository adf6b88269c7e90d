# SPDX-License-Identifier: GPL-2.0-or-later
"""What a terminal shows: progress, colour, narrow ones, other encodings, completion; and nothing of it in a pipe."""

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import termios
from pathlib import Path

import pytest
from calls import CASES, COMMANDS, call
from rich.console import Console

from epdem.base import terminal
from epdem.engines import ENGINES, SCENES

EPDEM = str(Path(sys.executable).parent / "epdem")
RUN = ["run", "steel.toml", "-e", "embedded", "--steps", "50", "-o", "out", "--fresh"]
COLOUR, ESCAPE = re.compile(r"\x1b\[[\d;]*3\dm"), re.compile(r"\x1b\[[\d;?]*[A-Za-z]")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the steel case at 12 speeds."""
    (tmp_path / "steel.toml").write_text((CASES / "steel_wall.toml").read_text().replace("count = 32", "count = 12"))
    return tmp_path


def shown(words: list[str], folder: Path, width: int, **environment: str) -> str:
    """What a command writes on a terminal of this width, standard output and error together."""
    child, fd = pty.fork()
    if child == 0:  # pragma: no cover
        fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", 40, width, 0, 0))
        os.chdir(folder)
        surroundings = {name: value for name, value in os.environ.items() if name != "COLUMNS"}  # of another terminal
        os.execve(EPDEM, [EPDEM, *words], surroundings | {"TERM": "xterm-256color"} | environment)
    text = b""
    while True:
        try:
            text += os.read(fd, 65536)
        except OSError:
            break
    os.waitpid(child, 0)
    return text.decode()


def piped(words: list[str], folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([EPDEM, *words], cwd=folder, capture_output=True, text=True, env=os.environ | environment)


def test_a_terminal_has_progress_and_colour_and_a_narrow_one_cuts_no_number(folder):
    text = shown(RUN, folder, 50)
    plain = ESCAPE.sub("", text)
    assert COLOUR.search(text) and "\x1b[31m" in text  # rows that fail are red
    assert "figure" in plain and "…" not in plain
    rows = [line for line in plain.splitlines() if line.startswith("│")]
    assert len(rows) % 10 == 0 and len(rows) > 10 and all(len(line) <= 50 for line in rows)  # parts of ten rows
    assert "F_max [N]" in plain and "steps" in plain


def test_a_terminal_has_a_bar_with_what_is_done_of_a_sweep(folder):
    words = ["sweep", *RUN[1:4], "--set", "impact.body.radius=1 mm,2 mm", "-j", "1", "-o", "out"]
    plain = ESCAPE.sub("", shown(words, folder, 120))
    assert "━━━" in plain and "2/2 points" in plain and "2 of 2 points done" in plain


def test_no_color_and_a_dumb_terminal_are_kept(folder):
    predict = ["predict", RUN[1]]
    assert COLOUR.search(shown(predict, folder, 100)) and not COLOUR.search(shown(predict, folder, 100, NO_COLOR="1"))
    assert "\x1b" not in shown(predict, folder, 100, TERM="dumb")


def test_a_pipe_gets_plain_text_without_progress_and_ascii_where_asked(folder):
    done = piped(RUN, folder)
    assert "\x1b" not in done.stdout + done.stderr and not done.stderr and "figure" not in done.stdout
    done = piped(["predict", RUN[1]], folder, PYTHONIOENCODING="ascii")
    assert done.returncode == 0 and done.stdout.isascii()
    assert len([line for line in done.stdout.splitlines() if line.startswith("|")]) == 14  # with head and rule


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_get_a_script_that_completes_commands(shell, tmp_path):
    done = piped([], tmp_path, _EPDEM_COMPLETE=f"source_{shell}")
    assert done.returncode == 0 and "_EPDEM_COMPLETE" in done.stdout
    if shell == "bash":
        asked = {"_EPDEM_COMPLETE": "complete_bash", "COMP_WORDS": "epdem c", "COMP_CWORD": "1"}
        found = set(piped([], tmp_path, **asked).stdout.split())
        assert found == {name for name in COMMANDS if name.startswith("c")} and len(found) == 2


def test_a_table_that_is_too_wide_comes_in_parts_with_the_first_column(capsys):
    screen = Console(width=40, force_terminal=False)
    table = terminal.table("many", ["name", *(f"column{k}" for k in range(5))], left=("name",))
    table.add_row("first", *(f"{k}.123456" for k in range(5)))
    terminal.show_table(screen, table)
    text = capsys.readouterr().out
    assert all(f"{k}.123456" in text and f"column{k}" in text for k in range(5)) and "…" not in text
    assert max(map(len, text.splitlines())) <= 40 and text.count("first") == 3 and text.count("many") == 1
    one = terminal.table("", ["only"])
    one.add_row("text")
    terminal.show_table(screen, one)
    assert "text" in capsys.readouterr().out


@pytest.mark.parametrize("command", COMMANDS)
def test_the_help_of_a_command_has_every_word_of_its_options(command, tmp_path, capsys, monkeypatch):
    """Rich takes words in square brackets for markup."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("typer.rich_utils.MAX_WIDTH", 500)
    shown = " ".join(call([command, "--help"], capsys, monkeypatch).out.split())
    for text in [COMMANDS[command].help, *(p.help for p in COMMANDS[command].params if p.help)]:
        assert " ".join(text.split()) in shown, text


def test_help_names_the_engines_that_have_ranks_and_decks():
    helps = {(c, p.name): p.help for c in ("run", "deck") for p in COMMANDS[c].params}
    assert {n for n, e in ENGINES.items() if n in helps["run", "ranks"].lower()} == {
        n for n, e in ENGINES.items() if e.ranks > 1
    }
    assert {n for n in ENGINES if n in helps["deck", "engine"]} == set(SCENES)
