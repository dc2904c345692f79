/* numbers.h -- numbers that were chosen for what is refused, each with its reason. */
#ifndef RESULTS_NUMBERS_H
#define RESULTS_NUMBERS_H

/* Where a weakly damped pendulum is driven no harder than this, in its units, hardly any start is
   in chaos, and the library's charts of the strobe map save nine tenths of the steps: 64 states
   took 17 s at most at a damping of 1e-6, and six minutes at a drive of 0.2. */
static const double charted_drive = 0.02, charted_share = 0.1;

/* A drive of so many natural frequencies is rather a slip: mHz for MHz. */
static const double far_above = 1e4;

#endif
