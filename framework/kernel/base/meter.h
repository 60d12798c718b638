/* meter.h -- where the time goes: a tree of frames, each a part of the program inside the part that called it.
**
** Only `ambit profile` switches it on; without a profile every function here returns at once, and loops that are too
** hot even for that ask ambit_meter_is_on() when they are opened. A thread measures its own frames with a clock of its
** processor, in memory taken beforehand, so that a run allocates nothing. Threads of a pool hang their frames under the
** place that waits for them. What measuring itself costs is measured too, and subtracted.
*/
#ifndef AMBIT_METER_H
#define AMBIT_METER_H
#include <stdbool.h>
#include <stdint.h>

/* What a frame is. */
enum {
  AMBIT_FRAME_SCRIPT,     /* Lua */
  AMBIT_FRAME_CORE,       /* a function of the kernel that Lua calls */
  AMBIT_FRAME_VERB,       /* one of those that compute: evaluate, simulate, ... */
  AMBIT_FRAME_LOAD,       /* a plugin is found and loaded */
  AMBIT_FRAME_STAGE,      /* of a verb: graph, tape, context, open, run, close, records */
  AMBIT_FRAME_ELEMENT,    /* an element writes formulas */
  AMBIT_FRAME_SOLVER,     /* a solver's own work */
  AMBIT_FRAME_ARITHMETIC, /* an arithmetic's own loops */
  AMBIT_FRAME_SERVICE,    /* a service of the kernel */
  AMBIT_FRAME_OPERATION,  /* an opcode */
  AMBIT_FRAME_THREAD,     /* an item of a pool, on whatever thread */
  AMBIT_FRAME_KINDS
};

#define AMBIT_FRAME_NAME 96

typedef struct ambit_profile ambit_profile;

/* A node of the tree, all calls on the same path together. */
typedef struct ambit_meter_frame ambit_meter_frame;
struct ambit_meter_frame {
  uint32_t kind;
  char name[AMBIT_FRAME_NAME];
  ambit_meter_frame *parent, *child, *next;
  uint64_t count, ticks;             /* calls, and clock ticks inside them */
  uint64_t child_count, child_ticks; /* of that, in frames inside, on the same thread; marks are not counted */
  uint64_t marks;                    /* of the calls, those that are marks */
  ambit_meter_frame *anchor;         /* of a frame of another thread: whom it works for */
};

ambit_profile *ambit_profile_begin(void); /* this thread is measured from now on; NULL: out of memory */
/* No longer; all threads are joined into one tree, whose root is the script. Call it once. */
const ambit_meter_frame *ambit_profile_end(ambit_profile *p);
void ambit_profile_close(ambit_profile *p);
/* Of a frame without those inside it, less the cost of measuring; and that cost. */
double ambit_profile_self_seconds(const ambit_profile *p, const ambit_meter_frame *f);
double ambit_profile_cost_seconds(const ambit_profile *p, const ambit_meter_frame *f);
/* Numbers that are noted with the present frame, such as what its time may be divided by; all zero at first. NULL: not
** measured, or no memory. Of the first thread's frames only. */
typedef struct ambit_meter_table {
  struct ambit_meter_table *next;
  const ambit_meter_frame *frame;
  const char *title; /* a constant */
  uint32_t rows, columns;
  char (*name)[AMBIT_FRAME_NAME]; /* [rows] */
  double *value;                  /* [rows x columns] */
} ambit_meter_table;
ambit_meter_table *ambit_meter_tabulate(const char *title, uint32_t rows, uint32_t columns);
const ambit_meter_table *ambit_profile_tables(const ambit_profile *p);

double ambit_profile_wall_seconds(const ambit_profile *p); /* between begin and end */
bool ambit_profile_is_cut(const ambit_profile *p);         /* frames were left out for lack of room */

bool ambit_meter_is_on(void); /* is this thread measured? */
void ambit_meter_enter(uint32_t kind, const char *name);
void ambit_meter_leave(void);
/* A part of the present frame begins, and goes on until the next mark or the end of the frame: one look at the
** clock. */
void ambit_meter_mark(uint32_t kind, const char *name);
/* Leaves all frames but the first `depth`: after an error. */
uint32_t ambit_meter_depth(void);
void ambit_meter_unwind(uint32_t depth);

/* The present place, for other threads to work for; to be passed to join by one of them. */
typedef struct ambit_meter_place {
  ambit_profile *profile; /* NULL: not measured */
  ambit_meter_frame *frame;
} ambit_meter_place;
ambit_meter_place ambit_meter_here(void);
/* Around an item of work, on any thread: true if it is measured, then part is due. */
bool ambit_meter_join(const ambit_meter_place *place, const char *name);
void ambit_meter_part(void);
#endif
