# Everything runs in .venv, which is made and kept up to date as needed. `make` alone lists the targets.

PYTHON ?= python3
ROBOTS = 200
SEED = 1000
MUTANTS = 400
WORKERS =

# What the browser tests drive, by the names that systems give it; the same as in tests/browser.
BROWSERS = chromium chromium-browser google-chrome

# What `make quick` runs: all rooms but the camera, the store and the command line, no drawings.
DRAWN = $(wildcard tests/report/test_*figure*.py tests/report/test_*film*.py tests/report/test_page*.py \
  tests/report/test_table_map.py)
QUICK = $(wildcard tests/analysis tests/exploration) tests/behaviors tests/conformance tests/core tests/planning \
  tests/procedures tests/simulation $(filter-out $(DRAWN),$(wildcard tests/report/test_*.py)) \
  tests/test_config.py tests/test_golden.py tests/test_quoted.py tests/test_readme_numbers.py tests/test_registry.py

# What `make mutants` lets find changes of the code: these, and what else tests the rooms in process and soon.
IN_PROCESS = $(QUICK) $(filter-out tests/store/test_processes.py tests/store/test_upgrading.py, \
  $(wildcard tests/store/test_*.py)) $(filter-out tests/lab/test_cluster.py tests/lab/test_workers.py, \
  $(wildcard tests/lab/test_*.py)) tests/api tests/logs tests/own_files $(addprefix tests/physics/test_,arm.py contact.py surface_friction.py \
  wrist_motion.py)

VENV := .venv
AFFCLI := $(VENV)/bin/affcli
PIP := $(VENV)/bin/python -m pip --disable-pip-version-check

# Stamps: the environment itself, affcli in it, the tools of check and test, those of test-browser, those
# of mutants.
MADE := $(VENV)/.made
INSTALLED := $(VENV)/.installed
INSTALLED_DEV := $(VENV)/.installed-dev
INSTALLED_BROWSER := $(VENV)/.installed-browser
INSTALLED_MUTANTS := $(VENV)/.installed-mutants

# KinDER's world has an environment of its own: why stands in its requirements.txt.
WORLD := $(VENV)/another-world
INSTALLED_WORLD := $(WORLD)/.installed

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.NOTPARALLEL:
.PHONY: help demo quick test test-browser torture mutants check reproduce bench another-world clean FORCE

## help          list these targets
help:
	@sed -n 's/^## /make /p' $(firstword $(MAKEFILE_LIST))

## demo          learn a tool, use it, break it, in a fresh demo.db and a page demo.html
demo: $(INSTALLED)
	@rm -f demo.db demo.db-wal demo.db-shm demo.db-journal demo.html
	@echo 'A robot babbles with a T-hook for an hour of its time:'
	@$(call picked,learn --tool t-hook,/^learned /p)
	@echo 'It brings the puck over goal 2:'
	@$(call picked,solve --goal 2,/^tool /p; /^t-hook /p)
	@echo 'Its tool breaks, and it does all 16 tasks with the broken and with the whole one:'
	@$(call picked,break-tool,/^16 trials/p; /^solved  /p; /^tries on lost/p)
	@$(call picked,report --html demo.html,)
	@printf '%s\n' 'Database: $(CURDIR)/demo.db' 'Page, to look at in a browser: $(CURDIR)/demo.html' \
	  'Try next, to see why it chose each row: $(AFFCLI) replay 11 --db demo.db'

# Run a command of the demo and show the lines that sed picks; all it said when it fails.
picked = said=`COLUMNS=80 $(AFFCLI) $(1) --db demo.db 2>&1` || { printf '%s\n' "$$said" >&2; exit 1; }; \
  printf '%s\n' "$$said" | sed -n '$(2)'

## quick         the tests of what robots do and of what is said of it, in a minute; no processes
quick: $(INSTALLED_DEV)
	$(VENV)/bin/pytest --numprocesses auto --dist worksteal $(QUICK)

## test          run the tests
test: $(INSTALLED_DEV)
	$(VENV)/bin/pytest --numprocesses auto --dist worksteal

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

## torture       the long tests whole: a hundred kills, readers for a minute, random attacks, fuzzing, new examples
torture: $(INSTALLED_DEV)
	$(VENV)/bin/pytest -m "torture or hypothesis" --torture --numprocesses auto --dist worksteal

## mutants       change the code in small ways, and see whether the tests find it [MUTANTS=400 SEED=1000]
mutants: $(INSTALLED_MUTANTS)
	@$(VENV)/bin/python tests/mutants.py --number $(MUTANTS) --seed $(SEED) $(IN_PROCESS)

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
bench: $(INSTALLED_DEV)
	$(VENV)/bin/python experiments/speed/bench.py --json bench.json

## another-world an environment for KinDER's hook world, .venv/another-world, and the tests of what plays in it
another-world: $(INSTALLED_WORLD)
	$(WORLD)/bin/python -m pytest -q -c experiments/another_world/pyproject.toml experiments/another_world/tests

## clean         remove .venv, caches, build products, demo.db and demo.html; other databases stay
clean:
	rm -rf $(VENV) build dist .hypothesis .import_linter_cache .mypy_cache .pytest_cache .ruff_cache
	rm -f demo.db demo.db-wal demo.db-shm demo.db-journal demo.html
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
	@echo 'Making a Python environment in $(VENV) ...' >&2
	@'$(PYTHON)' -m venv --clear $(VENV)
	@printf '%s\n' '$(CURDIR)' > $@

comma := ,
install = @echo 'Installing $(1) into $(VENV); the first time this takes a minute or two ...' >&2; \
  $(PIP) install -q -c requirements.lock -e '.[$(2)]'

$(INSTALLED): $(MADE) pyproject.toml requirements.lock
	$(call install,affcli and the libraries it needs,camera$(comma)figures)
	@touch $@

$(INSTALLED_WORLD): $(MADE) pyproject.toml $(wildcard experiments/another_world/*.toml experiments/another_world/*.txt)
	@echo "Installing KinDER's hook world into $(WORLD); this takes a minute or two ..." >&2
	@'$(PYTHON)' -m venv --clear $(WORLD)
	@$(WORLD)/bin/python -m pip --disable-pip-version-check install -q \
	  -r experiments/another_world/requirements.txt -e '.[figures]'
	@$(WORLD)/bin/python -m pip --disable-pip-version-check install -q --no-deps \
	  -r experiments/another_world/kinder.txt -e experiments/another_world
	@touch $@

# What check and test need includes what demo needs.
$(INSTALLED_DEV): $(MADE) pyproject.toml requirements.lock
	$(call install,what the tests and checks need,dev)
	@touch $(INSTALLED) $@

$(INSTALLED_BROWSER): $(MADE) pyproject.toml requirements.lock
	$(call install,what the browser tests need,dev$(comma)browser)
	@touch $(INSTALLED) $(INSTALLED_DEV) $@

$(INSTALLED_MUTANTS): $(MADE) pyproject.toml requirements.lock
	$(call install,what the mutants need,dev$(comma)mutants)
	@touch $(INSTALLED) $(INSTALLED_DEV) $@
