# SPDX-License-Identifier: GPL-2.0-or-later
"""The guide: every block is run or checked, columns and exit codes are explained, the site builds without a warning.

The first word of a block is its language, the others say what happens to it. `sh` and `python` run in the order of the
page; `sh in FILE` is run by that test; `sh by hand` takes minutes, another tree or root. `toml CASE` changes a case,
`toml config` is the file of settings. `deck` is a deck of LIGGGHTS, or lines of one. `cpp` is a part of a
program that test_stranger.py builds. `text` is output or a formula.
"""

import importlib.util
import math
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pandas as pd
import pytest
from cluster import cluster, needs_slurm

import epdem
from epdem import Scene
from epdem.case import scene
from epdem.case.impact import parse
from epdem.case.toml import read_toml
from epdem.errors import CaseError, EngineError
from marks import thorough

ROOT = Path(__file__).parents[2]
spec = importlib.util.spec_from_file_location("guide", ROOT / "docs/guide.py")
guide = importlib.util.module_from_spec(spec)
spec.loader.exec_module(guide)
TOOLS = [name for name in ("mkdocs", "latex2mathml") if importlib.util.find_spec(name) is None]
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.M | re.S)
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
ALL = [(path.name, info.split(), text) for path in PAGES for info, text in FENCE.findall(path.read_text())]
OTHERS = ("epdem-liggghts", "mpirun", "liggghts", "pip", "apt-get", "cmake", "yade", "podman", "apptainer", "echo")
OWN = ("studies.md",)  # test_a_study_in_ten_minutes and test_on_my_cluster run them
FEW = 'speeds = { from = "0.5 m/s", to = "50 m/s", count = 3 }'
SMALL_PAGES = ("yade", "adhesion", "partial_slip", "laws", "scenes", "press", "scene_checks")
SMALL = {
    "settle_glass": {"scene.box": ["10 mm", "10 mm", "60 mm"], "scene.count": 30, "scene.duration": "0.3 s"}
    | {"output.particles": 4},
    "hopper_beads": {"scene.count": 60, "scene.fill_time": "20 ms", "scene.duration": "40 ms"},
}


def of(kind: str, page: str | None = None) -> list[tuple[str, list[str], str]]:
    """(page, words after the language, text) of the blocks of a language."""
    return [(name, words[1:], text) for name, words, text in ALL if words[:1] == [kind] and page in (None, name)]


def small(folder):
    """Our cases in a folder, with few impacts and spheres."""
    shutil.copytree(ROOT / "cases", folder / "cases")
    for name, keys in SMALL.items():
        (folder / f"cases/{name}.toml").write_text(Scene.from_toml(ROOT / f"cases/{name}.toml").replace(keys).text)
    for name in ("steel_wall", "viscous_steel", "adhesion_thornton_1998"):
        text = re.sub(r"^speeds = .*$", FEW, (ROOT / f"cases/{name}.toml").read_text(), flags=re.M)
        (folder / f"cases/{name}.toml").write_text(text)


def test_every_block_says_what_it_is_and_none_is_only_indented():
    for name, words, text in ALL:
        where = f"{name}: {' '.join(words)}\n{text}"
        assert words and words[0] in ("sh", "python", "toml", "deck", "jinja", "text", "cpp"), where
        if words[1:2] == ["in"]:
            assert (ROOT / "tests" / words[2]).exists(), where
        elif words[0] == "sh":
            assert words[1:] in ([], ["slurm"], ["by", "hand"]), where
    for path in PAGES:
        bare = FENCE.sub("", path.read_text())
        assert not re.search(r"\n\n {4}\S", bare), f"{path.name}: put ``` and the language around this block"


def test_programs_files_and_commands_of_blocks_that_run_elsewhere_exist():
    commands, makefile = guide.names(), (ROOT / "Makefile").read_text()
    seen = 0
    for _, words, text in of("sh"):
        for line in text.replace("\\\n", " ").splitlines() if words[:1] in (["in"], ["by"]) else ():
            line = re.sub(r"^\w+=\S+ ", "", line)
            program, *rest = line.split()
            known = {
                "epdem": lambda r: r[0] in commands or " ".join(r[:2]) in commands,
                "make": lambda r: f"\n{r[0]}:" in makefile,
            }
            known[".venv/bin/python"] = lambda r: all((ROOT / w).exists() for w in r if w.endswith(".py"))
            known["python"] = known[".venv/bin/python"]
            assert program in OTHERS or known[program](rest), line
            seen += 1
    assert seen >= 15


def test_options_in_sentences_are_those_of_their_commands():
    """Of `epdem COMMAND --x` the command has it; of `--x` alone one of the commands, or a script of bench/ or docs/."""
    options = {
        name: {o for p in c.params for o in (*p.opts, *p.secondary_opts)} for name, c in guide._commands().items()
    }
    scripts = "".join(p.read_text() for room in ("bench", "docs") for p in (ROOT / room).glob("*.py"))
    others, seen = ("srun", "mpirun", "valgrind", "--fmad=false"), 0
    codes = [(p.name, code) for p in PAGES for code in re.findall(r"`([^`\n]+)`", FENCE.sub("", p.read_text()))]
    codes += [("commands.csv", code) for code in pd.read_csv(ROOT / "docs/data/commands.csv")["command"]]
    for page, code in codes:
        words = code.removesuffix("epdem --install-completion").split()  # an option of typer
        words = words[1:] if words[:1] == ["epdem"] else words
        names = [name for name in (" ".join(words[:2]), *words[:1]) if name in options]
        for option in (
            re.findall(r"(?<![\w-])--[a-z][\w-]*", " ".join(words)) if words and words[0] not in others else ()
        ):
            own = options[names[0]] if names else set().union(*options.values())
            known = option in own or (not names and (option in scripts or "/" in words[0]))
            assert known, f"{page}: {code}"
            seen += 1
    assert seen > 100


@pytest.mark.thorough
@pytest.mark.liggghts
def test_every_block_of_the_tour_runs(tmp_path):
    for page in ("tutorial", "choose", "strength", "results", "faq"):
        play(blocks(page), tmp_path)
    found = pd.read_csv(tmp_path / "runs/ball/results.csv")
    assert len(found) == 24 and found["passed"].all() and (tmp_path / "runs/ball/report.html").exists()
    said = set(re.findall(r"`(\w+)`", (ROOT / "docs/results.md").read_text()))
    for name in found:
        assert re.sub(r"_(theory|error|rms)$", "", name) in said, name


@pytest.mark.liggghts
@pytest.mark.yade("module")
@pytest.mark.parametrize("page", [thorough(page, unless=page == "yade") for page in SMALL_PAGES])
def test_every_block_of_a_page_runs_with_small_cases(page, tmp_path):
    small(tmp_path)
    for _, _, text in of("jinja", f"{page}.md"):
        (tmp_path / "my.in.j2").write_text(text)
    play(blocks(page), tmp_path, cases=False)
    assert list(tmp_path.glob("runs/**/report.html"))


def test_no_page_has_blocks_that_no_test_runs():
    played = {*OWN, *(f"{page}.md" for page in ("tutorial", "choose", "strength", "results", "faq", *SMALL_PAGES))}
    assert {name for name, words, _ in ALL if words in (["sh"], ["python"])} <= played


def merged(base: dict, more: dict) -> dict:
    """A table with the keys of another, tables within as well."""
    return base | {k: merged(base.get(k, {}), v) if isinstance(v, dict) else v for k, v in more.items()}


def test_every_block_of_toml_is_a_case_or_a_part_of_one():
    assert len(of("toml")) >= 5
    for name, words, text in of("toml"):
        if words[:1] == ["in"]:
            continue
        if words:
            given = tomllib.loads(text)
            whole = {"law": {}} if "name" in given.get("law", {}) else {}  # a law with all its keys
            data = merged(read_toml(ROOT / f"cases/{words[0]}.toml") | whole, given)
            assert scene.parse(data, name) if scene.is_scene(data) else parse(data, name)
        else:  # a scene without its head, which test_parts_input runs
            assert tomllib.loads(text)["scene"]["kind"] == "parts"


@pytest.mark.liggghts
def test_lines_of_decks_run_in_the_deck_of_the_page_on_liggghts(tmp_path):
    whole = next(text for name, _, text in of("deck") if name == "liggghts.md")
    parts = [(name, text) for name, _, text in of("deck") if "pair_style" in text and "atom_style" not in text]
    parts = [(name, text) for name, text in parts if name not in OWN]
    assert {name for name, _ in parts} >= {"README.md", "partial_slip.md"}
    for name, text in parts:
        given = [line.partition("  # ")[0] for line in text.splitlines()]
        heads = [" ".join(line.split()[:2]) for line in given]
        lines = [line for line in whole.splitlines() if " ".join(line.split()[:2]) not in heads]
        if "yieldPressure" in text:
            lines = [line for line in lines if "yieldPressure" not in line]
        at = next(k for k, line in enumerate(lines) if line.startswith("pair_coeff"))
        for line in given:
            lines.insert(at + (line.startswith("fix wall")), line)
            at += not line.startswith("fix wall")
        (tmp_path / "in.deck").write_text("\n".join(lines) + "\n")
        words = [str(sys.executable).replace("python", "epdem-liggghts"), "-in", "in.deck", "-log", "none"]
        done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == 0 and "restitution 0.9" in done.stdout, f"{name}\n{done.stdout[-600:]}"


def test_the_reference_names_every_command_and_what_the_package_offers():
    commands, python = guide.commands(), guide.python()
    for name in ("run", "verify crosscheck", "sweep", "verify rerun", "export liggghts"):
        assert f"## epdem {name}\n" in commands
    assert "| `--full` |" in commands and "points" not in re.findall(r"## epdem (\w+)", commands)
    names = [*epdem.__all__, *(f"theory.{name}" for name in epdem.theory.__all__)]
    assert {f"## {name}" for name in names} <= set(python.splitlines()) and "numpy.ndarray" not in python
    assert "Eq. 8.88 [Wu et al. 2003]" in python
    errors = (ROOT / "docs/faq.md").read_text()
    assert all(f"| {code} |" in errors for code in (0, 1, CaseError.exit_code, EngineError.exit_code, 130))


def test_the_reference_of_case_files_has_every_key_of_our_cases():
    keys = set(re.findall(r"^\| `([\w.]+)` \|", guide.cases(), re.M))
    assert "| `materials.NAME.poisson_ratio` | a number, >= -0.99, <= 0.5 | required |" in guide.cases()
    assert {"impact.body.radius", "measured.e_n", "scene.wall.angular_velocity", "numerics.skin"} <= keys
    for law, key in (("cavity", "compaction"), ("meyer", "meyer_index"), ("thornton", "yield_pressure_ratio")):
        assert f"| {law} | `law.{key}` |" in guide.cases()
    for path in sorted((ROOT / "cases").glob("*.toml")):
        for table, entries in read_toml(path).items():
            if table not in ("materials", "law") and isinstance(entries, dict):
                assert {f"{table}.{key}" for key, v in entries.items() if not isinstance(v, dict | list)} <= keys, path


def test_equations_become_mathml_and_code_stays():
    text = "of $a^2$ and `$HOME`\n\n    echo $PATH and $x\n\n```sh in a/b.py\necho $y\n```\n\n$$b$$\n"
    found = guide.mathematics(text, lambda latex, display="inline": f"<{display}:{latex}>")
    assert found.splitlines()[0] == "of <span><inline:a^2></span> and `$HOME`"
    assert "    echo $PATH and $x\n" in found and "<p><block:b></p>" in found
    assert "```sh\necho $y\n```" in guide.languages(text)


@pytest.mark.skipif(
    bool(TOOLS) and not os.environ.get("CI"),
    reason=f"{', '.join(TOOLS)} not installed; 'make test' and 'make guide' install it",
)
def test_the_site_builds_without_a_warning():
    done = subprocess.run([sys.executable, ROOT / "docs/guide.py"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    page = (ROOT / "runs/guide/site/theory.html").read_text()
    assert page.count("<math") > 60 and not re.search(r'(?:src|href)="https?://(?!squidfunk)', page)
    assert "<code>sh slurm" not in (ROOT / "runs/guide/site/studies.html").read_text()


def blocks(page: str) -> list[tuple[str, str]]:
    """(kind, text) of the blocks of a page that can be run."""
    return re.findall(r"^```(sh|python|sh slurm)\n(.*?)^```$", (ROOT / f"docs/{page}.md").read_text(), re.M | re.S)


def play(wanted: list[tuple[str, str]], folder: Path, env: dict[str, str] | None = None, *, cases: bool = True) -> None:
    """Run blocks in a folder, which gets our `cases`."""
    if cases:
        shutil.copytree(ROOT / "cases", folder / "cases", dirs_exist_ok=True)
    found = dict(env or os.environ)
    found["PATH"] = f"{Path(sys.executable).parent}:{found['PATH']}"
    for k, text in wanted:
        program = [sys.executable, "-c", text] if k == "python" else ["bash", "-e", "-c", text]
        done = subprocess.run(program, cwd=folder, env=found, capture_output=True, text=True)
        assert done.returncode == 0, f"{text}\n{done.stdout}{done.stderr}"


@pytest.mark.thorough
def test_a_study_in_ten_minutes(tmp_path):
    play([(kind, text) for kind, text in blocks("studies") if kind != "sh slurm"], tmp_path)
    assert len(pd.read_csv(tmp_path / "runs/study/sweep.csv")) == 15 * 32
    assert "15 points on embedded" in (tmp_path / "runs/study/report.html").read_text()
    assert len(pd.read_csv(tmp_path / "runs/table/sweep.csv")) == 2 * 32
    forces = pd.read_csv(tmp_path / "runs/press/sweep.csv")["plate_force_max"]
    assert (abs(forces / 12.0 - 1.0) <= 0.05).any() and len(forces) <= 8


@needs_slurm
@pytest.mark.waits
def test_on_my_cluster(tmp_path):
    (tmp_path / "slurm").mkdir()
    with cluster(tmp_path / "slurm") as nodes:
        play([(kind, text) for kind, text in blocks("studies") if kind == "sh slurm"], tmp_path, nodes.env)
    assert pd.read_csv(tmp_path / "runs/byhand/sweep.csv")["status"].tolist() == ["done"] * 64


@pytest.mark.liggghts
def test_the_notebook_of_conductivity_gives_that_of_a_lattice_of_hertz_s_contacts(tmp_path, monkeypatch):
    """All contacts of a chain have one force: overlaps d of pairs and d/2^(1/3) at walls add up to the stroke."""
    import nbformat
    from nbclient import NotebookClient

    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{os.environ['PATH']}")
    notebook = nbformat.read(ROOT / "docs/conductivity.ipynb", as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    d = 60e-6 / (2 + 2 * 2 ** (-1 / 3))
    a, a_wall = math.sqrt(5e-4 * d), math.sqrt(1e-3 * d * 2 ** (-1 / 3))
    chain = 2 / (2 * a) + 2 / (4 * a_wall)
    found = float(re.search(r"conductivity ([\d.e-]+)", notebook.cells[-1].outputs[0].text)[1])
    assert found == pytest.approx(9 / chain * 5.94e-3 / 36e-6, rel=1e-4)


@pytest.mark.liggghts
def test_the_notebook_runs(tmp_path, monkeypatch):
    import nbformat
    from nbclient import NotebookClient

    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{os.environ['PATH']}")
    shutil.copytree(ROOT / "cases", tmp_path / "cases")
    notebook = nbformat.read(ROOT / "docs/notebook.ipynb", as_version=4)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    kinds = [o.get("data", {}).keys() for cell in notebook.cells for o in cell.get("outputs", [])]
    assert sum("image/png" in k for k in kinds) >= 2 and sum("text/html" in k for k in kinds) >= 3
