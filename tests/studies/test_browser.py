# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a run in a real browser, headless, in two widths: no error, figures drawn, tables that sort.

A script that the test appends clicks on a heading and writes what it sees into the page; `make browser` installs
Chromium and keeps the pictures in runs/browser.
"""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from epdem.engines import engine
from epdem.impacts.run import run
from epdem.report.pages import write_page

ROOT = Path(__file__).parents[2]
CHROMIUM = shutil.which("chromium")
PICTURES = os.environ.get("EPDEM_BROWSER_PICTURES")
SEEN = """<script>
const errors = [], heads = [...document.querySelectorAll("table.sorts")][0].querySelectorAll("th");
const column = () => [...heads[0].closest("table").tBodies[0].rows].map(row => Number(row.children[2].textContent));
const before = column();
heads[2].querySelector("button").click();
const up = column();
heads[2].querySelector("button").click();
document.body.append(Object.assign(document.createElement("pre"), {id: "seen", textContent: JSON.stringify({
  charts: [...document.querySelectorAll(".chart svg")].map(c => c.getBoundingClientRect().height),
  ink: getComputedStyle(document.querySelector(".chart svg text")).fill,
  before, up, down: column(), sorted: heads[2].getAttribute("aria-sort"),
  wide: document.documentElement.scrollWidth - window.innerWidth,
})}));
</script>"""
pytestmark = [
    pytest.mark.figures,
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed; 'make browser' installs it"),
]


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """A page with the script that looks at it."""
    place = tmp_path_factory.mktemp("browser")
    outcome = run(ROOT / "cases/steel_wall.toml", engines=[engine("embedded")], out=place / "out")
    path = write_page(outcome)
    path.write_text(path.read_text().replace("</body>", f"{SEEN}</body>"))
    return path


def look(page: Path, *more: str) -> subprocess.CompletedProcess[str]:
    """Chromium on a page, until it is drawn."""
    words = [str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
    words += ["--enable-logging=stderr"]
    words += [f"--user-data-dir={page.parent / 'profile'}", "--virtual-time-budget=8000", *more, f"file://{page}"]
    return subprocess.run(words, capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize(("name", "more"), [("wide", ["1200,900"]), ("phone", ["500,900", "--force-dark-mode"])])
def test_figures_are_drawn_tables_sort_and_the_console_is_silent(page, name, more):
    done = look(page, f"--window-size={more[0]}", *more[1:], "--dump-dom")
    assert not re.findall(r"CONSOLE.*", done.stderr)
    seen = json.loads(re.search(r'<pre id="seen">(.*?)</pre>', done.stdout, re.S)[1])
    assert len(seen["charts"]) == 4 and min(seen["charts"]) > 200
    assert seen["ink"] == ("rgb(230, 237, 243)" if "--force-dark-mode" in more else "rgb(27, 31, 36)")
    assert seen["before"] == seen["up"] == sorted(seen["up"]) and seen["down"] == sorted(seen["up"], reverse=True)
    assert seen["sorted"] == "descending" and seen["wide"] <= 0
    if PICTURES:
        look(page, f"--window-size={more[0].split(',')[0]},4500", *more[1:], f"--screenshot={PICTURES}/{name}.png")
