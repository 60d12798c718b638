/* right.c -- nothing wrong here. */
#include "model/evaluate.h"
#include <ffi.h>
#include <lua.h>
