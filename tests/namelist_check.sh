#!/bin/sh
# The deck reader against gfortran's, where there is a gfortran; 77: not possible here.
command -v python3 >/dev/null 2>&1 || { echo "no python3: make deps-python"; exit 77; }
exec python3 tests/namelist_conformance/compare.py
