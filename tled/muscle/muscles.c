#include "tled/muscle/muscles.h"

#include "base/chars.h"
#include "base/mem.h"
#include "base/near.h"
#include "base/num.h"
#include "model/muscle_name.h"

#include <stdlib.h>
#include <string.h>

void muscles_free(muscle_list *l)
{
    free(l->volume);
    *l = (muscle_list){0};
}

int muscles_level(const char *text, double *level)
{
    return num_double(text, level) || *level < 0 || *level > 1 ? -1 : 0;
}

static int unknown(const model_array *names, const model_array *muscle, const char *word, const char *place,
                   int64_t line, err *e)
{
    const char **list = mem_array(names->rows, sizeof *list, "names", e);
    if (!list)
        return -1;
    int count = 0;
    const bool whole = muscle_name_short(word) != word;
    for (int64_t i = 0; i < names->rows && count < INT32_MAX; i++)
        if (muscle->u8[i])
            list[count++] = whole ? names->str[i] : muscle_name_short(names->str[i]);
    if (line)
        near_unknown(e, place, line, "muscle", word, list, count);
    else
        near_option(e, place, "muscle", word, list, count);
    free(list);
    return -1;
}

/* The one of that name: the long ones first. */
static int64_t find_one(const model_array *names, const model_array *muscle, const char *word)
{
    for (int64_t i = 0; i < names->rows; i++)
        if (muscle->u8[i] && chars_mean(word, names->str[i]))
            return i;
    for (int64_t i = 0; i < names->rows; i++)
        if (muscle->u8[i] && chars_mean(word, muscle_name_short(names->str[i])))
            return i;
    return -1;
}

static int add(muscle_list *to, int64_t volume, err *e)
{
    if (MEM_ROOM(&to->volume, &to->room, (int64_t)to->count + 1, "muscles", e))
        return -1;
    to->volume[to->count++] = (int32_t)volume;
    return 0;
}

static bool begins(const char *name, const char *word, size_t length)
{
    return chars_means(word, length, name, strlen(name), CHARS_BEGINS);
}

/* Those whose name, long or short, begins as the word does before its '*'. */
static int find_many(muscle_list *to, const model_array *names, const model_array *muscle, const char *word, err *e)
{
    const size_t length = strlen(word) - 1;
    for (int64_t i = 0; i < names->rows; i++) {
        const char *name = names->str[i];
        const bool is = begins(name, word, length) || begins(muscle_name_short(name), word, length);
        if (muscle->u8[i] && is && add(to, i, e))
            return -1;
    }
    return 0;
}

int muscles_named(muscle_list *to, const model *m, const char *word, const char *place, int64_t line, err *e)
{
    const model_array *names = model_need(m, "volume.name", e), *muscle = model_need(m, "volume.muscle", e);
    to->count = 0;
    if (!names || !muscle)
        return -1;
    const int64_t one = find_one(names, muscle, word);
    if (one >= 0)
        return add(to, one, e);
    if (*word && word[strlen(word) - 1] == '*' && find_many(to, names, muscle, word, e))
        return -1;
    return to->count ? 0 : unknown(names, muscle, word, place, line, e);
}
