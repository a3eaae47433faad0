# People and CI call these targets and nothing else. `make help` lists them.
# Everything that is made goes into the checkout: target/, .venv*/, out/, dist/, fuzz/.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory
export PATH := $(PATH):$(HOME)/.cargo/bin

CARGO ?= cargo
PYTHON ?= python3
FUZZ_SECONDS ?= 30
ROUNDS ?= 31
# Another state of the program, to be timed in turn.
OTHER ?=
# Folder of the sets of `eval`, those of its sets with a truth that are there, runs of each method on each map.
DATA ?= ../shared/data
set = $(if $(wildcard $(DATA)/$(2)),$(1))
SETS ?= $(call set,real,gt_real) $(call set,segcomp-abw,gt_segcomp_abw) $(call set,middlebury,middlebury) $(call set,synpeb,gt_synpeb) \
	$(call set,evops,gt_evops) $(call set,nyu-dpd,gt_nyu_dpd) $(call set,sr4000,gt_sr4000_dpd) \
	scene:random:seed=201-206,sensor=kinect_white scene:random:seed=201-206,sensor=tof_white
REPEAT ?= 3
# Further sets of docs/results.md, and all methods.
MORE_SETS = $(call set,real-presets,gt_real) $(call set,7scenes,video_7scenes) $(call set,tsdf,video_tsdf_fusion) \
	$(call set,kinect,kinect_v1)
METHODS ?= planar,ngaf,ransac,ppdfdm,fpdidm,hough,normals,mdl,gradient
# Random maps that `make stress` makes, and the seed of the first.
RUNS ?= 100000
SEED ?= 1
# Where `make install-c` installs.
PREFIX ?= /usr/local
# Name of this machine's folder of benchmark records.
MACHINE ?= $(shell scripts/machine)

VENV := .venv/ready
PY := .venv/bin/python
PEERS := .venv-peers/ready
# Features of the tests. What is built for them serves the pages' and the oracles' tests too, which ask for the same.
TESTED := depthplanes/serde,depthplanes-cli/parquet
CARGO_FUZZ := target/tools/bin/cargo-fuzz

say = @printf '\n== %s\n' '$(1)'

.NOTPARALLEL:
.PHONY: help demo dist try-deb deny test lint fmt format clippy rust-tests rustdoc packages package targets browser oracles python wheel npm c install-c bench bench-planar bench-track ablate tables peers results golden stress fuzz clean

help: ## List the targets
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1\t\2/' | expand -t 18

demo: ## Build the program and run a synthetic scene through it into out/demo
	$(CARGO) build --release --package depthplanes-cli
	"$${CARGO_TARGET_DIR:-target}"/release/depthplanes demo --out-dir out/demo

dist: ## Build the static program and pack it into dist: an archive and a Debian package
	@scripts/dist

try-deb: ## Install the package that `make dist` made in a new Debian and run it there; needs root
	@scripts/try-deb dist/depthplanes_*_amd64.deb

deny: ## Check licences, sources and advisories of all dependencies
	$(call say,dependencies)
	@scripts/deny '$(PYTHON)'

# Two at a time, which does not show the figures that `make oracles` prints.
test: ORACLE_FLAGS = --numprocesses 2
test: lint rust-tests rustdoc packages targets browser oracles python c ## Run every check: formatting, lints, all tests, documentation, packages, other targets, the pages in a browser, Python oracles, the Python package, the C library
	$(call say,all checks passed)

lint: format clippy deny ## Check formatting, lints and dependencies, change nothing

format:
	$(call say,formatting)
	@if scripts/component rustfmt; then $(CARGO) fmt --all --check || { \
		echo 'error: the code is not formatted; run `make fmt`' >&2; exit 1; }; fi

clippy:
	$(call say,lints)
	@if scripts/component clippy; then \
		$(CARGO) clippy --workspace --all-targets --features depthplanes/serde,depthplanes-io/exr,depthplanes-cli/parquet -- -D warnings; \
		$(CARGO) clippy --package depthplanes --no-default-features -- -D warnings; fi

rust-tests:
	$(call say,tests)
	$(CARGO) test --workspace --features $(TESTED)
	$(call say,tests of the library without threads)
	$(CARGO) test --package depthplanes --no-default-features --test grouping --test detection --test planar --test allocations
	$(call say,tests of the readers with OpenEXR)
	$(CARGO) test --workspace --features $(TESTED),depthplanes-cli/exr --test formats --test broken --test real_files

# All packages are made; the library's is built from what is in it, all of them by `make package`.
packages:
	$(call say,packages)
	$(CARGO) package --workspace --allow-dirty --no-verify
	$(CARGO) package --package depthplanes --allow-dirty

package: ## Make the packages of all crates and build each from what is in it
	$(CARGO) package --workspace --allow-dirty

# The program has the library's name, so its own page is left out.
rustdoc:
	$(call say,documentation)
	RUSTDOCFLAGS='-D warnings' $(CARGO) doc --no-deps --package depthplanes --package depthplanes-io --package depthplanes-video --package depthplanes-serve \
		--package depthplanes-ros2 --package depthplanes-rerun --features depthplanes-io/exr

targets: ## Check that the library compiles for WebAssembly, 64-bit ARM and 32-bit x86
	$(call say,other targets)
	@scripts/targets

browser: ## Build the live page anew and compare it, and the npm package with its page; use all of them in headless Chromium and node
	$(call say,the pages in a browser)
	@scripts/browser

oracles: $(VENV)
	$(call say,Python oracles)
	$(PY) -m pytest tests/oracles $(ORACLE_FLAGS)

python: ## Build the Python package, install it with NumPy alone, and run its tests
	$(call say,the Python package)
	@scripts/python '$(PYTHON)'

wheel: ## Make the Python package for others into dist: wheels for Linux, and the sources
	@scripts/wheel '$(PYTHON)'

c: $(VENV) ## Build the C library, install it into a folder, and run the examples and tests there
	$(call say,the C library)
	@scripts/c $(PY)

install-c: ## Install the C library with its headers below PREFIX (/usr/local)
	$(CARGO) build --release --package depthplanes-c
	@scripts/install-c '$(PREFIX)'

npm: ## Make the package for JavaScript and the page that needs no server into dist
	@scripts/npm

bench: $(VENV) ## Measure against cc3d and OpenCV; writes benchmarks/record/MACHINE/DATE.csv
	CARGO_TARGET_DIR=target $(CARGO) build --release --package depthplanes --examples
	$(PY) benchmarks/run.py --rounds $(ROUNDS) --record "benchmarks/record/$(MACHINE)/$$(date +%F).csv"

bench-track: ## Time tracking and the ground beside detection on recorded videos; writes benchmarks/record/MACHINE/track-DATE.csv
	CARGO_TARGET_DIR=target $(CARGO) build --release --package depthplanes-video --examples
	mkdir -p "benchmarks/record/$(MACHINE)"
	target/release/examples/bench_track $(ROUNDS) '$(DATA)/video_7scenes' '$(DATA)/video_tsdf_fusion' '$(DATA)/icl_nuim/evolin' \
		> "benchmarks/record/$(MACHINE)/track.partial"
	mv "benchmarks/record/$(MACHINE)/track.partial" "benchmarks/record/$(MACHINE)/track-$$(date +%F).csv"

bench-planar: ## Time planar on recorded and synthetic frames, beside OTHER's program if stated; writes benchmarks/record/MACHINE/planar-DATE.csv
	CARGO_TARGET_DIR=target $(CARGO) build --release --package depthplanes-io --examples
	mkdir -p "benchmarks/record/$(MACHINE)"
	target/release/examples/bench_planar $(ROUNDS) '$(DATA)' $(OTHER) > "benchmarks/record/$(MACHINE)/planar.partial"
	mv "benchmarks/record/$(MACHINE)/planar.partial" "benchmarks/record/$(MACHINE)/planar-$$(date +%F).csv"

ablate: ## Switch each part of planar off in turn and print what it is worth
	CARGO_TARGET_DIR=target/ablate $(CARGO) build --release --package depthplanes-cli --features ablate
	scripts/ablate target/ablate/release/depthplanes '$(DATA)'

tables: $(VENV) ## Write docs/paper-tables.md: the paper's tables on the same maps
	CARGO_TARGET_DIR=target $(CARGO) build --release --package depthplanes-cli
	$(PY) benchmarks/paper_tables.py

peers: $(PEERS) ## Run Open3D, pyransac3d and cc3d beside ours on SETS; writes out/peers/report.html
	CARGO_TARGET_DIR=target $(CARGO) build --release --package depthplanes-cli
	target/release/depthplanes eval $(SETS) --data '$(DATA)' --methods planar,ngaf,ransac \
		--peers '.venv-peers/bin/python benchmarks/peers.py' --repeat $(REPEAT) --report out/peers

results: ## Write docs/results.md and the README's table of methods anew: METHODS on all sets of DATA, some minutes
	CARGO_TARGET_DIR=target $(CARGO) build --release --package depthplanes-cli
	rm -rf out/results
	target/release/depthplanes eval $(SETS) $(MORE_SETS) --data '$(DATA)' --methods $(METHODS) --repeat 1 --report out/results
	scripts/results out/results/report.md docs/results.md
	DEPTHPLANES_GOLDEN=update $(CARGO) test --package depthplanes-cli --test docs the_tables_of_formats
	git status --short

golden: ## Write golden files, the outputs shown in the docs and their pictures anew; look at the difference
	DEPTHPLANES_GOLDEN=update $(CARGO) test --workspace
	git status --short

stress: ## Run RUNS (100000) random maps through random methods, parameters and cameras, from SEED (1) on
	STRESS_RUNS=$(RUNS) STRESS_SEED=$(SEED) $(CARGO) test --package depthplanes-io --test stress -- --nocapture

fuzz: $(CARGO_FUZZ) ## Fuzz every reader for FUZZ_SECONDS each (30)
	$(CARGO) test --package depthplanes-io --test fuzz_seeds -- --ignored
	$(CARGO) test --package depthplanes-video --test recordings -- --ignored
	@for target in fuzz/fuzz_targets/*.rs; do \
		target=$$(basename "$$target" .rs); printf '\n== fuzzing %s for %s s\n' "$$target" $(FUZZ_SECONDS); \
		RUSTC_BOOTSTRAP=1 PATH="$(CURDIR)/target/tools/bin:$$PATH" $(CARGO) fuzz run "$$target" -- \
			-max_total_time=$(FUZZ_SECONDS) -rss_limit_mb=1024 -max_len=8192 -print_final_stats=1; done

fmt: ## Format the code
	@if scripts/component rustfmt; then $(CARGO) fmt --all; else exit 1; fi

clean: ## Remove everything that was made
	rm -rf target .venv .venv-peers .venv-python .venv-maturin out dist fuzz/target tests/browser/node_modules bindings/web/node_modules crates/depthplanes-serve/page/node_modules
	find . -name __pycache__ -o -name .pytest_cache | xargs rm -rf

# Anew when the packages change, or when an earlier attempt did not finish.
$(VENV): tests/oracles/requirements.txt tests/oracles/requirements-alone.txt
	$(call say,Python packages into .venv)
	@scripts/venv .venv '$(PYTHON)' $^
	@touch $@

$(PEERS): benchmarks/peers-requirements.txt
	$(call say,Open3D and other peers into .venv-peers)
	@scripts/peers '$(PYTHON)' $<
	@touch $@

$(CARGO_FUZZ):
	@command -v c++ >/dev/null || { echo 'error: fuzzing needs a C++ compiler (Debian: apt-get install g++)' >&2; exit 1; }
	CARGO_TARGET_DIR=target/tools/build $(CARGO) install cargo-fuzz --locked --root target/tools
