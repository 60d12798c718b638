/* rational.h -- "ambit.rational/1": rational numbers, exactly. The plugin service/rational.so is loaded for sampled
** systems, whose instants may be nearer than doubles tell, and not before.
*/
#ifndef AMBIT_RATIONAL_H
#define AMBIT_RATIONAL_H
#include "base.h"
#include "tape.h"

#define AMBIT_RATIONAL_SERVICE "ambit.rational/1"

typedef struct ambit_rational ambit_rational;

/* All [any], with numbers that no other thread has. */
typedef struct ambit_rational_service {
  uint32_t size;
  ambit_rational *(*open)(void); /* 0; NULL: no memory */
  void (*close)(ambit_rational *x);
  void (*set)(ambit_rational *x, double value); /* finite */
  /* "-12.5e-3", "1/3", "0.1/0.7"; 0: it is none of these, or has more digits than anybody writes, and x is anything */
  uint32_t (*read)(ambit_rational *x, const char *literal);
  /* x := x op b for NEG, ABS, SQR, ADD, SUB, MUL, DIV; POWN: x^n; 0: no such number or operation, or a number of too
  ** many digits, and x is anything */
  uint32_t (*apply)(ambit_rational *x, uint32_t op, const ambit_rational *b, int32_t n);
  void (*go)(ambit_rational *x, const ambit_rational *first, const ambit_rational *period, uint32_t k);
  int32_t (*compare)(const ambit_rational *a, const ambit_rational *b); /* -1, 0, 1 */
  /* the tightest doubles; *hi is infinite beyond the largest one */
  void (*enclose)(const ambit_rational *x, double *lo, double *hi);
} ambit_rational_service;
#endif
