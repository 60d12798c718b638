/* base.h -- what every plugin shares: version, status, host services, entry.
**
** Rules that hold for the whole ABI:
**  - C17 and C++17, UTF-8; int32/uint32/double/pointers only; no bit-fields, no enums in structs.
**  - Every struct that crosses the border starts with `size`; fields are only ever appended; the reader copies
**    min(size, own size) into a zeroed struct; a NULL function pointer means "use the kernel's default".
**  - Nobody longjmps, exits, prints or throws across the border.
**  - Thread tags: [any] any thread, [main] the thread that owns the Lua state, [ctx] one thread at a time per context.
**  - An interval is two doubles lo <= hi; empty is lo = +inf, hi = -inf; entire is (-inf, +inf). A bound is never NaN.
*/
#ifndef AMBIT_BASE_H
#define AMBIT_BASE_H
#include <stddef.h>
#include <stdint.h>

#ifdef __FAST_MATH__
#error "Ambit cannot be compiled with -ffast-math: enclosures would be wrong"
#endif

#define AMBIT_ABI_MAJOR 1
#define AMBIT_ABI_MINOR 0
#define AMBIT_ABI ((uint32_t)AMBIT_ABI_MAJOR << 16 | AMBIT_ABI_MINOR)

#if defined(_WIN32)
#define AMBIT_EXPORT __declspec(dllexport)
#else
#define AMBIT_EXPORT __attribute__((visibility("default")))
#endif

#if defined(__GNUC__)
#define AMBIT_PRINTF(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define AMBIT_PRINTF(text, first)
#endif

/* Outcome of a call. Values are ABI. */
typedef int32_t ambit_status;
#define AMBIT_OK 0      /* done, result guaranteed */
#define AMBIT_DOMAIN 1  /* proven: no answer exists (log of a negative box) */
#define AMBIT_UNABLE 2  /* not proven either way: the enclosure blew up, the step cannot shrink further */
#define AMBIT_INVALID 3 /* the caller broke the contract (bad parameter, shape, unit) */
#define AMBIT_NOMEM 4
#define AMBIT_STOPPED 5 /* the sink asked to stop */
#define AMBIT_BROKEN 6  /* the plugin found its own state inconsistent */

/* Services that the kernel lends to a plugin; outlives every object made through it. */
typedef struct ambit_host ambit_host;
struct ambit_host {
  uint32_t size;
  uint32_t abi; /* major << 16 | minor of the kernel */
  /* [ctx] 64-byte aligned, zeroed, freed together with the object being opened; NULL on failure */
  void *(*alloc)(const ambit_host *h, size_t bytes);
  /* [any] records the message of this failure and returns s */
  ambit_status (*fail)(const ambit_host *h, ambit_status s, const char *format, ...) AMBIT_PRINTF(3, 4);
  void (*note)(const ambit_host *h, const char *format, ...) AMBIT_PRINTF(2, 3); /* [any] one log line */
  const void *(*service)(const ambit_host *h, const char *id); /* [any] "ambit.jet/1"; NULL if absent */
  /* [any] fail() with a code of <ambit/code.h>, or of the plugin's own: the word of s, a dot, what happened */
  ambit_status (*fail_code)(const ambit_host *h, ambit_status s, const char *code, const char *format, ...)
      AMBIT_PRINTF(4, 5);
};

/* A named parameter or option, declared as data, so that checks, units and the manual need no code.
** Shape: "" one number, "3" a vector, "3x3" a matrix by rows, "axis" a direction ("x", "-z" or three numbers; arrives
** as three numbers, not normalised), "flag" true or false (1 or 0), "integer", or a choice "rk4|rk8pd|msbdf" (arrives
** as the index of the word). */
typedef struct ambit_param {
  const char *name; /* "stiffness" */
  const char *
      unit; /* SI, "N/m"; "1" if dimensionless; "N m/rad|N/m": of a joint that turns, that slides ("N m|": of one that turns only) */
  const char *shape;    /* see above */
  const char *fallback; /* text used when absent ("0.5", "0,0,1", "true"); NULL = required; "" = may be absent */
  const char *doc;      /* one sentence */
} ambit_param;

/* The only symbol that the kernel looks up. Pure data: loading runs no code. */
typedef struct ambit_plugin {
  uint32_t size, abi;
  const char *id;                               /* "<kind>.<name>"; must match the file <kind>/<name>.so */
  const char *version;                          /* of the plugin */
  const char *doc;                              /* one paragraph, shown by `ambit plugins NAME` */
  const void *(*get)(const char *interface_id); /* [any] "ambit.arithmetic/1" -> ambit_arithmetic, else NULL */
} ambit_plugin;

#ifdef __cplusplus
extern "C" {
#endif
extern AMBIT_EXPORT const ambit_plugin ambit_entry;
#ifdef __cplusplus
}
#endif
#endif
