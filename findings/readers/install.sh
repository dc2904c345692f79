# install.sh -- to be sourced: readers of HDF5 files other than HDF5's own library, in the versions
# in which they were tried, into the folder $readers; $here is the folder findings. Needs python3 with venv; npm, and java with
# mvn, for the readers that are theirs.
python_readers='h5py==3.16.0 h5netcdf==1.8.2 netCDF4==1.7.5.1.post1 xarray==2026.9.0 zarr==3.1.6
  pyfive==1.3.0 kerchunk==0.2.10 virtualizarr==2.5.1 obspec-utils obstore==0.12.1 hidefix==0.12.0'
npm_readers='h5wasm@0.10.3 jsfive@0.4.2'
jhdf=0.9.4

if [ ! -x "$readers/venv/bin/python" ]; then
  "${PYTHON:-python3}" -m venv "$readers/venv" &&
    "$readers/venv/bin/pip" install --quiet --disable-pip-version-check $python_readers || exit 1
fi
if command -v npm >/dev/null && [ ! -d "$readers/npm/node_modules/jsfive" ]; then
  mkdir -p "$readers/npm"
  (cd "$readers/npm" && npm init --yes && npm install $npm_readers) >/dev/null || exit 1
fi
[ ! -d "$readers/npm" ] || cp "$here/readers/read.mjs" "$readers/npm" || exit 1
if command -v mvn >/dev/null && command -v java >/dev/null && [ ! -d "$readers/jhdf" ]; then
  mkdir -p "$readers/jhdf"
  cat >"$readers/jhdf/pom.xml" <<END
<project><modelVersion>4.0.0</modelVersion><groupId>readers</groupId><artifactId>readers</artifactId>
<version>1</version><dependencies><dependency><groupId>io.jhdf</groupId><artifactId>jhdf</artifactId>
<version>$jhdf</version></dependency></dependencies></project>
END
  (cd "$readers/jhdf" && mvn -q -B dependency:copy-dependencies -DoutputDirectory=jars) || exit 1
fi
