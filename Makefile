# make demo and make test are all that a newcomer needs; both set up everything first.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.ready
# byte code of these is kept: where PYTHONDONTWRITEBYTECODE is set, each command would compile hundreds of them again
MODULES := $(addprefix src/cratous/,spec core proofs services bridge judge)

.PHONY: help venv demo test rewritten test-fast test-long test-web lint types prove recheck mutate crosshair fuzz daa-fuzz bench docs dist changelog lock clean

help:
	@echo "make demo      set up, then plan, prove, fly, monitor and certify the crossing mission"
	@echo "make test      set up, then run the tests"
	@echo "make test-long the tests that take many minutes"
	@echo "make test-web  the ground station in headless Chromium, where there is one"
	@echo "make venv      only set up (.venv, pinned dependencies, compiled kernels)"
	@echo "make lint      style and spelling"
	@echo "make types     mypy, strict"
	@echo "make prove     prove every kernel (the cache answers what it has proved) and hold the ledger against it"
	@echo "make recheck   put every proof to the second solver (cvc5)"
	@echo "make mutate    look for faults that no theorem would notice, where something has changed since"
	@echo "make crosshair look for bugs in functions that are no kernels, two minutes"
	@echo "make fuzz      a million changed LMCP messages and frames, some minutes"
	@echo "make daa-fuzz  detect and avoid on 100,000 random and degenerate encounters"
	@echo "make bench     benchmarks (ratios, see bench/README.md)"
	@echo "make docs      regenerate the generated documents"
	@echo "make changelog move the fragments of changelog.d into CHANGELOG.md"
	@echo "make dist      build sdist and wheel of what is committed, into dist/"

venv: $(STAMP)

# byte code is made on all cores, pip would on one; a file of a package that is no Python of this version is no error
$(STAMP): requirements.lock pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --require-hashes --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	$(BIN)/python -m compileall -qq -j 0 $(VENV)/lib || true
	$(BIN)/python -m compileall -q -j 0 $(MODULES)
	$(BIN)/cratous warm
	@touch $(STAMP)

demo: venv
	$(BIN)/cratous run examples/crossing/mission.yaml
	@echo "open out/crossing/report.html in a browser"

test: venv
	$(BIN)/python -m pytest -n auto --dist loadfile --no-loadscope-reorder -m "not long"

test-long: venv
	$(BIN)/python -m pytest -m long

test-web: venv
	$(BIN)/python -m pytest tests/ground_station

# pytest rewrites what tests assert: kept here once, else each of its processes does it again
rewritten: venv
	@said=$$(PYTHONDONTWRITEBYTECODE= $(BIN)/python -m pytest --collect-only -qq 2>&1) || { echo "$$said"; exit 1; }

test-fast: venv
	$(BIN)/python -m pytest -n auto --dist loadfile --no-loadscope-reorder -m "not slow and not long"

lint: venv
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/codespell

types: venv
	$(BIN)/mypy

prove: venv
	$(BIN)/cratous prove --check

recheck: venv
	$(BIN)/cratous prove --recheck

mutate: venv
	$(BIN)/cratous prove --mutate --new

# seconds for each function
EACH_S ?= 10
crosshair: venv
	$(BIN)/python -m crosshair check --analysis_kind=asserts --per_condition_timeout=$(EACH_S) tests/programs/crosshair_targets.py

fuzz: venv
	$(BIN)/python tests/programs/fuzz_lmcp.py --count 1000000
	$(BIN)/python tests/programs/fuzz_lines.py --lines 1000000

daa-fuzz: venv
	$(BIN)/python tests/programs/daa_scenes.py 100000

bench: venv
	$(BIN)/python bench/run.py

docs: venv
	$(BIN)/python docs/tools/generate.py
	$(BIN)/python -m cratous.bridge.lmcp.generate

changelog: venv
	$(BIN)/python .ci/changelog --write

dist: venv
	$(BIN)/python .ci/dist

lock:
	$(BIN)/python -m pip install --quiet pip-tools
	$(BIN)/pip-compile --quiet --generate-hashes --allow-unsafe --strip-extras --no-header --no-emit-index-url --no-emit-trusted-host --no-emit-find-links --output-file requirements.lock requirements.in

clean:
	rm -rf $(VENV) out build dist *.egg-info src/*.egg-info .pytest_cache .mypy_cache .ruff_cache
