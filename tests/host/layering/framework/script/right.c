/* right.c -- nothing wrong here. */
#include "verbs/evaluate/evaluate.h"
#include <ffi.h>
#include <lua.h>
