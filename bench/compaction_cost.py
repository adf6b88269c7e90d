# SPDX-License-Identifier: GPL-2.0-or-later
"""Instructions of a step with compaction over one without, by callgrind: the numbers of docs/compaction.md.

Run: .venv/bin/python bench/compaction_cost.py

500 equal spheres in a face-centred packing of a periodic box close in on its centre, with friction. A step is the
difference of runs of 60 and 20 steps.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "engines"))

from plugin_decks import Bodies, launcher
from plugin_loop import SPACING, Scene, deck

OUTPUT = (  # what the deck of the tests writes beside the positions
    "thermo_style custom step atoms c_touching\n",
    "compute touching all reduce sum c_contacts\n",
    "compute contacts all contact/atom\n",
    " f_plasticWork f_elasticEnergy f_loadedContacts",
)


def packing(cells=5, squeeze=0.96, rate=50.0):
    """Data file of the packing: spheres that overlap by 4 % and approach the centre at `rate` times the distance."""
    rng, edge = np.random.default_rng(11), SPACING * np.sqrt(2) * squeeze
    corner = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), -1).reshape(-1, 1, 3)
    x = ((corner + np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]])) * edge).reshape(-1, 3)
    x = (x + rng.uniform(-2e-5, 2e-5, x.shape)) % (cells * edge)
    v = -rate * (x - cells * edge / 2) + rng.uniform(-0.01, 0.01, x.shape)
    spheres = Bodies(np.ones(len(x), int), SPACING / 2 * np.ones(len(x)), x, v, rng.uniform(-40, 40, x.shape))
    return spheres.data([(0.0, float(cells * edge))] * 3, types=1)


def instructions(folder, settings, skin, softens, steps):
    """Of a run."""
    scene = Scene(law="cavity", tangential="history", dashpot=False, settings=settings)
    text = deck(scene, steps=steps, every=100000).replace("neighbor 4e-4 bin", f"neighbor {skin} bin")
    text = text.replace("thermo 1\n", "thermo 100000\n")
    for words in OUTPUT:
        text = text.replace(words, "")
    if softens:
        text = text.replace("pair_style", "fix fs all property/global finiteStrain scalar 0.82\npair_style")
    (folder / "packing.data").write_text(packing())
    (folder / "in.deck").write_text(text)
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", launcher(), "-in", "in.deck"]
    env = dict(os.environ, EPDEM_SIMD="avx2")  # valgrind knows no AVX-512
    done = subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", done.stderr)[1])


def main() -> None:
    """Print instructions of a step and their ratio to those without compaction."""
    with tempfile.TemporaryDirectory() as folder:
        for softens in (False, True):
            without = None
            for settings, skin in (((), 5e-4), (("compaction on",), 2.5e-4), (("compaction on",), 5e-4)):
                counts = [instructions(Path(folder), settings, skin, softens, steps) for steps in (20, 60)]
                count = (counts[1] - counts[0]) / 40
                without = without or count
                name = " ".join(("cavity", *["finite_strain"] * softens, *settings))
                print(f"| {name} | skin {skin} m | {count:.0f} | {count / without:.3f} |", flush=True)


if __name__ == "__main__":
    main()
