/* records.h -- JSON lines: one object a line, flushed as it is written, so that what is there stays valid if the
** process dies.
**
** Every object has "record" ("provenance", "plugin", "step", "event", "value", "root", "term", "note",
** "result"); times and enclosures are
** [lo, hi] doubles that round-trip exactly; infinite bounds are the strings "inf", "-inf"; an empty enclosure is [].
** A failed write (full disk) is reported once and stops the run.
*/
#ifndef AMBIT_RECORDS_H
#define AMBIT_RECORDS_H
#include <ambit/status.h>
#include <ambit/interval.h>
#include <ambit/solver.h>
#include <stdbool.h>
#include <stdio.h>

typedef struct ambit_records ambit_records;
ambit_status ambit_records_open(const char *path, ambit_records **r, ambit_failure *f); /* "-": stdout */
/* STOPPED if a write failed, now or earlier */
ambit_status ambit_records_close(ambit_records *r, ambit_failure *f);

/* Bytes that were written. */
uint64_t ambit_records_length(const ambit_records *r);
/* The file, between two lines; -1: a line is being written, or one could not be. Safe in a signal handler. */
int ambit_records_idle_file(const ambit_records *r);

/* `before` is called at the beginning of each line and may write lines of its own: of what the line rests on. If it
** fails, the line is not written, and no other. */
void ambit_records_watch(ambit_records *r, ambit_status (*before)(void *user, ambit_failure *f), void *user);

/* Building one line: begin, any fields, end. Keys in a begin/end pair; `end` writes and flushes. No allocation
** after the first lines. */
void ambit_records_begin(ambit_records *r, const char *kind);
void ambit_records_text(ambit_records *r, const char *key, const char *value);
void ambit_records_number(ambit_records *r, const char *key, double value);
void ambit_records_flag(ambit_records *r, const char *key, bool value);
void ambit_records_interval(ambit_records *r, const char *key, ambit_interval value);
void ambit_records_open_object(ambit_records *r, const char *key);
void ambit_records_close_object(ambit_records *r);
ambit_status ambit_records_end(ambit_records *r, ambit_failure *f);
/* The times of solvers' records are those of a clock: `shift` is added to them. */
void ambit_records_shift(ambit_records *r, ambit_interval shift);
/* From hold on lines wait, but for those that `before` writes; release writes those that waited, or drops them. What is
** tried, and may not be taken, leaves no trace so. */
void ambit_records_hold(ambit_records *r);
ambit_status ambit_records_release(ambit_records *r, bool keep, ambit_failure *f);
/* what a solver emits: a step, an event or a root; name [nx] */
ambit_status ambit_records_solver(
    ambit_records *r, const ambit_record *record, const char *const *name, ambit_failure *f);
#endif
