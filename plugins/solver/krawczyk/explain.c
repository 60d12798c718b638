/* explain.c -- why boxes are left undecided, and what helps. */
#include "krawczyk.h"
#include <ambit/code.h>

static int has_unbounded(const krawczyk *k) {
  for (uint32_t i = 0; i < k->undecided.count; i++)
    if (!box_is_bounded(k->n, boxes_at(&k->undecided, k->m, i))) return 1;
  return 0;
}

static ambit_status explain_boxes(const krawczyk *k, uint32_t undecided) {
  const ambit_host *h = k->host;
  const char *s = undecided == 1 ? "" : "es";
  if (k->further)
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_FURTHER,
        "%u box%s cannot be told: there are more equations than unknowns, and that those left over hold exactly where "
        "the others do cannot be proved by enclosures",
        undecided, s);
  if (has_unbounded(k))
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_SEARCH_UNBOUNDED,
        "%u box%s could be neither proved nor excluded, and cut no further: they reach out to infinity, beyond the "
        "largest double; search a bounded box",
        undecided, s);
  return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDECIDED,
      "%u box%s of at most `tolerance` = %g%s could be neither proved nor excluded: a multiple root, a singular "
      "Jacobian, an edge of f's domain, or data too uncertain; %s or narrow the data",
      undecided, s, k->options.tolerance, k->np ? " (or as far as the uncertain data blur the equations)" : "",
      k->np ? "raise `parameter_pieces`, lower `tolerance`" : "lower `tolerance`");
}

ambit_status krawczyk_explain(const krawczyk *k, enum why why, uint32_t undecided) {
  const ambit_host *h = k->host;
  switch (why) {
  case WHY_BOXES:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_BOXES_MAX,
        "%u box%s left undecided after `boxes_max` = %u: raise it, search a smaller box, or narrow the data", undecided,
        undecided == 1 ? " is" : "es are", k->options.boxes_max);
  case WHY_UNDECIDED:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_UNDECIDED_MAX,
        "more than `undecided_max` = %u boxes could be neither proved nor excluded: the roots are not isolated, or the "
        "data too uncertain; narrow the data, or raise `tolerance` or `undecided_max`",
        k->options.undecided_max);
  case WHY_ROOTS:
    return h->fail_code(h, AMBIT_UNABLE, AMBIT_CODE_UNABLE_ROOTS_MAX,
        "there are more than `roots_max` = %u roots: raise it, or search a smaller box", k->options.roots_max);
  default: return explain_boxes(k, undecided);
  }
}
