# Each target is one line that calls a script or a tool.
.PHONY: setup demo test bench docs clean

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

clean:
	rm -rf .venv build runs
