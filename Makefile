# SPDX-License-Identifier: MIT
# What a person types. CMake does the work: presets in CMakePresets.json, build/PRESET is the output.

PREFIX ?= /usr/local
DESTDIR ?=
# OFF keeps a warning a warning, which a newer compiler than ours needs; CI says ON.
WERROR ?= OFF
# no: leave packages alone, for machines where scripts/setup.sh has nothing to say.
SETUP ?= yes

configure = cmake --preset $(1) -DALP_WARNINGS_AS_ERRORS=$(WERROR) --log-level=WARNING
build = $(call configure,$(1)) && cmake --build build/$(1)
setup = $(if $(filter no,$(SETUP)),@:,@scripts/setup.sh $(1))

# How long each reader is fed, and which (all, unless named: "gltf obj").
FUZZ_SECONDS ?= 600
FUZZ_TARGETS ?=

# Pictures of docs/gallery.md to make; empty: all that are quick.
GALLERY ?=

.PHONY: all demo gallery blender-addon deb test test-fast test-integrations fuzz format lint \
        lint-all install clean help

all: ## Build the library and the command, ready for use (the default)
	$(call setup,build)
	@$(call build,release)
	@echo "The command is build/release/apps/alpenglow/alpenglow; 'make help' lists all targets."

demo: ## Set up, build, bake occlusion and light of a teapot in a room, render it
	$(call setup,build)
	@$(call build,release)
	@scripts/demo.sh build/release/apps/alpenglow/alpenglow demo

gallery: ## Set up, build, make the pictures of docs/gallery.md (GALLERY="atrium windows")
	$(call setup,build)
	@$(call build,release)
	@scripts/make_gallery.py build/release/apps/alpenglow/alpenglow docs/pictures $(GALLERY)

blender-addon: ## Pack the Blender add-on into build/alpenglow-blender.zip
	@mkdir -p build
	@integrations/blender/make_zip.py build/alpenglow-blender.zip
	@echo "Install build/alpenglow-blender.zip in Blender: Edit > Preferences > Add-ons > Install"

test: ## Set up, build and run every test; ends in a line that counts them
	$(call setup,check)
	@$(call build,dev)
	@scripts/test.py dev

test-fast: ## Run all but slow tests and integrations, which takes a minute or so
	$(call setup,check)
	@$(call build,dev)
	@scripts/test.py dev fast

test-integrations: ## Run what needs Blender, a browser, numpy, Slurm or packages; see scripts/setup.sh
	$(call setup,check)
	@$(call build,dev)
	@scripts/test.py dev integrations

fuzz: ## Feed every reader made-up input under sanitizers, FUZZ_SECONDS (600) each of FUZZ_TARGETS
	$(call setup,check)
	@scripts/fuzz.sh --seconds $(FUZZ_SECONDS) $(FUZZ_TARGETS)

format: ## Format the sources
	@scripts/lint.sh format

lint: ## Check formatting, the law of the rooms, cppcheck; clang-tidy reads what changed
	$(call setup,check)
	@$(call configure,dev)
	@scripts/lint.sh

lint-all: ## The same, with clang-tidy on every file
	$(call setup,check)
	@$(call configure,dev)
	@scripts/lint.sh all

install: ## Build and install to PREFIX (default /usr/local; DESTDIR is honoured)
	$(call setup,build)
	@$(call build,release)
	@DESTDIR="$(DESTDIR)" cmake --install build/release --prefix "$(PREFIX)"

deb: ## Set up, build Debian packages into build/deb
	$(call setup,deb)
	@scripts/make_deb.sh

clean: ## Remove everything that was built
	@rm -rf build demo

help: ## This list
	@sed -n 's/^\([a-z-]*\):.*## /    make \1: /p' $(MAKEFILE_LIST) | awk -F': ' \
	    '{printf "%-27s %s\n", $$1, $$2}'
