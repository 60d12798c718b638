/* conduct_object.h -- the writable data of one loaded object, and counters in front of the allocations it makes. */
#ifndef AMBIT_CONDUCT_OBJECT_H
#define AMBIT_CONDUCT_OBJECT_H
#include <stdbool.h>
#include <stddef.h>

#define CONDUCT_SEGMENTS 8

typedef struct conduct_object {
  size_t nsegment, bytes;
  struct {
    const unsigned char *at;
    unsigned char *copy;
    size_t size;
  } segment[CONDUCT_SEGMENTS];
} conduct_object;

/* false: no memory */
bool conduct_object_open(conduct_object *o, const void *address);
size_t conduct_object_changed(const conduct_object *o); /* bytes */
void conduct_object_close(conduct_object *o);
#endif
