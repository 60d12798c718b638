/* fields.h -- requests and results of verbs as declared data: one reader makes a struct of C of a table of Lua's, one
** writer makes a table of a struct.
**
** A field is a key, a kind, and where the value lies in the struct. What a field points to (lists, texts) is Lua's: the
** reader leaves it on the stack, or the table keeps it.
*/
#ifndef AMBIT_LUA_FIELDS_H
#define AMBIT_LUA_FIELDS_H
#include "script/core.h"
#include <stddef.h>

enum {
  AMBIT_LUA_TEXT,       /* const char * */
  AMBIT_LUA_BUFFER,     /* char []; only written, and only if it is not "" */
  AMBIT_LUA_NUMBER,     /* double */
  AMBIT_LUA_COUNT,      /* uint32_t */
  AMBIT_LUA_SIGN,       /* int32_t */
  AMBIT_LUA_SIZE,       /* size_t */
  AMBIT_LUA_WORK,       /* uint64_t */
  AMBIT_LUA_FLAG,       /* bool */
  AMBIT_LUA_SWITCH,     /* uint32_t, 0 or 1 */
  AMBIT_LUA_CHOICE,     /* uint32_t: which of the texts of `of`, which end with NULL; only read */
  AMBIT_LUA_EXPRESSION, /* ambit_expr; only read */
  AMBIT_LUA_ENCLOSURE,  /* ambit_interval; only written, and only if it is not empty */
  AMBIT_LUA_OTHER,      /* something that the reader passes over: the verb itself takes it */
  /* lists: a pointer, and a size_t at `count` */
  AMBIT_LUA_TEXTS,       /* const char ** */
  AMBIT_LUA_NUMBERS,     /* double * */
  AMBIT_LUA_EXPRESSIONS, /* ambit_expr * */
  AMBIT_LUA_ENCLOSURES,  /* ambit_interval * */
  AMBIT_LUA_OPTIONS,     /* ambit_option *: { name, text, name, text, ... } */
  AMBIT_LUA_ROWS         /* structs, each a table with the fields of `of`, an ambit_lua_fields */
};

#define AMBIT_LUA_NEEDED 1u /* the field may not be missing */
#define AMBIT_LUA_SAME 2u   /* the list's length is known: by a field before it, or by who made the struct */

typedef struct ambit_lua_field {
  const char *key;
  uint32_t kind, flags;
  size_t at, count;
  const void *of;
} ambit_lua_field;

typedef struct ambit_lua_fields {
  const ambit_lua_field *field;
  size_t n, size; /* of the struct, in bytes */
} ambit_lua_fields;

#define AMBIT_LUA_ONE(type, key, kind, flags, member)                                                                  \
  { key, kind, flags, offsetof(type, member), 0, NULL }
#define AMBIT_LUA_LIST(type, key, kind, flags, member, count)                                                          \
  { key, kind, flags, offsetof(type, member), offsetof(type, count), NULL }
#define AMBIT_LUA_FIELDS(type, array)                                                                                  \
  { array, sizeof(array) / sizeof *(array), sizeof(type) }

/* Fields of the table at idx into `to`; what is missing keeps its value there. Raises an error "core.WHAT: ..." for a
** value that does not fit, for a list of another length, and for a key that is no field. */
void ambit_lua_read(lua_State *L, int idx, const char *what, const ambit_lua_fields *fields, void *to);
/* Sets the fields in the table on top of the stack. */
void ambit_lua_write(lua_State *L, const ambit_lua_fields *fields, const void *from);
/* Pushes a table with the fields. */
void ambit_lua_push(lua_State *L, const ambit_lua_fields *fields, const void *from);
#endif
