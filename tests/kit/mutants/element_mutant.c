/* element_mutant.c -- elements with one fault: a shipped element whose formula of one quantity is spoilt. */
#include "kit/mutants/mutant.h"
#include "kit/mutants/mutant_conduct.h"
#include <ambit/element.h>

enum { ANY = 99, ALL = 99 }; /* any port; every component */
#define WHOLE AMBIT_NO_PORT

enum {
  NEGATE,
  ZERO,
  TENTH,
  SLIGHTLY,
  NEXT,
  SHIFT,
  WITH_TIME,
  WITH_STATE,
  DECLINE,
  UNWRITTEN,
  GARBAGE,
  OTHER,
  REFUSE,
  MUTTER,
  PARTLY,
  NAN_OF,
  SQUARED,
  TWICE,
  NOTHING_AT_ALL,
  BEYOND,
  CRASH
};

typedef struct fault {
  const char *name, *base;
  uint32_t port, quantity, component;
  int how;
} fault;

static const fault faults[] = {
  { "hinge: wrong sign of a rotation", "revolute", ANY, AMBIT_POSE, 1, NEGATE },
  { "hinge: axes not of unit length", "revolute", ANY, AMBIT_POSE, 0, TENTH },
  { "hinge: position moved by 1e-3", "revolute", ANY, AMBIT_POSE, 9, SHIFT },
  { "hinge: two columns exchanged", "revolute", ANY, AMBIT_POSE, 0, NEXT },
  { "hinge: angular velocity with the wrong sign", "revolute", ANY, AMBIT_TWIST, 2, NEGATE },
  { "hinge: angular velocity forgotten", "revolute", ANY, AMBIT_TWIST, 0, ZERO },
  { "hinge: velocity off by 1e-6", "revolute", ANY, AMBIT_TWIST, 3, SLIGHTLY },
  { "hinge: acceleration without one term", "revolute", ANY, AMBIT_ACCEL, 4, ZERO },
  { "hinge: angular acceleration of 90 %", "revolute", ANY, AMBIT_ACCEL, 0, TENTH },
  { "hinge: reaction with the wrong sign", "revolute", 0, AMBIT_WRENCH, 3, NEGATE },
  { "hinge: moment forgotten", "revolute", 0, AMBIT_WRENCH, 0, ZERO },
  { "hinge: all reactions forgotten", "revolute", 0, AMBIT_WRENCH, ALL, ZERO },
  { "hinge: no reaction", "revolute", 0, AMBIT_WRENCH, ALL, DECLINE },
  { "hinge: balance with the wrong sign", "revolute", ANY, AMBIT_BALANCE, 0, NEGATE },
  { "hinge: no balance", "revolute", ANY, AMBIT_BALANCE, 0, DECLINE },
  { "hinge: rate that is not the derivative", "revolute", ANY, AMBIT_RATE, 0, TENTH },
  { "hinge: second rate that is not the derivative", "revolute", ANY, AMBIT_RATE2, 0, NEGATE },
  { "hinge: no pose", "revolute", ANY, AMBIT_POSE, ALL, DECLINE },
  { "hinge: no velocity", "revolute", ANY, AMBIT_TWIST, ALL, DECLINE },
  { "hinge: no acceleration", "revolute", ANY, AMBIT_ACCEL, ALL, DECLINE },
  { "hinge: pose half written", "revolute", ANY, AMBIT_POSE, 7, UNWRITTEN },
  { "hinge: pose that is no expression", "revolute", ANY, AMBIT_POSE, 5, GARBAGE },
  { "hinge: pose of other expressions", "revolute", ANY, AMBIT_POSE, 5, OTHER },
  { "hinge: pose refused without a word", "revolute", ANY, AMBIT_POSE, ALL, PARTLY },
  { "hinge: pose refused with two letters", "revolute", ANY, AMBIT_POSE, ALL, MUTTER },
  { "hinge: writes nothing and says OK", "revolute", ANY, ANY, ALL, UNWRITTEN },
  { "spring: writes nothing at all", "spring_damper", ANY, ANY, ALL, DECLINE },
  { "spring: refuses everything", "spring_damper", ANY, ANY, ALL, REFUSE },
  { "spring: force with the wrong sign on one end", "spring_damper", 1, AMBIT_WRENCH, ALL, NEGATE },
  { "spring: force of 90 % on both ends", "spring_damper", ANY, AMBIT_WRENCH, ALL, TENTH },
  { "spring: force off by 1e-6 on one end", "spring_damper", 0, AMBIT_WRENCH, 4, SLIGHTLY },
  { "spring: energy of 90 %", "spring_damper", WHOLE, AMBIT_ENERGY, 1, TENTH },
  { "spring: energy forgotten", "spring_damper", WHOLE, AMBIT_ENERGY, ALL, DECLINE },
  { "spring: energy that is no expression", "spring_damper", WHOLE, AMBIT_ENERGY, 1, GARBAGE },
  { "spring: power with the wrong sign", "spring_damper", WHOLE, AMBIT_POWER, 0, NEGATE },
  { "spring: power forgotten", "spring_damper", WHOLE, AMBIT_POWER, 0, DECLINE },
  { "spring: nothing on one end", "spring_damper", 1, AMBIT_WRENCH, ALL, DECLINE },
  { "spring: a torque more", "spring_damper", 1, AMBIT_WRENCH, 0, SHIFT },
  { "spring: energy that depends on time", "spring_damper", WHOLE, AMBIT_ENERGY, 1, WITH_TIME },
  { "body: mass of 90 %", "rigid_body", WHOLE, AMBIT_MASS, 0, TENTH },
  { "body: mass that changes in time", "rigid_body", WHOLE, AMBIT_MASS, 0, WITH_TIME },
  { "body: first moment of the mass wrong", "rigid_body", WHOLE, AMBIT_MASS_MOMENT, 1, TENTH },
  { "body: momentum with the wrong sign", "rigid_body", WHOLE, AMBIT_MOMENTUM, 4, NEGATE },
  { "body: angular momentum forgotten", "rigid_body", WHOLE, AMBIT_MOMENTUM, 0, ZERO },
  { "body: kinetic energy of 90 %", "rigid_body", WHOLE, AMBIT_ENERGY, 0, TENTH },
  { "body: potential energy with the wrong sign", "rigid_body", WHOLE, AMBIT_ENERGY, 1, NEGATE },
  { "body: energy counted twice", "rigid_body", WHOLE, AMBIT_ENERGY, 0, TWICE },
  { "body: gyroscopic torque wrong", "rigid_body", 0, AMBIT_WRENCH, 1, TENTH },
  { "body: weight forgotten on one axis", "rigid_body", 0, AMBIT_WRENCH, 5, ZERO },
  { "body: a momentum without a mass", "rigid_body", WHOLE, AMBIT_MASS, 0, DECLINE },
  { "point mass: force squared", "point_mass", 0, AMBIT_WRENCH, 3, SQUARED },
  { "joint spring: effort with the wrong sign", "joint_spring", 0, AMBIT_EFFORT, 0, NEGATE },
  { "joint spring: effort off by 1e-6", "joint_spring", 0, AMBIT_EFFORT, 0, SLIGHTLY },
  { "joint spring: energy forgotten", "joint_spring", WHOLE, AMBIT_ENERGY, ALL, DECLINE },
  { "joint damper: power from nowhere", "joint_damper", WHOLE, AMBIT_POWER, 0, NEGATE },
  { "joint friction: viscous part of 90 %", "joint_friction", 0, AMBIT_EFFORT, 0, TENTH },
  { "closed point: residual that does not belong to the force", "close_point", ANY, AMBIT_RESIDUAL, 1, TENTH },
  { "closed point: no residual", "close_point", ANY, AMBIT_RESIDUAL, ALL, DECLINE },
  { "closed point: force on one end only", "close_point", 0, AMBIT_WRENCH, ALL, ZERO },
  { "quaternion joint: rate of a coordinate wrong", "spherical_quaternion", ANY, AMBIT_COORDINATE_RATE, 2, NEGATE },
  { "quaternion joint: norm not kept", "spherical_quaternion", ANY, AMBIT_RESIDUAL, 0, WITH_STATE },
  { "quaternion joint: axes of a wrong sign", "spherical_quaternion", ANY, AMBIT_POSE, 3, NEGATE },
  { "state: twice what it is", "state", ANY, AMBIT_COORDINATE, 0, TWICE },
  { "state: without a rate", "state", ANY, AMBIT_COORDINATE_RATE, ALL, DECLINE },
  { "bush: rotational part with the wrong sign", "bushing", 0, AMBIT_WRENCH, 0, NEGATE },
  { "bush: power of 90 %", "bushing", WHOLE, AMBIT_POWER, 0, TENTH },
  { "slider: displacement along the wrong axis", "prismatic", ANY, AMBIT_POSE, 9, NEXT },
  { "slider: velocity forgotten", "prismatic", ANY, AMBIT_TWIST, 3, ZERO },
  { "link: Euler's term forgotten", "rigid_link", ANY, AMBIT_ACCEL, 3, ZERO },
  { "link: reaction without its lever", "rigid_link", 0, AMBIT_WRENCH, 1, ZERO },
  { "gear: ratio of 90 % in the second effort", "gear", 1, AMBIT_EFFORT, 0, TENTH },
  { "free body: order of the speeds", "free", ANY, AMBIT_TWIST, 1, NEXT },
  { "expresses quantities that nobody knows", "revolute", ANY, 99, ALL, OTHER },
  { "expresses its mass at a port", "rigid_body", 0, AMBIT_MASS, 0, OTHER },
  { "reads a parameter that it does not have", "joint_spring", 0, AMBIT_EFFORT, 0, BEYOND },
  { "crashes at a moving parameter", "rigid_link", ANY, AMBIT_TWIST, 0, CRASH },
};
enum { FAULTS = sizeof faults / sizeof *faults };

AMBIT_EXPORT const char *ambit_mutant_name(size_t i);
const char *ambit_mutant_name(size_t i) {
  return i < FAULTS ? faults[i].name : i < FAULTS + CONDUCT_FAULTS ? conduct_faults[i - FAULTS].name : NULL;
}

typedef struct selection {
  const fault *f;
  const ambit_element *base;
  void (*conduct)(void);
  uint64_t calls;
} selection;

static selection *chosen;

static uint32_t count_of(uint32_t quantity) {
  switch (quantity) {
  case AMBIT_POSE: return 12;
  case AMBIT_TWIST:
  case AMBIT_ACCEL:
  case AMBIT_WRENCH:
  case AMBIT_MOMENTUM: return 6;
  case AMBIT_MASS_MOMENT:
  case AMBIT_FIELD: return 3;
  case AMBIT_ENERGY: return 2;
  default: return 1;
  }
}

static ambit_expr times(ambit_build *b, const char *factor, ambit_expr x) {
  return b->op(b, AMBIT_OP_MUL, b->num(b, factor), x);
}

static void spoil(ambit_build *b, uint32_t n, uint32_t i, ambit_expr *out) {
  ambit_expr x = out[i], next = out[(i + 1) % n];
  switch (chosen->f->how) {
  case NEGATE: out[i] = b->op(b, AMBIT_OP_NEG, x, x); break;
  case ZERO: out[i] = b->num(b, "0"); break;
  case TENTH: out[i] = times(b, "0.9", x); break;
  case SLIGHTLY: out[i] = times(b, "1.000001", x); break;
  case TWICE: out[i] = times(b, "2", x); break;
  case NEXT: out[i] = next, out[(i + 1) % n] = x; break;
  case SHIFT: out[i] = b->op(b, AMBIT_OP_ADD, x, b->num(b, "1e-3")); break;
  case SQUARED: out[i] = b->op(b, AMBIT_OP_SQR, x, x); break;
  case WITH_TIME: out[i] = b->op(b, AMBIT_OP_MUL, x, b->op(b, AMBIT_OP_EXP, b->unknown(b, "1", "2"), 0)); break;
  case WITH_STATE: out[i] = b->op(b, AMBIT_OP_ADD, x, b->state(b, 0, 0, "1")); break;
  case UNWRITTEN: out[i] = UINT32_MAX; break;
  case GARBAGE:
    out[i] = 0x7fffff; /* no expression */
    break;
  default: out[i] = (ambit_expr)(i + 3); break;
  }
}

static bool hits(uint32_t port, uint32_t quantity) {
  const fault *f = chosen->f;
  return f && (f->port == ANY ? f->quantity == ANY || port != WHOLE : f->port == port) &&
         (f->quantity == ANY || f->quantity == quantity || (f->quantity == 99 && quantity >= 99));
}

static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {
  const fault *f = chosen->f;
  chosen->calls++;
  if (chosen->conduct && chosen->calls == 5) chosen->conduct();
  if (!hits(port, quantity)) return chosen->base->express(b, port, quantity, out);
  if (f->how == DECLINE) return AMBIT_UNABLE;
  if (f->how == REFUSE) return b->fail(b, AMBIT_INVALID, "this quantity is not available in this element, sorry");
  if (f->how == MUTTER) return b->fail(b, AMBIT_INVALID, "no");
  if (f->how == PARTLY) return AMBIT_INVALID;
  if (f->how == CRASH) abort();
  ambit_status status = chosen->base->express(b, port, quantity, out);
  if (f->how == OTHER && status == AMBIT_UNABLE) {
    for (uint32_t i = 0; i < count_of(quantity); i++) out[i] = b->num(b, "1");
    return AMBIT_OK;
  }
  if (status != AMBIT_OK) return status;
  if (f->how == BEYOND) b->param(b, 40);
  uint32_t n = count_of(quantity);
  for (uint32_t i = 0; i < n; i++)
    if (f->component == ALL || f->component == i || (f->component >= n && i == 0)) spoil(b, n, i, out);
  return AMBIT_OK;
}

static ambit_element *element;
static const void *get(const char *id) { return strcmp(id, AMBIT_ELEMENT) == 0 ? element : NULL; }

__attribute__((constructor)) static void choose(void);
static void choose(void) {
  const char *wanted = mutant_wanted();
  chosen = calloc(1, sizeof *chosen);
  element = calloc(1, sizeof *element);
  for (size_t i = 0; i < FAULTS; i++)
    if (strcmp(faults[i].name, wanted) == 0) chosen->f = &faults[i];
  chosen->conduct = conduct_of(wanted);
  chosen->base = mutant_base(chosen->f ? chosen->f->base : "revolute", AMBIT_ELEMENT);
  if (!chosen->base) exit(1);
  *element = *chosen->base;
  element->express = express;
}

AMBIT_EXPORT const ambit_plugin ambit_entry = { sizeof ambit_entry, AMBIT_ABI, "element.element_mutant", "1.0",
  "An element with one fault.", get };
