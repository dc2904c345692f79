/*
 * clock.h -- the clocks of the system, in seconds. No state.
 */
#ifndef CLOCK_H
#define CLOCK_H

/* Since some time in the past, not affected by changes of the date. */
double clock_wall(void);

/* Processor time of the calling thread; of all threads. */
double clock_thread(void);
double clock_process(void);

#endif
