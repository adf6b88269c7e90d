# SPDX-License-Identifier: GPL-2.0-or-later
"""Small LIGGGHTS scenes for the tests of the plugin, and for bench/: decks as text, runs, exact read-back."""

import os
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

LAWS = ("hertz", "thornton", "johnson", "cavity", "meyer")
YIELDING = LAWS[1:]
ADHESIVE = ("jkr", "thornton_ning", "cavity_adhesive")

# Three types of body: aluminium, steel, polymer (SI).
E = np.array([70e9, 208e9, 5e9])
NU = np.array([0.33, 0.30, 0.40])
RHO = np.array([2700.0, 7850.0, 1200.0])
Y = np.array([0.2e9, 1.0e9, 0.06e9])
P_Y = 2.8 * Y
X = np.array([0.1, 0.3, 0.5])  # hardening

OWN = f"""
fix p1 all property/global yieldPressure peratomtype {" ".join(map(repr, P_Y.tolist()))}
fix p2 all property/global yieldStress peratomtype {" ".join(map(repr, Y.tolist()))}
fix p3 all property/global hardeningExponent peratomtype {" ".join(map(repr, X.tolist()))}
"""


# Work of adhesion [J/m^2]: of millimetre spheres at metres per second one that is seen.
GAMMA = np.array([[600.0, 400.0, 200.0], [400.0, 800.0, 300.0], [200.0, 300.0, 100.0]])


def per_pair(name, value, n=3):
    """One value for every pair of n types."""
    return f"fix {name} all property/global {name} peratomtypepair {n} {' '.join([repr(value)] * n * n)}\n"


def gamma(law):
    """GAMMA, of which cavity_adhesive holds less: 6.6 Y^3 R*/E*^2."""
    return GAMMA / (200.0 if law == "cavity_adhesive" else 1.0)


def adhesion(law):
    """The line of workOfAdhesion; nothing for a law without adhesion."""
    values = " ".join(map(repr, gamma(law).ravel().tolist()))
    return f"fix gamma all property/global workOfAdhesion peratomtypepair 3 {values}\n" if law in ADHESIVE else ""


# What LIGGGHTS's own plastic models need beside the elastic constants, at strengths like those above.
FOREIGN = {
    "hertz": per_pair("coefficientRestitution", 0.7),
    "thornton_ning": per_pair("coefficientRestitution", 0.999)
    + per_pair("surfaceEnergy", 0.0)
    + "fix yr all property/global coefficientYieldRatio peratomtype 0.01 0.01 0.01\n",
    "edinburgh": per_pair("coefficientRestitution", 0.999)
    + per_pair("coefficientAdhesionStiffness", 0.0)
    + per_pair("UnloadingStiffness", 5.0)
    + per_pair("surfaceEnergy", 0.0)
    + per_pair("pullOffForce", 0.0)
    + "fix ae all property/global adhesionExponent scalar 1.5\n"
    + "fix oe all property/global overlapExponent scalar 1.5\n",
}


def launcher():
    """The LIGGGHTS under test: EPDEM_LIGGGHTS, or the launcher beside this Python."""
    return os.environ.get("EPDEM_LIGGGHTS") or str(Path(sys.executable).with_name("epdem-liggghts"))


@dataclass
class Run:
    folder: Path
    code: int
    text: str

    @property
    def error(self):
        """LIGGGHTS's last words; it sometimes prints random bytes after them."""
        lines = [line for line in self.text.splitlines() if line.startswith("ERROR")]
        return lines[-1] if lines else ""

    def frames(self, name="out.bin"):
        """Steps and sorted rows (id first) of a binary dump: shape (frames, atoms, columns)."""
        return read_dump(self.folder / name)

    @property
    def last(self):
        return self.frames()[1][-1]


def run(folder, deck, *, ranks=1, files=None, command=None, preload=None, env=None, timeout=120):
    """Runs a deck in `folder`, with `env` added to the environment; returns exit code and everything printed."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in (files or {}).items():
        (folder / name).write_text(text)
    (folder / "in.deck").write_text(deck)
    line = [command or launcher(), "-in", "in.deck"]
    env = dict(os.environ) | (env or {})
    if preload:  # a name in LD_PRELOAD ends at a space
        link = folder / "preloaded.so"
        link.unlink(missing_ok=True)
        link.symlink_to(preload)
        env["LD_PRELOAD"] = str(link)
    if ranks > 1:
        extra = ["--allow-run-as-root"] if os.geteuid() == 0 else []
        line = [
            "mpirun",
            *extra,
            "--oversubscribe",
            "--mca",
            "btl_base_warn_component_unused",
            "0",
            "-np",
            str(ranks),
            *line,
        ]
    done = subprocess.run(line, cwd=folder, env=env, capture_output=True, timeout=timeout)
    text = (done.stdout + done.stderr).decode(errors="replace")
    return Run(folder, done.returncode, text)


def good(*args, **kwargs):
    """A run that has to succeed."""
    result = run(*args, **kwargs)
    assert result.code == 0, result.error or result.text[-2000:]
    return result


def read_dump(path):
    """LIGGGHTS's binary dump: raw doubles, one block per rank."""
    raw, at, steps, frames = Path(path).read_bytes(), 0, [], []
    while at < len(raw):
        step, n = np.frombuffer(raw, "<i8", 2, at)
        columns, blocks = np.frombuffer(raw, "<i4", 2, at + 16 + 4 + 24 + 48)
        at += 16 + 4 + 24 + 48 + 8
        rows = []
        for _ in range(blocks):
            count = int(np.frombuffer(raw, "<i4", 1, at)[0])
            rows.append(np.frombuffer(raw, "<f8", count, at + 4).reshape(-1, columns))
            at += 4 + 8 * count
        rows = np.concatenate(rows)
        assert len(rows) == n
        steps.append(int(step))
        frames.append(rows[np.argsort(rows[:, 0])])
    return np.array(steps), np.array(frames) if len({len(f) for f in frames}) == 1 else frames


@dataclass
class Bodies:
    """Spheres of a scene: type (1..3), radius, position, velocity, spin; ids are 1..n in this order."""

    type: np.ndarray
    radius: np.ndarray
    x: np.ndarray
    v: np.ndarray
    w: np.ndarray = None
    ids: np.ndarray = field(default=None)

    def __post_init__(self):
        n = len(self.radius)
        self.w = np.zeros((n, 3)) if self.w is None else self.w
        self.ids = np.arange(1, n + 1) if self.ids is None else self.ids

    @property
    def mass(self):
        return RHO[self.type - 1] * 4 / 3 * np.pi * self.radius**3

    def data(self, box, types=3):
        """A data file for read_data; rows in the order of the ids."""
        rows, speeds = [], []
        for k in np.argsort(self.ids):
            values = (2 * self.radius[k], RHO[self.type[k] - 1], *self.x[k])
            rows.append(f"{self.ids[k]} {self.type[k]} " + " ".join(repr(float(q)) for q in values))
            speeds.append(f"{self.ids[k]} " + " ".join(repr(float(q)) for q in (*self.v[k], *self.w[k])))
        lines = ["scene", "", f"{len(rows)} atoms", f"{types} atom types", ""]
        lines += [f"{lo!r} {hi!r} {c}lo {c}hi" for c, (lo, hi) in zip("xyz", box, strict=True)]
        lines += ["", "Atoms", "", *rows, "", "Velocities", "", *speeds, ""]
        return "\n".join(lines)


def head(*, boundary="f f f", ranks=(1, 1, 1), sort=None, options="hard_particles yes\nsoft_particles yes"):
    """All that comes before the atoms."""
    order = "" if sort is None else f"atom_modify sort {sort}\n"
    return f"""atom_style granular
atom_modify map array
{order}boundary {boundary}
newton off
communicate single vel yes
units si
{options}
processors {" ".join(map(str, ranks))}
"""


def materials(model, *, friction=0.3):
    """Properties of the three types for any model."""
    own = OWN + adhesion(model.removeprefix("ep/")) if model.startswith("ep/") else FOREIGN[model]
    return f"""fix m1 all property/global youngsModulus peratomtype {" ".join(map(repr, E.tolist()))}
fix m2 all property/global poissonsRatio peratomtype {" ".join(map(repr, NU.tolist()))}
{per_pair("coefficientFriction", friction)}{own}"""


MOVE = "fix move all nve/sphere\n"


def contact(model, *, tangential="history", wall=None, models="", settings=""):
    """Pair style and, if `wall` names one, the wall at z = 0 of type 2; a wall's settings come last."""
    words = f"model {model} tangential {tangential} {models}"
    text = f"pair_style gran {words} {settings}\npair_coeff * *\n"
    if wall == "primitive":
        text += f"fix wall all wall/gran {words} primitive type 2 zplane 0.0 {settings}\n"
    if wall == "mesh":
        text += "fix plate all mesh/surface file plate.stl type 2\n"
        text += f"fix wall all wall/gran {words} mesh n_meshes 1 meshes plate {settings}\n"
    return text


def deck_of(model, body, *, dt=1e-7, skin=1e-3, properties=None, move=MOVE, top=None, **of_contact):
    """A deck of the spheres of box.data; `body` runs it. top: of `head`, of_contact: of `contact`."""
    text = head(**(top or {})) + f"read_data box.data\nneighbor {skin!r} bin\nneigh_modify delay 0\n"
    text += (properties or materials(model)) + contact(model, **of_contact)
    return text + f"timestep {dt!r}\n{move}thermo_modify lost error norm no\n{body}"


DUMP = "dump out all custom {every} out.bin id x y z vx vy vz omegax omegay omegaz\n"
