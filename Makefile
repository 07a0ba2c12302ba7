# Needs make, Rust (cargo) and Python >= 3.11 with venv; all else goes to .venv.

PYTHON ?= python3
VENV   ?= .venv
CARGO  ?= cargo
PY     := $(VENV)/bin/python

# The tests use the release profile: the numerics are too slow without
# optimisation, and the extension below reuses the compiled dependencies.
PROFILE := --release

TOOLS     := $(VENV)/.tools.stamp
PEERS     := $(VENV)/.peers.stamp
EXTENSION := $(VENV)/.extension.stamp
PACKAGE   := Cargo.toml Cargo.lock pyproject.toml README.md
RUST      := $(shell find rust -name '*.rs')

.PHONY: build example test soak check bench headline bench-compare bench-record instructions instructions-record docs clean
.DEFAULT_GOAL := build

build: $(EXTENSION)

$(TOOLS): requirements-dev.txt
	$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or later is needed: make PYTHON=...")'
	test -x $(PY) || $(PYTHON) -m venv $(VENV)
	$(PY) -m pip install --quiet --disable-pip-version-check -r requirements-dev.txt
	touch $@

# The Python sources are installed in place: only Rust changes need a rebuild.
$(EXTENSION): $(TOOLS) $(PACKAGE) $(RUST)
	VIRTUAL_ENV="$(abspath $(VENV))" $(PY) -m maturin develop $(PROFILE) --locked
	touch $@

example: $(EXTENSION)
	$(PY) examples/kishan_1973.py

test: $(EXTENSION)
	$(CARGO) test $(PROFILE) --locked
	$(CARGO) run --quiet $(PROFILE) --locked --example speeds
	OPENBLAS_NUM_THREADS=1 $(PY) -m pytest -n auto --dist worksteal

# Random studies by the thousand, other ones each time; every argument with every odd value.
soak: $(EXTENSION)
	$(CARGO) test $(PROFILE) --locked --test tests -- ensemble_fuzz --ignored --nocapture
	SPANWISE_SOAK=1 $(PY) -m pytest tests/test_doors.py

# clippy runs in the dev profile: with the settings of maturin in the release
# profile, the two would keep invalidating each other's build of PyO3.
check: $(EXTENSION)
	$(CARGO) fmt --check
	$(CARGO) clippy --locked --all-targets -- -D warnings
	PYO3_PYTHON="$(abspath $(PY))" $(CARGO) clippy --locked --all-targets --features python -- -D warnings
	$(PY) -m ruff check
	$(PY) -m ruff format --check
	$(PY) -m mypy
	$(PY) -m mypy.stubtest spanwise._core

bench: $(EXTENSION)
	$(CARGO) bench --locked
	$(PY) benches/python.py

# Crossings per second of the ensemble, with the fingerprint of its results.
headline: $(EXTENSION)
	$(PY) benches/headline.py

# Against what others would write, which takes packages that nothing else needs.
bench-compare: $(EXTENSION) $(PEERS)
	$(PY) benches/peers/numba_headline.py

$(PEERS): $(TOOLS) benches/requirements-peers.txt
	$(PY) -m pip install --quiet --disable-pip-version-check -r benches/requirements-peers.txt
	touch $@

# One run of the benchmarks whose history is kept, appended to benches/history.csv and drawn.
bench-record: $(TOOLS)
	$(CARGO) bench --locked --bench ensemble --bench crossing
	$(PY) benches/history.py --append --plot benches/history.png

# Fails if a crossing takes more instructions than benches/instructions.toml says. Built as `cargo test $(PROFILE)`
# builds: bench and release profile are the same, and so share all that is compiled.
instructions: $(TOOLS)
	CARGO="$(CARGO)" $(PY) benches/instructions.py

instructions-record: $(TOOLS)
	CARGO="$(CARGO)" $(PY) benches/instructions.py --record

# With the feature `python` only to reuse what clippy compiled.
docs: $(TOOLS)
	RUSTDOCFLAGS="-D warnings" PYO3_PYTHON="$(abspath $(PY))" $(CARGO) doc --locked --no-deps --features python

clean:
	$(CARGO) clean
	rm -rf $(VENV) .mypy_cache .pytest_cache .ruff_cache
	rm -f python/spanwise/_core*.so python/spanwise/_core*.pyd
	find python tests examples -name __pycache__ -type d -prune -exec rm -rf {} +
