# SPDX-License-Identifier: GPL-2.0-or-later
"""Kinds of scenes are files: a kind of the user's own in three engines, and no kind is known below the room case."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from parts_cases import GLASS, STEEL
from scene_runs import HOSTS, run, write_case

from epdem.case.scene import load
from epdem.case.toml import portable_text, read_toml
from epdem.errors import CaseError
from epdem.report.pages import write_page
from epdem.scenes.judge.measures import refuse_measures
from epdem.scenes.plan.plan import plan
from epdem.studies.sweep.run import plan as plan_sweep
from epdem.studies.sweep.run import run as run_sweep

ROOT = Path(__file__).parents[2]
EPDEM = str(Path(sys.executable).with_name("epdem"))
MILL, EXAMPLE = re.findall(r"```\w+ in scenes/test_kinds.py\n(.*?)```", (ROOT / "docs/parts.md").read_text(), re.S)
SCENE = tomllib.loads(EXAMPLE)["scene"] | {"count": 20, "diameter": "50 mm", "duration": "80 ms"}
SCENE |= {"balls": [{"material": "glass", "radius": "3 mm"}]}
CASE = {
    "case": {"name": "mill", "title": "A mill", "source": "a test"},
    "materials": {"glass": GLASS, "steel": STEEL},
    "law": {"name": "thornton"},
    "scene": SCENE,
    "output": {"rows": 20, "particles": 20, "energy": True},
    "contact": {"friction": 0.4},
    "numerics": {"time_step": "2e-5 s"},
}


@pytest.fixture
def mill(tmp_path):
    """A case of a kind that lies beside it."""
    (tmp_path / "mill.toml.j2").write_text(MILL)
    return write_case(CASE, tmp_path)


@pytest.mark.parametrize("engine", HOSTS)
def test_a_kind_of_a_user_runs_and_its_torque_does_the_work(engine, mill):
    """The balls fall on the turning shell; the torque of its row, times its turn, is the work in the energy balance."""
    assert len(MILL.splitlines()) <= 20
    outcome = run(mill, engine, out=mill.parent / "out")
    rows, balance = outcome.results.rows, outcome.results.energy_balance
    assert outcome.passed and "torque" in rows and "shell_torque_y" not in rows
    work = np.cumsum(-6.0 * rows["torque"] * np.diff(rows["time"], prepend=0.0))
    assert balance["work"].iloc[-1] == pytest.approx(work.iloc[-1], rel=1e-9)
    assert np.abs(rows["torque"]).max() > 0
    page = write_page(outcome).read_text()
    assert "Key figure: torque against time" in page and "A scene of kind mill" in page


@pytest.mark.liggghts
def test_a_kind_of_a_user_is_swept_and_viewed(mill):
    out = mill.parent / "sweep"
    found = run_sweep(plan_sweep(mill, {"scene.count": "5,10"}), out)
    assert found.passed and found.table["particles_last"].tolist() == [5, 10]
    assert found.table.attrs["units"]["torque_max"] == "N m"
    assert "torque" in found.report().read_text()
    subprocess.check_call([EPDEM, "view", str(mill), "-o", str(mill.parent / "view.png")], stdout=subprocess.DEVNULL)
    assert (mill.parent / "view.png").stat().st_size > 1000


def test_the_file_of_a_kind_counts_from_the_case_and_goes_with_it(mill, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (other / "case.toml").write_text(portable_text(mill))
    one, two = plan(load(mill)), plan(load(other / "case.toml"))
    assert one.scene == two.scene and read_toml(other / "case.toml")["scene"]["kind"] == str(tmp_path / "mill.toml.j2")


TABLES = """{% for name in ["one", "two"] %}
[[scene.row]]
name = "{{ name }}"
wall = "shell"
torque = "+z"
title = "{{ name }}"
{% endfor %}
[[scene.measure]]
name = "many"
kind = "count"
"""


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('wall = "shell"', 'wall = "hull"', "row.one.wall = 'hull' is no wall"),
        ('torque = "+z"', 'torque = "up"', "row.0.torque = 'up', must be"),
        ('kind = "count"', 'kind = "cont"', "measure.0.kind = 'cont', must be one of"),
        ('name = "many"', "colour = 3", "measure.0.colour = 3, unknown key"),
    ],
)
def test_a_mistake_in_a_table_names_its_line(old, new, words, mill):
    text = MILL[: MILL.index("row = [")] + MILL[MILL.index("places = ") :] + TABLES.replace(old, new)
    (mill.parent / "mill.toml.j2").write_text(text)
    line = text.split("\n").index(new) + 1
    with pytest.raises(CaseError, match=re.escape(f"mill.toml.j2', line {line}: {words}")):
        load(mill)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"diameter": "-5 cm"}, r"scene.diameter = '-5 cm', must lie in \(0, inf\) m"),
        ({"diameter": "2 cm"}, "scene: a ball is larger than a quarter of the mill; give a larger diameter"),
        ({"walls": "tin"}, r"scene.walls = 'tin' is not defined; add \[materials.tin\]"),
        ({"count": 100_000}, r"scene.count = 100000: the spheres would fill .* at most 26%"),
        ({"lifters": 3}, "scene.lifters = 3, unknown key; the nearest: scene."),
        ({"kind": "./kiln.toml.j2"}, "kiln.toml.j2: no such file"),
        (
            {"kind": "mill"},
            "scene.kind = 'mill', must be one of 'brazilian', 'compaction', 'drum', 'hopper', 'peening', 'press', ",
        ),
    ],
)
def test_a_mistake_names_the_key_of_the_kind(change, words, mill):
    path = write_case(CASE | {"scene": SCENE | change}, mill.parent)
    with pytest.raises(CaseError, match=words):
        plan(load(path))


ROWS = Path(__file__).with_name("refused_kinds.txt").read_text().splitlines()


@pytest.mark.parametrize("row", [row for row in ROWS if " => " in row and row[0] != "#"])
def test_a_mistake_of_a_kind_names_its_file(row, mill):
    old, new, words = re.fullmatch("(.*?) => (.*?) ?-> (.*)", row).groups()
    assert old in MILL
    (mill.parent / "mill.toml.j2").write_text(MILL.replace(old, new))
    with pytest.raises(CaseError, match=words):
        refuse_measures(plan(load(mill)))


def test_a_message_names_the_key_of_the_case_also_where_the_kind_has_no_places(mill):
    kind = re.sub("^places = .*", "", MILL, flags=re.M)
    (mill.parent / "mill.toml.j2").write_text(kind.replace("/ 2 }}", "/ 99 }}"))
    with pytest.raises(CaseError, match=r"^scene.count = \d+: the spheres would fill"):
        plan(load(mill))


@pytest.mark.parametrize("name", ["of_type", "heads", "body", "model_copy", "named_materials", "_secret", "copy"])
def test_a_kind_may_give_a_key_any_name(name, mill):
    scene = {name if key == "count" else key: value for key, value in SCENE.items()}
    (mill.parent / "mill.toml.j2").write_text(
        re.sub(r"\bcount = ({ type|{{ count)", rf"{name} = \1", MILL).replace(
            f"{name} = {{{{ count", f"count = {{{{ {name}"
        )
    )
    case = load(write_case(CASE | {"scene": scene}, mill.parent))
    assert case.parts.fill[0].count == case.scene[name] == 20
    with pytest.raises(CaseError, match=f"scene.{name} = 0.5, must be a whole number"):
        load(write_case(CASE | {"scene": scene | {name: 0.5}}, mill.parent))


@pytest.mark.parametrize("name", ["kind", "measure", "largest", "output", "refuse"])
def test_a_name_that_a_kind_cannot_give_is_refused_with_its_line(name, mill):
    (mill.parent / "mill.toml.j2").write_text(MILL.replace("count =", f"{name} ="))
    with pytest.raises(CaseError, match=rf"mill.toml.j2, line 4: \[keys\] {name}: the name is taken"):
        load(mill)


def test_a_message_names_the_particles_of_a_kind_without_places(mill):
    text = "".join(x for x in MILL.splitlines(keepends=True) if not x.startswith("places"))
    (mill.parent / "mill.toml.j2").write_text(text)
    assert load(mill).parts.place("scene.fill.balls.particles") == "scene.balls"


def test_no_word_of_a_kind_stands_below_the_room_of_cases():
    """Names of kinds and of their walls, in code and templates; `compaction` is also an option of laws."""
    names = sorted(path.name.removesuffix(".toml.j2") for path in (ROOT / "templates/kinds").iterdir())
    assert names == ["brazilian", "compaction", "drum", "hopper", "peening", "press", "settle"]
    words = rf"\b(Preset|{'|'.join(name.title() for name in names)})\b|[\"'](settle|hopper|drum|peening)[\"']"
    words += r"|\b(plate_force|plate_z|press_z)\b|f_(drum|plate|floor)\b"
    product = ROOT / "python/epdem"
    rooms = [x for x in product.rglob("*.py") if x.relative_to(product).parts[0] not in ("case", "verification")]
    rooms += [path for host in ("liggghts", "lammps", "yade") for path in (ROOT / "templates" / host).rglob("*.j2")]
    assert len(rooms) > 120
    found = [f"{path.name}: {hit[0]}" for path in rooms for hit in re.finditer(words, path.read_text())]
    allowed = {"measures.py", "scene.py.j2"}  # kinds of measures and of motions
    assert [hit for hit in found if hit.partition(":")[0] not in allowed] == []
