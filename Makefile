# Front door. CMake does the work; each task has a build folder of its own under build/.
.DEFAULT_GOAL := build
.PHONY: build demo test check-all exhaustive bench tradeoffs mutation fuzz dist clean help

JOBS ?= 2
DEMO_ARGS ?=
FUZZ_SECONDS ?= 120
ASSETS ?= $(or $(HDRP_TEST_ASSETS),../shared/assets)

configure = cmake -S . -B build/$(1) -G Ninja $(2) >build/$(1).log 2>&1 || \
            { cat build/$(1).log; exit 1; }
compile = cmake --build build/$(1) --parallel $(JOBS)
ctest = cd build/$(1) && ctest -j $(JOBS) --output-on-failure --no-tests=error

build: ## build everything, run nothing
	@mkdir -p build
	@tools/install-deps --check test || true
	@$(call configure,test,-DCMAKE_BUILD_TYPE=Release)
	@$(call compile,test)

demo: ## render the built-in scene into a picture; installs what is missing
	@mkdir -p build
	@tools/install-deps demo
	@$(call configure,demo,-DCMAKE_BUILD_TYPE=Release -DHDRP_BUILD_TESTS=OFF)
	@$(call compile,demo) --target hdrp_render
	@build/demo/examples/render/hdrp_render $(DEMO_ARGS)

test: ## run the whole test suite; installs what is missing
	@mkdir -p build
	@tools/install-deps test
	@$(call configure,test,-DCMAKE_BUILD_TYPE=Release)
	@$(call compile,test)
	@$(call ctest,test)

# The other builds leave out the tests that call compilers themselves: they would only repeat.
check-all: test ## the test suite, then sanitizers, clang, every standard and GPU everywhere
	@$(call configure,sanitize,-DCMAKE_BUILD_TYPE=RelWithDebInfo -DHDRP_SANITIZE=ON \
	    -DHDRP_TEST_COMPILERS=OFF)
	@$(call compile,sanitize)
	@$(call ctest,sanitize)
	@$(call configure,clang,-DCMAKE_BUILD_TYPE=Release -DHDRP_TEST_COMPILERS=OFF \
	    -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++)
	@$(call compile,clang)
	@$(call ctest,clang)
	@$(call configure,full,-DHDRP_FULL_MATRIX=ON -DHDRP_BUILD_EXAMPLES=OFF)
	@$(call ctest,full) -L "compile|gcn"

exhaustive: ## every float and every code through every codec and function of one float; half an hour
	@mkdir -p build
	@tools/install-deps test
	@$(call configure,test,-DCMAKE_BUILD_TYPE=Release)
	@$(call compile,test) --target exhaustive_run

mutation: ## make constants and operators wrong, one by one, and count what the tests notice
	@mkdir -p build
	@tools/install-deps test
	@$(call configure,test,-DCMAKE_BUILD_TYPE=Release)
	@$(call compile,test) --target mutation

# What it finds lies in build/fuzz; FUZZ_CULL_PRINT=1 prints what an input stands for.
fuzz: ## cull what random bytes describe, under sanitizers, for FUZZ_SECONDS
	@mkdir -p build/fuzz/corpus
	@tools/install-deps test
	@$(call configure,test,-DCMAKE_BUILD_TYPE=Release)
	@$(call compile,test) --target fuzz_build
	@build/test/tests/fuzz/fuzz_cull -max_total_time=$(FUZZ_SECONDS) -max_len=1024 -len_control=0 \
	    -timeout=10 -artifact_prefix=build/fuzz/ -print_final_stats=1 build/fuzz/corpus

bench: ## time the formulas beside other libraries, and light culling; results go to bench/results
	@mkdir -p build
	@tools/install-deps bench
	@$(call configure,bench,-DCMAKE_BUILD_TYPE=Release -DHDRP_BUILD_BENCH=ON -DHDRP_BUILD_TESTS=OFF)
	@$(call compile,bench) --target bench

# Pictures need scenes; without them the recorded costs of features stay.
tradeoffs: bench ## measure error and cost of every variant again, and write docs/tradeoffs.md
	@tools/install-deps tradeoffs
	@$(call configure,test,-DCMAKE_BUILD_TYPE=Release)
	@$(call compile,test) --target accuracy_record stability_record published_table
	@$(call compile,test) --target half_record # by itself: it renews the same page
	@python3 tools/gcn_probe.py --write
	@python3 tools/gcn_passes.py --write
	@$(call compile,bench) --target hdrp_render
	@! test -d "$(ASSETS)/gltf" || python3 bench/feature_cost.py \
	    build/bench/examples/render/hdrp_render "$(ASSETS)" bench/results
	@python3 tools/tradeoffs.py
	@/usr/bin/python3 tools/tradeoffs_charts.py

dist: ## write one-file headers to dist/
	@tools/install-deps dist
	@python3 tools/amalgamate.py dist

clean: ## remove what the targets above have made, pictures excepted
	rm -rf build dist

help: ## list the targets
	@sed -n 's/^\([a-z-]*\):[^#]*## /\1 - /p' Makefile
