/* numbers.h -- numbers that were chosen for blocks of lanes; all change the time, none a result. */
#ifndef PENDRES_ENGINE_SUNDIALS_NUMBERS_H
#define PENDRES_ENGINE_SUNDIALS_NUMBERS_H

enum {
  /*
   * Lanes of a strip: few enough for the 14 vectors of an order-8 step to share 32 KB, and no more
   * vectors of a state than the kernels keep in registers at once. Measured; twice or half as many
   * cost a few per cent.
   */
  LANES_OF_STATES = 80,
  LANES_OF_TANGENTS = 48,
  LANES_OF_MORE = 24
};

#endif
