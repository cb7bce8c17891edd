# Everything a user or a CI machine needs, from Python 3.11 or newer and make alone.
PYTHON ?= python3
CASE ?= catenary
ARGS ?=

BIN := .venv/bin
BIN_MUJOCO3 := .venv-mujoco3/bin

STUDIES := resolution contact-stiffness phase-b sweep-step sensor-noise
CASES := catenary parabola two-circles shallow-catenary tip-only

.PHONY: help install run test test-all lint bench results install-mujoco3 test-mujoco3 versions clean

help:            ## list the targets
	@grep -E '^[a-z0-9-]+: .*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 20

install: .venv/installed      ## build .venv with the newest MuJoCo

run: install     ## sweep CASE in both models and write results/CASE/report.html
	$(BIN)/vibrissa run $(CASE) $(ARGS)

test: install    ## the fast tests, under two minutes
	$(BIN)/python -m pytest -n auto $(ARGS)

test-all: install    ## all tests, the slow ones too
	$(BIN)/python -m pytest -n auto -m "slow or not slow" $(ARGS)

lint: install    ## format, style, types, import rules
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: install   ## speed, side by side on one core; ARGS="analytic mujoco stepping exudyn study"
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.bench $(ARGS)

results: install ## all named cases and all shipped studies at full size, and the README's picture
	$(BIN)/python -m compare.overview results/overview.png
	set -e; for case in $(CASES); do $(BIN)/vibrissa run $$case; done
	set -e; for study in $(STUDIES); do \
	  $(BIN)/vibrissa study $$study; $(BIN)/vibrissa study-report results/$$study; done

install-mujoco3: .venv-mujoco3/installed   ## build .venv-mujoco3 with MuJoCo 3.17

test-mujoco3: install-mujoco3    ## the fast tests under MuJoCo 3.17
	$(BIN_MUJOCO3)/python -m pytest -n auto $(ARGS)

versions: install install-mujoco3    ## the beams of both MuJoCo versions and the closed form side by side
	set -e; for beam in chain rod; do \
	  $(BIN)/vibrissa simulate $(CASE) --beam $$beam --out results/versions/4 $(ARGS); done
	set -e; for beam in chain cable; do \
	  $(BIN_MUJOCO3)/vibrissa simulate $(CASE) --beam $$beam --out results/versions/3.17 $(ARGS); done
	$(BIN)/vibrissa side-by-side $(CASE) --out results/versions \
	  $(foreach sweep,3.17/mujoco-chain 3.17/mujoco-cable 4/mujoco-chain 4/mujoco-rod,results/versions/$(sweep).parquet)

clean:           ## remove what the targets above made
	rm -rf .venv .venv-mujoco3 .mypy_cache .ruff_cache .pytest_cache .hypothesis

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,dask]'
	touch $@

.venv-mujoco3/installed: pyproject.toml
	$(PYTHON) -m venv .venv-mujoco3
	$(BIN_MUJOCO3)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,dask]' 'mujoco==3.17.*'
	touch $@
