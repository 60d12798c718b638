/* interpreter.h -- runs tapes in any arithmetic; fills in what a plugin leaves out. */
#ifndef AMBIT_INTERPRETER_H
#define AMBIT_INTERPRETER_H
#include <ambit/status.h>
#include <ambit/interval.h>
#include <ambit/arithmetic.h>

/* full := the plugin's struct with every NULL run[] replaced by the kernel's "hull, interval function, set". INVALID
** if a required function is missing. */
ambit_status ambit_arithmetic_complete(const ambit_arithmetic *plugin, ambit_arithmetic *full, ambit_failure *f);

/* The flags with which tapes for a completed arithmetic are sealed: KEEP if it reads constants, and functions written
** in other operations if it leaves them out. */
uint32_t ambit_arithmetic_seal(const ambit_arithmetic *full);

typedef struct ambit_block ambit_block; /* slots x lanes of elements for one tape and one context */
ambit_status ambit_block_open(
    const ambit_tape *t, const ambit_arithmetic *full, void *ctx, size_t lanes, ambit_block **block, ambit_failure *f);
void ambit_block_close(ambit_block *block);
/* input number `in`, lane `lane`; var >= 0: an independent variable */
void ambit_block_set(ambit_block *block, uint32_t in, size_t lane, ambit_interval x, int32_t var);
uint32_t ambit_block_run(ambit_block *block); /* no allocation; AMBIT_F_* over all lanes */
/* Bounds that mean something; what is no enclosure is noted (ambit_bounds_check) and becomes the entire line. */
/* Again, operation by operation: flags [ninstr] of each, over all lanes. Slow. */
void ambit_block_run_each(ambit_block *block, uint32_t *flags);
ambit_interval ambit_block_get(const ambit_block *block, uint32_t out, size_t lane);
void *ambit_block_base(ambit_block *block, size_t *pitch);
#endif
