/* multibody.h -- the motion of bodies on hinges and slides, with closed loops, from the textbook and in extended
** precision: what enclosures of mechanisms must contain. Shares no line with the program that it checks.
**
** Everything is written in world axes at the world's origin. A twist is (w, u): angular velocity, and velocity of the
** point of the body that is at the origin. M comes from composite bodies, the rest from Newton and Euler's equations,
** loops and ties of joints from their accelerations with multipliers (one linear system), time from Gragg's rule,
** extrapolated.
*/
#ifndef MULTIBODY_H
#define MULTIBODY_H
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef MULTIBODY_QUAD /* a tool may be compiled with it, for digits to quote */
#include <quadmath.h>
typedef __float128 multibody_real;
#define MULTIBODY_FN(f) f##q
#else
typedef long double multibody_real;
#define MULTIBODY_FN(f) f##l
#endif

#define MULTIBODY_MOST 64 /* bodies */
#define MULTIBODY_LOOPS 16
#define MULTIBODY_TIES 16
#define MULTIBODY_STATES (2 * MULTIBODY_MOST)

typedef struct multibody_body {
  int parent;                                 /* -1: the world; less than its own number */
  bool slides;                                /* along the axis; otherwise it turns about it */
  multibody_real axis[3];                     /* of length 1, in the axes of the body */
  multibody_real offset[3];                   /* of the joint, in the axes of the parent */
  multibody_real turn_axis[3], turn;          /* how the joint's axes lie in the parent's: turned about this axis */
  multibody_real mass, centre[3], inertia[6]; /* of the body, at the centre: xx xy xz yy yz zz */
  /* what acts in the joint: torque + amplitude sin(rate t) - stiffness (q - rest) - damping v; a rotor's inertia */
  multibody_real torque, amplitude, rate, stiffness, rest, damping, armature;
  multibody_real friction, creep; /* - friction tanh(v / creep), if there is friction */
  multibody_real proportional, derivative, goal, swing,
      tempo; /* follows goal + swing sin(tempo t), as PD control does */
} multibody_body;

typedef struct multibody_tie { /* q[follower] = ratio q[leader] + offset + swing sin(tempo t) at all times */
  int follower, leader;        /* a leader of -1: there is none */
  multibody_real ratio, offset, swing, tempo;
} multibody_tie;

typedef struct multibody_loop { /* two points that coincide in these directions of the world */
  int a, b;                     /* bodies; -1: the world */
  multibody_real at_a[3], at_b[3];
  bool along[3];
} multibody_loop;

typedef struct multibody {
  int n, nloop, ntie;
  multibody_body body[MULTIBODY_MOST];
  multibody_loop loop[MULTIBODY_LOOPS];
  multibody_tie tie[MULTIBODY_TIES];
  multibody_real gravity[3];
  size_t evaluations; /* made until now */
} multibody;

/* Accelerations a [n] for q, v [n] at t; false: singular. */
bool multibody_accelerations(
    multibody *m, const multibody_real *q, const multibody_real *v, multibody_real t, multibody_real *a);
/* Gives followers the coordinates and speeds that their leaders and t ask for; ties come after those of their
** leaders. */
void multibody_follow(const multibody *m, multibody_real t, multibody_real *q, multibody_real *v);
/* Changes the coordinates q[i] and speeds v[i] with dependent[i] so that loops are closed; false: not found. */
bool multibody_close(multibody *m, const bool *dependent, multibody_real *q, multibody_real *v);
/* From t to `to`, with so large an error in each step, relative to 1 + |x|; false: steps shrink to nothing. */
bool multibody_integrate(
    multibody *m, multibody_real t, multibody_real to, multibody_real tolerance, multibody_real *q, multibody_real *v);
#endif
