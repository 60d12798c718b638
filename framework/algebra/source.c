/* source.c -- the languages. */
#include "algebra/source.h"
#include "base/vector.h"

const char *const ambit_language_name[AMBIT_LANGUAGE_COUNT] = { "text", "lua", "latex", "modelica" };
static const ambit_style *const style_of[AMBIT_LANGUAGE_COUNT] = { &ambit_style_text, &ambit_style_lua,
  &ambit_style_latex, &ambit_style_modelica };

ambit_status ambit_source_write(const ambit_graph *g, ambit_expr e, ambit_language language,
    const ambit_source_names *names, char **out, ambit_failure *f) {
  *out = NULL;
  ambit_writer w = { .g = g, .style = style_of[language], .names = names, .grows = true };
  w.out = ambit_vector_reserve(NULL, &w.room, 64, 1);
  bool done = w.out && ambit_writer_run(&w, e);
  *out = w.out;
  if (!done) return ambit_fail(f, AMBIT_NOMEM, "out of memory for the text of an expression");
  if (w.used > AMBIT_SOURCE_MAX)
    return ambit_fail(f, AMBIT_INVALID,
        "the text of an expression is longer than %u characters: give names to its parts", AMBIT_SOURCE_MAX);
  if (w.too_high)
    return ambit_fail(f, AMBIT_INVALID, "an exponent beyond %d cannot be written as source", AMBIT_EXPONENT_MAX);
  return AMBIT_OK;
}
