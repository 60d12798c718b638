/* arena.h -- memory that is freed all at once: pointers stay valid until the arena closes. */
#ifndef AMBIT_ARENA_H
#define AMBIT_ARENA_H
#include <ambit/base.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_arena ambit_arena;

AMBIT_EXPORT ambit_arena *ambit_arena_open(void);        /* NULL: out of memory */
AMBIT_EXPORT void ambit_arena_close(ambit_arena *arena); /* NULL is allowed */
AMBIT_EXPORT void *ambit_arena_alloc(
    ambit_arena *arena, size_t bytes); /* zeroed, 64-byte aligned; NULL: out of memory */
AMBIT_EXPORT char *ambit_arena_text(ambit_arena *arena, const char *text); /* a copy */
AMBIT_EXPORT size_t ambit_arena_bytes(const ambit_arena *arena);           /* handed out so far */
AMBIT_EXPORT size_t ambit_arena_count(const ambit_arena *arena);           /* in so many pieces */

#ifdef __cplusplus
}
#endif
#endif
