/* rigid_link.c -- a massless rigid link (formulas: attached.h). */
#include "attached.h"

AMBIT_ELEMENT_ENTRY("rigid_link", "1.0",
    "A massless rigid link: a frame at `offset` from another one, perhaps turned by `angle` about `axis`. Give it mass "
    "with rigid_body or point_mass.",
    attached_element)
