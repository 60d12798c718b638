/* arena.h -- memory that is freed all at once: pointers stay valid until the arena closes. */
#ifndef AMBIT_ARENA_H
#define AMBIT_ARENA_H
#include <stddef.h>

typedef struct ambit_arena ambit_arena;

ambit_arena *ambit_arena_open(void);                          /* NULL: out of memory */
void ambit_arena_close(ambit_arena *arena);                   /* NULL is allowed */
void *ambit_arena_alloc(ambit_arena *arena, size_t bytes);    /* zeroed, 64-byte aligned; NULL: out of memory */
char *ambit_arena_text(ambit_arena *arena, const char *text); /* a copy */
size_t ambit_arena_bytes(const ambit_arena *arena);           /* handed out so far */
size_t ambit_arena_count(const ambit_arena *arena);           /* in so many pieces */
#endif
