/* One table of words that have an American and a British spelling. The tools and the model format use the British one.
 * Command lines may use either: a word that is not known as typed is looked up once more in British spelling. Help,
 * completion and messages use the British one. Nothing is allocated.
 */
#ifndef SINEW_SPELLING_H
#define SINEW_SPELLING_H

#include <stdbool.h>
#include <stddef.h>

/* Copies the first n bytes of what was typed, with American words made British. A word is a run of letters. False, with
 * `to` undefined, if there is no such word or no room. */
bool spelling_british(const char *typed, size_t n, char *to, size_t size);

/* The American spelling of a British word, or NULL. */
const char *spelling_american(const char *word);

#endif
