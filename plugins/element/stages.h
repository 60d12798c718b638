/* stages.h -- a joint as a sequence of elementary motions, each along a direction that is fixed in the frame reached by
** the ones before: turn by c q about n, or slide by c q along it.
**
** One stage, in own axes (subscript 1: after it), with p = n s the displacement and Q = Rot(n, q) the rotation:
**   turn    w_1 = Q^T w + n q'                               v_1 = Q^T v
**           alpha_1 = Q^T alpha + n q'' + (Q^T w) x n q'     a_1 = Q^T a
**   slide   w_1 = w          v_1 = v + w x p + n s'
**           alpha_1 = alpha  a_1 = a + alpha x p + w x (w x p) + 2 w x n s' + n s''
** The wrench (t, f) after it acts before it as (Q t + p x Q f, Q f); along the motion n.t (n.f) + effort = 0
** [Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 4]. The motion of `to` is the motion of `from` carried
** through all stages, and the wrench goes the other way. The balance of coordinate q is the sum of c n.t or c n.f over
** the stages that it moves, plus the effort. A motion that is given in time puts in the power that the balance lacks.
*/
#ifndef AMBIT_STAGES_H
#define AMBIT_STAGES_H
#include <ambit/spatial.h>

#define STAGES_MAX 6

enum { STAGES_FROM, STAGES_TO, STAGES_JOINT };

#define STAGE_IS_STATE UINT32_MAX

typedef struct stage {
  int turns;              /* 1: turns about the axis, 0: slides along it */
  ambit_vector3 axis;     /* unit vector */
  uint32_t coordinate;    /* its number within the joint */
  ambit_expr coefficient; /* c: rad or m per unit of the coordinate */
  const char *unit;       /* of the coordinate */
  uint32_t given;         /* parameter that may give the only coordinate's motion, or STAGE_IS_STATE */
} stage;

typedef struct stages {
  uint32_t count;
  stage list[STAGES_MAX];
} stages;

static inline void stages_push(stages *s, stage one) { s->list[s->count++] = one; }

static inline stage stage_turn(ambit_build *b, ambit_vector3 axis, uint32_t coordinate) {
  return (stage) { 1, axis, coordinate, b->num(b, "1"), "rad", STAGE_IS_STATE };
}

static inline stage stage_slide(ambit_build *b, ambit_vector3 axis, uint32_t coordinate) {
  return (stage) { 0, axis, coordinate, b->num(b, "1"), "m", STAGE_IS_STATE };
}

/* The unit vector of parameter `index`; a direction that moves in time fails. */
static inline ambit_status stages_axis(ambit_build *b, uint32_t index, const char *name, ambit_vector3 *axis) {
  ambit_status status = ambit_check_fixed(b, b->param(b, index), 3, name);
  return status == AMBIT_OK ? ambit_vector3_unit(b, b->param(b, index), axis) : status;
}

static inline ambit_vector3 stages_direction(ambit_build *b, int i) {
  ambit_vector3 v = ambit_vector3_zero();
  v.c[i] = b->num(b, "1");
  return v;
}

/* q, or its time derivative of that order */
static inline ambit_expr stage_coordinate(ambit_build *b, const stage *s, uint32_t order) {
  if (s->given != STAGE_IS_STATE) return ambit_joint_coordinate(b, s->given, order, s->unit);
  return b->state(b, s->coordinate, order, s->unit);
}

/* c q n, or its time derivative of that order */
static inline ambit_vector3 stage_motion(ambit_build *b, const stage *s, uint32_t order) {
  return ambit_vector3_scale(b, ambit_multiply(b, s->coefficient, stage_coordinate(b, s, order)), s->axis);
}

static inline ambit_rotation stage_rotation(ambit_build *b, const stage *s) {
  if (!s->turns) return ambit_rotation_identity(b);
  return ambit_rotation_about(b, s->axis, ambit_multiply(b, s->coefficient, stage_coordinate(b, s, 0)));
}

static inline ambit_vector3 stage_offset(ambit_build *b, const stage *s) {
  return s->turns ? ambit_vector3_zero() : stage_motion(b, s, 0);
}

static inline ambit_screw stage_twist(ambit_build *b, const stage *s, ambit_screw twist) {
  if (s->turns) {
    twist = ambit_screw_turn_back(b, stage_rotation(b, s), twist);
    twist.angular = ambit_vector3_add(b, twist.angular, stage_motion(b, s, 1));
  } else
    twist.linear = ambit_vector3_add(b, ambit_velocity_at(b, twist, stage_offset(b, s)), stage_motion(b, s, 1));
  return twist;
}

/* `twist`: before the stage */
static inline ambit_screw stage_acceleration(ambit_build *b, const stage *s, ambit_screw accel, ambit_screw twist) {
  ambit_vector3 rate = stage_motion(b, s, 1), rate2 = stage_motion(b, s, 2);
  if (s->turns) {
    ambit_rotation q = stage_rotation(b, s);
    ambit_vector3 w = ambit_rotation_turn_back(b, q, twist.angular);
    accel = ambit_screw_turn_back(b, q, accel);
    accel.angular = ambit_vector3_add(b, ambit_vector3_add(b, accel.angular, rate2), ambit_vector3_cross(b, w, rate));
    return accel;
  }
  ambit_vector3 coriolis = ambit_vector3_scale(b, b->num(b, "2"), ambit_vector3_cross(b, twist.angular, rate));
  accel.linear = ambit_acceleration_at(b, accel, twist.angular, stage_offset(b, s));
  accel.linear = ambit_vector3_add(b, ambit_vector3_add(b, accel.linear, coriolis), rate2);
  return accel;
}

static inline ambit_status stages_pose(ambit_build *b, const stages *s, ambit_expr *out) {
  const ambit_expr *from = b->get(b, STAGES_FROM, AMBIT_POSE);
  if (!from) return AMBIT_INVALID;
  ambit_pose pose = ambit_pose_read(from);
  for (uint32_t i = 0; i < s->count; i++)
    pose = ambit_pose_after(b, pose, stage_rotation(b, &s->list[i]), stage_offset(b, &s->list[i]));
  ambit_pose_write(pose, out);
  return AMBIT_OK;
}

static inline ambit_status stages_velocity(ambit_build *b, const stages *s, uint32_t quantity, ambit_expr *out) {
  const ambit_expr *twist_from = b->get(b, STAGES_FROM, AMBIT_TWIST);
  const ambit_expr *from = twist_from ? b->get(b, STAGES_FROM, quantity) : NULL;
  if (!from) return AMBIT_INVALID;
  ambit_screw twist = ambit_screw_read(twist_from), accel = ambit_screw_read(from);
  for (uint32_t i = 0; i < s->count; i++) {
    if (quantity == AMBIT_ACCEL) accel = stage_acceleration(b, &s->list[i], accel, twist);
    twist = stage_twist(b, &s->list[i], twist);
  }
  ambit_screw_write(quantity == AMBIT_ACCEL ? accel : twist, out);
  return AMBIT_OK;
}

/* Wrench on `from`, and with balance != NULL the projections on the coordinates. */
static inline ambit_status stages_force(ambit_build *b, const stages *s, ambit_expr *wrench_out, ambit_expr *balance) {
  const ambit_expr *to = b->get(b, STAGES_TO, AMBIT_WRENCH);
  if (!to) return AMBIT_INVALID;
  ambit_screw wrench = ambit_screw_read(to);
  for (uint32_t i = s->count; i-- > 0;) {
    const stage *one = &s->list[i];
    if (balance) {
      ambit_expr along = ambit_vector3_dot(b, one->axis, one->turns ? wrench.angular : wrench.linear);
      ambit_expr *sum = &balance[one->coordinate];
      *sum = ambit_add(b, *sum, ambit_multiply(b, one->coefficient, along));
    }
    wrench = ambit_wrench_before(b, wrench, stage_rotation(b, one), stage_offset(b, one));
  }
  if (wrench_out) ambit_screw_write(wrench, wrench_out);
  return AMBIT_OK;
}

static inline ambit_status stages_balance(ambit_build *b, const stages *s, uint32_t dof, ambit_expr *out) {
  const ambit_expr *effort = b->get(b, STAGES_JOINT, AMBIT_EFFORT);
  if (!effort) return AMBIT_INVALID;
  for (uint32_t i = 0; i < dof; i++) out[i] = effort[i];
  return stages_force(b, s, NULL, out);
}

static inline int stages_know(uint32_t port, uint32_t quantity) {
  int of_joint = quantity >= AMBIT_COORDINATE && quantity <= AMBIT_RATE2;
  return (port == STAGES_JOINT && (of_joint || quantity == AMBIT_BALANCE)) ||
         (port == STAGES_TO && quantity <= AMBIT_ACCEL) || (port == STAGES_FROM && quantity == AMBIT_WRENCH) ||
         (port == AMBIT_NO_PORT && quantity == AMBIT_POWER);
}

static inline ambit_status stages_express(
    ambit_build *b, const stages *s, uint32_t dof, uint32_t port, uint32_t quantity, ambit_expr *out) {
  if (quantity == AMBIT_POSE) return stages_pose(b, s, out);
  if (quantity <= AMBIT_ACCEL) return stages_velocity(b, s, quantity, out);
  if (quantity == AMBIT_POWER) {
    uint32_t given = s->list[0].given;
    return given == STAGE_IS_STATE ? AMBIT_UNABLE : ambit_drive_power(b, STAGES_JOINT, given, out);
  }
  if (port == STAGES_FROM) return stages_force(b, s, out, NULL);
  if (quantity == AMBIT_BALANCE) return stages_balance(b, s, dof, out);
  for (uint32_t i = 0; i < s->count; i++) {
    const stage *one = &s->list[i];
    out[one->coordinate] = stage_coordinate(b, one, quantity - AMBIT_COORDINATE);
  }
  return AMBIT_OK;
}

#define STAGES_PORTS(dof, what)                                                                                        \
  { "from", AMBIT_PORT_FRAME, AMBIT_ROLE_IN, 0, 0, "the frame that carries the joint" },                               \
      { "to", AMBIT_PORT_FRAME, AMBIT_ROLE_OUT, 0, 0, "the frame that moves" }, {                                      \
    "joint", AMBIT_PORT_JOINT, AMBIT_ROLE_OUT, dof, 0, what                                                            \
  }

/* The element of a joint whose function `build(b, &stages)` lists its stages. */
#define STAGES_ELEMENT(dof, build)                                                                                     \
  static ambit_status express(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out) {                     \
    stages s = { 0 };                                                                                                  \
    ambit_status status = stages_know(port, quantity) ? build(b, &s) : AMBIT_UNABLE;                                   \
    return status == AMBIT_OK ? stages_express(b, &s, dof, port, quantity, out) : status;                              \
  }                                                                                                                    \
  static const ambit_element element = { sizeof element, 3, ports, params, express, NULL };
#endif
