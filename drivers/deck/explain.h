/*
 * explain.h -- what kinds of scenes and which keys there are, in words for readers.
 *
 * Owns: --list, --explain, --init and docs/decks.md, all from the table that the reader checks
 * decks by. Thread safe: no state outside the arguments.
 */
#ifndef DECK_EXPLAIN_H
#define DECK_EXPLAIN_H

#include "deck/deck.h"

/** All kinds with what they compute, a line each. */
void deck_list(FILE *out);

/**
 * Everything about a kind (all its keys), a group, or a key (`damping`, `damping_range`,
 * `pendulum.damping`): meaning, unit, default, range, scenes. A word that is none of these returns
 * PENDRES_INVALID_ARGUMENT, and `why`, of `size` bytes, says so with the nearest one that is.
 */
pendres_status deck_explain(const char *word, FILE *out, char *why, size_t size);

/** The same of all kinds and keys, as the page docs/decks.md. */
void deck_reference(FILE *out);

/**
 * A deck of that kind that runs, with a comment on every key: those that must be given have a
 * value, the others stand there with their defaults as comments. PENDRES_INVALID_ARGUMENT as above.
 */
pendres_status deck_init(const char *kind, FILE *out, char *why, size_t size);

#endif
