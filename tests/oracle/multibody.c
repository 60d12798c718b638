/* multibody.c -- the equations of motion; multibody_flow.c integrates them. */
#include "multibody.h"
#include <string.h>

typedef multibody_real real;
#define FN MULTIBODY_FN

typedef struct twist {
  real w[3], u[3];
} twist; /* or a wrench: moment about the origin, force */
typedef struct matrix3 {
  real at[3][3];
} matrix3;

/* Mass, first moment and inertia about the origin. */
typedef struct spatial {
  real mass, moment[3];
  matrix3 inertia;
} spatial;

typedef struct state {
  matrix3 R[MULTIBODY_MOST];
  real r[MULTIBODY_MOST][3];                                     /* the joint */
  twist s[MULTIBODY_MOST], V[MULTIBODY_MOST], A[MULTIBODY_MOST]; /* A: without accelerations of joints, no gravity */
  spatial I[MULTIBODY_MOST];
} state;

static real dot(const real *a, const real *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const real *a, const real *b, real *c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static void times(const matrix3 *m, const real *x, real *y) {
  for (int i = 0; i < 3; i++) y[i] = dot(m->at[i], x);
}

static matrix3 product(const matrix3 *a, const matrix3 *b) {
  matrix3 c;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      c.at[i][j] = a->at[i][0] * b->at[0][j] + a->at[i][1] * b->at[1][j] + a->at[i][2] * b->at[2][j];
  return c;
}

/* Rodrigues' formula; k of length 1 */
static matrix3 turned(const real *k, real angle) {
  real c = FN(cos)(angle), s = FN(sin)(angle), d = 1 - c;
  return (matrix3) { { { c + d * k[0] * k[0], d * k[0] * k[1] - s * k[2], d * k[0] * k[2] + s * k[1] },
      { d * k[0] * k[1] + s * k[2], c + d * k[1] * k[1], d * k[1] * k[2] - s * k[0] },
      { d * k[0] * k[2] - s * k[1], d * k[1] * k[2] + s * k[0], c + d * k[2] * k[2] } } };
}

static void place(const multibody *m, const real *q, state *z) {
  static const matrix3 one = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  static const real origin[3] = { 0, 0, 0 };
  for (int i = 0; i < m->n; i++) {
    const multibody_body *b = &m->body[i];
    const matrix3 *P = b->parent < 0 ? &one : &z->R[b->parent];
    const real *from = b->parent < 0 ? origin : z->r[b->parent];
    matrix3 turn = turned(b->turn_axis, b->turn), base = product(P, &turn);
    real step[3], axis[3];
    times(P, b->offset, step);
    times(&base, b->axis, axis);
    for (int k = 0; k < 3; k++) z->r[i][k] = from[k] + step[k] + (b->slides ? q[i] * axis[k] : 0);
    if (b->slides) {
      z->R[i] = base;
      z->s[i] = (twist) { { 0, 0, 0 }, { axis[0], axis[1], axis[2] } };
    } else {
      matrix3 own = turned(b->axis, q[i]);
      z->R[i] = product(&base, &own);
      memcpy(z->s[i].w, axis, sizeof axis);
      cross(z->r[i], axis, z->s[i].u); /* velocity of the point at the origin: axis x (0 - r) */
    }
  }
}

/* The body's inertia about the origin, in world axes. */
static spatial inertia_of(const multibody_body *b, const matrix3 *R, const real *r) {
  const real *j = b->inertia;
  matrix3 own = { { { j[0], j[1], j[2] }, { j[1], j[3], j[4] }, { j[2], j[4], j[5] } } }, half = product(R, &own);
  real c[3];
  times(R, b->centre, c);
  for (int k = 0; k < 3; k++) c[k] += r[k];
  spatial s = { .mass = b->mass };
  real square = dot(c, c);
  for (int i = 0; i < 3; i++) {
    s.moment[i] = b->mass * c[i];
    for (int k = 0; k < 3; k++)
      s.inertia.at[i][k] = dot(half.at[i], R->at[k]) + b->mass * ((i == k ? square : 0) - c[i] * c[k]);
  }
  return s;
}

/* Momentum about the origin. */
static twist momentum(const spatial *I, const twist *V) {
  twist h;
  real a[3], b[3];
  times(&I->inertia, V->w, a);
  cross(I->moment, V->u, b);
  for (int k = 0; k < 3; k++) h.w[k] = a[k] + b[k];
  cross(V->w, I->moment, a);
  for (int k = 0; k < 3; k++) h.u[k] = I->mass * V->u[k] + a[k];
  return h;
}

static void move(const multibody *m, const real *v, state *z) {
  for (int i = 0; i < m->n; i++) {
    int p = m->body[i].parent;
    twist V = p < 0 ? (twist) { { 0 }, { 0 } } : z->V[p], A = p < 0 ? (twist) { { 0 }, { 0 } } : z->A[p];
    const twist *s = &z->s[i];
    real a[3], b[3], c[3]; /* the axis is carried along: s' = V x s */
    cross(V.w, s->w, a);
    cross(V.w, s->u, b);
    cross(V.u, s->w, c);
    for (int k = 0; k < 3; k++) {
      z->V[i].w[k] = V.w[k] + s->w[k] * v[i];
      z->V[i].u[k] = V.u[k] + s->u[k] * v[i];
      z->A[i].w[k] = A.w[k] + a[k] * v[i];
      z->A[i].u[k] = A.u[k] + (b[k] + c[k]) * v[i];
    }
    z->I[i] = inertia_of(&m->body[i], &z->R[i], z->r[i]);
  }
}

/* What body i must be given for A, gravity pulling: rate of change of its momentum about the origin. */
static twist wrench(const multibody *m, const state *z, int i) {
  twist A = z->A[i], h = momentum(&z->I[i], &z->V[i]);
  for (int k = 0; k < 3; k++) A.u[k] -= m->gravity[k];
  twist f = momentum(&z->I[i], &A);
  real a[3], b[3], c[3];
  cross(z->V[i].w, h.w, a);
  cross(z->V[i].u, h.u, b);
  cross(z->V[i].w, h.u, c);
  for (int k = 0; k < 3; k++) f.w[k] += a[k] + b[k], f.u[k] += c[k];
  return f;
}

static void add_spatial(spatial *to, const spatial *s) {
  to->mass += s->mass;
  for (int i = 0; i < 3; i++) {
    to->moment[i] += s->moment[i];
    for (int k = 0; k < 3; k++) to->inertia.at[i][k] += s->inertia.at[i][k];
  }
}

static real along(const twist *s, const twist *f) { return dot(s->w, f->w) + dot(s->u, f->u); }

#define SYSTEM_MOST (MULTIBODY_MOST + 3 * MULTIBODY_LOOPS + MULTIBODY_TIES)
typedef struct linear {
  int n;
  real at[SYSTEM_MOST][SYSTEM_MOST + 1];
} linear;

/* Gauss with row pivots; the answer in column n. */
static bool solve(linear *e) {
  int n = e->n;
  for (int c = 0; c < n; c++) {
    int best = c;
    for (int r = c + 1; r < n; r++)
      if (FN(fabs)(e->at[r][c]) > FN(fabs)(e->at[best][c])) best = r;
    if (e->at[best][c] == 0) return false;
    for (int k = c; best != c && k <= n; k++) {
      real x = e->at[c][k];
      e->at[c][k] = e->at[best][k], e->at[best][k] = x;
    }
    for (int r = c + 1; r < n; r++) {
      real f = e->at[r][c] / e->at[c][c];
      if (f == 0) continue;
      for (int k = c; k <= n; k++) e->at[r][k] -= f * e->at[c][k];
    }
  }
  for (int r = n - 1; r >= 0; r--) {
    for (int k = r + 1; k < n; k++) e->at[r][n] -= e->at[r][k] * e->at[k][n];
    e->at[r][n] /= e->at[r][r];
  }
  return true;
}

static real torque_of(const multibody_body *b, real q, real v, real t) {
  real sum = b->torque + b->amplitude * FN(sin)(b->rate * t) - b->stiffness * (q - b->rest) - b->damping * v;
  if (b->friction != 0) sum -= b->friction * FN(tanh)(v / b->creep);
  return sum + b->proportional * (b->goal + b->swing * FN(sin)(b->tempo * t) - q) +
         b->derivative * (b->swing * b->tempo * FN(cos)(b->tempo * t) - v);
}

/* M a = torques - bias, into the first n rows */
static void balance(const multibody *m, const real *q, const real *v, real t, state *z, linear *e) {
  int n = m->n;
  twist f[MULTIBODY_MOST];
  spatial composite[MULTIBODY_MOST];
  for (int i = 0; i < n; i++) f[i] = wrench(m, z, i), composite[i] = z->I[i];
  for (int i = n - 1; i >= 0; i--) {
    int p = m->body[i].parent;
    const multibody_body *b = &m->body[i];
    twist h = momentum(&composite[i], &z->s[i]);
    for (int j = i; j >= 0; j = m->body[j].parent) e->at[i][j] = e->at[j][i] = along(&z->s[j], &h);
    e->at[i][i] += b->armature;
    e->at[i][e->n] = torque_of(b, q[i], v[i], t) - along(&z->s[i], &f[i]);
    if (p < 0) continue;
    add_spatial(&composite[p], &composite[i]);
    for (int k = 0; k < 3; k++) f[p].w[k] += f[i].w[k], f[p].u[k] += f[i].u[k];
  }
}

/* A point of a body: where it is, its velocity, its acceleration without accelerations of joints. */
typedef struct point {
  real x[3], v[3], a[3];
} point;
static point point_of(const state *z, int body, const real *at) {
  point p = { { at[0], at[1], at[2] }, { 0 }, { 0 } };
  if (body < 0) return p;
  const twist *V = &z->V[body], *A = &z->A[body];
  real d[3], e[3];
  times(&z->R[body], at, d);
  for (int k = 0; k < 3; k++) p.x[k] = z->r[body][k] + d[k];
  cross(V->w, p.x, d);
  for (int k = 0; k < 3; k++) p.v[k] = V->u[k] + d[k];
  cross(A->w, p.x, d);
  cross(V->w, p.v, e);
  for (int k = 0; k < 3; k++) p.a[k] = A->u[k] + d[k] + e[k];
  return p;
}

static bool carries(const multibody *m, int j, int body) {
  for (; body >= 0; body = m->body[body].parent)
    if (body == j) return true;
  return false;
}

/* One row for each direction of each loop: d gap / d q_j into row[][j], the gap and its rates; returns how many. */
typedef struct rows {
  int n;
  real G[3 * MULTIBODY_LOOPS][MULTIBODY_MOST], gap[3 * MULTIBODY_LOOPS], bias[3 * MULTIBODY_LOOPS];
} rows;
static void close_rows(const multibody *m, const state *z, rows *out) {
  out->n = 0;
  for (int l = 0; l < m->nloop; l++) {
    const multibody_loop *c = &m->loop[l];
    point a = point_of(z, c->a, c->at_a), b = point_of(z, c->b, c->at_b);
    for (int k = 0; k < 3; k++) {
      if (!c->along[k]) continue;
      for (int j = 0; j < m->n; j++) {
        real d[3], g = 0;
        if (carries(m, j, c->a)) {
          cross(z->s[j].w, a.x, d);
          g += z->s[j].u[k] + d[k];
        }
        if (carries(m, j, c->b)) {
          cross(z->s[j].w, b.x, d);
          g -= z->s[j].u[k] + d[k];
        }
        out->G[out->n][j] = g;
      }
      out->gap[out->n] = a.x[k] - b.x[k];
      out->bias[out->n++] = a.a[k] - b.a[k];
    }
  }
}

/* The accelerations' part of ties, from row `first` on. */
static void tie_rows(const multibody *m, real t, int first, linear *e) {
  for (int k = 0; k < m->ntie; k++) {
    const multibody_tie *c = &m->tie[k];
    int r = first + k;
    e->at[r][c->follower] = e->at[c->follower][r] = 1;
    if (c->leader >= 0) e->at[r][c->leader] = e->at[c->leader][r] = -c->ratio;
    e->at[r][e->n] = -c->swing * c->tempo * c->tempo * FN(sin)(c->tempo * t);
  }
}

bool multibody_accelerations(multibody *m, const real *q, const real *v, real t, real *a) {
  state z;
  linear e;
  rows c;
  m->evaluations++;
  place(m, q, &z);
  move(m, v, &z);
  close_rows(m, &z, &c);
  e.n = m->n + c.n + m->ntie;
  for (int i = 0; i < e.n; i++)
    for (int j = 0; j <= e.n; j++) e.at[i][j] = 0;
  balance(m, q, v, t, &z, &e);
  for (int r = 0; r < c.n; r++) {
    for (int j = 0; j < m->n; j++) e.at[m->n + r][j] = e.at[j][m->n + r] = c.G[r][j];
    e.at[m->n + r][e.n] = -c.bias[r];
  }
  tie_rows(m, t, m->n + c.n, &e);
  if (!solve(&e)) return false;
  for (int i = 0; i < m->n; i++) a[i] = e.at[i][e.n];
  return true;
}

void multibody_follow(const multibody *m, real t, real *q, real *v) {
  for (int k = 0; k < m->ntie; k++) {
    const multibody_tie *c = &m->tie[k];
    q[c->follower] = c->offset + c->swing * FN(sin)(c->tempo * t);
    v[c->follower] = c->swing * c->tempo * FN(cos)(c->tempo * t);
    if (c->leader < 0) continue;
    q[c->follower] += c->ratio * q[c->leader];
    v[c->follower] += c->ratio * v[c->leader];
  }
}

/* The dependent part x of G x = right: as many unknowns as rows. */
static bool dependent_part(const rows *c, int n, const bool *dependent, const real *right, real *x) {
  linear e = { .n = c->n };
  int column = 0;
  for (int j = 0; j < n; j++) {
    if (!dependent[j]) continue;
    if (column == c->n) return false;
    for (int r = 0; r < c->n; r++) e.at[r][column] = c->G[r][j];
    column++;
  }
  if (column != c->n) return false;
  for (int r = 0; r < c->n; r++) e.at[r][c->n] = right[r];
  if (!solve(&e)) return false;
  for (int j = 0, k = 0; j < n; j++) x[j] = dependent[j] ? e.at[k++][c->n] : 0;
  return true;
}

bool multibody_close(multibody *m, const bool *dependent, real *q, real *v) {
  state z;
  rows c;
  real step[MULTIBODY_MOST], right[3 * MULTIBODY_LOOPS], last = 1;
  for (int turn = 0; turn < 12; turn++) {
    place(m, q, &z);
    move(m, v, &z);
    close_rows(m, &z, &c);
    if (!dependent_part(&c, m->n, dependent, c.gap, step)) return false;
    last = 0;
    for (int j = 0; j < m->n; j++) q[j] -= step[j], last = FN(fmax)(last, FN(fabs)(step[j]));
    if (last < 1e-17) break;
  }
  if (!(last < 1e-15)) return false;
  place(m, q, &z);
  move(m, v, &z);
  close_rows(m, &z, &c);
  for (int r = 0; r < c.n; r++) {
    right[r] = 0;
    for (int j = 0; j < m->n; j++)
      if (!dependent[j]) right[r] -= c.G[r][j] * v[j];
  }
  if (!dependent_part(&c, m->n, dependent, right, step)) return false;
  for (int j = 0; j < m->n; j++)
    if (dependent[j]) v[j] = step[j];
  return true;
}
