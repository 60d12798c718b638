/* dimension.c -- dimensions under operations, and their names. */
#include "models/dimension.h"
#include "num/function.h"
#include <stdio.h>
#include <string.h>

static const ambit_dimension bare = { .state = AMBIT_DIMENSION_BARE };
static const ambit_dimension open_dimension = { .state = AMBIT_DIMENSION_OPEN };
static const ambit_dimension soft_number = { .state = AMBIT_DIMENSION_SOFT };
static const ambit_dimension number = { .state = AMBIT_DIMENSION_KNOWN };

ambit_dimension ambit_dimension_known(const int16_t power[AMBIT_DIMENSIONS]) {
  ambit_dimension d = number;
  memcpy(d.power, power, sizeof d.power);
  return d;
}

static bool is(ambit_dimension a, uint8_t state) { return a.state == state; }
static bool is_known(ambit_dimension a) { return is(a, AMBIT_DIMENSION_KNOWN); }
static bool is_open(ambit_dimension a) { return is(a, AMBIT_DIMENSION_OPEN); }
static bool is_bare(ambit_dimension a) { return is(a, AMBIT_DIMENSION_BARE); }
static bool same_power(ambit_dimension a, ambit_dimension b) { return memcmp(a.power, b.power, sizeof a.power) == 0; }
static bool is_plain_number(ambit_dimension a) { return !is_open(a) && !a.of_state && same_power(a, number); }

bool ambit_dimension_agree(ambit_dimension a, ambit_dimension b) {
  return !is_known(a) || !is_known(b) || same_power(a, b);
}

bool ambit_dimension_is_number(ambit_dimension a) { return !is_known(a) || a.mixed || same_power(a, number); }

static bool sum(ambit_dimension a, ambit_dimension b, ambit_dimension *out) {
  bool agree = ambit_dimension_agree(a, b);
  if (is_open(a) || is_open(b)) {
    *out = open_dimension;
  } else if (is_known(a) || is_known(b)) {
    *out = is_known(a) ? a : b;
    out->mixed = !is_known(a) || !is_known(b) || a.mixed || b.mixed;
  } else if (is_bare(a) || is_bare(b)) {
    ambit_dimension other = is_bare(a) ? b : a; /* 3 + cos a may be a coefficient with a unit */
    *out = is_plain_number(other) ? bare : other;
  } else {
    *out = same_power(a, b) ? a : open_dimension;
  }
  out->of_state = !is_open(*out) && (a.of_state || b.of_state);
  return agree;
}

static ambit_dimension product(ambit_dimension a, ambit_dimension b, int sign) {
  if (is_open(a) || is_open(b)) return open_dimension;
  if (is_bare(a) && is_bare(b)) return bare;
  if (is_bare(a) || is_bare(b)) {
    ambit_dimension other = is_bare(a) ? b : a;
    if (other.of_state) return open_dimension;
    if (is_plain_number(other)) return bare; /* 2 pi is as bare as 2 */
  }
  ambit_dimension out = is_known(b) || is_bare(a) ? b : a;
  if (is_known(a)) out = a;
  out.mixed = a.mixed || b.mixed;
  out.of_state = a.of_state || b.of_state;
  for (int i = 0; i < AMBIT_DIMENSIONS; i++) {
    int power = a.power[i] + sign * b.power[i]; /* a BARE one's is 0 */
    if (power > AMBIT_POWER_MAX || power < -AMBIT_POWER_MAX) return open_dimension;
    out.power[i] = (int16_t)power;
  }
  return out;
}

ambit_dimension ambit_dimension_power(ambit_dimension a, int64_t power) {
  for (int i = 0; i < AMBIT_DIMENSIONS; i++) {
    int64_t p = a.power[i] * power;
    if (p % AMBIT_POWER_ONE != 0) return open_dimension;
    p /= AMBIT_POWER_ONE;
    if (p > AMBIT_POWER_MAX || p < -AMBIT_POWER_MAX) return open_dimension;
    a.power[i] = (int16_t)p;
  }
  return a;
}

/* sin, exp and their like: of a number, and a number. */
static bool function(ambit_dimension a, ambit_dimension *out) {
  *out = is_known(a) && !a.mixed ? number : soft_number;
  out->of_state = is_known(*out) && a.of_state;
  return ambit_dimension_is_number(a);
}

/* The angle of a point: its coordinates have one dimension. */
static bool angle(ambit_dimension a, ambit_dimension b, ambit_dimension *out) {
  *out = is_known(a) || is_known(b) ? number : soft_number;
  out->of_state = is_known(*out) && (a.of_state || b.of_state);
  return ambit_dimension_agree(a, b);
}

static bool described(ambit_function_unit unit, ambit_dimension a, ambit_dimension b, ambit_dimension *out) {
  if (unit == AMBIT_FUNCTION_KEEPS) return sum(a, b, out);
  if (unit == AMBIT_FUNCTION_OF_NUMBERS) return function(a, out);
  *out = ambit_dimension_power(a, AMBIT_POWER_ONE / 3);
  return true;
}

bool ambit_dimension_op(uint32_t op, ambit_dimension a, ambit_dimension b, ambit_dimension *out) {
  switch (op) {
  case AMBIT_OP_ADD:
  case AMBIT_OP_SUB:
  case AMBIT_OP_MIN:
  case AMBIT_OP_MAX: return sum(a, b, out);
  case AMBIT_OP_NEG:
  case AMBIT_OP_ABS: *out = a; return true;
  case AMBIT_OP_MUL: *out = product(a, b, 1); return true;
  case AMBIT_OP_DIV: *out = product(a, b, -1); return true;
  case AMBIT_OP_SQR: *out = ambit_dimension_power(a, 2 * AMBIT_POWER_ONE); return true;
  case AMBIT_OP_SQRT: *out = ambit_dimension_power(a, AMBIT_POWER_ONE / 2); return true;
  case AMBIT_OP_ATAN2: return angle(a, b, out);
  default: return ambit_op_is_function(op) ? described(ambit_function_of(op)->unit, a, b, out) : function(a, out);
  }
}

/* -- texts */

static int common_divisor(int a, int b) {
  while (b) {
    int rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/* "", "^2", "^1.5", "^(1/3)" of a positive power in sixtieths */
static void power_text(int power, char out[16]) {
  int divisor = common_divisor(power, AMBIT_POWER_ONE), below = AMBIT_POWER_ONE / divisor;
  if (power == AMBIT_POWER_ONE)
    out[0] = '\0';
  else if (below % 3 == 0)
    snprintf(out, 16, "^(%d/%d)", power / divisor, below);
  else
    snprintf(out, 16, "^%.4g", (double)power / AMBIT_POWER_ONE);
}

void ambit_dimension_text(const int16_t power[AMBIT_DIMENSIONS], char out[AMBIT_DIMENSION_TEXT_MAX]) {
  static const char *const base[AMBIT_DIMENSIONS] = { "m", "kg", "s", "A", "K", "mol", "cd" };
  size_t used = 0;
  for (int sign = 1; sign >= -1; sign -= 2) {
    for (int i = 0; i < AMBIT_DIMENSIONS; i++) {
      char exponent[16];
      if (power[i] * sign <= 0) continue;
      const char *join = sign < 0 ? (used ? "/" : "1/") : used ? "*" : "";
      power_text(power[i] * sign, exponent);
      used += (size_t)snprintf(out + used, AMBIT_DIMENSION_TEXT_MAX - used, "%s%s%s", join, base[i], exponent);
    }
  }
  if (!used) snprintf(out, AMBIT_DIMENSION_TEXT_MAX, "1");
}

/* m kg s A K, in whole powers */
static const struct {
  int8_t power[5];
  const char *name, *unit;
} named[] = {
  { { 0, 0, 0, 0, 0 }, "a number or angle", "rad" },
  { { 1, 0, 0, 0, 0 }, "a length", "m" },
  { { 2, 0, 0, 0, 0 }, "an area", "m^2" },
  { { 3, 0, 0, 0, 0 }, "a volume", "m^3" },
  { { 0, 1, 0, 0, 0 }, "a mass", "kg" },
  { { 0, 0, 1, 0, 0 }, "a time", "s" },
  { { 0, 0, 0, 1, 0 }, "an electric current", "A" },
  { { 0, 0, 0, 0, 1 }, "a temperature", "K" },
  { { 1, 0, -1, 0, 0 }, "a speed", "m/s" },
  { { 1, 0, -2, 0, 0 }, "an acceleration", "m/s^2" },
  { { 0, 0, -1, 0, 0 }, "a frequency or angular speed", "rad/s" },
  { { 0, 0, -2, 0, 0 }, "an angular acceleration", "rad/s^2" },
  { { 1, 1, -2, 0, 0 }, "a force", "N" },
  { { 2, 1, -2, 0, 0 }, "a torque or energy", "N m" },
  { { 2, 1, -3, 0, 0 }, "a power", "W" },
  { { 1, 1, -1, 0, 0 }, "a momentum", "N s" },
  { { 2, 1, -1, 0, 0 }, "an angular momentum", "N m s" },
  { { -1, 1, -2, 0, 0 }, "a pressure", "Pa" },
  { { 2, 1, 0, 0, 0 }, "a moment of inertia", "kg m^2" },
  { { -3, 1, 0, 0, 0 }, "a density", "kg/m^3" },
  { { 0, 1, -2, 0, 0 }, "a stiffness", "N/m" },
  { { 0, 1, -1, 0, 0 }, "a damping", "N s/m" },
  { { 2, 1, -3, -1, 0 }, "a voltage", "V" },
  { { 2, 1, -3, -2, 0 }, "a resistance", "ohm" },
  { { 2, 1, -2, -2, 0 }, "an inductance", "H" },
  { { 0, 0, 1, 1, 0 }, "an electric charge", "C" },
  { { -2, -1, 4, 2, 0 }, "a capacitance", "F" },
  { { -2, -1, 3, 2, 0 }, "a conductance", "S" },
  { { 2, 1, -2, -1, 0 }, "a magnetic flux", "Wb" },
  { { 0, 1, -2, -1, 0 }, "a magnetic flux density", "T" },
};

void ambit_dimension_name(const int16_t power[AMBIT_DIMENSIONS], char out[AMBIT_DIMENSION_TEXT_MAX]) {
  char text[AMBIT_DIMENSION_TEXT_MAX];
  for (size_t k = 0; k < sizeof named / sizeof *named; k++) {
    bool same = power[5] == 0 && power[6] == 0;
    for (int i = 0; i < 5; i++) same = same && power[i] == named[k].power[i] * AMBIT_POWER_ONE;
    if (!same) continue;
    snprintf(out, AMBIT_DIMENSION_TEXT_MAX, "%s (%s)", named[k].name, named[k].unit);
    return;
  }
  ambit_dimension_text(power, text);
  snprintf(out, AMBIT_DIMENSION_TEXT_MAX, "a value in %.100s", text);
}
