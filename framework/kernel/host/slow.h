/* slow.h -- the slow path of the elementary functions (num/elementary.h): a plugin, loaded at the first argument
** that needs it. */
#ifndef AMBIT_SLOW_H
#define AMBIT_SLOW_H
#include "host/load.h"
#include <ambit/registry.h>

/* From now on the plugin service/elementary is looked for on this registry's path (NULL: as for
** ambit_registry_open), and a failure is noted through it. Once loaded it stays for the life of the process: any
** thread may be inside it. */
void ambit_slow_offer(ambit_registry *r, const char *path);
void ambit_slow_withdraw(ambit_registry *r); /* the registry is about to close */
/* The plugin, once it is loaded; else NULL. [any] */
const ambit_loaded *ambit_slow_loaded(void);
/* BROKEN if the plugin ever gave NaN or reversed bounds; what was computed is sound nevertheless: such bounds are
** replaced by the function's whole range. */
ambit_status ambit_slow_sound(ambit_failure *f);
#endif
