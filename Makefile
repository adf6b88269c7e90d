# Each target is one line that calls a script or a tool.
.PHONY: setup demo test bench docs tidy sanitize wheel deb trees clean

setup:
	@scripts/setup

demo: setup
	.venv/bin/epdem run cases/steel_wall.toml --engine embedded --engine liggghts

test:
	@scripts/setup yade slurmctld slurmd slurm-client munge
	.venv/bin/python -m pytest -n 2

bench: setup
	.venv/bin/python bench/all.py

docs: setup
	.venv/bin/python docs/make.py

# the files that use every header of the laws; the wheel of clang-tidy brings its own compiler
tidy: setup
	.venv/bin/clang-tidy --quiet cpp_contact/capi/*.cpp cpp_contact/liggghts/loop/sse2.cpp tests/*/*.cpp -- \
	  -std=c++17 -Icpp_contact/include -DEPDEM_VERSION='""'

sanitize: setup
	.venv/bin/python scripts/sanitize

# PYTHONS="python3 /path/to/other": the wheel is tried in a clean environment of each
wheel: setup
	@scripts/wheel $(PYTHONS)

deb: setup
	@scripts/deb

# TREES="/path/to/lmp_auto ...": executables of other trees that were built after `epdem header`
trees: setup
	@.venv/bin/python scripts/trees $(TREES)

clean:
	rm -rf .venv build dist runs
