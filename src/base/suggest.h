/* "Did you mean": the known word nearest to a mistyped one. */
#ifndef SF_BASE_SUGGEST_H
#define SF_BASE_SUGGEST_H

#include <stddef.h>

/* The candidate that the fewest edits (insert, delete, replace, swap of neighbours; a change of case costs nothing)
 * turn into `word`; the first of equals. NULL when none is within a third of the word's length (at least one edit), or
 * the word is empty or longer than 64 bytes. NULL candidates are passed over. The answer is one of the caller's
 * pointers. */
const char *sf_suggest(const char *word, const char *const *candidates, size_t n);

#endif
