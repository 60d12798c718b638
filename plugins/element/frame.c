/* frame.c -- a marked point or direction on a body; the same mathematics as a rigid link (attached.h) under the name
** that says what it is for.
*/
#include "attached.h"

AMBIT_ELEMENT_ENTRY("frame", "1.0",
    "A mark on a body: a frame at `offset` from another one, perhaps turned by `angle` about `axis`. The same as "
    "rigid_link.",
    attached_element)
