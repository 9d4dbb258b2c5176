# SPDX-License-Identifier: Apache-2.0
# Thin front of CMake: installs what is missing, configures, builds, runs.
#   make demo    bake the steak and feel its force
#   make test    build everything and run all tests
#   make build   stop after building; the programs are in build/release/bin
.PHONY: build test demo clean packages test-packages

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
