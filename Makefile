# Everything a user or a CI machine needs, from Python 3.11 or newer and make alone.
PYTHON ?= python3
CASE ?= catenary
ARGS ?=

BIN := .venv/bin
BIN_MUJOCO3 := .venv-mujoco3/bin
BIN_ENGINES := .venv-engines/bin

# Neighbours stay on one core, which makes what they share once; a core that is done takes over.
PARALLEL := -n auto --dist worksteal

STUDIES := resolution contact-stiffness phase-b sweep-step sensor-noise methods-deflection methods-noise
EXTRAS := drake exudyn pinocchio dart pyelastica warp mjx
CASES := catenary parabola two-circles shallow-catenary tip-only

# One folder a run; a run writes its report last. A beam that disagrees is a finding, not a failure.
BEAMS := chain rod $(if $(wildcard .venv-mujoco3/installed),cable)
RUNS := $(foreach case,$(CASES),$(foreach beam,$(BEAMS),results/runs/$(case)-$(beam)/report.html))
FOUND = --budget --beam $(BEAM) --out $(@D) $(ARGS) || test $$? -eq 1; test -f $@

.NOTPARALLEL:
.PHONY: help install develop run test test-slow test-all trials coverage lint docs gallery wheel fuzz sweeps bench results again studies \
  net size reference install-mujoco3 test-mujoco3 test-python test-floors install-engines test-engines versions clean

help:            ## list the targets
	@grep -E '^[a-z0-9-]+: .*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 20

install: .venv/installed      ## build .venv with the newest MuJoCo and all that a user needs

develop: .venv/developed      ## the same with the tools of the targets below: half as large again

run: install     ## sweep CASE in both models and write results/CASE/report.html
	$(BIN)/vibrissa run $(CASE) $(ARGS)

test: develop    ## the fast tests, under two minutes
	$(BIN)/python -m pytest $(PARALLEL) $(ARGS)

test-slow: develop   ## the slow tests alone
	$(BIN)/python -m pytest $(PARALLEL) -m "slow and not trial" $(ARGS)

test-all: develop    ## all tests, the slow ones too
	$(BIN)/python -m pytest $(PARALLEL) -m "not trial" $(ARGS)

trials: develop      ## what intervals and causes promise, on hundreds of random cases each: minutes
	$(BIN)/python -m pytest $(PARALLEL) -m trial $(ARGS)

coverage: develop    ## how much of the code the fast tests run; ARGS='-m "not trial"' for all tests
	$(BIN)/python -m pytest $(PARALLEL) --cov --cov-report=term --cov-report=html $(ARGS)

lint: develop    ## format, style, types, import rules
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

reference: install ## docs/examples/reference/tables: contact states for tests of any engine
	$(BIN)/python -m docs.figures.reference_tables docs/examples/reference/tables

size: develop    ## lines of code and docstring, room by room
	$(BIN)/python -m tests.size

docs: develop    ## the pages and an API reference, offline -> site/index.html
	$(BIN)/python -m sphinx --fail-on-warning --keep-going -q -c docs . site

gallery: develop ## docs/gallery/*.png, by the lines on its page
	$(BIN)/python -m docs.gallery.make

wheel: develop   ## dist/*.whl and *.tar.gz
	$(BIN)/python -m build --no-isolation

fuzz: develop    ## bad input to all commands; ARGS="N SEED"
	$(BIN)/python -m tests.fuzz.inputs $(or $(ARGS),10000 1)

sweeps: develop  ## random sweeps in MuJoCo against the closed form; ARGS="N [SEED]"
	$(BIN)/python -m tests.fuzz.sweeps $(or $(ARGS),200)

models: develop  ## random foreign models, inspected and fixed; ARGS="N [SEED [SWEPT]]"
	$(BIN)/python -m tests.fuzz.models $(or $(ARGS),200)

bench: develop   ## speed, side by side on one core; ARGS="ratios analytic mujoco stepping engines"
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.bench $(ARGS)

net: develop     ## some 270 sweeps of this checkout, held against those that another one made in OLD
	rm -rf results/net
	$(BIN)/python -m tests.net make results/net
	$(BIN)/python -m tests.net compare $(or $(OLD),$(error OLD=DIR is missing)) results/net

results: $(RUNS) | install ## results/README.md: all named cases, all beams there are; goes on where it stopped
	$(BIN)/python -m docs.figures.overview results/overview.png
	$(BIN)/python -m docs.figures.hysteresis results/hysteresis.png
	$(BIN)/python -m docs.figures.quasi_static results/quasi-static.csv
	$(BIN)/python -m docs.figures.quasi_static_picture results/quasi-static.csv results/quasi-static.png
	$(BIN)/python -m docs.figures.paper catenary results/pictures
	$(BIN)/python -m docs.figures.methods catenary results/pictures
	cp results/pictures/methods.png results/methods-catenary.png
	for case in catenary parabola tip-only; do \
	  $(BIN)/python -m docs.figures.methods $$case results/runs/methods-$$case --on all; done
	$(BIN)/vibrissa study resolution --out results/resolution
	$(BIN)/vibrissa report results/resolution
	cp results/resolution/report/disagreement-mujoco.segments.png results/study-resolution.png
	$(BIN)/vibrissa run catenary --stations 60 --film --frames 60 --out results/pictures || test $$? -eq 1
	cp results/pictures/figure-15.png results/pictures/still-2.png results/
	mkdir -p results/pictures/space
	sed -n '/^\[beam\]/,/^```/{/^```/!p}' analytic/space.md > results/pictures/space/egg.toml
	$(BIN)/vibrissa run results/pictures/space/egg.toml --engine exact --out results/pictures/space
	cp results/pictures/space/space.png results/
	$(BIN)/python -m docs.figures.findings results/runs results
	$(if $(wildcard .venv-engines/installed),$(BIN_ENGINES),$(BIN))/python -m docs.figures.league results

again: install   ## the same, but forget the runs that are done
	rm -rf results/runs
	$(MAKE) results

studies: install ## all shipped studies at full size
	set -e; for study in $(STUDIES); do \
	  $(BIN)/vibrissa study $$study || test $$? -eq 1; $(BIN)/vibrissa report results/$$study; done

install-mujoco3: .venv-mujoco3/installed   ## build .venv-mujoco3 with MuJoCo 3.17

test-mujoco3: install-mujoco3    ## the fast tests under MuJoCo 3.17
	$(BIN_MUJOCO3)/python -m pytest $(PARALLEL) $(ARGS)

test-python:     ## the fast tests under another Python: PYTHON=python3.13
	$(PYTHON) -m venv --clear .venv-python
	.venv-python/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,dask]'
	.venv-python/bin/python -m pytest $(PARALLEL) $(ARGS)

test-floors:     ## the fast tests with the oldest dependencies that are allowed, MuJoCo 3.17 among them; their warnings and last digits do not count
	$(PYTHON) -m venv --clear .venv-floors
	sed -nE '/^dependencies/,/^]/s/^ +"([a-z0-9-]+)>=([0-9.]+).*/\1==\2.*/p' pyproject.toml > .venv-floors/floors.txt
	.venv-floors/bin/python -m pip install --quiet --disable-pip-version-check --constraint .venv-floors/floors.txt --editable '.[dev,dask]'
	.venv-floors/bin/python -m pytest $(PARALLEL) -o filterwarnings= $(ARGS) \
	  --deselect tests/figures/test_reference_tables.py::test_the_tables_are_made_again

install-engines: .venv-engines/installed   ## build .venv-engines with all engines of the extras, for the league table

# An extra may lean on what another one brings: each is alone, in a copy (of links) of what all need.
test-engines:    ## the tests of the other engines, each in an environment of its own; ARGS="-m slow" for more
	$(PYTHON) -m venv --clear .venv-alone/base
	.venv-alone/base/bin/python -m pip install --quiet --disable-pip-version-check --compile --editable . pytest pytest-xdist  # compiled once, for all copies
	set -e; for extra in $(EXTRAS); do \
	  alone=.venv-alone/$$extra; rm -rf $$alone; cp -al .venv-alone/base $$alone; \
	  $$alone/bin/python -m pip install --quiet --disable-pip-version-check --editable ".[$$extra]" \
	    || { echo "$$extra: cannot be installed here"; continue; }; \
	  echo "$$extra alone:"; \
	  $$alone/bin/python -m pytest --quiet $(PARALLEL) tests/engines/*/ tests/engines/test_twins.py \
	    tests/engines/test_real_split.py tests/engines/test_refused.py $(ARGS); done

versions: install install-mujoco3    ## the beams of both MuJoCo versions and the closed form side by side
	set -e; for beam in chain rod; do \
	  $(BIN)/vibrissa run $(CASE) --sweep-only --beam $$beam --out results/versions/4 $(ARGS); done
	set -e; for beam in chain cable; do \
	  $(BIN_MUJOCO3)/vibrissa run $(CASE) --sweep-only --beam $$beam --out results/versions/3.17 $(ARGS); done
	$(BIN)/vibrissa compare $(CASE) --out results/versions \
	  $(foreach sweep,3.17/mujoco-chain 3.17/mujoco-cable 4/mujoco-chain 4/mujoco-rod,results/versions/$(sweep).parquet)

clean:           ## remove what the targets above made
	rm -rf .venv .venv-mujoco3 .venv-engines .venv-alone .venv-python .venv-floors .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	rm -rf site htmlcov .coverage* dist results/*/

results/runs/%-chain/report.html: BEAM = chain
results/runs/%-chain/report.html: | install
	$(BIN)/vibrissa run $* $(FOUND)

results/runs/%-rod/report.html: BEAM = rod
results/runs/%-rod/report.html: | install
	$(BIN)/vibrissa run $* $(FOUND)

results/runs/%-cable/report.html: BEAM = cable
results/runs/%-cable/report.html: | install-mujoco3
	$(BIN_MUJOCO3)/vibrissa run $* $(FOUND)

.venv/installed: pyproject.toml
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable . pytest
	touch $@

.venv/developed: .venv/installed
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,dask,docs]'
	touch $@

.venv-engines/installed: pyproject.toml
	$(PYTHON) -m venv .venv-engines
	$(BIN_ENGINES)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,drake,exudyn,dart,pyelastica,pinocchio,warp,mjx]'
	touch $@

.venv-mujoco3/installed: pyproject.toml
	$(PYTHON) -m venv .venv-mujoco3
	$(BIN_MUJOCO3)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev,dask]' 'mujoco==3.17.*'
	touch $@
