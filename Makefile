# Everything runs in .venv, which is made and kept up to date as needed. `make` alone lists the targets.

PYTHON ?= python3
ROBOTS = 200
SEED = 1000
WORKERS =

# What the browser tests drive, by the names that systems give it; the same as in tests/browser.
BROWSERS = chromium chromium-browser google-chrome

# What `make quick` runs: all rooms but the camera, the store and the command line, no drawings.
DRAWN = $(wildcard tests/report/test_*figure*.py tests/report/test_*film*.py tests/report/test_page*.py \
  tests/report/test_table_map.py)
QUICK = $(wildcard tests/analysis tests/exploration) tests/behaviors tests/conformance tests/core tests/planning \
  tests/procedures tests/simulation $(filter-out $(DRAWN),$(wildcard tests/report/test_*.py)) \
  tests/test_config.py tests/test_golden.py tests/test_quoted.py tests/test_registry.py

VENV := .venv
AFFCLI := $(VENV)/bin/affcli
PIP := $(VENV)/bin/python -m pip --disable-pip-version-check

# Stamps: the environment itself, affcli in it, the tools of check and test, those of test-browser.
MADE := $(VENV)/.made
INSTALLED := $(VENV)/.installed
INSTALLED_DEV := $(VENV)/.installed-dev
INSTALLED_BROWSER := $(VENV)/.installed-browser

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.NOTPARALLEL:
.PHONY: help demo quick test test-browser torture check reproduce bench clean FORCE

## help          list these targets
help:
	@sed -n 's/^## /make /p' $(firstword $(MAKEFILE_LIST))

## demo          learn a tool, use it, break it and report, in a fresh demo.db
demo: $(INSTALLED)
	@rm -f demo.db demo.db-wal demo.db-shm demo.db-journal
	AFFCLI_DB=demo.db $(AFFCLI) learn --tool t-hook
	AFFCLI_DB=demo.db $(AFFCLI) solve --goal 2
	AFFCLI_DB=demo.db $(AFFCLI) break-tool
	AFFCLI_DB=demo.db $(AFFCLI) report
	@printf '\nThe database: %s\nA query to try:\n  %s\n' '$(CURDIR)/demo.db' \
	  '$(AFFCLI) sql --db demo.db "select exploratory_behavior, exploratory_params, round(movement, 1) as inches, round(direction) as degrees, times_successful, times_used from affordance_table order by times_used desc limit 5"'

## quick         the tests of what robots do and of what is said of it, in a minute; no processes
quick: $(INSTALLED_DEV)
	$(VENV)/bin/pytest --numprocesses auto --dist loadfile $(QUICK)

## test          run the tests
test: $(INSTALLED_DEV)
	$(VENV)/bin/pytest --numprocesses auto --dist loadfile

## test-browser  test the page in a real browser; installs what it needs
test-browser: $(INSTALLED_BROWSER)
	@for name in $(BROWSERS); do command -v $$name >/dev/null && exit; done; \
	if [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null; then \
	  export DEBIAN_FRONTEND=noninteractive; \
	  apt-get install -y -qq chromium >/dev/null 2>&1 || \
	    { apt-get update -qq && apt-get install -y -qq chromium >/dev/null; }; \
	else \
	  echo 'no browser here: install chromium, chromium-browser or google-chrome (Debian: apt install chromium)' >&2; exit 1; \
	fi
	$(VENV)/bin/pytest tests/browser --browser

## torture       the long tests whole: a hundred kills, readers for a minute, fuzzing
torture: $(INSTALLED_DEV)
	$(VENV)/bin/pytest -m torture --torture --numprocesses auto --dist loadfile

## check         lint, formatting, types and import contracts
check: $(INSTALLED_DEV)
	$(VENV)/bin/ruff check
	$(VENV)/bin/ruff format --check
	$(VENV)/bin/mypy affcli tests
	$(VENV)/bin/lint-imports

## reproduce     the whole paper on many robots, in reproduce.db [ROBOTS=200 SEED=1000 WORKERS=n]
reproduce: $(INSTALLED)
	$(AFFCLI) reproduce --robots $(ROBOTS) --seed $(SEED) $(if $(WORKERS),--workers $(WORKERS)) --db reproduce.db

## bench         measure the speed, also beside other engines, which it installs apart; figures in bench.json
bench: $(INSTALLED)
	$(VENV)/bin/python experiments/speed/bench.py --json bench.json

## clean         remove .venv, caches, build products and demo.db; every other database stays
clean:
	rm -rf $(VENV) build dist .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	rm -f demo.db demo.db-wal demo.db-shm demo.db-journal
	find affcli migrations tests experiments -name __pycache__ -type d -prune -exec rm -rf {} +

# One line that says why PYTHON cannot make the environment; empty when it can.
PYTHON_PROBLEM = $(shell \
  version=`'$(PYTHON)' -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null` || \
    { echo 'affcli needs Python 3.11 or newer, and "$(PYTHON)" does not run: install Python, or name one with "make PYTHON=/path/to/python3.12"'; exit; }; \
  '$(PYTHON)' -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
    { echo "affcli needs Python 3.11 or newer, and \"$(PYTHON)\" is $$version: install a newer one, or name it with \"make PYTHON=/path/to/python3.12\""; exit; }; \
  '$(PYTHON)' -c 'import venv, ensurepip' 2>/dev/null || \
    echo "\"$(PYTHON)\" ($$version) cannot make virtual environments, it lacks venv or ensurepip: install them (Debian, Ubuntu: apt install python$$version-venv)")

# The stamp names the checkout: an environment that was copied or moved along with the files would
# go on running the code of the first place. It is made anew then, and when its Python is gone.
ifneq ($(shell $(VENV)/bin/python -c '' 2>/dev/null && cat $(MADE) 2>/dev/null),$(CURDIR))
$(MADE): FORCE
endif

$(MADE):
	@$(if $(PYTHON_PROBLEM),$(error $(PYTHON_PROBLEM)))
	'$(PYTHON)' -m venv --clear $(VENV)
	@printf '%s\n' '$(CURDIR)' > $@

$(INSTALLED): $(MADE) pyproject.toml requirements.lock
	$(PIP) install -q -c requirements.lock -e '.[camera,figures]'
	@touch $@

# What check and test need includes what demo needs.
$(INSTALLED_DEV): $(MADE) pyproject.toml requirements.lock
	$(PIP) install -q -c requirements.lock -e '.[dev]'
	@touch $(INSTALLED) $@

$(INSTALLED_BROWSER): $(MADE) pyproject.toml requirements.lock
	$(PIP) install -q -c requirements.lock -e '.[dev,browser]'
	@touch $(INSTALLED) $(INSTALLED_DEV) $@
