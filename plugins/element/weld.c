/* weld.c -- two bodies that are one; the same mathematics as a rigid link (attached.h). */
#include "attached.h"

AMBIT_ELEMENT_ENTRY("weld", "1.0",
    "A joint that does not move: a frame fixed to another one at `offset`, perhaps turned by `angle` about `axis`. The "
    "same as rigid_link.",
    attached_element)
