# packages.mk -- what this needs of others, `make deps` and its like, and what others take of it,
# `make sdist` and `make wheel`.

.PHONY: deps deps-doc deps-wheel deps-explorer deps-mpi deps-fuzz deps-plots deps-python sdist wheel

sdist wheel:
	@packaging/wheel.sh $@

# Without what is in folders of its own.
PACKAGES := gcc make pkg-config libc6-dev $(if $(SUNDIALS_DIR),,libsundials-dev) \
            $(if $(HDF5_DIR),,libhdf5-dev) $(if $(GSL_DIR),,libgsl-dev) libcmocka-dev \
            librandom123-dev zlib1g-dev
MPI_PACKAGES := openmpi-bin libopenmpi-dev
PLOT_PACKAGES := python3 python3-h5py python3-matplotlib
FUZZ_PACKAGES := clang libclang-rt-dev
WHEEL_PACKAGES := cmake dpkg-dev gcc librandom123-dev make pkg-config python3-venv zlib1g-dev
DOC_PACKAGES := doxygen help2man mkdocs
PYTHON_PACKAGES := python3-cffi python3-numpy python3-xarray python3-h5netcdf
EXPLORER_PACKAGES := python3-venv chromium
EXPLORER_MODULES := bokeh cffi h5netcdf h5py matplotlib numpy panel param playwright xarray

deps:
	@.ci/packages $(PACKAGES)

deps-mpi:
	@.ci/packages $(MPI_PACKAGES)

deps-plots:
	@.ci/packages $(PLOT_PACKAGES)

deps-doc:
	@.ci/packages $(DOC_PACKAGES)

deps-wheel:
	@.ci/packages $(WHEEL_PACKAGES)

deps-fuzz:
	@.ci/packages $(FUZZ_PACKAGES)

deps-python:
	@.ci/packages $(PYTHON_PACKAGES)

deps-explorer:
	@.ci/packages $(EXPLORER_PACKAGES)
	python3 -m venv $(BUILD)/explorer
	$(BUILD)/explorer/bin/pip install --quiet $(EXPLORER_MODULES)
