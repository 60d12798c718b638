/* table.c -- the descriptions by opcode: one row of AMBIT_FUNCTIONS each, and no other list. */
#include "num/function.h"

#define AMBIT_X(name, arity, symbol) extern const ambit_described ambit_function_##symbol;
AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X

const ambit_described *ambit_function_of(uint32_t op) {
  static const ambit_described *const table[] = {
#define AMBIT_X(name, arity, symbol) &ambit_function_##symbol,
    AMBIT_FUNCTIONS(AMBIT_X)
#undef AMBIT_X
  };
  return ambit_op_is_function(op) ? table[op - AMBIT_OP_FUNCTIONS] : NULL;
}
