/* starters.c -- decks that a laboratory begins with, ten lines in SI each; see deck_init(). */
#include "deck/table.h"

#include <string.h>

static const deck_starter starters[] = {
  { "resonator", "a resonator in SI: its response with the jumps",
    "&scene     kind = 'branches', title = 'A resonator of 1.2 MHz' /\n"
    "&units     mass = '1 ng', natural_frequency = '1.2 MHz' /\n"
    "! F = m x'' + c x' + k1 x + k2 x^2 + k3 x^3 ...: k1 = 1 is what mass and frequency make\n"
    "&pendulum  force = 'polynomial', force_coefficients = 1, 0, '1e14 N/m^3'\n"
    "           damping = 'Q 5000' /\n"
    "&sweep     drive_amplitude = '100 pN', '300 pN'\n"
    "           drive_frequency_range = '1.199 MHz', '1.206 MHz', 141 /\n"
    "! Starts whose states are looked for, about as far from rest as it swings.\n"
    "&ensemble  members = 8 /\n" },
  { "junction", "a Josephson junction in SI: current and voltage, up and down",
    "&scene      kind = 'hysteresis', title = 'A junction of 10 uA' /\n"
    "&units      critical_current = '10 uA', resistance = '10 ohm', capacitance = '0.5 pF' /\n"
    "! With microwaves: drive_amplitude = '5 uA', drive_frequency = '30 GHz'.\n"
    "&pendulum   drive_amplitude = 0, drive_frequency = 1 /\n"
    "&sweep      torque_range = '0 uA', '12 uA', 61 /\n"
    "! Without current the phase rests at x = pi/2.\n"
    "&hysteresis x = 1.6 /\n" },
  { "two_wells", "a resonator with two wells in SI: where each start ends",
    "&scene     kind = 'basins', title = 'A beam that is buckled' /\n"
    "! The wells are where k1 x + k3 x^3 = 0, here at +-707 nm.\n"
    "&units     mass = '1 ng' /\n"
    "&pendulum  force = 'polynomial', force_coefficients = '-50 N/m', 0, '1e14 N/m^3'\n"
    "           damping = '1 Mrad/s', drive_amplitude = '3.5 uN', drive_frequency = '1.2 MHz' /\n"
    "&sweep     x_range = '-1.4 um', '1.4 um', 200, v_range = '-6 m/s', '6 m/s', 200 /\n" },
};

const deck_starter *deck_starter_get(size_t k)
{
  return k < sizeof starters / sizeof *starters ? &starters[k] : NULL;
}

const deck_starter *deck_starter_find(const char *name)
{
  const deck_starter *s = NULL;
  for (size_t k = 0; (s = deck_starter_get(k)) != NULL && strcmp(s->name, name) != 0;) k++;
  return s;
}
