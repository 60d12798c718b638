/* writer.h -- expressions as text: the writer that all languages share, and the language of messages. */
#ifndef AMBIT_WRITER_H
#define AMBIT_WRITER_H
#include <ambit/graph.h>
#include "graph/store.h"
#include "num/decimal.h"
#include "num/function.h"

/* What a node is called, in the language; it must bind like a name. */
typedef struct ambit_source_name {
  ambit_expr node;
  const char *name;
} ambit_source_name;

typedef struct ambit_source_names {
  size_t n;
  const ambit_source_name *list; /* [n] by ascending node, see ambit_source_names_sort */
} ambit_source_names;

void ambit_source_names_sort(size_t n, ambit_source_name *list);

#define AMBIT_SOURCE_MAX 1000000u /* characters of one text */

/* Binding strength of an expression, and what an operand's place demands. */
enum {
  AMBIT_BINDS_SUM = 1,
  AMBIT_BINDS_SIGN = 2,
  AMBIT_BINDS_PRODUCT = 3,
  AMBIT_BINDS_POWER = 4,
  AMBIT_BINDS_ATOM = 5
};
#define AMBIT_BINDS_ADDEND 0          /* right of a plus: anything but a sign */
#define AMBIT_EXPONENT_MAX 1000000000 /* what Lua's ambit.pow takes for an integer */
#define AMBIT_LEAF_MAX (3 * AMBIT_DECIMAL_MAX)

/* A node is written as head, a, middle, b, tail; b only if there are two operands. */
typedef struct ambit_layout {
  char head[32], middle[16], tail[32];
  ambit_expr a, b;
  int place_a, place_b; /* what the operand has to bind as strongly as */
  bool two;
  bool wrap; /* a, a number, is to be more than a number of the language */
} ambit_layout;

typedef struct ambit_writer ambit_writer;

typedef struct ambit_style {
  const char *open, *close;                             /* brackets */
  int (*strength)(const ambit_writer *w, ambit_expr e); /* unless it has a name */
  ambit_layout (*layout)(const ambit_writer *w, ambit_expr e);
  bool (*leaf)(ambit_writer *w, ambit_expr e, bool wrap); /* writes a leaf that has no name; false: out of memory */
} ambit_style;

extern const ambit_style ambit_style_text; /* as ambit_graph_text writes */

struct ambit_writer {
  const ambit_graph *g;
  const ambit_style *style;
  const ambit_source_names *names; /* or NULL */
  char *out;                       /* [room], terminated at the end */
  size_t room, used;
  bool grows;    /* otherwise, writing stops when the room is used up */
  bool too_high; /* an exponent beyond 1e9 was met */
  struct ambit_piece *stack;
  size_t depth, capacity;
};

/* e into w->out, which is terminated then. False: out of memory. The stack is freed, out is not. */
bool ambit_writer_run(ambit_writer *w, ambit_expr e);
bool ambit_writer_put(ambit_writer *w, const char *text);           /* false: out of memory */
const char *ambit_writer_name(const ambit_writer *w, ambit_expr e); /* or NULL */
bool ambit_writer_brackets(const ambit_writer *w, ambit_expr e, int place);
/* The usual strength of an operation; MUL and DIV that begin with a sign bind as one. Leaves: AMBIT_BINDS_ATOM. */
int ambit_writer_strength(const ambit_writer *w, ambit_expr e);
/* The text of a leaf in ambit_graph_text; the buffer holds it if it has to be made. */
const char *ambit_leaf_text(const ambit_graph *g, ambit_expr e, char buffer[AMBIT_LEAF_MAX]);
/* "sin" of an operation, by the names of tape.h */
const char *ambit_op_symbol(uint32_t op);
/* The layout of an operation with usual operators and functions sin(a), atan2(a, b). */
ambit_layout ambit_layout_infix(const ambit_writer *w, ambit_expr e);
/* The layout of a function as its description says, its operands in such places. */
ambit_layout ambit_layout_form(const ambit_function_form *form, const ambit_node *x, int place);
/* out [room >= 1] := the text of e as far as it fits, at the cost of what is written; true: there is room for one more
** character, so that it is the whole text. */
bool ambit_writer_begin(const ambit_graph *g, ambit_expr e, size_t room, char *out);
#endif
