/* element.h -- "ambit.element/1": a part of a mechanism, as formulas.
**
** Demand driven: the kernel calls express() only for a (port, quantity) that some output, event or solver input
** reaches; express() pulls what it needs through b->get(). Nothing that nobody asks for is ever built.
**
** The road of motion and force (Kecskemethy & Hiller 1994): motion is pulled from an OUT frame towards the ground,
** force is pulled from an IN frame towards the tips. All wrenches exerted on the port, inertial ones included, sum to
** zero (d'Alembert).
*/
#ifndef AMBIT_ELEMENT_H
#define AMBIT_ELEMENT_H
#include "tape.h"

#define AMBIT_ELEMENT "ambit.element/1"

typedef uint32_t ambit_expr; /* node number in the graph; 0 is the constant 0 */

/* Kinds of ports. A joint port carries the generalised coordinates of the joint, a constraint port (always OUT) the
** equations of an element that closes a loop, a state port (always OUT) quantities with a first-order equation of their
** own: a current, a pressure, the integral of a controller. An element with a state port has no joint of its own. */
#define AMBIT_PORT_FRAME 1u
#define AMBIT_PORT_JOINT 2u
#define AMBIT_PORT_CONSTRAINT 3u
#define AMBIT_PORT_STATE 4u
/* Roles: IN is given by the user (another element's OUT), OUT is made by this element. */
#define AMBIT_ROLE_IN 1u
#define AMBIT_ROLE_OUT 2u

/* Quantities of a frame port (count in brackets), SI. Twist, acceleration and wrench are resolved in the frame's own
** axes and taken at its origin. */
#define AMBIT_POSE 1u  /* [12] rotation by rows (own axes -> world), then position in the world, m; OUT frames */
#define AMBIT_TWIST 2u /* [6] angular velocity, rad/s, linear velocity, m/s; OUT frames */
/* [6] rad/s^2, m/s^2; the linear part is the proper acceleration: minus the field of gravity; OUT frames */
#define AMBIT_ACCEL 3u
/* [6] torque, N m, force, N, that this element exerts on the frame; IN frames. get(): the sum over all elements
** attached to that frame */
#define AMBIT_WRENCH 4u
#define AMBIT_ENERGY 5u /* [2] kinetic, potential, J, of this element; port AMBIT_NO_PORT */
/* [1] W that this element puts into the mechanism beyond what its AMBIT_ENERGY gives up: dampers, drives, applied
** forces. The energies of all elements together change by the sum of it. Port AMBIT_NO_PORT */
#define AMBIT_POWER 6u
/* Quantities of a joint port with c coordinates q and d degrees of freedom, whose speeds are u. Almost always c = d and
** u = q'; else AMBIT_COORDINATE_RATE tells q' (the quaternion of a spherical joint: c = 4, d = 3, u the angular
** velocity). */
#define AMBIT_COORDINATE 16u /* [c] OUT: q */
#define AMBIT_RATE 17u       /* [d] OUT: u */
#define AMBIT_RATE2 18u      /* [d] OUT: time derivative of u */
/* [d] generalised force along u applied to the joint, IN; get(): the sum over all attached */
#define AMBIT_EFFORT 19u
/* [d] OUT: generalised force that must vanish: projection of the wrench on the joint plus its effort */
#define AMBIT_BALANCE 20u
#define AMBIT_COORDINATE_RATE 21u /* [c] OUT: q' from q and u; asked for only where c differs from d */
/* Quantities of a state port with d states: AMBIT_COORDINATE [d], their values x, and AMBIT_COORDINATE_RATE [d], x' as
** a function of coordinates, speeds, states, data and time. */
/* Quantities of a constraint port with d rows. */
/* [d] OUT: g, which vanishes. The element's wrenches and efforts are those of multipliers: virtual power
** sum of lambda_k dg_k/dt, whatever the motion; where g itself moves in time, at fixed time, and the AMBIT_POWER is
** -lambda_k times its derivative at fixed coordinates. A row whose time derivative vanishes identically (the norm of a
** quaternion) has none. */
#define AMBIT_RESIDUAL 24u
/* Quantities of the mechanism as a whole; port AMBIT_NO_PORT, summed over all elements. */
#define AMBIT_FIELD 32u       /* [3] acceleration of gravity, world axes, m/s^2 */
#define AMBIT_MASS 33u        /* [1] kg */
#define AMBIT_MASS_MOMENT 34u /* [3] mass times position of its centre in the world, kg m */
#define AMBIT_MOMENTUM 35u    /* [6] angular momentum about the world's origin, N m s, momentum, N s; world axes */
#define AMBIT_NO_PORT UINT32_MAX
#define AMBIT_QUANTITY_MAX 12u /* the largest count above */

typedef struct ambit_port {
  const char *name;    /* "from" */
  uint32_t kind, role; /* AMBIT_PORT_*, AMBIT_ROLE_* */
  uint32_t dof;        /* of a joint port (or AMBIT_DOF), rows of a constraint port, states of a state port, else 0 */
  uint32_t optional;   /* IN ports only: 1 = may be left unconnected */
  const char *doc;
} ambit_port;

/* dof of a joint port with more coordinates than degrees of freedom, and how to read it */
#define AMBIT_DOF(dof, coordinates) ((uint32_t)(dof) | (uint32_t)(coordinates) << 16)
static inline uint32_t ambit_port_dof(const ambit_port *p) { return p->dof & 0xffffu; }
static inline uint32_t ambit_port_coordinates(const ambit_port *p) { return p->dof >> 16 ? p->dof >> 16 : p->dof; }

typedef struct ambit_build ambit_build;
struct ambit_build { /* [main] valid only during express() */
  uint32_t size;
  ambit_expr (*num)(ambit_build *b, const char *decimal); /* "0.5", "1/3", "pi": rigorous, encloses what it says */
  /* folds, hash-conses; y ignored if unary; POWN: y is the int32 exponent */
  ambit_expr (*op)(ambit_build *b, uint32_t opcode, ambit_expr x, ambit_expr y);
  const ambit_expr *(*param)(ambit_build *b, uint32_t index); /* in declaration order; NULL: optional and absent */
  /* the element's own coordinate number i (counted through its OUT joint ports in order, or its state ports), or its
  ** first or second time derivative (order 0, 1, 2); becomes a state. `unit` is that of the coordinate, whatever the
  ** order; NULL: the one that the scene gives. Orders 1 and 2 only where coordinates and degrees of freedom are as
  ** many; else speed() */
  ambit_expr (*state)(ambit_build *b, uint32_t i, uint32_t order, const char *unit);
  /* pulls a quantity: of an own IN port: motion of the frame it is connected to; of an own OUT port: the sum of what
  ** is exerted there by all elements attached to it; of AMBIT_NO_PORT: of the mechanism. NULL: return any status but
  ** OK and UNABLE (a failure, already recorded, or a chain too deep for the stack: the kernel calls express() again);
  ** or an optional port is not connected */
  const ambit_expr *(*get)(ambit_build *b, uint32_t port, uint32_t quantity);
  ambit_expr (*unknown)(ambit_build *b, const char *lo,
      const char *hi); /* fresh and independent in [lo, hi], called after the last parameter */
  ambit_status (*fail)(ambit_build *b, ambit_status s, const char *format, ...) AMBIT_PRINTF(3, 4);
  /* total time derivative of a given motion (of a parameter) */
  ambit_expr (*diff_time)(ambit_build *b, ambit_expr x);
  /* bounds that hold for x whatever the unknowns are, perhaps wide; for checks of data (a mass below zero) */
  void (*range)(ambit_build *b, ambit_expr x, double *lo, double *hi);
  /* the own speed number i (degrees of freedom counted through the OUT joint ports) or its time derivative (order 1, 2,
  ** as in state()), of a joint with more coordinates than degrees of freedom; becomes a state. `unit`: of the speed */
  ambit_expr (*speed)(ambit_build *b, uint32_t i, uint32_t order, const char *unit);
  /* the own multiplier number i (rows counted through the constraint ports) */
  ambit_expr (*multiplier)(ambit_build *b, uint32_t i, const char *unit);
  /* time derivative of a given motion with all coordinates held: what is left of diff_time() in a mechanism at rest */
  ambit_expr (*partial_time)(ambit_build *b, ambit_expr x);
};

typedef struct ambit_element {
  uint32_t size;
  uint32_t nport;
  const ambit_port *port;   /* [nport] */
  const ambit_param *param; /* an entry with NULL name ends */
  /* [main] writes the quantity (count above, or dof) into out. AMBIT_UNABLE without fail(): not mine, the kernel adds
  ** nothing */
  ambit_status (*express)(ambit_build *b, uint32_t port, uint32_t quantity, ambit_expr *out);
  /* [main] NULL, or looks at the data when the element is added: fail() refuses it. No state(), speed(), multiplier(),
  ** unknown() or get() */
  ambit_status (*check)(ambit_build *b);
} ambit_element;
#endif
