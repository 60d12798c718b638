/* allocations.h -- a malloc that counts, and that can be told to abort. */
#ifndef AMBIT_TEST_ALLOCATIONS_H
#define AMBIT_TEST_ALLOCATIONS_H
#include <stddef.h>

size_t ambit_allocation_count(void);  /* by this thread so far */
void ambit_allocation_forbid(int on); /* this thread: an allocation prints what it is and aborts */
#endif
