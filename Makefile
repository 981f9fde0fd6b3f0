# Everything from a bare clone: needs make and Python 3.11 or newer. `make help` lists the targets.

VENV := .venv
STAMP := $(VENV)/.installed
# The newest one that starts, has venv, and for which the pinned packages have builds. Or choose: make PYTHON=...
PYTHONS := python3.13 python3.12 python3.11 python3 python3.14
PYTHON ?=
ARGS ?=

.DEFAULT_GOAL := help
.PHONY: help run test check bench pictures tables golden lock clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "  make %-8s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

run: $(STAMP) ## open the sandbox: make run ARGS="--port 9000 --no-open"
	$(VENV)/bin/tumble run $(ARGS)

# A file's tests stay with one worker, so that each kernel is compiled about once. One worker: make test ARGS="-n 0".
test: $(STAMP) ## run the tests, on all cores: make test ARGS="tests/engine -x"
	$(VENV)/bin/python -m pytest -n auto --maxprocesses 4 --dist loadfile $(ARGS)

check: $(STAMP) ## what CI runs: lint, format, types, and the tests with none skipped
	$(VENV)/bin/ruff check
	$(VENV)/bin/ruff format --check
	$(VENV)/bin/mypy
	TUMBLE_NO_SKIP=1 $(MAKE) test ARGS="$(ARGS)"

bench: $(STAMP) ## time the engine: make bench ARGS="..."
	$(VENV)/bin/tumble bench $(ARGS)

pictures: $(STAMP) ## make the pictures of the documents again
	$(VENV)/bin/python -m tests.pictures

tables: $(STAMP) ## measure the documents' tables and diagrams again, on a quiet machine
	$(VENV)/bin/tumble accuracy --peers -o docs
	$(VENV)/bin/tumble stability --peers -o docs
	$(VENV)/bin/tumble effects "The Talk/Pyramid" "Effects/Wind" --markdown docs/effects.md

golden: $(STAMP) ## write the golden hashes again, after a change of behaviour that was meant
	$(VENV)/bin/python -m tests.golden.hashes

# Kernels are compiled again after this, and each stale copy of them is gone.
clean: ## remove compiled kernels and caches (not .venv)
	find . -path ./$(VENV) -prune -o -name __pycache__ -type d -exec rm -rf {} +
	rm -rf build dist htmlcov .coverage .coverage.* .hypothesis .mypy_cache .pytest_cache .ruff_cache

# In a Python of its own, with nothing held back: then the exact versions of all that came. The oldest Python first,
# because some packages bring more along there.
lock: PYTHONS := python3.11 python3.12 python3.13 python3
lock: ## choose the newest versions that pyproject.toml allows: writes constraints.txt
	@$(find_python); \
	folder=$$(mktemp -d) && trap 'rm -rf "$$folder"' EXIT && \
	"$$python" -m venv "$$folder" && \
	"$$folder/bin/python" -m pip install --quiet --disable-pip-version-check '.[dev,peers,dask]' && \
	{ printf '%s\n' \
	    '# The exact version of every package that tumble and its tests run with. Made by `make lock`; not edited by hand.' \
	    '# pyproject.toml names what is asked for directly; the rest is what those bring along.'; \
	  "$$folder/bin/python" -m pip freeze --disable-pip-version-check | grep -v '^tumble '; } > constraints.txt && \
	echo "constraints.txt: $$(grep -vc '^#' constraints.txt) packages"

# Stale when a dependency changed, not when code did: the installation points at this folder.
$(STAMP): pyproject.toml constraints.txt
	@$(find_python); \
	test -x $(VENV)/bin/python && $(VENV)/bin/python -c '$(usable)' 2>/dev/null || \
	{ echo "creating $(VENV) with $$($$python --version)"; $$python -m venv --clear $(VENV); }
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	@touch $@

usable = import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))

# A shell line that sets $python, or ends with an explanation.
define find_python
python=; for name in $(or $(PYTHON),$(PYTHONS)); do \
	  if "$$name" -c '$(usable)' >/dev/null 2>&1; then python=$$name; break; fi; \
	done; \
	if [ -z "$$python" ]; then \
	  echo "tumble needs Python 3.11 or newer with the venv module; tried: $(or $(PYTHON),$(PYTHONS))." >&2; \
	  echo "On Debian or Ubuntu: apt-get install python3 python3-venv. Or name one: make PYTHON=/path/to/python3.12 ..." >&2; \
	  exit 1; \
	fi
endef
