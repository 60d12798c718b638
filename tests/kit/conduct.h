/* conduct.h -- what no plugin may do, whatever its kind: the rules of <ambit/base.h> that hold for the whole ABI.
**
**   globals      its writable data stay as they were loaded: what a context needs lives in memory from `alloc`
**   environment  rounding mode, locale, environment variables, folder, umask, signal handlers stay as they were
**   leftovers    no thread runs on, no file stays open
**   allocations  counted for those who ask (calls of malloc and its relatives by the plugin's own object)
**
** What it prints is caught by the parent process (conformance_apart.c).
*/
#ifndef AMBIT_CONDUCT_H
#define AMBIT_CONDUCT_H
#include <stdbool.h>
#include <stddef.h>

typedef struct conduct conduct;

/* From now on the object that holds this address is watched; NULL: no memory. */
conduct *conduct_open(const void *address);
/* Judges what has happened since; returns how many rules were checked. The objects of the plugin are closed. */
size_t conduct_judge(conduct *c, void (*finding)(void *user, const char *rule, const char *message), void *user);
void conduct_close(conduct *c);

/* Allocations of this thread by watched objects so far. */
size_t conduct_allocations(void);
/* The control bits of the floating-point unit: rounding, flushing. */
unsigned conduct_floating(void);
#endif
