/* files.c -- files by Landlock (Documentation/userspace-api/landlock.rst of the Linux kernel). The calls have no
** wrapper in the C library. */
#include "sandbox.h"
#include <errno.h>
#include <fcntl.h>
#include <linux/landlock.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

/* rights by the version of Landlock that knows them; headers may be older than the kernel */
#define FILES_1 ((1ull << 13) - 1) /* execute, write, read, list, remove, make */
#define REFER (1ull << 13)         /* 2: rename to another folder */
#define TRUNCATE (1ull << 14)      /* 3 */
#define DEVICES (1ull << 15)       /* 5: ioctl on devices */
#define TCP 3ull                   /* 4: bind, connect */
#define SCOPED 3ull                /* 6: abstract sockets, signals to others */

#define READ (LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR)
#define WRITE (LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_FILE | LANDLOCK_ACCESS_FS_MAKE_REG)
#define OF_A_FILE (LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | TRUNCATE)

/* as in the kernel's newest header */
typedef struct ruleset {
  uint64_t files, network, scoped;
} ruleset;

static long version_of_system(void) {
  return syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
}

static size_t size_of(long version) {
  return version >= 6 ? sizeof(ruleset) : version >= 4 ? 2 * sizeof(uint64_t) : sizeof(uint64_t);
}

static uint64_t files_of(long version) {
  return FILES_1 | (version >= 2 ? REFER : 0) | (version >= 3 ? TRUNCATE : 0) | (version >= 5 ? DEVICES : 0);
}

/* A path that cannot be opened is not there, or may not be read anyway: nothing is allowed. */
static int allow(int rules, const char *path, uint64_t rights) {
  struct stat about;
  struct landlock_path_beneath_attr beneath = { .parent_fd = open(path, O_PATH | O_CLOEXEC) };
  if (beneath.parent_fd < 0) return 1;
  if (fstat(beneath.parent_fd, &about) == 0 && !S_ISDIR(about.st_mode)) rights &= OF_A_FILE;
  beneath.allowed_access = rights;
  int good = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &beneath, 0) == 0;
  int error = errno;
  close(beneath.parent_fd);
  errno = error;
  return good;
}

static int add_rules(const ambit_sandbox_request *q, int rules, uint64_t known) {
  for (size_t i = 0; i < q->nread; i++)
    if (!allow(rules, q->read[i], READ)) return 0;
  for (size_t i = 0; i < q->nwrite; i++)
    if (!allow(rules, q->write[i], (READ | WRITE | TRUNCATE | REFER) & known)) return 0;
  return allow(rules, "/dev/null", LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE);
}

int sandbox_keep_files(const ambit_sandbox_request *q, int *kept, char *text, size_t room) {
  long version = version_of_system();
  *kept = version >= 1;
  if (!*kept) return 1;
  ruleset all = { files_of(version), version >= 4 ? TCP : 0, version >= 6 ? SCOPED : 0 };
  int rules = (int)syscall(SYS_landlock_create_ruleset, &all, size_of(version), 0);
  int good = rules >= 0 && add_rules(q, rules, all.files) && syscall(SYS_landlock_restrict_self, rules, 0) == 0;
  if (!good) snprintf(text, room, "files cannot be kept from the process (Landlock): %s", strerror(errno));
  if (rules >= 0) close(rules);
  return good;
}
