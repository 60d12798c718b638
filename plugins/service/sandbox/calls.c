/* calls.c -- system calls by seccomp: a list of those that a computation needs; all others are refused with EPERM. */
#include "sandbox.h"
#if HAS_SECCOMP
#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

/* Which files may be opened is Landlock's to say, where there is one; mmap of a library wants PROT_EXEC. */
static const int allowed[] = { SCMP_SYS(read), SCMP_SYS(readv), SCMP_SYS(pread64), SCMP_SYS(write), SCMP_SYS(writev),
  SCMP_SYS(pwrite64), SCMP_SYS(lseek), SCMP_SYS(close), SCMP_SYS(dup), SCMP_SYS(dup2), SCMP_SYS(dup3), SCMP_SYS(pipe2),
  SCMP_SYS(open), SCMP_SYS(openat), SCMP_SYS(stat), SCMP_SYS(fstat), SCMP_SYS(lstat), SCMP_SYS(newfstatat),
  SCMP_SYS(statx), SCMP_SYS(access), SCMP_SYS(faccessat), SCMP_SYS(faccessat2), SCMP_SYS(readlink),
  SCMP_SYS(readlinkat), SCMP_SYS(getdents64), SCMP_SYS(getcwd), SCMP_SYS(chdir), SCMP_SYS(fchdir), SCMP_SYS(ftruncate),
  SCMP_SYS(fsync), SCMP_SYS(fdatasync), SCMP_SYS(rename), SCMP_SYS(renameat), SCMP_SYS(renameat2), SCMP_SYS(unlink),
  SCMP_SYS(unlinkat), SCMP_SYS(fchmod), SCMP_SYS(umask), SCMP_SYS(flock), SCMP_SYS(mmap), SCMP_SYS(munmap),
  SCMP_SYS(mprotect), SCMP_SYS(mremap), SCMP_SYS(madvise), SCMP_SYS(mincore), SCMP_SYS(brk), SCMP_SYS(futex),
  SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(set_tid_address), SCMP_SYS(sched_yield),
  SCMP_SYS(sched_getaffinity), SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn),
  SCMP_SYS(sigaltstack), SCMP_SYS(restart_syscall), SCMP_SYS(setitimer), SCMP_SYS(getitimer), SCMP_SYS(timer_create),
  SCMP_SYS(timer_settime), SCMP_SYS(timer_delete), SCMP_SYS(nanosleep), SCMP_SYS(clock_nanosleep),
  SCMP_SYS(clock_gettime), SCMP_SYS(clock_getres), SCMP_SYS(gettimeofday), SCMP_SYS(time), SCMP_SYS(times),
  SCMP_SYS(getrusage), SCMP_SYS(getrlimit), SCMP_SYS(getpid), SCMP_SYS(getppid), SCMP_SYS(gettid), SCMP_SYS(getuid),
  SCMP_SYS(geteuid), SCMP_SYS(getgid), SCMP_SYS(getegid), SCMP_SYS(uname), SCMP_SYS(sysinfo), SCMP_SYS(getrandom),
  SCMP_SYS(poll), SCMP_SYS(ppoll), SCMP_SYS(select), SCMP_SYS(pselect6), SCMP_SYS(exit), SCMP_SYS(exit_group) };

/* Processes of its own: to fork them, to wait for them and to end them. */
static const int of_children[] = { SCMP_SYS(fork), SCMP_SYS(vfork), SCMP_SYS(wait4), SCMP_SYS(waitid), SCMP_SYS(kill),
  SCMP_SYS(prctl), SCMP_SYS(setrlimit) };

static int add_list(scmp_filter_ctx filter, const int *list, size_t n) {
  int error = 0;
  for (size_t i = 0; i < n && !error; i++)
    if (list[i] >= 0) error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, list[i], 0); /* < 0: not on this machine */
  return error;
}

/* The call, if its argument is the value, or has all bits of the mask. */
static int add_if(scmp_filter_ctx filter, int call, unsigned argument, scmp_datum_t value) {
  const struct scmp_arg_cmp equal = { argument, SCMP_CMP_EQ, value, 0 };
  return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, 1, &equal);
}

static int add_if_masked(scmp_filter_ctx filter, int call, unsigned argument, scmp_datum_t mask) {
  const struct scmp_arg_cmp masked = { argument, SCMP_CMP_MASKED_EQ, mask, mask };
  return seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, call, 1, &masked);
}

/* Threads, but processes only with `children`; limits are read or, there, made smaller; terminals are asked for their
** size; the process may abort. clone3 hides its flags behind a pointer: without it the C library takes clone. */
static int add_special(scmp_filter_ctx filter, const ambit_sandbox_request *q) {
  static const scmp_datum_t question[] = { TCGETS, TIOCGWINSZ };
  static const scmp_datum_t query[] = { F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_DUPFD_CLOEXEC, F_SETLK, F_SETLKW,
    F_GETLK };
  int error = seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
  if (!error && q->children) error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(clone), 0);
  if (!error && !q->children) error = add_if_masked(filter, SCMP_SYS(clone), 0, CLONE_VM | CLONE_THREAD);
  if (!error && q->children) error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(prlimit64), 0);
  if (!error && !q->children) error = add_if(filter, SCMP_SYS(prlimit64), 2, 0);
  for (size_t i = 0; i < sizeof question / sizeof *question && !error; i++)
    error = add_if(filter, SCMP_SYS(ioctl), 1, question[i]);
  for (size_t i = 0; i < sizeof query / sizeof *query && !error; i++)
    error = add_if(filter, SCMP_SYS(fcntl), 1, query[i]);
  return error ? error : add_if(filter, SCMP_SYS(tgkill), 0, (scmp_datum_t)getpid()); /* abort() */
}

int sandbox_keep_calls(const ambit_sandbox_request *q, char *text, size_t room) {
  scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  int error = filter ? 0 : -ENOMEM;
  if (!error) error = add_list(filter, allowed, sizeof allowed / sizeof *allowed);
  if (!error && q->children) error = add_list(filter, of_children, sizeof of_children / sizeof *of_children);
  if (!error) error = add_special(filter, q);
  if (!error) error = seccomp_load(filter);
  if (filter) seccomp_release(filter);
  if (error) snprintf(text, room, "system calls cannot be kept from the process (seccomp): %s", strerror(-error));
  return !error;
}
#else
#include <stdio.h>

int sandbox_keep_calls(const ambit_sandbox_request *q, char *text, size_t room) {
  (void)q;
  snprintf(text, room, "this Ambit was built without libseccomp");
  return 0;
}
#endif
