/* equations_lua.c -- the Lua module `equations` of the tests: solutions of x' = f(x, p, t), f a list of instructions,
** in extended precision, by Gragg's rule, extrapolated in the square of the step [Hairer, Norsett, Wanner, Solving
** Ordinary Differential Equations I, II.9]. A step that comes near a kink of abs, min or max is halved until the kink
** adds nothing that counts. Shares nothing with Ambit.
**
** equations.solve { n, p = { ... }, x = { ... }, code = { { "mul", 3, 4 }, ... }, out = { ... }, times = { ... },
**   tolerance [, steps = { [k] = { ... } }: other p up to times[k], k > 1] } returns the list of states at the times
**   (the first is where x is given), or nil. Slots count from 1: x, p, t, then instructions; { "number", c } is a
**   constant.
*/
#include <lauxlib.h>
#include <lua.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef long double real;
enum { STATES = 16, SLOTS = 600, TIMES = 5000, COLUMNS = 9, STEPS = 200000 };
#define NOTHING 1e-17L /* that a kink may add in a step */

static const char *const names[] = { "number", "add", "sub", "mul", "div", "neg", "sqr", "sqrt", "exp", "log", "sin",
  "cos", "tan", "atan", "atan2", "sinh", "cosh", "tanh", "abs", "min", "max", "asin", "acos", "log1p", "expm1", "asinh",
  "acosh", "atanh", "log2", "log10", "exp2", "cbrt", "hypot", "pow", NULL };
enum {
  NUMBER,
  ADD,
  SUB,
  MUL,
  DIV,
  NEG,
  SQR,
  SQRT,
  EXP,
  LOG,
  SIN,
  COS,
  TAN,
  ATAN,
  ATAN2,
  SINH,
  COSH,
  TANH,
  ABS,
  MIN,
  MAX,
  ASIN,
  ACOS,
  LOG1P,
  EXPM1,
  ASINH,
  ACOSH,
  ATANH,
  LOG2,
  LOG10,
  EXP2,
  CBRT,
  HYPOT,
  POW
};

typedef struct equations {
  int n, np, ncode, op[SLOTS], a[SLOTS], b[SLOTS], out[STATES];
  real constant[SLOTS], slot[SLOTS];
  /* of the operand of abs, or the difference of those of min and max, in the step that is tried: the value before, the
  ** least size, the largest change from one time to the next */
  real before[SLOTS], least[SLOTS], change[SLOTS];
  bool has_before;
} equations;

static real function(int op, real a) {
  switch (op) {
  case NEG: return -a;
  case SQR: return a * a;
  case SQRT: return sqrtl(a);
  case EXP: return expl(a);
  case LOG: return logl(a);
  case SIN: return sinl(a);
  case COS: return cosl(a);
  case TAN: return tanl(a);
  case ATAN: return atanl(a);
  case SINH: return sinhl(a);
  case COSH: return coshl(a);
  case TANH: return tanhl(a);
  case ASIN: return asinl(a);
  case ACOS: return acosl(a);
  case LOG1P: return log1pl(a);
  case EXPM1: return expm1l(a);
  case ASINH: return asinhl(a);
  case ACOSH: return acoshl(a);
  case ATANH: return atanhl(a);
  case LOG2: return log2l(a);
  case LOG10: return log10l(a);
  case EXP2: return exp2l(a);
  case CBRT: return cbrtl(a);
  default: return fabsl(a);
  }
}

static real value(const equations *e, int i) {
  real a = e->slot[e->a[i]], b = e->slot[e->b[i]];
  switch (e->op[i]) {
  case NUMBER: return e->constant[i];
  case ADD: return a + b;
  case SUB: return a - b;
  case MUL: return a * b;
  case DIV: return a / b;
  case ATAN2: return atan2l(a, b);
  case HYPOT: return hypotl(a, b);
  case POW: return powl(a, b);
  case MIN: return a < b ? a : b;
  case MAX: return a > b ? a : b;
  default: return function(e->op[i], a);
  }
}

static bool is_kinked(int op) { return op == ABS || op == MIN || op == MAX; }

static void watch(equations *e, int i) {
  real d = e->slot[e->a[i]] - (e->op[i] == ABS ? 0 : e->slot[e->b[i]]);
  e->least[i] = fminl(e->least[i], fabsl(d));
  if (e->has_before) e->change[i] = fmaxl(e->change[i], fabsl(d - e->before[i]));
  e->before[i] = d;
}

static bool is_near_kink(const equations *e, real h) {
  for (int i = 0; i < e->ncode; i++)
    if (is_kinked(e->op[i]) && e->least[i] < e->change[i] && e->change[i] * fabsl(h) > NOTHING) return true;
  return false;
}

static void rate(equations *e, real t, const real *x, real *f) {
  int first = e->n + e->np + 1;
  memcpy(e->slot, x, (size_t)e->n * sizeof(real));
  e->slot[e->n + e->np] = t;
  for (int i = 0; i < e->ncode; i++) {
    e->slot[first + i] = value(e, i);
    if (is_kinked(e->op[i])) watch(e, i);
  }
  e->has_before = true;
  for (int i = 0; i < e->n; i++) f[i] = e->slot[e->out[i]];
}

static void gragg(equations *e, real t, real h, int steps, const real *x, real *now) {
  real before[STATES], f[STATES], d = h / steps;
  memcpy(before, x, sizeof before);
  e->has_before = false;
  rate(e, t, x, f);
  for (int i = 0; i < e->n; i++) now[i] = x[i] + d * f[i];
  for (int k = 1; k < steps; k++) {
    rate(e, t + k * d, now, f);
    for (int i = 0; i < e->n; i++) {
      real next = before[i] + 2 * d * f[i];
      before[i] = now[i], now[i] = next;
    }
  }
}

/* x at t + h; the error relative to the tolerance */
static real extrapolate(equations *e, real t, real h, real tolerance, real *x) {
  real row[COLUMNS][STATES], now[STATES], old[STATES], previous[STATES], error = 0;
  for (int i = 0; i < e->ncode; i++) e->least[i] = HUGE_VALL, e->change[i] = 0;
  for (int k = 0; k < COLUMNS; k++) {
    gragg(e, t, h, 2 * (k + 1), x, now);
    for (int j = 0; j < k; j++) {
      real ratio = (real)(k + 1) / (real)(k - j);
      memcpy(old, row[j], sizeof old), memcpy(row[j], now, sizeof now);
      for (int i = 0; i < e->n; i++) now[i] += (now[i] - old[i]) / (ratio * ratio - 1);
    }
    if (k == COLUMNS - 1) memcpy(previous, row[k - 1], sizeof previous);
    memcpy(row[k], now, sizeof now);
  }
  for (int i = 0; i < e->n; i++) {
    real off = fabsl(now[i] - previous[i]) / (tolerance * (1 + fabsl(now[i])));
    if (!(off <= error)) error = off;
  }
  memcpy(x, now, sizeof now);
  return error;
}

static bool integrate(equations *e, real from, real to, real tolerance, real *x) {
  real t = from, h = (to - from) / 4, trial[STATES];
  for (int step = 0; step < STEPS && t != to; step++) {
    if (fabsl(h) > fabsl(to - t)) h = to - t;
    memcpy(trial, x, sizeof trial);
    real error = extrapolate(e, t, h, tolerance, trial);
    if (is_near_kink(e, h)) error = INFINITY;
    if (error <= 1) memcpy(x, trial, sizeof trial), t = h == to - t ? to : t + h;
    h *= error < 1e-4L ? 2 : error < 0.1L ? 1.25L : error <= 1 ? 1 : 0.5L; /* 0.02 may be rounding */
    if (fabsl(h) < 1e-9L) return false;
  }
  return t == to;
}

/* -- Lua */

static int list(lua_State *L, const char *key, real *to, int room) {
  luaL_argcheck(L, lua_getfield(L, 1, key) == LUA_TTABLE, 1, key);
  int n = (int)luaL_len(L, -1);
  luaL_argcheck(L, n <= room, 1, key);
  for (int i = 0; i < n; i++) {
    lua_geti(L, -1, i + 1);
    to[i] = luaL_checknumber(L, -1);
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
  return n;
}

static int operand(lua_State *L, int at, int most) {
  lua_geti(L, -1, at);
  int slot = (int)luaL_optinteger(L, -1, 1) - 1;
  luaL_argcheck(L, slot >= 0 && slot < most, 1, "an operand comes later");
  lua_pop(L, 1);
  return slot;
}

static void read_code(lua_State *L, equations *e) {
  lua_getfield(L, 1, "code");
  e->ncode = (int)luaL_len(L, -1);
  int first = e->n + e->np + 1;
  luaL_argcheck(L, first + e->ncode <= SLOTS, 1, "code");
  for (int i = 0; i < e->ncode; i++) {
    lua_geti(L, -1, i + 1);
    lua_geti(L, -1, 1);
    e->op[i] = luaL_checkoption(L, -1, NULL, names);
    lua_pop(L, 1);
    if (e->op[i] == NUMBER) {
      lua_geti(L, -1, 2);
      e->constant[i] = luaL_checknumber(L, -1);
      lua_pop(L, 1);
    } else
      e->a[i] = operand(L, 2, first + i), e->b[i] = operand(L, 3, first + i);
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
}

/* p up to times[k], if it is another one there */
static void take_step(lua_State *L, equations *e, int k) {
  lua_getfield(L, 1, "steps");
  if (!lua_isnil(L, -1)) {
    lua_geti(L, -1, k + 1);
    for (int i = 0; i < e->np; i++) {
      lua_geti(L, -1, i + 1);
      e->slot[e->n + i] = luaL_checknumber(L, -1);
      lua_pop(L, 1);
    }
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
}

static int solve(lua_State *L) {
  static equations e;
  static real times[TIMES];
  real x[STATES] = { 0 }, out[STATES];
  memset(&e, 0, sizeof e);
  e.n = list(L, "x", x, STATES);
  e.np = list(L, "p", e.slot + e.n, SLOTS / 2);
  read_code(L, &e);
  luaL_argcheck(L, list(L, "out", out, STATES) == e.n, 1, "out");
  for (int i = 0; i < e.n; i++) e.out[i] = (int)out[i] - 1;
  int count = list(L, "times", times, TIMES);
  lua_getfield(L, 1, "tolerance");
  real tolerance = luaL_optnumber(L, -1, 1e-17);
  lua_newtable(L);
  for (int k = 0; k < count; k++) {
    if (k > 0) take_step(L, &e, k);
    if (k > 0 && !integrate(&e, times[k - 1], times[k], tolerance, x)) return lua_pushnil(L), 1;
    lua_newtable(L);
    for (int i = 0; i < e.n; i++) lua_pushnumber(L, (double)x[i]), lua_seti(L, -2, i + 1);
    lua_seti(L, -2, k + 1);
  }
  return 1;
}

int luaopen_equations(lua_State *L);
__attribute__((visibility("default"))) int luaopen_equations(lua_State *L) {
  lua_newtable(L);
  lua_pushcfunction(L, solve);
  lua_setfield(L, -2, "solve");
  return 1;
}
