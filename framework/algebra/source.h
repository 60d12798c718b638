/* source.h -- expressions as source text: "text" (as ambit_graph_text writes them), Lua, LaTeX, Modelica.
**
** Lua: the operators and functions of `ambit` under their own names (sin, number, pi, ...), bracketed as the graph
** is, so that running the text makes the same nodes in the same order; numbers are wrapped where Lua itself would
** calculate with them. Modelica: an arithmetic expression of its specification, appendix A (version 3.6). LaTeX: math
** mode. A number is the shortest text that reads back as the same double; literals ("0.1", "1/3") and pi stay what they
** are. Texts are exact but for enclosures that are constants: LaTeX shows them, Modelica has their midpoint, Lua a
** fresh datum.
*/
#ifndef AMBIT_SOURCE_H
#define AMBIT_SOURCE_H
#include "graph/writer.h"

typedef enum ambit_language {
  AMBIT_LANGUAGE_TEXT,
  AMBIT_LANGUAGE_LUA,
  AMBIT_LANGUAGE_LATEX,
  AMBIT_LANGUAGE_MODELICA,
  AMBIT_LANGUAGE_COUNT
} ambit_language;

extern const ambit_style ambit_style_lua, ambit_style_latex, ambit_style_modelica;
extern const char *const ambit_language_name[AMBIT_LANGUAGE_COUNT]; /* "text", "lua", "latex", "modelica" */

/* The source text of e, in memory that the caller frees. A node that has a name is written as that name, but for e
** itself unless it is a leaf; other leaves by ambit_source_identifier. INVALID: longer than AMBIT_SOURCE_MAX, or an
** exponent beyond 1e9, which Lua would not take for an integer. */
ambit_status ambit_source_write(const ambit_graph *g, ambit_expr e, ambit_language language,
    const ambit_source_names *names, char **out, ambit_failure *f);

/* The nodes below e[0..ne) that want a name so that no text gets long: none if all are short, otherwise what is used
** more than once, and what is long or deep. Operands first. Returns how many there are, writes at most room;
** SIZE_MAX: out of memory. */
size_t ambit_source_share(const ambit_graph *g, size_t ne, const ambit_expr *e, size_t room, ambit_expr *node);

/* What something called `name` may be called in the language: yaw_rate is \mathrm{yaw\_rate}, beta1 \beta_{1}; a name
** that is no identifier of Modelica is quoted. Different names may become equal only if they are no identifiers. False:
** does not fit. */
bool ambit_source_identifier(ambit_language language, const char *name, size_t room, char *out);
#endif
