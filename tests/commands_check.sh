#!/bin/sh
# commands_check.sh -- the commands that README.md, CONTRIBUTING.md and the pages of docs/ print, in
# the order of the pages, except of those pages that have a check of their own (your_pendulum, files,
# python). Runs are cut short by keys behind them; apt-get only says what it would do; what takes
# long, or needs what is not there, is looked at as far as it goes. A command that is not known here
# is a failure: add how it can be tried. Run by make check, which sets BUILD, CC, MAKE and RESONANCE.
set -u
[ -n "${RESONANCE:-}" ] || { echo "no program resonance"; exit 77; }
MAKE=${MAKE:-make}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
unset DESTDIR PREFIX
shared=$(cd "$BUILD" && pwd)/libpendres.so

# A tree like this one, and a place for the files that are written. What is installed by folders is
# copied, the rest linked: folders and files by name, and no results that somebody keeps at the top,
# since a run writes to where a link leads. With their times: a page that is newer than what was made
# of it has the program linked anew, under the feet of other checks.
cp -rp examples input plots docs python "$scratch"
for entry in .ci */ Makefile mkdocs.yml Doxyfile LICENSE CITATION.cff ./*.md ./*.map ./*.in; do
  entry=${entry%/}
  [ -e "$scratch/$entry" ] || ln -s "$PWD/$entry" "$scratch/$entry"
done
ln -s "$RESONANCE" "$scratch/resonance"
cd "$scratch" || exit 1

fail()
{
  [ ! -s "$scratch/log" ] || cat "$scratch/log"
  echo "commands_check: $*"
  exit 1
}

# What is installed is read from apt's lists and left as it is.
mkdir shims
cat >shims/apt-get <<'TEXT'
#!/bin/sh
[ "$1" = update ] || exec env PATH="${PATH#*:}" apt-get -s "$@"
TEXT
printf '#!/bin/sh\nexec %s "$@"\n' "$(command -v "$MAKE")" >shims/make
chmod +x shims/apt-get shims/make

# Few points: what follows a deck's name where it is run.
settings_of()
{
  case $1 in
    f02.nml) echo sweep.damping=0.2 sweep.damping_range=0.3,0.4,2 ensemble.members=8 ;;
    hysteresis.nml) echo sweep.drive_frequency_range=0.83,0.85,3 ;;
    ramp.nml) echo hysteresis.rate=1e-3 noise.trajectories=9 ;;
    cascade.nml) echo sweep.drive_amplitude_range=1.04,1.07,4 ;;
    lyapunov.nml) echo sweep.drive_amplitude_range=0.9,1.5,4 sweep.drive_frequency_range=0.6,0.7,3 ;;
    section.nml | ueda_section.nml) echo orbit.periods=600 ;;
    *) echo --dump-namelist ;; # read and checked; its kind is run by tests of scenes
  esac
}

# run WHERE COMMAND: in the scratch tree, as printed but for what is put behind it.
run()
{
  (PATH=$scratch/shims:$scratch:$PATH && eval "$2") >log 2>&1 || fail "$1: failed: $2"
}

# without_errors: numbers without what may differ on another processor, last digits and errors.
without_errors()
{
  sed -e 's/ *+- [^ ,]*//g' -e 's/\(\.[0-9]\{8\}\)[0-9]*/\1/g' -e 's/  */ /g' -e 's/ $//'
}

# answers WORDS: what was printed is what README.md shows, in its lines that begin so.
answers()
{
  without_errors <log >answer
  sed '/^```text$/,/^```$/!d' README.md | grep -E "$1" | without_errors | cmp -s - answer
}

# The commands that a page prints as indented lines, without its equations and decks, and what the
# program answers.
commands_of()
{
  sed -e '/^```/,/^```/d' -e '/^    &/,/^    \/$/d' "$1" | sed -n 's/^    \([a-zA-Z.]\)/\1/p' |
    grep -v -e '^x' -e '^dw/d' -e '^resonance: '
}

try()
{
  case $2 in
    'apt-get install auto-07p') ;; # not asked for by anything that is built here
    apt-get*'make -j2 check') run "$1" "${2%check} -n check CHECKS=" ;;
    apt-get*'make && ./resonance input/f02.nml') run "$1" "$2 $(settings_of f02.nml)"; [ -s f02.h5 ] ||
      fail "$1: no f02.h5" ;;
    'make install PREFIX='*)
      run "$1" "$2 DESTDIR=$scratch/stage LDCONFIG=:"
      [ -x stage/usr/local/bin/resonance ] || fail "$1: nothing installed by $2" ;;
    'make '*) goals="$goals $(echo "${2%%#*}" | tr ' ' '\n' | grep -v -e = -e '^-' -e '^make$')" ;;
    './resonance input/duffing.nml')
      run "$1" "$2 --quiet --force"
      answers '^damping|^0|^cusp' || fail "README.md does not show what $2 prints" ;;
    './resonance --init='*'>'*) run "$1" "$2" ;;
    './resonance sweep.nml') run "$1" "$2 --quiet --force" ;; # of a fence below, written before
    './resonance my.nml'*) run "$1" "$2 --quiet --force" ;;
    './resonance input/'*.nml)
      run "$1" "$2 --quiet --force $(settings_of "${2##*/}")" ;;
    './resonance input/'*.nml' '*=*) run "$1" "$2 --quiet --force" ;;
    'resonance --resume --shard=3/8 deck.nml'*)
      printf "&scene kind = 'free_oscillation' /\n&sweep amplitude = 1, 2, 3 /\n" >deck.nml
      for shard in 1 2 3 4 5 6 7 8; do
        run "$1" "resonance --resume --shard=$shard/8 deck.nml"
      done ;;
    'resonance --merge deck.nml'*) run "$1" "$2" ; [ -s deck.h5 ] || fail "$1: no deck.h5" ;;
    'python3 plots/plot.py '*.h5) # plots_check draws each kind of run
      for file in ${2#*plot.py }; do
        [ "$file" != my.h5 ] || continue # of a deck that was printed
        grep -q "input/${file%.h5}\.nml" "$1" || fail "$1: no command makes $file"
      done ;;
    'PYTHONPATH=python python3'*)
      [ -n "$computing" ] || return 0
      case $2 in
        *pendres.explorer*) return 0 ;; # explorer_check runs it
        *-c*) text=$2 ;;
        *) text="$2 readme.py" ;;
      esac
      run "$1" "PYTHONDONTWRITEBYTECODE=1 PENDRES_LIBRARY=$shared $(echo "$text" |
        sed "s|python3|$computing|")"
      case $text in
        *readme.py)
          answers '^fold' || fail "README.md does not show what Python prints" ;;
      esac ;;
    'pip install ./python') ;; # by python_check
    'cc '* | 'c++ '*) ;; # by install_check, beside an installed library
    'cd docs/auto' | 'for n in 10 20'*auto-07p* | 'python3 table.py'*) ;; # AUTO is in no test
    'cmake '*) ;; # the sources of SUNDIALS are not there
    'tests/same_bytes.sh '*) [ -x tests/same_bytes.sh ] || fail "$1: no tests/same_bytes.sh" ;;
    *) fail "$1 prints a command that is not tried: $2" ;;
  esac
}

# Decks in fences are read; the last of a page is there for its commands.
for page in docs/*.md; do
  awk -v page="$(basename "$page" .md)" '/^```/ { on = /fortran/; n += on; next }
    on { print > ("fence-" page "-" n ".nml") }' "$page"
done
for deck in fence-*.nml; do
  ! grep -q '^&scene' "$deck" || run "$deck" "resonance --dump-namelist $deck"
done
cp fence-lesson-1.nml sweep.nml

computing=
for candidate in "${PYTHON:-python3}" /usr/bin/python3; do
  "$candidate" -c 'import cffi, numpy' 2>/dev/null && computing=$candidate && break
done
sed -n '/^```python$/,/^```$/{/^```/!p}' README.md >readme.py
goals=
tried=0
for page in README.md CONTRIBUTING.md python/README.md examples/README.md docs/*.md; do
  case $page in */your_pendulum.md | */files.md | */python.md | */decks.md) continue ;; esac
  commands_of "$page" >lines
  while IFS= read -r line <&9; do # 3 and 4 are those of a make with -j
    try "$page" "$line"
    tried=$((tried + 1))
  done 9<lines
done
[ $tried -ge 25 ] || fail "only $tried commands were found"

# Without checks, since -n runs those that are scripts.
run CONTRIBUTING.md "make -n CHECKS= $(echo $goals)"

# In the text of the README.
for command in 'resonance --list' 'resonance --explain=damping' 'resonance --explain=loop_area' \
  'resonance --init=basins' 'resonance --init=resonator >init.nml && resonance -q init.nml' \
  'resonance --init=junction >init.nml && resonance -q --force init.nml' \
  'resonance --init=two_wells >init.nml && resonance -q --force init.nml' \
  'resonance --dump-namelist input/f01.nml' 'resonance -q input/f02.nml ensemble.members=8
    pendulum.drive_amplitude=0.15 sweep.damping_range=0.1,0.4,4 -o text.h5'; do
  run README.md "$(echo $command)"
done
for deck in input/*.nml; do
  name=${deck#input/}
  grep -q -e "\`${name%.nml}\`" -e "$deck" README.md docs/*.md || fail "no page tells of $deck"
done
for page in docs/*.md; do
  grep -q ": ${page#docs/}\$" mkdocs.yml || fail "mkdocs.yml does not list $page"
  grep -q "(${page#docs/})" docs/README.md || [ "$page" = docs/README.md ] ||
    fail "docs/README.md does not list $page"
  for link in $(grep -o ']([^)#]*' "$page" | sed 's/^](//' | grep -v '^http'); do
    [ -e "docs/$link" ] || fail "$page leads to $link, which is not there"
  done
done
for script in docs/batch/*.sh; do sh -n "$script" || fail "$script is no shell script"; done
exit 0
