#!/bin/sh
# plots_check.sh -- every kind of run that is quick to make is drawn, with and without options, what
# cannot be drawn is told on one line, and the colours of states can be told apart by everybody.
set -u
top=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-/usr/bin/python3}
"$python" -c 'import h5py, matplotlib' 2>/dev/null ||
  { echo "no Python with h5py and matplotlib: make deps-plots"; exit 77; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# deck NAME KIND GROUPS: run a small deck.
deck()
{
  printf "&scene kind = '%s', title = '%s' /\n%s\n" "$2" "$1" "$3" >"$1.nml"
  "$RESONANCE" --quiet "$1.nml" >"$1.txt" 2>&1 || { cat "$1.txt"; exit 1; }
}
p='&pendulum drive_amplitude = 0.2'
e='&ensemble members = 8 /'
deck free free_oscillation '&sweep amplitude = 0.5, 1, 2 /'
deck curve resonance_curve "$p / &sweep damping = 0.2, 0.3, drive_frequency_range = 0.8, 1.1 / $e"
cp curve.h5 curve_inset.h5
deck strong resonance_curve '&pendulum drive_amplitude = 0.5 /
  &sweep damping = 0.8, 1.2, drive_frequency_range = 0.5, 1.1 / &ensemble members = 8 /'
deck response response "$p / &sweep damping = 0.3, 0.5, drive_period_range = 5, 9, 5 / $e"
deck drives resonance_curve "&pendulum damping = 0.3 / &sweep drive_amplitude = 0.1, 0.2, 0.3 / $e"
deck lines response "&pendulum damping = 0.3 /
  &sweep drive_amplitude = 0.1, 0.2, drive_period_range = 5, 9, 3 / $e"
deck along response "&pendulum damping = 0.3 / &sweep drive_amplitude = 0.1, 0.2, drive_period = 7 / $e"
deck noisy response "$p / &sweep damping = 0.5, drive_period = 6, 7, temperature = 0, 0.01 / $e"
deck volume response "&sweep drive_amplitude_range = 0.1, 0.2, 2, damping = 0.3, 0.5,
  drive_frequency_range = 0.7, 1.1, 3, resolution = 2 / $e"
deck orbit orbit "$p, damping = 0.2, drive_frequency = 0.8 / &orbit x = 1.0, v = 0.0 /"
deck one orbit "$p, damping = 0.2, drive_frequency = 0.8 / &orbit x = 1.0, v = 0.0, samples = 1 /"
deck basins basins "$p, damping = 0.12, drive_period = 8 /
  &sweep x_range = -1.5, 4.5, 24, v_range = -2, 2, 16 /"
deck lone basins '&pendulum drive_amplitude = 1, damping = 0.1, drive_frequency = 1 /
  &sweep x_range = -1.5, 4.5, 8, v_range = -2, 2, 6 /'
grep -q "basins.by = 'well'" lone.txt || { echo "no word of wells"; exit 1; }
deck line phase_diagram "$p / &sweep damping = 0.2, drive_frequency_range = 0.7, 0.9, 5 / $e"
deck plane phase_diagram "$p / &sweep damping = 0.2, 0.3, drive_frequency = 0.7, 0.8, 0.9 / $e"
deck section orbit '&pendulum drive_amplitude = 0.2, damping = 0.0, drive_frequency = 0.8 /
  &orbit x = 1.0, transient = .true., periods = 300, samples = 4, spectrum = .true. /'
deck sweep hysteresis "$p, damping = 0.15 / &sweep drive_frequency_range = 0.75, 0.85, 5 /
  &hysteresis start = 'sa' /"
deck junction hysteresis "&pendulum drive_amplitude = 9, damping = 0.3, drive_frequency = 3 /
  &sweep torque_range = 1.88, 1.94, 4 / &hysteresis x = 1.6 /"
deck volts hysteresis "&units critical_current = '100 uA', resistance = '5 ohm',
  capacitance = '0.1 pF' / &pendulum drive_amplitude = '250 uA', drive_frequency = '200 GHz' /
  &sweep torque_range = '120 uA', '150 uA', 7 / &hysteresis x = 1.6, v = 1 /"
deck doubling bifurcation_diagram '&pendulum damping = 0.5, drive_frequency = 0.6666666666666666 /
  &sweep drive_amplitude_range = 1.04, 1.07, 4 / &bifurcation_diagram x = 1.6, strobes = 5 /'
deck points bifurcation_diagram '&pendulum damping = 0.5, drive_frequency = 0.6666666666666666 /
  &sweep drive_amplitude_range = 1.04, 1.07, 4 /
  &bifurcation_diagram x = 1.6, strobes = 5, attractors = F, bifurcations = F, exponents = F /'
deck map lyapunov_map '&pendulum damping = 0.5 / &precision tolerance = 1e-4 /
  &sweep drive_amplitude_range = 0.9, 1.5, 6, drive_frequency_range = 0.6, 0.7, 4 /'
deck away escape "$p, damping = 0.12, drive_period = 7.7 / &escape from = 'sa' /"
deck actions escape "&pendulum damping = 0.5, drive_amplitude = 0, drive_frequency = 1 /
  &sweep torque = 0.5, 0.8 / &escape x = 2.5 /"
deck rates switching "$p, damping = 0.12, drive_period = 7.7 / &sweep temperature = 0.02, 0.03 /
  &noise trajectories = 200, periods = 20 /"
deck branches branches "$p / &sweep damping = 0.2, drive_frequency_range = 0.7, 0.9, 5 / $e"
deck hertz branches "&units natural_frequency = 1.2e6 / $p / &sweep damping = 0.2, 0.3,
  drive_frequency_range = 0.7, 0.9, 5 / $e"
deck ramp hysteresis "$p, damping = 0.15, temperature = 1e-3 / &sweep
  drive_frequency_range = 0.83, 0.87, 9 / &hysteresis start = 'sa', rate = 5e-4 /
  &noise trajectories = 9 /"

# What is followed to infinity and what is named by numbers; a fit; starts and rates in SI.
deck escape switching "&pendulum force = 'polynomial', force_coefficients = 1, -1, damping = 0.1,
  drive_amplitude = 0.02, drive_frequency = 0.85 / &sweep temperature = 0.02, 0.03 /
  &switching from = 1 / &noise trajectories = 100, periods = 100 /"
deck fit fit "&pendulum force = 'polynomial', force_coefficients = 1, 0, 1 / &data file = '$top/input/fit.csv'
  columns = 'frequency', 'volts', 'error', 'direction', 'drive_amplitude=drive'
  observable = 'first_harmonic_amplitude' /
  &fit free = 'damping', 'frequency_scale', 'drive_scale', 'amplitude_scale', 'offset' /"
beam="&units mass = '1e-18 kg', natural_frequency = '10 MHz' / &pendulum force = 'polynomial',
  force_coefficients = 1, 0, '4e12 N/m^3', damping = 'Q 100', drive_amplitude = '0.356 pN',
  drive_frequency = '10.21 MHz' /"
deck kelvin switching "$beam &sweep temperature = '300 K', '350 K' /
  &noise trajectories = 100, periods = 1000 /"
deck metres basins "$beam &sweep x_range = '-9 nm', '9 nm', 8, v_range = '-1 m/s', '1 m/s', 6 /"

plot() { "$python" -W error::UserWarning "$top/plots/plot.py" "$@" >out 2>err; }
# An outer axis is curves or shares in one picture; of other kinds a picture a value.
outer='&outer key = "drive_amplitude", values = 0.1, 0.2, 0.3'
deck outer_response response "&pendulum damping = 0.2 / &sweep drive_frequency = 0.7, 0.8, 0.9 / $e $outer /"
deck outer_curve resonance_curve "&sweep damping = 0.2, 0.3 / $e $outer /"
deck outer_branches branches "&pendulum damping = 0.15 / &sweep drive_frequency = 0.7, 0.8, 0.9 / $e $outer /"
deck outer_sweep hysteresis "&pendulum damping = 0.15 / &sweep drive_frequency = 0.7, 0.8, 0.9 /
  &hysteresis start = 'sa' / $outer /"
deck outer_basins basins "&pendulum damping = 0.12, drive_period = 8 / &sweep x_range = -1.5, 4.7, 10,
  v_range = -2, 2, 10 / $outer /"
deck outer_orbit orbit "&pendulum damping = 0.12, drive_period = 8 / &orbit x = 0 / $outer /"
plot outer_orbit.h5 -o pictures || { cat err; exit 1; }
[ -s pictures/outer_orbit-3.png ] && [ "$(wc -l <out)" -eq 3 ] || { echo "not a picture a value"; exit 1; }
rm outer_orbit.h5
plot ./*.h5 -o pictures || { cat err; exit 1; }
plot ./*.h5 -o narrow -f svg --size 3.4,3 --unit 1.2MHz --frequency --no-boundary --ensemble --surface --no-title ||
  { cat err; exit 1; }
[ "$(wc -l <out)" -eq "$(ls ./*.h5 | wc -l)" ] || { echo "not all were drawn"; exit 1; }

# What cannot be drawn is a line, no traceback, and the others are drawn.
echo nonsense >broken.h5
plot missing.h5 broken.h5 free.h5 -o some && { echo "a missing file passed"; exit 1; }
[ "$(wc -l <err)" -eq 2 ] && [ -f some/free.png ] || { cat err; exit 1; }

"$python" "$top/tests/plots_axes.py" || exit 1
"$python" "$top/tests/plots_colours.py"
