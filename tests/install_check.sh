#!/bin/sh
# install_check.sh -- what a stranger gets: installs into a scratch folder and builds a program
# with `pkg-config --cflags --libs pendres` or CMake alone, against the shared and the static library.
# Run by make check, which sets BUILD, CC, MAKE and PKG_CONFIG.
set -u
CC=${CC:-gcc}
MAKE=${MAKE:-make}
PKG_CONFIG=${PKG_CONFIG:-pkg-config}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
unset DESTDIR PREFIX LIBDIR BINDIR INCLUDEDIR MANDIR

fail()
{
  echo "install_check: $*"
  exit 1
}

quiet()
{
  "$@" >"$scratch/log" 2>&1 || {
    cat "$scratch/log"
    fail "failed: $*"
  }
}

top=$PWD
stage="$scratch/the stage" # whose name the shell must not take apart
# The variables of an outer command line come along in MAKEFLAGS; these are the later ones.
quiet $MAKE install DESTDIR="$stage" PREFIX=/opt/pendres LDCONFIG=:
for file in lib/libpendres.a lib/libpendres.so lib/libpendres.so.1 lib/pkgconfig/pendres.pc \
  lib/cmake/pendres/pendres-config.cmake lib/cmake/pendres/pendres-config-version.cmake \
  include/pendres/pendres.h share/man/man1/resonance.1 share/man/man3/pendres.3 \
  share/pendres/input/f02.nml share/pendres/plots/plot.py share/pendres/docs/decks.md \
  share/pendres/python/pendres/__init__.py share/pendres/python/setup.py; do
  [ -e "$stage/opt/pendres/$file" ] || fail "$file was not installed"
done
[ -x "$stage/opt/pendres/share/pendres/docs/batch/slurm-array.sh" ] || fail "scripts do not run"
for header in include/pendres/*.h; do
  cmp -s "$header" "$stage/opt/pendres/$header" || fail "$header was not installed"
done
grep -q '^.B <pendres/context.h>' "$stage/opt/pendres/share/man/man3/pendres.3" &&
  grep -qF /opt/pendres/share/pendres/examples "$stage/opt/pendres/share/man/man3/pendres.3" ||
  fail "pendres.3 lacks headers, or where the examples are"
[ "$(ls "$stage")" = opt ] && [ "$(ls "$stage/opt")" = pendres ] || fail "files outside PREFIX"
grep -rlF "$stage" "$stage/opt/pendres/lib/pkgconfig" "$stage/opt/pendres/lib/cmake" &&
  fail "DESTDIR got into what pkg-config or CMake reads"
quiet $MAKE uninstall DESTDIR="$stage" PREFIX=/opt/pendres
[ -z "$(find "$stage" ! -type d)" ] || fail "make uninstall left" $(find "$stage" ! -type d)

# A folder with a blank in its name: to be used where a shell reads what pkg-config quotes.
blank="$scratch/a prefix"
quiet $MAKE install DESTDIR= PREFIX="$blank" LDCONFIG=:
echo '#include <pendres/pendres.h>
int main(void) { return pendres_version() == 0; }' >"$scratch/blank.c"
flags=$(PKG_CONFIG_PATH="$blank/lib/pkgconfig" $PKG_CONFIG --cflags --libs pendres)
eval "$CC \"$scratch/blank.c\" -o \"$scratch/blank\" $flags" || fail "no use of '$blank'"
LD_LIBRARY_PATH="$blank/lib" "$scratch/blank" || fail "nothing runs in '$blank'"
quiet $MAKE uninstall DESTDIR= PREFIX="$blank"
[ -z "$(find "$blank" ! -type d)" ] || fail "make uninstall left" "$(find "$blank" ! -type d)"

# So may the tree's own: a deck is run and its picture drawn, by a program that draws nothing.
if [ -n "${RESONANCE:-}" ]; then
  tree="$scratch/a tree"
  mkdir -p "$tree/input" || exit 1
  for entry in Makefile drivers src include tests plots tools validation; do ln -s "$top/$entry" "$tree"; done
  ln -s "$RESONANCE" "$tree/resonance"
  cp input/f01.nml "$tree/input"
  cp input/f01.nml "$tree/input/workprec_left_out.nml"
  quiet env PYTHON=true $MAKE -C "$tree" -o resonance BUILD=build figures
  [ "$(ls "$tree/build/figures")" = f01.h5 ] || fail "make figures in '$tree' made no f01.h5"
fi

prefix=$scratch/prefix
quiet $MAKE install DESTDIR= PREFIX="$prefix" LDCONFIG=:
PKG_CONFIG_PATH=$prefix/lib/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
export PKG_CONFIG_PATH
export LD_LIBRARY_PATH="$prefix/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

cat >"$scratch/stranger.c" <<'TEXT'
#include <math.h>
#include <stdio.h>
#include <string.h>

#include <pendres/pendres.h>

int main(void)
{
  pendres_context *ctx = NULL;
  const pendres_pendulum p = {.damping = 0.24, .drive_amplitude = 0.2, .drive_frequency = 0.9};
  const pendres_options options = {.tolerance = 1e-9};
  double x[2] = {1.0, 2.0}, v[2] = {0.0, 0.0};
  const pendres_pendulum both[2] = {p, p};

  if (strcmp(pendres_version(), PENDRES_VERSION) != 0) return 2;
  if (pendres_context_create(&options, &ctx)) return 3;
  if (pendres_strobe_advance(ctx, 2, both, x, v, 50, NULL)) {
    fprintf(stderr, "%s\n", pendres_context_message(ctx));
    return 4;
  }
  pendres_context_free(ctx);
  if (!isfinite(x[0]) || !isfinite(x[1]) || pendres_free_frequency(0.0) != 1.0) return 5;
  printf("%s; %s\n", pendres_version(), pendres_build_info());
  return 0;
}
TEXT
version=$(sed -n 's/^#define PENDRES_VERSION "\(.*\)"/\1/p' include/pendres/version.h)
[ "$($PKG_CONFIG --modversion pendres)" = "$version" ] || fail "pendres.pc has another version"

sed -n '/^```c$/,/^```$/{/^```/!p}' docs/install.md >"$scratch/page.c"
cd "$scratch" || exit 1
strict="-std=c11 -Wall -Wextra -Wpedantic -Werror"
quiet $CC $strict stranger.c $($PKG_CONFIG --cflags --libs pendres) -o shared
quiet ./shared
readelf -d shared | grep -q 'NEEDED.*\[libpendres\.so\.1\]' || fail "shared: no soname"
for other in hdf5 sundials gsl; do
  readelf -d shared | grep -q "NEEDED.*$other" && fail "shared: must not name $other itself"
done

# The page's own program, as it stands there, by the page's own command.
cp page.c example.c
command=$(sed -n 's/^    cc \(example\.c .*\)/\1/p' "$top/docs/install.md")
[ -n "$command" ] || fail "the page does not say how to compile its program"
quiet sh -c "$CC $strict $command"
grep -q '^after 50 drive periods: x = ' log || fail "the page's program says nothing"

# The examples, as they were installed: each compiles, in its language, runs and says something.
for example in "$prefix"/share/pendres/examples/*.c "$prefix"/share/pendres/examples/*.cc; do
  case $example in
    *.cc) compiler="${CXX:-c++} -std=c++11"; command -v ${CXX:-c++} >/dev/null || continue ;;
    *) compiler="$CC -std=c11" ;;
  esac
  quiet $compiler -Wall -Wextra -Wpedantic -Werror "$example" \
    $($PKG_CONFIG --cflags --libs pendres) -o example
  quiet ./example
  [ -s log ] || fail "$example says nothing"
done

# Found at run time without a word to the session, as the page says.
quiet $CC $strict page.c $($PKG_CONFIG --cflags --libs pendres) \
  -Wl,-rpath,"$($PKG_CONFIG --variable=libdir pendres)" -o rpath
(unset LD_LIBRARY_PATH && quiet ./rpath) || exit 1

# The archive in place of the shared library beside it, by the words of the documentation.
words=$(sed -n 's/.*`pkg-config \(--static [^`]* pendres\)`.*/\1/p' "$top/docs/install.md" |
  head -n 1)
[ -n "$words" ] || fail "no page says how to link libpendres.a"
static=$($PKG_CONFIG $words)
quiet $CC $strict stranger.c $static -o static
readelf -d static | grep -q 'NEEDED.*pendres' && fail "static: still wants the shared library"
(unset LD_LIBRARY_PATH && quiet ./static) || exit 1
# Everything in the archive at once: pendres.pc names all that it needs.
quiet $CC $strict stranger.c -Wl,--whole-archive "$prefix/lib/libpendres.a" \
  -Wl,--no-whole-archive $static -o whole
(unset LD_LIBRARY_PATH && quiet ./whole) || exit 1

# The same with CMake, both ways.
if command -v cmake >/dev/null; then
  mkdir cmake
  echo 'cmake_minimum_required(VERSION 3.13)
project(stranger C)
find_package(pendres 1.0 REQUIRED)
add_executable(shared ../stranger.c)
target_link_libraries(shared PRIVATE pendres::pendres)
add_executable(static ../stranger.c)
target_link_libraries(static PRIVATE pendres::static)
find_package(pendres 99 QUIET)
if(pendres_FOUND)
  message(FATAL_ERROR "version 99 was found")
endif()' >cmake/CMakeLists.txt
  quiet cmake -S cmake -B cmake/build -DCMAKE_C_COMPILER="$CC" -DCMAKE_PREFIX_PATH="$prefix"
  quiet cmake --build cmake/build
  (unset LD_LIBRARY_PATH && quiet cmake/build/shared && quiet cmake/build/static) || exit 1
  readelf -d cmake/build/shared | grep -q 'NEEDED.*\[libpendres\.so\.1\]' ||
    fail "CMake: pendres::pendres is not the shared library"
  readelf -d cmake/build/static | grep -q 'NEEDED.*pendres' &&
    fail "CMake: pendres::static still wants the shared library"
fi

# The Python package works where it was installed, without the tree: pkg-config tells of the rest.
for python in "${PYTHON:-python3}" /usr/bin/python3; do
  "$python" -c 'import cffi, numpy' 2>/dev/null || continue
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$prefix/share/pendres/python quiet "$python" -c '
import pendres
assert "share/pendres/python" in pendres.__file__
p = pendres.pendulum(damping=0.24, drive_amplitude=0.2, drive_frequency=0.9)
o = pendres.settle(p, 1.0, 0.0)[1].orbit[0]
assert o.loop_area > 0.1 and abs(o.loop_area - o.dissipation) < 1e-8'
  break
done

# So does one that holds the library, as wheels do, with neither tree nor installation nor pkg-config.
for python in "${PYTHON:-python3}" /usr/bin/python3; do
  "$python" -c 'import cffi, numpy' 2>/dev/null || continue
  mkdir -p wheel/pendres
  cp "$top"/python/pendres/*.py wheel/pendres
  cp "$prefix/lib/libpendres.so" wheel/pendres
  quiet env PYTHONPATH="$top/python/pendres" "$python" -B -c '
import sys, _headers
open("wheel/pendres/headers.txt", "w").write(_headers.folder_text(sys.argv[1]))' \
    "$prefix/include/pendres"
  (unset LD_LIBRARY_PATH PKG_CONFIG_PATH
    quiet env PYTHONPATH=wheel "$python" -B -c '
import pendres
assert "wheel/pendres" in pendres.__file__
assert "wheel/pendres/libpendres.so" in open("/proc/self/maps").read()
assert pendres.free_frequency(0.0) == 1.0') || exit 1
  break
done

# What pip builds from sources says what they need where that is missing, as a make that fails does;
# setuptools announces of nothing that it will refuse it.
mkdir -p source/library source/licences
cp -r "$top"/python/*.* "$top/python/pendres" source
cp -r "$top/include" source/library
cp "$top/LICENSE" source/licences/LICENSE.pendres
echo 'all: ; @false' >source/library/Makefile
for python in "${PYTHON:-python3}" /usr/bin/python3; do
  (cd source && "$python" -c 'import setuptools.errors, wheel' 2>/dev/null) || continue
  (cd source && "$python" -B setup.py -q build) >log 2>&1 && fail "built by a make that fails"
  grep -q '^error: the library was not built' log && grep -q 'apt-get install gcc' log &&
    ! grep -qi 'setuptoolsdeprecationwarning' log || {
    cat log
    fail "setup.py does not say what the sources need, or asks for what setuptools will refuse"
  }
  break
done

if [ -x "$prefix/bin/resonance" ]; then
  "$prefix/bin/resonance" --version >"$scratch/log" 2>&1 || fail "resonance --version failed"
  grep -qF "$version" "$scratch/log" || fail "resonance --version does not say $version"
fi
nm -D --defined-only "$prefix/lib/libpendres.so" | awk '$2 != "A" && $NF !~ /^pendres_/' | grep . &&
  fail "exported without the prefix"
cat "$scratch/log"
exit 0
