/* arena.c -- a chain of blocks; an allocation is a bump of the newest block's fill mark. */
#include <ambit/arena.h>
#include "base/memory.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define ALIGNMENT 64u
#define FIRST_BLOCK 4096u
#define LARGEST_BLOCK (1u << 20)

typedef struct block {
  struct block *older;
  size_t size, used;
} block;

struct ambit_arena {
  block *newest;
  size_t next_size, total, count;
};

static size_t round_up(size_t bytes) { return (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT; }
static const size_t header = (sizeof(block) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;

ambit_arena *ambit_arena_open(void) {
  ambit_arena *arena = calloc(1, sizeof *arena);
  if (arena) arena->next_size = FIRST_BLOCK;
  return arena;
}

void ambit_arena_close(ambit_arena *arena) {
  if (!arena) return;
  for (block *b = arena->newest; b;) {
    block *older = b->older;
    free(b);
    b = older;
  }
  free(arena);
}

static block *add_block(ambit_arena *arena, size_t bytes) {
  size_t size = arena->next_size;
  if (size < bytes) size = bytes;
  if (size > SIZE_MAX / 2 - header || !ambit_memory_allows(header + size)) return NULL;
  block *b = aligned_alloc(ALIGNMENT, header + size);
  if (!b) return NULL;
  *b = (block) { arena->newest, size, 0 };
  memset((char *)b + header, 0, size);
  arena->newest = b;
  if (arena->next_size < LARGEST_BLOCK) arena->next_size *= 2;
  return b;
}

void *ambit_arena_alloc(ambit_arena *arena, size_t bytes) {
  if (bytes > SIZE_MAX / 4) return NULL;
  bytes = round_up(bytes ? bytes : 1);
  block *b = arena->newest;
  if (!b || b->size - b->used < bytes) b = add_block(arena, bytes);
  if (!b) return NULL;
  void *place = (char *)b + header + b->used;
  b->used += bytes;
  arena->total += bytes;
  arena->count++;
  return place;
}

char *ambit_arena_text(ambit_arena *arena, const char *text) {
  size_t bytes = strlen(text) + 1;
  char *copy = ambit_arena_alloc(arena, bytes);
  return copy ? memcpy(copy, text, bytes) : NULL;
}

size_t ambit_arena_bytes(const ambit_arena *arena) { return arena->total; }
size_t ambit_arena_count(const ambit_arena *arena) { return arena->count; }
