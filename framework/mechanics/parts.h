/* parts.h -- the inside of a mechanism, shared by mechanism.c, part_names.c, part_data.c and part_variables.c (what it
** consists of), pull.c (demand) and build.c (what elements see).
**
** A cell remembers one (part, port, quantity): what express() wrote, or the sum over everything attached. While it is
** being worked out, `next` is the cell that it waits for, so that a loop can be named.
*/
#ifndef AMBIT_PARTS_H
#define AMBIT_PARTS_H
#include "graph/collect.h"
#include <ambit/mechanism.h>
#include "graph/name.h"

#define AMBIT_CELL_EMPTY 0u
#define AMBIT_CELL_BUSY 1u    /* its express() is running */
#define AMBIT_CELL_WAITING 2u /* its express() was broken off because the stack was deep; see pull.c */
#define AMBIT_CELL_DONE 3u
#define AMBIT_CELL_DECLINED 4u /* the element has none */

typedef struct ambit_cell {
  const ambit_expr *value; /* DONE; lives as long as the mechanism */
  struct ambit_cell *next;
  uint32_t part, port, quantity;
  uint32_t request; /* WAITING: number of the request that was broken off */
  uint8_t state;
  bool open; /* depends on a sum over attached elements: void when a part is added */
} ambit_cell;

#define AMBIT_COLUMNS 6u /* cells per port: the quantities of a joint; the others have fewer */

typedef struct ambit_joined {    /* one end of a connection */
  uint32_t part, port;           /* IN port: what it is connected to; OUT port: the first attached */
  uint32_t next_part, next_port; /* IN port: the next one attached to the same OUT port; part UINT32_MAX ends */
} ambit_joined;

typedef struct ambit_part {
  const ambit_element *element;
  const char *type, *name, *where; /* where: NULL if unknown */
  const char *unit;                /* of its coordinates where the element does not say one */
  const ambit_expr **param;        /* NULL: optional and absent */
  size_t nparam;
  ambit_joined *joined; /* [nport] */
  ambit_cell *cell;     /* [(nport + 1) * AMBIT_COLUMNS]; row nport: the part as a whole */
  ambit_cell *cut; /* the same while the mechanism is cut, for what accelerations may act on; else NULL; see cut.h */
  /* of all its OUT joints, constraints and states, in the order of the ports; each list holds places in the
  ** mechanism's, UINT32_MAX: not (yet) made */
  uint32_t ncoordinate, dof, rows;
  uint32_t nunknown;                         /* that its element asked for */
  uint32_t *coordinate, *speed, *multiplier; /* [ncoordinate] [dof] [rows] */
} ambit_part;

typedef struct ambit_part_names {
  uint32_t *table; /* parts by name: open addressing; UINT32_MAX = free */
  size_t table_size;
  struct ambit_type_count {
    const char *type;
    size_t next; /* number for the next unnamed one */
  } * type;
  size_t ntype, type_capacity;
} ambit_part_names;

/* What the user says about closed loops; loops.h reads it. */
typedef struct ambit_loop_choice {
  const char **reference_name; /* [nreference] coordinates, with their values where pivots are chosen */
  const double *reference;
  const char **independent; /* [nindependent] */
  size_t nreference, nindependent;
} ambit_loop_choice;

struct ambit_mechanism {
  ambit_holder holder; /* first, see mark.c */
  ambit_graph *graph;
  ambit_arena *arena;
  const char *name;
  ambit_part *part;
  size_t count, capacity;
  ambit_part_names names;
  /* in the order in which they were asked for */
  ambit_coordinate *coordinate; /* rate of a joint with more coordinates than speeds: AMBIT_NO_EXPR */
  ambit_speed *speed;
  ambit_multiplier *multiplier;
  size_t ncoordinate, nspeed, nmultiplier, coordinate_capacity, speed_capacity, multiplier_capacity;
  ambit_cell whole[AMBIT_COLUMNS]; /* sums over all parts */
  ambit_loop_choice choice;
  size_t pulled, available, nopen;
  /* while pulling */
  ambit_failure *failure;
  ambit_cell *deferred; /* what has to be pulled first; not NULL: everything is being broken off */
  uint32_t depth;
  struct ambit_request *request; /* [nrequest] each waits for the next */
  size_t nrequest, request_capacity;
  uint32_t requests; /* ever made: their numbers */
};

extern const ambit_element ambit_world_element;

/* The sum of a quantity over all parts; NULL: there is none. */
ambit_cell *ambit_mechanism_cell(ambit_mechanism *m, uint32_t quantity);
/* The cell of a quantity at a port (AMBIT_NO_PORT: of the part); NULL: that kind of port has no such quantity. */
ambit_cell *ambit_part_cell(const ambit_part *p, uint32_t port, uint32_t quantity);
size_t ambit_quantity_count(const ambit_part *p, uint32_t port, uint32_t quantity);
const char *ambit_quantity_name(uint32_t quantity); /* "twist" */
/* "revolute `beta1` (scene.lua:12)" */
#define AMBIT_WHO_MAX 256
const char *ambit_part_who(const ambit_part *p, char out[AMBIT_WHO_MAX]);

typedef struct ambit_request {
  ambit_cell *cell;
  uint32_t number;
} ambit_request;

/* In pull.c: the value, worked out if need be. NULL: m->failure, m->deferred, or a cell that is DECLINED says why. */
const ambit_expr *ambit_pull_cell(ambit_mechanism *m, ambit_cell *cell, ambit_cell *asker);

/* In part_names.c: is the name fit and free; "revolute1", "revolute2", ... (NULL: out of memory); the part, about to
** be number m->count, by its name.
*/
ambit_status ambit_part_check_name(const ambit_mechanism *m, const ambit_part *p, ambit_failure *f);
const char *ambit_part_make_name(ambit_mechanism *m, const char *type);
bool ambit_part_enter_name(ambit_mechanism *m, const ambit_part *p);
/* In part_data.c: how many numbers parameter i has; parameters given, or their fallbacks. */
size_t ambit_part_components(const ambit_part *p, size_t i);
ambit_status ambit_part_take_params(
    ambit_mechanism *m, ambit_part *p, const ambit_expr *const *given, ambit_failure *f);
/* Names the uncertain data of its parameters after them; false: out of memory. The name of the next unknown that its
** element asks for: after the last parameter. */
bool ambit_part_name_data(ambit_mechanism *m, const ambit_part *p);
void ambit_part_unknown_name(ambit_part *p, char out[AMBIT_DATUM_NAME_MAX]);
/* Does the port hold variables of its element, by the names of AMBIT_COORDINATE and AMBIT_COORDINATE_RATE? */
static inline bool ambit_port_has_coordinates(const ambit_port *p) {
  return p->role == AMBIT_ROLE_OUT && (p->kind == AMBIT_PORT_JOINT || p->kind == AMBIT_PORT_STATE);
}
/* Are the speeds of its joints the time derivatives of their coordinates? */
static inline bool ambit_part_has_rates(const ambit_part *p) { return p->ncoordinate == p->dof; }
/* In part_variables.c: the symbols of a part's coordinate, speed or multiplier number i, made on first use; NULL: the
** failure says why.
*/
const ambit_coordinate *ambit_part_coordinate(
    ambit_mechanism *m, uint32_t part, uint32_t i, const char *unit, ambit_failure *f);
const ambit_speed *ambit_part_speed(ambit_mechanism *m, uint32_t part, uint32_t i, const char *unit, ambit_failure *f);
const ambit_multiplier *ambit_part_multiplier(
    ambit_mechanism *m, uint32_t part, uint32_t i, const char *unit, ambit_failure *f);
/* In build.c: calls express() of the cell's element. */
ambit_status ambit_build_express(ambit_mechanism *m, ambit_cell *cell, ambit_expr *out);
/* In mark.c: marks all expressions of the mechanism that the holder is part of. */
void ambit_mechanism_mark(ambit_holder *holder, ambit_graph *g);
/* In build.c: calls check() of a part that is about to be added. */
ambit_status ambit_build_check(ambit_mechanism *m, uint32_t part, ambit_failure *f);
#endif
