/* scripted.c -- wrong on purpose: model does not know Lua. */
#include "graph/graph.h"
#include <lua.h>
