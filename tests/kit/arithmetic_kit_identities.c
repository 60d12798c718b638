/* arithmetic_kit_identities.c -- inverses and functional equations.
**
** A program whose exact value is known for every x and y of its domain (x itself, y, or a constant) must give a set
** that holds all these values, whatever it loses on the way. Programs are written as a pocket calculator reads them.
*/
#include "kit/arithmetic_kit_inside.h"
#include <math.h>
#include <string.h>

typedef struct identity {
  const char *program;
  char is; /* 'x', 'y', or 'c': the number between lo and hi */
  double lo, hi;
  double x_lo, x_hi, y_lo, y_hi;
} identity;

#define PI_LO 0x1.921fb54442d18p+1
#define PI_HI 0x1.921fb54442d19p+1

static const identity identities[] = {
  /* inverses */
  { "x y - y +", 'x', 0, 0, -8, 8, -8, 8 },
  { "x y + x -", 'y', 0, 0, -8, 8, -8, 8 },
  { "x y * y /", 'x', 0, 0, -8, 8, 0.25, 8 },
  { "x y / y *", 'x', 0, 0, -8, 8, -8, -0.25 },
  { "x neg neg", 'x', 0, 0, -8, 8, 0, 1 },
  { "x sqr sqrt", 'x', 0, 0, 0, 8, 0, 1 },
  { "x sqrt sqr", 'x', 0, 0, 0, 8, 0, 1 },
  { "x exp log", 'x', 0, 0, -600, 600, 0, 1 },
  { "x log exp", 'x', 0, 0, 0x1p-40, 1e6, 0, 1 },
  { "x sin asin", 'x', 0, 0, -1.57, 1.57, 0, 1 },
  { "x asin sin", 'x', 0, 0, -1, 1, 0, 1 },
  { "x cos acos", 'x', 0, 0, 0, 3.14, 0, 1 },
  { "x acos cos", 'x', 0, 0, -1, 1, 0, 1 },
  { "x tan atan", 'x', 0, 0, -1.5, 1.5, 0, 1 },
  { "x atan tan", 'x', 0, 0, -8, 8, 0, 1 },
  { "x -1^ -1^", 'x', 0, 0, 0.125, 8, 0, 1 },
  { "x x -", 'c', 0, 0, -8, 8, 0, 1 },
  { "x x /", 'c', 1, 1, 0.25, 8, 0, 1 },
  { "x -1^ x *", 'c', 1, 1, 0.25, 8, 0, 1 },
  /* powers */
  { "x sqr x x * -", 'c', 0, 0, -8, 8, 0, 1 },
  { "x 3^ x sqr x * -", 'c', 0, 0, -8, 8, 0, 1 },
  { "x 0^", 'c', 1, 1, -8, 8, 0, 1 },
  { "x 5^ x -3^ * x sqr -", 'c', 0, 0, 0.25, 8, 0, 1 },
  { "x y * sqrt x sqrt y sqrt * -", 'c', 0, 0, 0, 8, 0, 8 },
  { "x y + sqr x sqr - y sqr - 2 x * y * -", 'c', 0, 0, -8, 8, -8, 8 },
  { "x y + x * x sqr x y * + -", 'c', 0, 0, -8, 8, -8, 8 },
  /* exponentials */
  { "x exp x neg exp *", 'c', 1, 1, -300, 300, 0, 1 },
  { "x y + exp x exp y exp * -", 'c', 0, 0, -8, 8, -8, 8 },
  { "x y * log x log - y log -", 'c', 0, 0, 0x1p-20, 1e6, 0x1p-20, 1e6 },
  { "x sinh x exp x neg exp - 2 / -", 'c', 0, 0, -8, 8, 0, 1 },
  { "x cosh x exp x neg exp + 2 / -", 'c', 0, 0, -8, 8, 0, 1 },
  { "x cosh sqr x sinh sqr -", 'c', 1, 1, -8, 8, 0, 1 },
  { "x tanh x sinh x cosh / -", 'c', 0, 0, -8, 8, 0, 1 },
  /* circular functions */
  { "x sin sqr x cos sqr +", 'c', 1, 1, -1e4, 1e4, 0, 1 },
  { "x tan x sin x cos / -", 'c', 0, 0, -1.5, 1.5, 0, 1 },
  { "x y + sin x sin y cos * - x cos y sin * -", 'c', 0, 0, -8, 8, -8, 8 },
  { "x y + cos x cos y cos * - x sin y sin * +", 'c', 0, 0, -8, 8, -8, 8 },
  { "x pi + sin x sin +", 'c', 0, 0, -100, 100, 0, 1 },
  { "pi 2 / x - cos x sin -", 'c', 0, 0, -100, 100, 0, 1 },
  { "x asin x acos +", 'c', PI_LO / 2, PI_HI / 2, -1, 1, 0, 1 },
  { "x atan x -1^ atan +", 'c', PI_LO / 2, PI_HI / 2, 0.25, 8, 0, 1 },
  { "x asin sin x -", 'c', 0, 0, -1, 1, 0, 1 },
  /* the quadrants of atan2 (y = first operand, x = second) */
  { "y x atan2 y x / atan -", 'c', 0, 0, 0.25, 8, -8, 8 },
  { "y x atan2 y x / atan - pi -", 'c', 0, 0, -8, -0.25, 0.25, 8 },
  { "y x atan2 y x / atan - pi +", 'c', 0, 0, -8, -0.25, -8, -0.25 },
  { "y x atan2 x y / atan + pi 2 / -", 'c', 0, 0, -8, 8, 0.25, 8 },
  { "y x atan2 x y / atan + pi 2 / +", 'c', 0, 0, -8, 8, -8, -0.25 },
  { "y x atan2 sin x sqr y sqr + sqrt *", 'y', 0, 0, -8, 8, 0.25, 8 },
  { "y x atan2 cos x sqr y sqr + sqrt *", 'x', 0, 0, -8, 8, -8, -0.25 },
  /* choices */
  { "x y min x y max + x -", 'y', 0, 0, -8, 8, -8, 8 },
  { "x abs x neg x max -", 'c', 0, 0, -8, 8, 0, 1 },
  { "x y max x y - abs x + y + 2 / -", 'c', 0, 0, -8, 8, -8, 8 },
  { "x y min x y - abs x y + - 2 / +", 'c', 0, 0, -8, 8, -8, 8 },
};

static const struct {
  const char *word;
  uint32_t op;
} words[] = { { "+", AMBIT_OP_ADD }, { "-", AMBIT_OP_SUB }, { "neg", AMBIT_OP_NEG }, { "*", AMBIT_OP_MUL },
  { "sqr", AMBIT_OP_SQR }, { "/", AMBIT_OP_DIV }, { "sqrt", AMBIT_OP_SQRT }, { "exp", AMBIT_OP_EXP },
  { "log", AMBIT_OP_LOG }, { "sin", AMBIT_OP_SIN }, { "cos", AMBIT_OP_COS }, { "tan", AMBIT_OP_TAN },
  { "asin", AMBIT_OP_ASIN }, { "acos", AMBIT_OP_ACOS }, { "atan", AMBIT_OP_ATAN }, { "atan2", AMBIT_OP_ATAN2 },
  { "sinh", AMBIT_OP_SINH }, { "cosh", AMBIT_OP_COSH }, { "tanh", AMBIT_OP_TANH }, { "abs", AMBIT_OP_ABS },
  { "min", AMBIT_OP_MIN }, { "max", AMBIT_OP_MAX } };

enum { X, Y, PI, TWO, FIRST, LANES = 3 };

static uint32_t op_of(const char *word, size_t length) {
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    if (strlen(words[i].word) == length && strncmp(words[i].word, word, length) == 0) return words[i].op;
  return AMBIT_OP_POWN;
}

static int32_t exponent_of(const char *word) {
  int32_t sign = *word == '-' ? -1 : 1, n = 0;
  for (word += sign < 0; *word != '^'; word++) n = 10 * n + (*word - '0');
  return sign * n;
}

/* the slot of the result */
static uint32_t compute(kit_state *s, const char *program) {
  uint32_t stack[8], depth = 0, next = FIRST;
  for (const char *word = program; *word;) {
    size_t length = strcspn(word, " ");
    if (length == 1 && *word >= 'x')
      stack[depth++] = *word == 'x' ? X : Y;
    else if (length == 1 && *word == '2')
      stack[depth++] = TWO;
    else if (length == 2 && *word == 'p')
      stack[depth++] = PI;
    else {
      uint32_t op = op_of(word, length), right = stack[--depth];
      uint32_t left = kit_op_arity[op] == 2 ? stack[--depth] : right;
      kit_apply(s, op, next, left, op == AMBIT_OP_POWN ? (uint32_t)exponent_of(word) : right, LANES);
      stack[depth++] = next++;
    }
    word += length + (word[length] == ' ');
  }
  return stack[0];
}

static kit_set wanted(const identity *e, kit_set x, kit_set y) {
  return e->is == 'x' ? x : e->is == 'y' ? y : (kit_set) { e->lo, e->hi };
}

static void check_identity(kit_state *s, const identity *e) {
  kit_set x[LANES], y[LANES];
  for (size_t l = 0; l < LANES; l++) {
    x[l] = kit_set_within(s, e->x_lo, e->x_hi), y[l] = kit_set_within(s, e->y_lo, e->y_hi);
    if (!s->rigorous) x[l].hi = x[l].lo, y[l].hi = y[l].lo;
    bool variables = kit_random(s) % 2;
    kit_set_variable(s, X, l, x[l], variables ? 0 : -1), kit_set_variable(s, Y, l, y[l], variables ? 1 : -1);
    kit_set_element(s, PI, l, (kit_set) { PI_LO, PI_HI }), kit_set_element(s, TWO, l, (kit_set) { 2, 2 });
  }
  uint32_t result = compute(s, e->program);
  for (size_t l = 0; l < LANES; l++) {
    kit_set r = kit_bounds_of(s, result, l), want = wanted(e, x[l], y[l]);
    double room = s->rigorous ? 0 : 1e-4 * (1 + fabs(want.lo)); /* exp(8)^2 loses 8 digits */
    s->judged++;
    if (!(r.lo <= want.lo + room && want.hi - room <= r.hi))
      kit_find(s, "identity", "%s with x in [%a, %a], y in [%a, %a] is [%a, %a], which does not hold [%a, %a] (%s)",
          e->program, x[l].lo, x[l].hi, y[l].lo, y[l].hi, r.lo, r.hi, want.lo, want.hi, s->environment->name);
  }
}

void kit_check_identities(kit_state *s) {
  for (int round = 0; kit_more(s, round, 60); round++)
    for (size_t i = 0; i < sizeof identities / sizeof *identities; i++) check_identity(s, &identities[i]);
}
