# documents.mk -- manuals, references and pictures: `make doc`, `docs`, `man`, `decks-reference`,
# `results-reference`, `interface-list`, `python-stubs`, `figures`, `gallery`.

.PHONY: doc docs python-stubs decks-reference results-reference interface-list figures gallery

doc:
	@command -v doxygen >/dev/null || { echo 'make doc needs Doxygen (Debian: apt-get install' \
	  'doxygen); without it, each header in include/pendres/ is its own manual' >&2; exit 1; }
	@mkdir -p build
	doxygen Doxyfile

# Links out of docs/ lead nowhere there; they are for readers of the tree.
docs:
	@command -v mkdocs >/dev/null || { echo 'make docs needs MkDocs: make deps-doc' >&2; exit 1; }
	@mkdir -p build
	mkdocs build --quiet --clean --site-dir build/site
	@echo 'build/site/index.html'

man: $(PROGRAM)
	@command -v help2man >/dev/null || { echo 'make man needs help2man (Debian: apt-get install' \
	  'help2man)' >&2; exit 1; }
	LC_ALL=C help2man -N -n 'resonance of driven pendulums' -o man/resonance.1 ./$(PROGRAM)

decks-reference: $(PROGRAM)
	@./$(PROGRAM) --reference >docs/decks.md.new && mv docs/decks.md.new docs/decks.md

results-reference: $(PROGRAM)
	@$${PYTHON:-/usr/bin/python3} -B tests/results_list.py ./$(PROGRAM) tests/kinds/*.nml \
	  >docs/results.md.new && mv docs/results.md.new docs/results.md

python-stubs: all
	@PYTHONPATH=python $${PYTHON:-/usr/bin/python3} -B tests/stubs_list.py \
	  >python/pendres/__init__.pyi.new && mv python/pendres/__init__.pyi.new python/pendres/__init__.pyi

interface-list:
	@$${PYTHON:-/usr/bin/python3} -B tests/interface_list.py '$(CC)' include >tests/interface.txt
	@$(MAKE) --no-print-directory python-stubs || echo 'python/pendres/__init__.pyi is not renewed'

# Every deck that computes a figure, and its picture, into build/figures. The shell makes the names:
# those of make end at a blank.
figures: $(PROGRAM)
	@mkdir -p $(BUILD)/figures; top=$$PWD; cd $(BUILD)/figures && failed=0 && \
	for deck in "$$top"/input/*.nml; do \
	  case $${deck##*/} in workprec_*) continue ;; esac; echo "$${deck##*/}"; \
	  "$(PROGRAM_PATH)" --quiet "$$deck" >/dev/null || [ $$? -eq 3 ] || failed=1; \
	done; plot() { $${PYTHON:-/usr/bin/python3} "$$top/plots/plot.py" "$$@"; }; \
	plot *.h5 && plot --surface f10.h5 && exit $$failed

# The few pictures that docs/gallery.md and the README show, from what `make figures` left.
GALLERY := f05 f07 f08 f09 integrity duffing drives resonator fit hysteresis josephson cascade
gallery:
	@$${PYTHON:-/usr/bin/python3} plots/plot.py --dpi 200 -o docs/gallery \
	  $(GALLERY:%=$(BUILD)/figures/%.h5)
	@$${PYTHON:-/usr/bin/python3} plots/plot.py --dpi 200 -o docs $(BUILD)/figures/f02.h5
