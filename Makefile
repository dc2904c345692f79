# Makefile of libpendres and the program `resonance`. GNU make 4.2 or later.
#
#   make            library (static and shared) and program
#   make check      build and run all tests; CHECKS="test_flow ..." runs some,
#                   SKIP="test_hard ..." leaves some out; VALGRIND=1 looks
#                   for errors of memory alone, for an hour or two
#   make accuracy   error estimates at random parameters against the reference, for an hour or so;
#                   ACCURACY="--seed=3 --orbits=2000 --section=orbits" for less
#   make fuzz       bytes that a fuzzer makes up (clang's libFuzzer), for the readers of decks, journals,
#                   data and files of results, FUZZ_SECONDS=60 each; what breaks them is left in build/fuzz
#   make mutants    which of the chosen numbers of MUTANTS=src/noise/numbers.h no test pins, outside of CI
#   make faults     memory that is refused to every kind of scene, at each place six times
#   make bench      build and run the benchmarks, one after another, and compare their ratios and
#                   counts with the last release's; make bench-baseline makes them the new ones
#   make install    into DESTDIR and PREFIX (default /usr/local); make uninstall takes it back
#   make wheel      a Python wheel that holds library and program, into build/dist; make sdist, the
#                   sources as pip takes them
#   make deps       install what is needed (Debian, Ubuntu); elsewhere say what is needed
#   make deps-python   what the Python package needs; make deps-plots, what plots need; make
#                   deps-fuzz, what make fuzz needs; make deps-explorer, the explorer and its test;
#                   make deps-doc, what make doc, docs and man need; make deps-wheel, for make wheel
#   make doc        reference manual from the public headers, with doxygen
#   make docs       the pages of docs/ as a site with a search, with MkDocs, into build/site
#   make man        man/resonance.1 anew, with help2man: for a release, and when options change
#   make decks-reference   docs/decks.md anew, from the table of keys
#   make results-reference  docs/results.md anew, from runs of each kind
#   make python-stubs      what type checkers know of the Python package, anew
#   make interface-list    tests/interface.txt anew, the functions, values and structs that are public
#   make figures    run every deck and draw every picture, into build/figures; some minutes
#   make gallery    the small pictures of docs/gallery.md anew, from those runs
#   make style      where lines or files are too long
#   make clean
#
# Yours to set: CC CFLAGS CPPFLAGS LDFLAGS PREFIX DESTDIR SUNDIALS_DIR HDF5_DIR GSL_DIR BUILD,
# MPI=1 (the program runs under mpirun; make deps-mpi), WERROR=1 (warnings are errors),
# SANITIZE=address,undefined (in a build directory of its own), SANITIZE_KERNELS=1 (with all
# instruction sets).
#
# Conventions:
# - All of src makes the library. kernels*.c are compiled once for each instruction set, with
#   PENDRES_KERNELS set to its name; the program chooses when it runs. Nothing else is compiled
#   for more than the baseline, so what was built here runs anywhere.
# - Everything is hidden unless a public header says otherwise: each header in include/pendres
#   has `#pragma GCC visibility push(default)` after its includes and `pop` at its end.
# - What is below drivers but main.c makes libdriver.a, and so do validation/*.c and
#   tests/oracle/*.c, what the program is measured against. They see the public headers alone.
# - tests/test_NAME.c are programs of their own, tests/NAME_check.sh scripts; both count.
#   They run at the top of the tree, with RESONANCE naming the program to try.
# - tools/*.mk are the goals that make documents, pictures, fuzzers and packages.

VERSION_H := include/pendres/version.h
version_part = $(shell sed -n 's/^.define PENDRES_VERSION_$(1) //p' $(VERSION_H))
MAJOR := $(call version_part,MAJOR)
MINOR := $(call version_part,MINOR)
VERSION := $(MAJOR).$(MINOR).$(call version_part,PATCH)
SOVERSION := $(MAJOR)

# ---- What a user may set ---------------------------------------------------------------------

comma := ,
ifeq ($(origin CC),default)
CC := gcc
endif
AR ?= ar
PKG_CONFIG ?= pkg-config
INSTALL ?= install
LDCONFIG ?= ldconfig
BUILD ?= build$(if $(SANITIZE),/sanitize-$(subst $(comma),-,$(SANITIZE)))$(if $(VALGRIND),/valgrind)
PREFIX ?= /usr/local
BINDIR ?= $(PREFIX)/bin
LIBDIR ?= $(PREFIX)/lib
INCLUDEDIR ?= $(PREFIX)/include
MANDIR ?= $(PREFIX)/share/man
DATADIR ?= $(PREFIX)/share/pendres
TEST_TIMEOUT ?= $(if $(VALGRIND),36000,600)
RUN ?= $(if $(VALGRIND),sh tests/valgrind.sh)
CFLAGS ?= $(if $(SANITIZE),-O2,-O3 $(HARDENED)) -g -Wall -Wextra -Wpedantic
LDFLAGS ?= -Wl,-z,relro -Wl,-z,now
# As Debian's own. The sanitizers look for the same, and more.
HARDENED := -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2

# ---- What the results rely on, whatever CFLAGS say -------------------------------------------

# No contraction: the same bytes on every instruction set; fused operations are written out.
NEEDED := -std=c11 -ffp-contract=off -fno-math-errno -fopenmp-simd -fvisibility=hidden -fPIC
SANITIZER := $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-sanitize-recover=all \
               -fno-omit-frame-pointer)
ALL_CFLAGS = $(CFLAGS) $(NEEDED) $(SANITIZER) $(if $(filter-out 0,$(WERROR)),-Werror)
THREADS := -pthread
# Theirs are tables of structs whose last fields are zero and go without saying.
TERSE := -Wno-missing-field-initializers

# Valgrind computes fused operations in software: for memory alone two roundings do.
UNFUSED := '-D__builtin_fma(a,b,c)=((a)*(b)+(c))'
NEEDED += $(if $(VALGRIND),$(UNFUSED))

FLAGS_avx2 := -mavx2 $(if $(VALGRIND),,-mfma)
FLAGS_avx512 := -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512

# ---- Goals that need no compiler and no libraries --------------------------------------------

GOALS := $(or $(MAKECMDGOALS),all)
BUILDING := $(filter-out deps deps-doc deps-wheel docs deps-explorer deps-fuzz deps-mpi fuzz deps-plots deps-python clean uninstall doc \
              style gallery sdist wheel help,$(GOALS))

ifneq ($(BUILDING),)
# For tests that compute much by themselves. Clang has the library for it in a package of its own;
# where that is missing they run on one thread.
OPENMP := $(shell echo 'int main(void) { return 0; }' | \
            $(CC) -fopenmp -x c - -o /dev/null 2>/dev/null && echo -fopenmp)
have = $(shell $(PKG_CONFIG) --exists $(1) 2>/dev/null && echo yes)
cflags_of = $(shell $(PKG_CONFIG) --cflags $(1))
libs_of = $(shell $(PKG_CONFIG) --libs $(1))
# A library in a folder of its own: DIR/lib and DIR/lib64, found again at run time.
folder_libs = $(foreach d,$(wildcard $(1)/lib $(1)/lib64),-L$(d) -Wl,-rpath,$(d))

# SUNDIALS has no pkg-config file; its configuration says what else it wants. From 7.0 on there is
# a core library beside the others, and a SUNDIALS with MPI, as in Debian 13, includes mpi.h.
SUNDIALS_CFLAGS := $(if $(SUNDIALS_DIR),-I$(SUNDIALS_DIR)/include)
SUNDIALS_FACTS := $(shell \
  printf '%s\n' '#include <sundials/sundials_config.h>' 'major=SUNDIALS_VERSION_MAJOR' \
    'mpi=SUNDIALS_MPI_ENABLED' | \
  $(CC) $(CPPFLAGS) $(SUNDIALS_CFLAGS) -E -P -x c - 2>/dev/null | sed -n '/^[a-z]*=[0-9]*$$/p')
SUNDIALS_MAJOR := $(patsubst major=%,%,$(filter major=%,$(SUNDIALS_FACTS)))
SUNDIALS_CORE := $(filter-out 6,$(SUNDIALS_MAJOR))
ifeq ($(SUNDIALS_MAJOR),)
$(warning SUNDIALS was not found: run `make deps`, or set SUNDIALS_DIR)
else ifneq ($(and $(SUNDIALS_CORE),$(filter mpi=1,$(SUNDIALS_FACTS))),)
MPI_PC := $(firstword $(foreach p,mpi-c ompi-c mpich mpi,$(if $(call have,$(p)),$(p))))
MPI_CFLAGS := $(if $(MPI_PC),$(call cflags_of,$(MPI_PC)),$(shell mpicc --showme:compile))
MPI_LIBS := $(if $(MPI_PC),$(call libs_of,$(MPI_PC)),$(shell mpicc --showme:link))
endif
# The program over MPI, `make MPI=1`: the library itself knows nothing of it.
ifneq ($(filter-out 0,$(MPI))$(filter %/resonance-mpi,$(GOALS)),)
RANKS_PC := $(firstword $(foreach p,mpi-c ompi-c mpich mpi,$(if $(call have,$(p)),$(p))))
RANKS_CFLAGS := $(if $(RANKS_PC),$(call cflags_of,$(RANKS_PC)),$(shell mpicc --showme:compile))
RANKS_LIBS := $(if $(RANKS_PC),$(call libs_of,$(RANKS_PC)),$(shell mpicc --showme:link))
ifeq ($(RANKS_LIBS),)
$(error MPI=1, and no MPI was found: run `make deps-mpi`)
endif
endif
SUNDIALS_LIBS := $(if $(SUNDIALS_DIR),$(call folder_libs,$(SUNDIALS_DIR))) \
                 -lsundials_arkode -lsundials_cvode -lsundials_nvecserial \
                 $(if $(SUNDIALS_CORE),-lsundials_core)

ifneq ($(GSL_DIR),)
GSL_CFLAGS := -I$(GSL_DIR)/include
GSL_LIBS := $(call folder_libs,$(GSL_DIR)) -lgsl -lgslcblas
else ifeq ($(call have,gsl),yes)
GSL_PC := gsl
GSL_CFLAGS := $(call cflags_of,gsl)
GSL_LIBS := $(call libs_of,gsl)
else
GSL_LIBS := -lgsl -lgslcblas
endif

# With the dimension scales of hdf5_hl. hdf5-serial first: on Debian hdf5.pc may be the MPI flavour.
ifneq ($(HDF5_DIR),)
HDF5_CFLAGS := -I$(HDF5_DIR)/include
HDF5_LIBS := $(call folder_libs,$(HDF5_DIR)) -lhdf5_hl -lhdf5
else
HDF5_PC := $(firstword $(foreach p,hdf5-serial hdf5,$(if $(call have,$(p)),$(p))))
HDF5_CFLAGS := $(if $(HDF5_PC),$(call cflags_of,$(HDF5_PC)))
HDF5_LIBS := -lhdf5_hl $(if $(HDF5_PC),$(call libs_of,$(HDF5_PC)),-lhdf5)
endif

X86_64 := $(filter x86_64-%,$(shell $(CC) -dumpmachine))
endif

SETS := base $(if $(X86_64),avx2 avx512)
LIBS = $(SUNDIALS_LIBS) $(MPI_LIBS) $(GSL_LIBS) $(HDF5_LIBS) $(THREADS) -lm
# The program alone keeps journals, with checksums of zlib, which HDF5 asks for anyway.
DRIVER_LIBS = $(LIBS) $(if $(filter-out 0,$(MPI)),$(RANKS_LIBS)) -lz
ALL_CPPFLAGS = $(CPPFLAGS) -Iinclude $(SUNDIALS_CFLAGS) $(MPI_CFLAGS) $(GSL_CFLAGS) $(HDF5_CFLAGS)
LINK = $(CC) $(CFLAGS) $(SANITIZER) $(LDFLAGS)

# ---- Sources and products --------------------------------------------------------------------

KERNEL_SOURCES := $(wildcard src/*/kernels*.c src/*/*/kernels*.c)
LIBRARY_SOURCES := $(filter-out $(KERNEL_SOURCES),$(wildcard src/*/*.c src/*/*/*.c))
# One of these is the program's: drivers/farm/ranks.h.
RANKS := $(if $(filter-out 0,$(MPI)),mpi,serial)
OTHER_RANKS := $(filter-out %_$(RANKS).c,$(wildcard drivers/farm/ranks_*.c))
DRIVER_SOURCES := $(filter-out drivers/main.c $(OTHER_RANKS),$(wildcard drivers/*.c drivers/*/*.c drivers/*/*/*.c)) \
                  $(wildcard validation/*.c tests/oracle/*.c)
HEADERS := $(wildcard include/pendres/*.h)
OBJ := $(BUILD)/obj
LIBRARY_OBJECTS := $(LIBRARY_SOURCES:%.c=$(OBJ)/%.o) \
                   $(foreach s,$(SETS),$(KERNEL_SOURCES:%.c=$(OBJ)/%.$(s).o))
DRIVER_OBJECTS := $(DRIVER_SOURCES:%.c=$(OBJ)/%.o)

STATIC := $(BUILD)/libpendres.a
SONAME := libpendres.so.$(SOVERSION)
SHARED := $(BUILD)/libpendres.so.$(VERSION)
DRIVER := $(BUILD)/libdriver.a
# Other build directories leave the program at the top alone.
PROGRAM := $(if $(wildcard drivers/main.c),$(patsubst build/resonance,resonance,$(BUILD)/resonance))
PROGRAM_PATH := $(if $(PROGRAM),$(if $(filter /%,$(PROGRAM)),$(PROGRAM),$(CURDIR)/$(PROGRAM)))

TEST_NAMES := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c))
TEST_PROGRAMS := $(TEST_NAMES:%=$(BUILD)/tests/%)
# Scripts look at what would be installed: nothing for sanitizers and valgrind.
SCRIPT_NAMES := $(if $(SANITIZE)$(VALGRIND),,$(patsubst tests/%.sh,%,$(wildcard tests/*_check.sh)))
# Scripts first: some take long, and short tests fill what is left of the time at the end.
CHECKS ?= $(filter-out $(SKIP),$(SCRIPT_NAMES) $(TEST_NAMES))
ACCURACY_OBJECTS := $(patsubst %.c,$(OBJ)/%.o,$(wildcard tests/accuracy/*.c))
ACCURACY_PROGRAM := $(BUILD)/tests/accuracy/accuracy
BENCH_PROGRAMS := $(patsubst %.c,$(BUILD)/%,$(wildcard bench/bench_*.c))

.PHONY: all accuracy check check-run faults bench bench-baseline install uninstall style clean help
.SUFFIXES:
.DELETE_ON_ERROR:

all: $(STATIC) $(SHARED) $(BUILD)/libpendres.so $(BUILD)/$(SONAME) $(PROGRAM)

help:
	@sed -n '2,/^$$/s/^# \{0,1\}//p' Makefile

# Objects are made anew when a compiler or a flag has changed.
ifneq ($(BUILDING),)
FLAGS_TEXT := $(strip $(LINK) $(SONAME) $(ALL_CPPFLAGS) $(ALL_CFLAGS) $(DRIVER_LIBS) $(FLAGS_avx2) $(FLAGS_avx512) \
  $(SANITIZE_KERNELS))
ifneq ($(FLAGS_TEXT),$(strip $(file <$(BUILD)/flags)))
$(shell mkdir -p $(BUILD))
$(file >$(BUILD)/flags,$(FLAGS_TEXT))
endif
endif
$(BUILD)/flags: ;

# What the program was made of, whatever the compiler and the folder: a journal of other sources is
# refused.
ifneq ($(BUILDING),)
SOURCES_SUM := $(shell cat $(sort $(HEADERS) $(wildcard src/*/*.[ch] src/*/*/*.[ch] \
                 drivers/*.[ch] drivers/*/*.[ch] drivers/*/*/*.[ch] validation/*.[ch] \
                 tests/oracle/*.[ch])) | cksum)
ifneq ($(SOURCES_SUM),$(strip $(file <$(BUILD)/sources)))
$(file >$(BUILD)/sources,$(SOURCES_SUM))
endif
endif
$(BUILD)/sources: ;
$(OBJ)/drivers/resume.o: $(BUILD)/sources

# Headings and tables of the docs, for --explain, but of pages on the program itself.
PAGES := $(filter-out $(patsubst %,docs/%.md,decks accuracy architecture auto install \
           interface platforms replication scaling),$(wildcard docs/*.md))
$(BUILD)/pages.inc: $(PAGES) drivers/pages.awk
	@mkdir -p $(@D); LC_ALL=C awk -f drivers/pages.awk $(PAGES) </dev/null >$@.new && mv $@.new $@
$(OBJ)/drivers/pages.o: $(BUILD)/pages.inc
$(OBJ)/drivers/pages.o: ALL_CPPFLAGS += -I$(BUILD)
$(OBJ)/drivers/resume.o: ALL_CPPFLAGS += '-DSOURCES_SUM="$(SOURCES_SUM)"'

COMPILE = @mkdir -p $(@D); echo "  CC  $(@:$(OBJ)/%=%)"; \
          $(CC) $(ALL_CPPFLAGS) $(1) $(ALL_CFLAGS) $(2) -MMD -MP -c -o $@ $<

$(OBJ)/src/%.o: src/%.c $(BUILD)/flags
	$(call COMPILE,-Isrc)

$(OBJ)/drivers/%.o: drivers/%.c $(BUILD)/flags
	$(call COMPILE,-Idrivers $(THREADS) $(RANKS_CFLAGS))

$(OBJ)/validation/%.o: validation/%.c $(BUILD)/flags
	$(call COMPILE,-Idrivers -Itests -I. $(THREADS))

$(OBJ)/tests/%.o: tests/%.c $(BUILD)/flags
	$(call COMPILE,-Isrc -Idrivers -Itests -I. $(OPENMP),$(TERSE))

$(OBJ)/bench/%.o: bench/%.c $(BUILD)/flags
	$(call COMPILE,-Isrc -Idrivers -Itests -Ibench $(OPENMP),$(TERSE))

# Sanitizers watch the kernels of the plainest instruction set, which is the same source and which
# the tests of kernels run beside the others. The others stay as they are released: watched, they
# are ten times as slow and take a minute each to compile. SANITIZE_KERNELS=1 watches all.
WATCHED := $(if $(filter-out 0,$(SANITIZE_KERNELS)),$(SETS),base)
define KERNEL_RULE
$(OBJ)/src/%.$(1).o: src/%.c $(BUILD)/flags
	$$(call COMPILE,-Isrc -DPENDRES_KERNELS=$(1) $(FLAGS_$(1)),$(if $(SANITIZE),$(if \
	  $(filter $(1),$(WATCHED)),-O1,-O3 -fno-sanitize=all)))
endef
$(foreach s,$(SETS),$(eval $(call KERNEL_RULE,$(s))))

# The list of members is a prerequisite too: a file taken away leaves the archive.
# Members may have one name, from different folders: they are appended, not replaced.
ARCHIVE = @rm -f $@; echo "  AR  $@"; $(AR) qcs $@ $(filter %.o,$^)

$(STATIC): $(LIBRARY_OBJECTS)
	$(ARCHIVE)

$(DRIVER): $(DRIVER_OBJECTS) $(BUILD)/flags
	$(ARCHIVE)

$(SHARED): $(LIBRARY_OBJECTS) pendres.map
	@echo "  LD  $@"
	@$(LINK) -shared -Wl,-soname,$(SONAME) -Wl,--version-script,pendres.map $(if $(SANITIZE),,-Wl$(comma)-z$(comma)defs) \
	  -o $@ $(filter %.o,$^) $(LIBS)

$(BUILD)/$(SONAME) $(BUILD)/libpendres.so: $(SHARED)
	@ln -sf $(notdir $(SHARED)) $@

ifneq ($(PROGRAM),)
$(PROGRAM): $(OBJ)/drivers/main.o $(DRIVER) $(STATIC)
	@echo "  LD  $@"
	@$(LINK) $(THREADS) -o $@ $^ $(DRIVER_LIBS)
endif

# For a test, beside the program without MPI: the archive's own ranks are passed over.
$(BUILD)/resonance-mpi: $(OBJ)/drivers/main.o drivers/farm/ranks_mpi.c $(DRIVER) $(STATIC)
	@echo "  LD  $@"
	@$(LINK) $(ALL_CPPFLAGS) -Idrivers $(RANKS_CFLAGS) $(NEEDED) $(THREADS) -o $@ $^ $(DRIVER_LIBS) \
	  $(RANKS_LIBS)

# ---- Tests and benchmarks --------------------------------------------------------------------

.SECONDARY: $(TEST_NAMES:%=$(OBJ)/tests/%.o) $(BENCH_PROGRAMS:$(BUILD)/%=$(OBJ)/%.o)

$(BUILD)/tests/%: $(OBJ)/tests/%.o $(DRIVER) $(STATIC)
	@mkdir -p $(@D); echo "  LD  $@"
	@$(LINK) $(OPENMP) -o $@ $^ $(DRIVER_LIBS) -lcmocka

$(BUILD)/bench/%: $(OBJ)/bench/%.o $(DRIVER) $(STATIC)
	@mkdir -p $(@D); echo "  LD  $@"
	@$(LINK) $(OPENMP) -o $@ $^ $(DRIVER_LIBS)

$(ACCURACY_PROGRAM): $(ACCURACY_OBJECTS) $(DRIVER) $(STATIC)
	@mkdir -p $(@D); echo "  LD  $@"
	@$(LINK) $(OPENMP) -o $@ $^ $(DRIVER_LIBS)

accuracy: $(ACCURACY_PROGRAM) $(PROGRAM)
	@$(RUN_ENVIRONMENT) $< $(ACCURACY)

# What does not compile counts as failed, and the others still run. All is built before: make begins
# what is ready, and scripts, which need all of it, would come last.
check:
	@rm -rf $(BUILD)/results; mkdir -p $(BUILD)/results
	+@$(MAKE) --no-print-directory -k all || true
	+@$(MAKE) --no-print-directory -k check-run || true
	@tests/summary.sh $(BUILD)/results $(CHECKS)

check-run: all $(CHECKS:%=run/%)

# For scripts: what they need to know of this build.
RUN_ENVIRONMENT = BUILD='$(BUILD)' CC='$(CC)' PKG_CONFIG='$(PKG_CONFIG)' \
                  RESONANCE='$(PROGRAM_PATH)' \
                  UBSAN_OPTIONS="$${UBSAN_OPTIONS-print_stacktrace=1}"

.PHONY: $(TEST_NAMES:%=run/%) $(SCRIPT_NAMES:%=run/%)
$(TEST_NAMES:%=run/%): run/%: $(BUILD)/tests/% $(PROGRAM)
	@$(RUN_ENVIRONMENT) tests/run.sh $(BUILD)/results/$* $(TEST_TIMEOUT) $(RUN) $<

run/accuracy_check: $(ACCURACY_PROGRAM)
run/bench_check: $(BENCH_PROGRAMS)
$(SCRIPT_NAMES:%=run/%): run/%: tests/%.sh all
	+@$(RUN_ENVIRONMENT) MAKE='$(MAKE)' tests/run.sh $(BUILD)/results/$* $(TEST_TIMEOUT) sh $<

# Memory that is refused, six times at each place that asks for it; make check does so once.
faults: all
	@$(RUN_ENVIRONMENT) FAULTS=6 tests/faults_memory_check.sh

FIGURES := $(BUILD)/bench/figures.txt

bench bench-baseline: all $(BENCH_PROGRAMS)
	@rm -f $(FIGURES)
	@for b in $(BENCH_PROGRAMS); do echo "== $$b"; \
	  $(RUN_ENVIRONMENT) BENCH_FIGURES=$(FIGURES) $$b || exit 1; done
	@echo "== beside the figures in bench/baseline.txt"
	@bench/compare.sh bench/baseline.txt $(FIGURES)
	@test $@ = bench || { { echo '# Figures of `make bench`: libpendres $(VERSION),' \
	    'SUNDIALS $(SUNDIALS_MAJOR), $(notdir $(CC)). Renewed by `make bench-baseline`.'; \
	  bench/compare.sh --renew bench/baseline.txt $(FIGURES); } >$(FIGURES).new && \
	  mv $(FIGURES).new bench/baseline.txt; }

# ---- Installation ----------------------------------------------------------------------------

# What pkg-config and CMake read: what a program needs that links libpendres.a, which the shared
# library knows by itself. An installation writes them, like the manual page, where they
# belong and nowhere else: two that run at once, each with its own PREFIX, keep apart.
OTHERS = $(SUNDIALS_LIBS) $(if $(MPI_PC),,$(MPI_LIBS)) $(if $(GSL_PC),,$(GSL_LIBS)) \
         $(if $(HDF5_PC),-lhdf5_hl,$(HDF5_LIBS)) $(THREADS) -lm
FILL = sed -e 's|@PREFIX@|$(PREFIX)|' -e 's|@VERSION@|$(VERSION)|' -e 's|@SONAME@|$(SONAME)|'
FILL_PC = $(FILL) -e 's|@LIBDIR@|$(subst $(PREFIX)/,$${prefix}/,$(LIBDIR))|' \
  -e 's|@INCLUDEDIR@|$(subst $(PREFIX)/,$${prefix}/,$(INCLUDEDIR))|' \
  -e 's|@REQUIRES@|$(strip $(MPI_PC) $(GSL_PC) $(HDF5_PC))|' -e 's|@LIBS@|$(strip $(OTHERS))|'
FILL_CMAKE = $(FILL) -e 's|@LIBDIR@|$(LIBDIR)|' -e 's|@INCLUDEDIR@|$(INCLUDEDIR)|' \
  -e 's|@LIBS@|$(strip $(LIBS))|'

# What share/pendres holds, beside what a compiler reads.
SHARED_FILES = $(shell find examples input plots docs python -type f ! -name '*.h5' ! -name '*.pyc' \
                 ! -path '*.egg-info/*' ! -path 'python/build/*')

install: all
	$(INSTALL) -d "$(DESTDIR)$(LIBDIR)/pkgconfig" "$(DESTDIR)$(INCLUDEDIR)/pendres"
	$(INSTALL) -m 644 $(STATIC) "$(DESTDIR)$(LIBDIR)"
	$(INSTALL) -m 755 $(SHARED) "$(DESTDIR)$(LIBDIR)"
	ln -sf $(notdir $(SHARED)) "$(DESTDIR)$(LIBDIR)/$(SONAME)"
	ln -sf $(notdir $(SHARED)) "$(DESTDIR)$(LIBDIR)/libpendres.so"
	$(INSTALL) -m 644 $(HEADERS) "$(DESTDIR)$(INCLUDEDIR)/pendres"
	$(FILL_PC) pendres.pc.in >"$(DESTDIR)$(LIBDIR)/pkgconfig/pendres.pc"
	chmod 644 "$(DESTDIR)$(LIBDIR)/pkgconfig/pendres.pc"
	$(INSTALL) -d "$(DESTDIR)$(LIBDIR)/cmake/pendres"
	@for file in pendres-config pendres-config-version; do \
	  $(FILL_CMAKE) $$file.cmake.in >"$(DESTDIR)$(LIBDIR)/cmake/pendres/$$file.cmake" && \
	  chmod 644 "$(DESTDIR)$(LIBDIR)/cmake/pendres/$$file.cmake" || exit 1; done
ifneq ($(PROGRAM),)
	$(INSTALL) -d "$(DESTDIR)$(BINDIR)"
	$(INSTALL) -m 755 $(PROGRAM) "$(DESTDIR)$(BINDIR)"
	$(INSTALL) -d "$(DESTDIR)$(MANDIR)/man1"
	$(INSTALL) -m 644 man/resonance.1 "$(DESTDIR)$(MANDIR)/man1"
endif
	$(INSTALL) -d "$(DESTDIR)$(MANDIR)/man3"
	sh man/pendres.3.sh $(VERSION) '$(DATADIR)' >"$(DESTDIR)$(MANDIR)/man3/pendres.3"
	chmod 644 "$(DESTDIR)$(MANDIR)/man3/pendres.3"
	@for folder in $(sort $(dir $(SHARED_FILES))); do \
	  $(INSTALL) -d "$(DESTDIR)$(DATADIR)/$$folder" || exit 1; done
	@for file in $(SHARED_FILES); do \
	  if [ -x "$$file" ]; then mode=755; else mode=644; fi; \
	  $(INSTALL) -m $$mode "$$file" "$(DESTDIR)$(DATADIR)/$$file" || exit 1; done
	@test -n '$(DESTDIR)' || $(LDCONFIG) 2>/dev/null || true

uninstall:
	rm -f "$(DESTDIR)$(LIBDIR)/libpendres.a" "$(DESTDIR)$(LIBDIR)/libpendres.so" \
	  "$(DESTDIR)$(LIBDIR)/$(SONAME)" "$(DESTDIR)$(LIBDIR)/$(notdir $(SHARED))" \
	  "$(DESTDIR)$(LIBDIR)/pkgconfig/pendres.pc" "$(DESTDIR)$(BINDIR)/resonance" \
	  "$(DESTDIR)$(MANDIR)/man1/resonance.1" "$(DESTDIR)$(MANDIR)/man3/pendres.3"
	rm -rf "$(DESTDIR)$(INCLUDEDIR)/pendres" "$(DESTDIR)$(LIBDIR)/cmake/pendres" "$(DESTDIR)$(DATADIR)"
	@test -n '$(DESTDIR)' || $(LDCONFIG) 2>/dev/null || true

style:
	@tests/style_check.sh

# A build directory of another name is kept if it holds anything else.
clean:
	rm -rf $(addprefix $(BUILD)/,obj tests bench results doc flags sources pages.inc) \
	  $(BUILD)/libpendres.* $(BUILD)/libdriver.a $(PROGRAM)
ifeq ($(BUILD),build)
	rm -rf build
else
	@rmdir $(BUILD) 2>/dev/null || true
endif

# Documents and pictures, fuzzing, packages: what neither builds, tests nor installs.
include $(wildcard tools/*.mk)

-include $(LIBRARY_OBJECTS:.o=.d) $(DRIVER_OBJECTS:.o=.d) $(OBJ)/drivers/main.d \
         $(TEST_NAMES:%=$(OBJ)/tests/%.d) $(ACCURACY_OBJECTS:.o=.d) \
         $(BENCH_PROGRAMS:$(BUILD)/%=$(OBJ)/%.d)
