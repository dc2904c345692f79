#!/bin/sh
# results_check.sh -- --explain knows keys, results, oscillators, words and subjects of the pages, and
# says of others that it does not; docs/results.md is what files say of their variables.
set -u
top=$(cd "$(dirname "$0")/.." && pwd)
failed=0

# has WORD TEXT ...: its explanation has these texts.
has()
{
  word=$1
  said=$("$RESONANCE" --explain="$word") || { echo "nothing is said of $word"; failed=1; }
  shift
  for text in "$@"; do
    case $said in *"$text"*) ;; *) echo "what is said of $word lacks '$text': $said"; failed=1 ;; esac
  done
}
has damping '&pendulum' 'friction coefficient'
has hysteresis '&hysteresis' 'the cascade' 'docs/gallery.md'
has loop_area 'work of the drive' 'of: hysteresis, orbit'
has step_width 'width of the step'
has duffing 'docs/models.md' 'a1 = α' 'docs/gallery.md'
has FOLD 'fold_frequency' 'docs/models.md' 'the pendulum jumps'
has 'period doubling' 'docs/models.md' 'read about it:'
has Shapiro 'docs/sweeps.md, Current and voltage of a junction'
has Q "damping = 'Q 5000'" 'docs/units.md, Words of a laboratory'
has beta_c '1/sqrt' capacitance
has linewidth "damping = '240 Hz'"
has f0 natural_frequency 'docs/models.md'
for word in 'quality factor' Ic 'plasma frequency' ringdown kelvin MEMS Kerr bistability 'IV curve'; do
  has "$word" 'docs/units.md, Words of a laboratory'
done
for word in xyzzy '' ' ' '%s' 'a very long word of no meaning at all'; do
  said=$("$RESONANCE" --explain="$word" 2>&1)
  [ $? -eq 2 ] || { echo "'$word' was taken: $said"; failed=1; }
done
case $("$RESONANCE" --explain=dampin 2>&1) in
  *"did you mean 'damping'"*) ;; *) echo "no hint for 'dampin'"; failed=1 ;;
esac

python=${PYTHON:-/usr/bin/python3}
"$python" -c 'import h5py' 2>/dev/null || { echo "no Python with h5py: make deps-python"; exit $failed; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
"$python" -B "$top/tests/results_list.py" "$RESONANCE" "$top"/tests/kinds/*.nml >"$scratch/now" || exit 1
cmp -s "$top/docs/results.md" "$scratch/now" || {
  diff "$top/docs/results.md" "$scratch/now" | head -20
  echo "docs/results.md is not what files say: make results-reference"
  failed=1
}
exit $failed
