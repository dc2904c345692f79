# fuzz.mk -- `make fuzz`: the readers beside clang's libFuzzer, each with a harness in tests/fuzz.

FUZZ_NAMES := $(patsubst tests/fuzz/fuzz_%.c,%,$(wildcard tests/fuzz/fuzz_*.c))
FUZZ_SECONDS ?= 60

.PHONY: fuzz

# Of the library and the program what reads, and no more: the rest would take minutes to compile.
FUZZED_OBJECTS := $(filter $(addprefix $(OBJ)/,src/base/% src/model/% src/store/% src/analysis/sweeps/sweep.o \
  drivers/deck/% drivers/farm/index.o drivers/farm/journal% drivers/farm/record.o drivers/terminal/safe_text.o drivers/system/% \
  drivers/options.o drivers/shard.o drivers/verify.o), \
  $(LIBRARY_OBJECTS) $(DRIVER_OBJECTS))

.SECONDARY: $(FUZZ_NAMES:%=$(OBJ)/tests/fuzz/fuzz_%.o)
# What collects records, and the data of fits, need all of it.
$(BUILD)/fuzz_collect $(BUILD)/fuzz_data: $(LIBRARY_OBJECTS) $(DRIVER_OBJECTS)
$(BUILD)/fuzz_%: $(OBJ)/tests/fuzz/fuzz_%.o $(FUZZED_OBJECTS)
	@echo "  LD  $@"
	@$(LINK) -fsanitize=fuzzer -o $@ $^ $(DRIVER_LIBS)

# HDF5 may crash in the process that reads for --verify, and the fuzzer is not to take it for ours;
# nor does it see what a file is good for, and keeps all that are there.
FUZZ_data = $(FUZZ_verify)
FUZZ_verify := -handle_segv=0 -handle_bus=0 -handle_abrt=0 -handle_ill=0 -handle_fpe=0 \
               -keep_seed=1 -reduce_inputs=0

.PHONY: $(FUZZ_NAMES:%=fuzz/%)
$(FUZZ_NAMES:%=fuzz/%): fuzz/%: $(BUILD)/fuzz_%
	@mkdir -p $(BUILD)/corpus/$*
	ASAN_OPTIONS=allocator_may_return_null=1 $< -max_total_time=$(FUZZ_SECONDS) -timeout=100 \
	  -print_final_stats=1 -artifact_prefix=$(BUILD)/$*- $(FUZZ_$*) $(BUILD)/corpus/$* \
	  tests/fuzz/corpus/$*

# What is found of new ways through the code is kept in build/fuzz/corpus, and gone on from.
CLANG ?= $(shell for c in clang clang-19 clang-17 clang-16 clang-15 clang-14; do \
           command -v $$c && break; done)
fuzz:
	@test -n '$(CLANG)' && $(CLANG) --version >/dev/null 2>&1 || { \
	  echo 'make fuzz needs clang with libFuzzer (Debian: make deps-fuzz)' >&2; exit 1; }
	+@$(MAKE) --no-print-directory -k CC=$(CLANG) BUILD=build/fuzz \
	  SANITIZE=address,undefined,fuzzer-no-link $(FUZZ_NAMES:%=fuzz/%)

-include $(FUZZ_NAMES:%=$(OBJ)/tests/fuzz/fuzz_%.d)
