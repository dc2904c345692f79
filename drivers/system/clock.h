/*
 * clock.h -- the clocks of the system, in seconds. No state.
 */
#ifndef CLOCK_H
#define CLOCK_H

/* Since some time in the past, whatever becomes of the date. */
double clock_wall(void);

/* Of processor, that the calling thread has used; that all threads have. */
double clock_thread(void);
double clock_process(void);

#endif
