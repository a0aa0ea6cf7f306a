# `make` lists the targets. Each is a few commands that can also be typed.
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
.PHONY: help demo lab docs build test test-all test-view test-peers test-methods test-packages test-blender test-mutants blender packages wheels fuzz bench bench-integrate bench-hard bench-typed bench-render lint format install dependencies clean

JOBS ?= $(shell cmake/jobs.sh)
BUILD := build/release
DEMO_TARGET ?= --target-error 16% --target-quantile 90%
FUZZ_SECONDS ?= 1800
LOADERS ?= $(sort $(patsubst test/fuzz/fuzz_%.cpp,%,$(wildcard test/fuzz/fuzz_*.cpp)))

help: ## this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-15s %s\n", $$1, $$2}' Makefile

demo: build ## build, then render a scene of our own to an error and denoise it (three minutes on two cores)
	@library=$$(cmake/denoiser.sh build/denoiser); \
	MONTELUX_OIDN_LIBRARY=$$library $(BUILD)/montelux render scenes/demo/studio.pbrt $(DEMO_TARGET) \
	    $${library:+--denoise} -o build/demo.exr -o build/demo.png
	$(BUILD)/montelux convert build/demo.exr build/demo_raw.png --layer mean

LAB_PYTHON := $(BUILD)/python-environment/bin/python
lab: dependencies ## every figure of Monte Carlo integration, drawn at build/lab/index.html (some minutes)
	cmake --preset release -D MONTELUX_PYTHON=AUTO
	@test -x $(LAB_PYTHON) || { echo "make lab needs the Python module, which CMake had to leave out: see its line above." >&2; exit 1; }
	cmake --build $(BUILD) --parallel $(JOBS) --target montelux_python
	$(LAB_PYTHON) -m pip install --quiet --disable-pip-version-check --only-binary :all: 'matplotlib>=3.8'
	PYTHONPATH=$(BUILD)/python $(LAB_PYTHON) -m montelux.lab --out build/lab

docs: dependencies ## these pages as a site, with references of program, Python and C++: build/site/index.html
	cmake/install-dependencies.sh docs
	cmake --preset release -D MONTELUX_PYTHON=AUTO
	cmake --build $(BUILD) --parallel $(JOBS) --target montelux $$(test ! -x $(LAB_PYTHON) || echo montelux_python_stub)
	docs/site/build.sh $(BUILD)/montelux $(BUILD)/python/montelux

build: dependencies ## the program, at build/release/montelux
	cmake --preset release
	cmake --build $(BUILD) --parallel $(JOBS) --target montelux

test: dependencies ## fast tests, those where memory can go wrong also under the address and undefined-behaviour sanitizers
	cmake --preset test
	cmake --build build/test --parallel $(JOBS)
	cmake/run-tests.sh fast $(JOBS) build/test

test-all: dependencies ## each file compiled alone; every test, the slow ones too; then the whole house under the sanitizers (hours)
	cmake --preset lint
	cmake/check_includes.py build/lint/compile_commands.json $(JOBS)
	cmake --preset test
	cmake --build build/test --parallel $(JOBS)
	cmake --preset asan
	cmake --build build/asan --parallel $(JOBS)
	cmake/run-tests.sh 'fast|slow' $(JOBS) build/test build/asan

PEERS := build/test-peers
PEER_SCENES ?= ../shared/scenes/mitsuba/docs/scenes
test-peers: build ## scenes of Mitsuba's documentation by both programs, pixel by pixel (half an hour; less with ONLY=shape_disk,sensor_thinlens)
	@mkdir -p $(PEERS)
	bench/render/mitsuba-environment.sh $(PEERS)/mitsuba
	python=$(PEERS)/mitsuba/bin/python; test -x $$python || python=python3; \
	$$python test/peers/mitsuba_peers.py $(BUILD)/montelux $(PEER_SCENES) --json $(PEERS)/result.json \
	    $(if $(ONLY),--only $(ONLY)) $(if $(VARIANT),--variant $(VARIANT)) | tee $(PEERS)/result.md

METHODS_OUT := build/test-methods
test-methods: build ## guided, bidirectional, ... pictures beside path tracing's on 34 scenes (an hour of CPU; less with ONLY=pool,fog)
	@mkdir -p $(METHODS_OUT) && rm -f $(METHODS_OUT)/result.json
	python=$(LAB_PYTHON); test -x $$python || python=python3; \
	$$python test/peers/methods_agreement.py $(BUILD)/montelux --json $(METHODS_OUT)/result.json \
	    $(if $(ONLY),--only $(ONLY)) | tee $(METHODS_OUT)/result.md

test-mutants: dependencies ## plant each fault of test/mutants, and say which test notices it (hours; less with ONLY=mc_warp,film)
	test/mutants/run_mutants.py --jobs $(JOBS) --json build/mutants/result.json $(if $(ONLY),--only $(ONLY))

test-view: dependencies ## the viewer's page in Chromium, alone and with the program (some minutes)
	cmake/install-dependencies.sh browser
	cmake --preset test
	cmake --build build/test --parallel $(JOBS) --target montelux
	test/view/page/environment.sh build/test/browser-environment
	ctest --test-dir build/test -R '^view/(page|program)$$' --output-on-failure

test-blender: dependencies ## the Blender add-on in bpy from PyPI (400 MB), and in Blender's window where it is installed (minutes)
	cmake --preset test
	cmake --build build/test --parallel $(JOBS) --target montelux
	test/blender/environment.sh build/test/blender-environment
	ctest --test-dir build/test -R '^blender/addon$$' --output-on-failure

FUZZ := build/fuzz
fuzz: dependencies ## libFuzzer on the loaders of files (half an hour each; less with FUZZ_SECONDS=60 LOADERS="ply exr")
	cmake/install-dependencies.sh fuzz
	cmake --preset fuzz
	cmake --build $(FUZZ) --parallel $(JOBS) --target $(addprefix fuzz_,$(LOADERS))
	test/fuzz/run_fuzzers.sh $(FUZZ) $(FUZZ_SECONDS) $(LOADERS)

bench: dependencies ## speed of the parts, then of whole pictures
	cmake --preset bench
	cmake --build build/bench --parallel $(JOBS)
	cmake/run-benchmarks.sh build/bench

INTEGRATE := build/bench-integrate
bench-integrate: dependencies ## integrators beside GSL, cubature, vegas (hours; less with SEEDS=5 LINES=gauss,osc-5 METHODS= TARGETS=)
	@cmake/install-dependencies.sh bench || echo "Going on without the rivals that are missing."
	bench/integrate/vegas-environment.sh $(INTEGRATE)/vegas
	cmake --preset mc -B $(INTEGRATE) -D MONTELUX_BENCH=ON -D MONTELUX_TESTS=OFF -D MONTELUX_LTO=ON
	cmake --build $(INTEGRATE) --parallel $(JOBS) --target montelux_bench_integrate
	$(INTEGRATE)/bench/integrate/montelux_bench_integrate --vegas-python $(INTEGRATE)/vegas/bin/python \
	    --json $(INTEGRATE)/result.json $(if $(SEEDS),--seeds $(SEEDS)) $(if $(LINES),--lines $(LINES)) \
	    $(if $(METHODS),--methods $(METHODS)) $(if $(TARGETS),--targets $(TARGETS)) | tee $(INTEGRATE)/result.md

HARD := build/bench-hard
bench-hard: dependencies ## integrators on hard integrals: silent failures (hours; less with SEEDS=5 FAMILIES=modes METHODS=auto TARGETS=1e-3; BANK=tuning)
	@cmake/install-dependencies.sh bench || echo "Going on without the rivals that are missing."
	bench/integrate/vegas-environment.sh $(HARD)/vegas
	cmake --preset mc -B $(HARD) -D MONTELUX_BENCH=ON -D MONTELUX_TESTS=OFF -D MONTELUX_LTO=ON
	cmake --build $(HARD) --parallel $(JOBS) --target montelux_bench_hard
	$(HARD)/bench/hard/montelux_bench_hard --vegas-python $(HARD)/vegas/bin/python --jobs $(JOBS) --verbose \
	    --json $(HARD)/result.json $(if $(SEEDS),--seeds $(SEEDS)) $(if $(FAMILIES),--families $(FAMILIES)) \
	    $(if $(METHODS),--methods $(METHODS)) $(if $(TARGETS),--targets $(TARGETS)) $(if $(BANK),--bank $(BANK)) | tee $(HARD)/result.md

bench-typed: build ## formulas as people type them, divergent ones too, through the program (an hour; less with METHODS=auto TARGETS=1e-3 TIME=2)
	bench/typed/typed_integrals.py $(BUILD)/montelux --jobs $(JOBS) --seeds $(or $(SEEDS),1) \
	    $(if $(METHODS),--methods $(METHODS)) $(if $(TARGETS),--targets $(TARGETS)) $(if $(TIME),--time $(TIME))

RENDERS := build/bench-render
bench-render: build ## pictures beside Mitsuba 3 (minutes a scene; SCENES="FOLDER ...", ENGINES=montelux,llvm_ad_rgb SPP=16 RUNS=3 WIDTH=200 THREADS=1)
	@cmake/install-dependencies.sh bench-render || echo "Going on without the LLVM that is missing."
	@mkdir -p $(RENDERS)
	bench/render/mitsuba-environment.sh $(RENDERS)/mitsuba
	python=$(RENDERS)/mitsuba/bin/python; test -x $$python || python=python3; \
	$$python bench/render/bench_render.py $(BUILD)/montelux $(or $(SCENES),scenes/demo) --json $(RENDERS)/result.json \
	    $(if $(ENGINES),--engines $(ENGINES)) $(if $(SPP),--spp $(SPP)) $(if $(RUNS),--runs $(RUNS)) \
	    $(if $(WIDTH),--width $(WIDTH)) $(if $(THREADS),--threads $(THREADS)) | tee $(RENDERS)/result.md

lint: ## formatting and static analysis (FILES="a.cpp b.cpp" for some, else all)
	cmake/install-dependencies.sh lint
	cmake/lint.sh $(JOBS) $(FILES)

format: ## rewrite the sources in the house format
	git ls-files '*.h' '*.cpp' | xargs clang-format -i

install: build ## headers, libraries and program (PREFIX=/usr/local)
	cmake --build $(BUILD) --parallel $(JOBS)
	cmake --install $(BUILD) --prefix $(or $(PREFIX),/usr/local)

blender: ## the add-on for Blender: build/montelux-blender.zip
	blender/build_zip.py build/montelux-blender.zip

PACKAGES := build/packages
packages: dependencies ## the Debian packages montelux, libmontelux-dev and python3-montelux, at build/packages (see docs/install.md)
	cmake/install-dependencies.sh packages
	cmake --preset packages
	cmake --build $(PACKAGES) --parallel $(JOBS)
	cmake --build $(PACKAGES) --parallel $(JOBS) --target montelux_python_stub
	rm -f $(PACKAGES)/*.deb
	cd $(PACKAGES) && cpack
	lintian --fail-on error,warning $(if $(DEBEMAIL),,--suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog) $(PACKAGES)/*.deb

wheels: dependencies ## wheels for Python with all libraries inside, at build/wheels
	packaging/wheels.sh

test-packages: packages wheels ## installs both on a bare Debian 12, and uses them (root, network)
	cmake/install-dependencies.sh packages
	packaging/chroot_test.sh build/wheels $(PACKAGES) build/chroot

dependencies: ## install the missing Debian packages (with sudo when not root)
	@cmake/install-dependencies.sh build

clean: ## forget everything that was built
	rm -rf build
