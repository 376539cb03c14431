/* One table of words that have an American and a British spelling. The tools and the model format have the British one; command
 * lines may have either: what is typed and not known as it stands is looked up once more in the British spelling. Help, completion
 * and messages have the British one alone. Nothing is allocated.
 */
#ifndef SINEW_SPELLING_H
#define SINEW_SPELLING_H

#include <stdbool.h>
#include <stddef.h>

/* Writes the first n bytes of what was typed with its American words made British; a word is what stands between characters that are no
 * letters. False, and nothing of use written, where there is no such word or no room. */
bool spelling_british(const char *typed, size_t n, char *to, size_t size);

/* The American spelling of a British word, or NULL. */
const char *spelling_american(const char *word);

#endif
