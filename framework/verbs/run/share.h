/* share.h -- which equations an instruction of a tape is for: by this a profile divides what opcodes cost.
**
** An instruction that one equation alone reaches is its own; one that k of them reach is shared, and each bears the
** k-th part. What all bear together is the whole tape.
*/
#ifndef AMBIT_SHARE_H
#define AMBIT_SHARE_H
#include <ambit/tape.h>

/* While a profile is taken: a table for the tape with a row for each of the n equations, of which each has nout / n
** outputs in a row; name [n], or NULL: numbers. Columns: by opcode, instructions of its own; by opcode, its part of
** all; then, by equation, instructions that both reach. t may be NULL. Without memory there is no table. */
void ambit_share_note(const ambit_tape *t, const char *title, uint32_t n, const char *const *name);
#endif
