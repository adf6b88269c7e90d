# Each target is one line that calls a script or a tool.
.PHONY: setup demo test walltime bench docs tidy sanitize clean

setup:
	@scripts/setup

demo: setup
	.venv/bin/epdem run cases/steel_wall.toml --engine embedded --engine liggghts

test:
	@scripts/setup yade slurmctld slurmd slurm-client munge
	.venv/bin/python -m pytest -n 2

# a scene of this duration takes more than a minute, the shortest walltime of Slurm
walltime: setup
	EPDEM_WALLTIME="3 s" .venv/bin/python -m pytest tests/studies/test_sweep_slurm.py -k walltime

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

clean:
	rm -rf .venv build runs
