/* numbers.h -- numbers that were chosen for guesses of resonances on lines, with reasons. */
#ifndef PENDRES_LINE_NUMBERS_H
#define PENDRES_LINE_NUMBERS_H

enum {
  LINE_PLACES = 24, /* all over the data, at which it is looked for */
  LINE_ROUNDS = 30, /* of places in turn with what is far: each halves the distance or so */
  LINE_DELAYS = 8   /* tried on either side of the slope of the phase, over a turn of it within the
                       data, which a resonance adds */
};

/* From this share of the way from their middle to their ends on data are far from a resonance. */
static const double line_edge = 0.8;

/* A delay is told apart from another by this share of what is tried first: noise of some per cent
   moves it by more. */
static const double line_delay_fine = 1.0 / 64.0;

/* A resonance is seen where it lowers chi-square by more than this: four numbers of it at the best
   of some hundred places in noise do so in one set of data of ten thousand. */
static const double line_seen = 40.0;

#endif
