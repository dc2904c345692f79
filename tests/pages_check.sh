#!/bin/sh
# pages_check.sh -- every command of docs/your_pendulum.md, in its order, and the numbers that the
# page tells. Python's where there is cffi, pictures where there is matplotlib.
# Run by make check, which sets BUILD and RESONANCE.
set -u
[ -n "${RESONANCE:-}" ] || { echo "no program resonance"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
page=$PWD/docs/your_pendulum.md
PENDRES_LIBRARY=$(cd "$BUILD" && pwd)/libpendres.so
PYTHONPATH=$PWD/python
PYTHONDONTWRITEBYTECODE=1
PATH=$(dirname "$RESONANCE"):$PATH
export PENDRES_LIBRARY PYTHONPATH PYTHONDONTWRITEBYTECODE PATH
ln -s "$PWD/plots" "$scratch/plots"

fail()
{
  echo "pages_check: $*"
  exit 1
}

# told WORDS FILE: the page's numbers are those that were printed.
told()
{
  grep -q -- "$1" "$2" || { cat "$2"; fail "the page is out of date: no '$1'"; }
}

# blocks LANGUAGE: what stands between ```LANGUAGE and ```.
blocks()
{
  sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/{/^\`\`\`/!p}" "$page"
}

# python MODULES: a Python that has them.
python()
{
  for candidate in "${PYTHON:-python3}" /usr/bin/python3; do
    "$candidate" -c "import $1" 2>/dev/null && echo "$candidate" && return
  done
}

drawing=$(python h5py,matplotlib)
blocks sh >"$scratch/all.sh"
grep -v plots/plot.py "$scratch/all.sh" >"$scratch/compute.sh"
sed -n "s|^python3 \(plots/plot.py.*\)|$drawing \1|p" "$scratch/all.sh" >"$scratch/draw.sh"
blocks python >"$scratch/page.py"
cd "$scratch" || exit 1
sh -e compute.sh >printed 2>log || { cat log; fail "a command failed"; }
told '0\.743469008' printed
told 'resonance_frequency, ' printed
told '^0\.579449.* 0\.617079' printed
told ' sa .* 0\.8319.* 0\.66' printed
told 'LA to SA .* 1175 ' printed
if [ -n "$drawing" ]; then
  [ -s draw.sh ] && sh -e draw.sh >log 2>&1 && [ -s jumps.png ] && [ -s shares.png ] &&
    [ -s escape.png ] || { cat log; fail "no pictures"; }
fi
computing=$(python cffi,numpy)
if [ -n "$computing" ]; then
  "$computing" page.py >printed 2>&1 || { cat printed; fail "Python's commands failed"; }
  told 'up .* 0\.617079 .* FOLD SA LA' printed
  told 'down 0\.5116.* SYMMETRY' printed
  told 'down 0\.50038.* FLIP LA' printed
  told 'down 0\.4982.* CRISIS CHAOTIC' printed
  told '0\.617079 .* a EDGE' printed
fi
cat printed
exit 0
