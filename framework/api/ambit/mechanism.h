/* mechanism.h -- parts (elements with parameters), joined at frames; quantities are pulled on demand and remembered.
**
** Part 0 is the world: one OUT frame `world` at rest. Motion is pulled towards the world, forces towards the tips;
** gravity enters as the proper acceleration of the world frame (minus the sum of all AMBIT_FIELDs), so that dynamics
** needs no poses.
*/
#ifndef AMBIT_MECHANISM_H
#define AMBIT_MECHANISM_H
#include <ambit/graph.h>
#include <ambit/element.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ambit_mechanism ambit_mechanism;
typedef struct ambit_frame {
  uint32_t part, port; /* an OUT port of a part */
} ambit_frame;

#define AMBIT_WORLD ((ambit_frame) { 0, 0 })
#define AMBIT_NOWHERE ((ambit_frame) { UINT32_MAX, 0 }) /* an optional port that is not connected */

/* One part to add. param[i]: NULL = absent, else the expressions of parameter i in its declared shape. connection[i]:
** for IN port i the frame it is connected to (OUT ports: ignored). `where`: "scene.lua:12", for messages. */
typedef struct ambit_part_spec {
  const ambit_element *element;
  const char *type, *name, *where; /* name NULL: type and a number */
  const ambit_expr *const *param;
  const ambit_frame *connection;
  const char *unit; /* of coordinates whose unit the element leaves to the scene; NULL: "1" */
} ambit_part_spec;

AMBIT_EXPORT ambit_mechanism *ambit_mechanism_open(ambit_graph *g, const char *name);
AMBIT_EXPORT void ambit_mechanism_close(ambit_mechanism *m);
AMBIT_EXPORT ambit_graph *ambit_mechanism_graph(ambit_mechanism *m);
/* INVALID: a name used twice, a missing connection, a joint port connected to no joint. */
AMBIT_EXPORT ambit_status ambit_mechanism_add(
    ambit_mechanism *m, const ambit_part_spec *spec, uint32_t *part, ambit_failure *f);
AMBIT_EXPORT uint32_t ambit_mechanism_count(const ambit_mechanism *m);
AMBIT_EXPORT const char *ambit_mechanism_part_name(const ambit_mechanism *m, uint32_t part);
AMBIT_EXPORT const ambit_element *ambit_mechanism_part_element(const ambit_mechanism *m, uint32_t part);

/* The quantity at an OUT frame or joint port: motion is that of the frame; AMBIT_WRENCH, AMBIT_EFFORT: the sum over
** all attached elements; frame AMBIT_NOWHERE: of the mechanism (AMBIT_FIELD, AMBIT_ENERGY, AMBIT_POWER, ...). The
** pointer stays valid. NULL: the failure says which element and why; a loop of elements is named part by part. */
AMBIT_EXPORT const ambit_expr *ambit_mechanism_pull(
    ambit_mechanism *m, ambit_frame frame, uint32_t quantity, ambit_failure *f);
/* how often express() was called, of how many (part, port, quantity) that exist: "leave out" in numbers */
AMBIT_EXPORT void ambit_mechanism_pulled(const ambit_mechanism *m, size_t *pulled, size_t *available);
/* The quantities of one part, part < count: those of its ports, then those of the part as a whole (port
** AMBIT_NO_PORT). Returns their number and writes at most `room`. */
typedef struct ambit_part_quantity {
  const char *name; /* "twist" */
  uint32_t port;
  bool pulled; /* was it asked for? */
} ambit_part_quantity;
AMBIT_EXPORT size_t ambit_mechanism_part_quantities(
    const ambit_mechanism *m, uint32_t part, size_t room, ambit_part_quantity *out);

/* The coordinates that elements have made, in the order of the parts. */
typedef struct ambit_coordinate {
  const char *name; /* "beta1" (several coordinates: "name.1", ...) */
  const char *unit; /* of q */
  ambit_expr q;     /* a symbol */
  ambit_expr rate;  /* q' as an expression: the symbol of its speed; of a quaternion a function of q and speeds */
  uint32_t part, index;
  bool own; /* of a state port: the element says its rate, and there is no speed */
} ambit_coordinate;
/* The speeds, one for each degree of freedom, in the same order: symbols of u and of its time derivative. */
typedef struct ambit_speed {
  const char *name; /* "beta1'" ("name.1'", ...; where there are fewer speeds than coordinates "name'.1", ...) */
  const char *unit; /* of u */
  ambit_expr u, du;
  uint32_t part, index;
  ambit_expr coordinate; /* q with q' = u, or AMBIT_NO_EXPR */
} ambit_speed;
/* The multipliers of constraints, one for each row that uses one, in the order of the parts. */
typedef struct ambit_multiplier {
  const char *name; /* "lambda_close" ("lambda_close.1", ... if the element has several rows) */
  ambit_expr lambda;
  uint32_t part, index;
} ambit_multiplier;
/* Each returns their number and writes at most `room`; multipliers: of those whose wrench has been pulled. A failure of
** pulling leaves the joint out; pull it yourself to hear why. */
AMBIT_EXPORT size_t ambit_mechanism_coordinates(ambit_mechanism *m, size_t room, ambit_coordinate *out);
/* unit of a coordinate that has been made; NULL: q is none. Pulls nothing. */
AMBIT_EXPORT const char *ambit_mechanism_coordinate_unit(const ambit_mechanism *m, ambit_expr q);
AMBIT_EXPORT size_t ambit_mechanism_speeds(ambit_mechanism *m, size_t room, ambit_speed *out);
AMBIT_EXPORT size_t ambit_mechanism_multipliers(ambit_mechanism *m, size_t room, ambit_multiplier *out);

#ifdef __cplusplus
}
#endif
#endif
