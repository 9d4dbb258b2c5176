# SPDX-License-Identifier: Apache-2.0
# Thin front of CMake: installs what is missing, configures, builds, runs.
#   make demo    bake the steak and feel its force
#   make test    build everything and run all tests
#   make paper   the paper's tables, ours beside them, into build/paper; resumable, 10 to 20 minutes on 2 cores
#   make build   stop after building; the programs are in build/release/bin
.PHONY: build test demo paper paper-docs clean packages test-packages

BUILD := build/release
JOBS  := $(shell nproc)

build: packages
	@cmake --preset release -DKNEAD_BUILD_TESTS=OFF
	@cmake --build --preset release --parallel $(JOBS)

test: test-packages
	@cmake --preset release -DKNEAD_BUILD_TESTS=ON
	@cmake --build --preset release --parallel $(JOBS)
	@ctest --preset release --parallel $(JOBS)

demo: build
	@examples/steak/demo.sh $(BUILD)

# Everything anew: rm -rf build/paper first.
paper: build
	@mkdir -p build/paper
	@$(BUILD)/bin/knead-evaluate examples/cubes/scenario*.toml examples/steak/steak.toml \
	    --seeds 10 --steps 1000 --paper build/paper --cache build/paper/cache

# The tables of the last `make paper` into docs/paper.md, between its two marks, and docs/paper.csv.
paper-docs:
	@awk '/^<!-- end of the tables/ { skip = 0 } !skip { print } \
	      /^<!-- the tables/ { skip = 1; while ((getline line < "build/paper/paper.md") > 0) print line }' \
	    docs/paper.md > build/paper/docs.md
	@cp build/paper/docs.md docs/paper.md
	@cp build/paper/table2.csv docs/paper.csv

clean:
	rm -rf build

packages:
ifndef KNEAD_SKIP_PACKAGES
	@.ci/install-packages
endif

test-packages:
ifndef KNEAD_SKIP_PACKAGES
	@.ci/install-packages --test
endif

# Checks beside `make test` (docs/testing.md):
#   make asan        all tests under AddressSanitizer and UndefinedBehaviorSanitizer
#   make asan-quick  those of everything that reads files or moves a hand
#   make tsan        those of everything that has threads of ours, under ThreadSanitizer
#   make fuzz        every fuzz target for FUZZ_SECONDS; repeats itself with a FUZZ_SEED other than 0
#   make crash       100 times kill -9
#   make coverage    line coverage of formats and runtime
.PHONY: asan asan-quick tsan fuzz crash coverage check-packages
FUZZ_SECONDS := 30
FUZZ_SEED := 0
# fuzz_cache needs all of knead-evaluate: not in the quick version.
QUICK := formats_unit_test formats_property_test formats_mutation_test out_of_memory_test common_test scene_test \
         unit_material knead_test test_mesh test_runtime_core test_runtime_api test_runtime_contact \
         test_runtime_surface test_haptics test_loop_threads test_reduced_object test_session test_safety \
         bare_core write_cube c_abi_test c_haptics_test fuzz_write_seeds \
         $(addprefix fuzz_,asset build_state csv devices medit outline payload ply scene session sniff stage stl veg vtk)
THREADED := test_haptics test_loop_threads test_reduced_object test_session write_cube c_haptics_test
# Tests of programs that were not built call themselves so, those of Google Test; the others by name.
NOT_BUILT := _NOT_BUILT|target_cache|VTKHDF|vtkMeshQuality

asan: test-packages
	@cmake --preset asan
	@cmake --build --preset asan --parallel $(JOBS)
	@ctest --preset asan --parallel $(JOBS)

asan-quick: test-packages
	@cmake --preset asan
	@cmake --build --preset asan --parallel $(JOBS) --target $(QUICK)
	@ctest --preset asan --parallel $(JOBS) -L '^(unit|property|fuzz)$$' -E '$(NOT_BUILT)'

tsan: test-packages
	@cmake --preset tsan
	@cmake --build --preset tsan --parallel $(JOBS) --target $(THREADED)
	@ctest --preset tsan -L '^unit$$' -E '$(NOT_BUILT)|^Core\.|^CAbi\.from'

fuzz: check-packages
	@cmake --preset fuzz
	@cmake --build --preset fuzz --parallel $(JOBS)
	@tests/fuzz/run.sh -s $(FUZZ_SECONDS) -r $(FUZZ_SEED) -j $(JOBS) build/fuzz

crash: test-packages
	@cmake --preset release -DKNEAD_BUILD_TESTS=ON
	@cmake --build --preset release --parallel $(JOBS) --target crash_test
	@KNEAD_CRASH_KILLS=100 build/release/tests/crash_test

coverage: check-packages
	@tests/coverage/run.sh build/coverage

check-packages:
ifndef KNEAD_SKIP_PACKAGES
	@.ci/install-packages --check
endif
