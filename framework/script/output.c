/* output.c -- files that commands write: whole, or not at all.
**
** What is written goes to a file of another name beside the old one, which only this process knows (mkstemp), and takes
** its place when all of it is on the disk. So a reader never sees half a report, a failure leaves the old one as it
** was, and nobody can lay a link where the new one will be. Devices and pipes are written to as they are.
*/
#include "script/core.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int write_all(int file, const char *text, size_t length) {
  while (length) {
    ssize_t n = write(file, text, length);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    text += n, length -= (size_t)n;
  }
  return 0;
}

static int finish(int file, int problem) { return close(file) != 0 && problem == 0 ? errno : problem; }

static int write_in_place(const char *name, const char *text, size_t length) {
  int file = open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  return file < 0 ? errno : finish(file, write_all(file, text, length));
}

/* The rights that open() would have given. */
static mode_t usual_mode(void) {
  mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

/* `name` is no link and no special file; `mode`: of the new one */
static int replace(const char *name, mode_t mode, const char *text, size_t length) {
  size_t bytes = strlen(name) + sizeof ".XXXXXX";
  char *other = malloc(bytes);
  if (!other) return ENOMEM;
  snprintf(other, bytes, "%s.XXXXXX", name);
  int file = mkostemp(other, O_CLOEXEC), problem = file < 0 ? errno : 0;
  if (file >= 0) {
    if (fchmod(file, mode) != 0) problem = errno;
    if (!problem) problem = write_all(file, text, length);
    if (!problem && fsync(file) != 0) problem = errno;
    problem = finish(file, problem);
    if (!problem && rename(other, name) != 0) problem = errno;
    if (problem) unlink(other);
  }
  free(other);
  return problem;
}

/* write_file(name, text): nil, or what went wrong; then the file is what it was */
static int write_file(lua_State *L) {
  size_t length;
  struct stat about;
  const char *name = luaL_checkstring(L, 1), *text = luaL_checklstring(L, 2, &length);
  bool there = stat(name, &about) == 0;
  int problem;
  if (there && !S_ISREG(about.st_mode)) {
    problem = write_in_place(name, text, length);
  } else {
    char *real = there ? realpath(name, NULL) : NULL; /* a link goes on leading to the file */
    problem = replace(real ? real : name, there ? about.st_mode & 0777 : usual_mode(), text, length);
    if (problem == EACCES && there) problem = write_in_place(name, text, length); /* ours, in a folder that is not */
    free(real);
  }
  if (!problem) return 0;
  lua_pushfstring(L, "%s: %s", name, strerror(problem));
  return 1;
}

void ambit_lua_open_output(lua_State *L, ambit_lua *core) {
  static const luaL_Reg functions[] = { { "write_file", write_file }, { NULL, NULL } };
  ambit_lua_set_functions(L, core, functions);
}
