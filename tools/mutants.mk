# mutants.mk -- `make mutants MUTANTS=src/noise/numbers.h TESTS="test_switching test_cloud"`: which of
# a file's chosen numbers no test pins. Without TESTS those of its folder; an hour and more a folder.

MUTANTS ?= $(wildcard src/*/numbers.h src/*/*/numbers.h src/engine/accuracy.c drivers/*/numbers.h)

.PHONY: mutants

mutants: all
	@for file in $(MUTANTS); do echo "== $$file"; tools/mutants.sh $$file $(TESTS) || exit 1; done
