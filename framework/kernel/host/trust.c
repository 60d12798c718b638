/* trust.c -- who may write where; the rules are those by which ssh trusts the files of a user. */
#include "host/trust.h"
#include <dlfcn.h>
#include <errno.h>
#include <grp.h>
#include <link.h>
#include <pthread.h>
#include <pwd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct folder {
  struct folder *next;
  char name[];
} folder;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static folder *trusted; /* kept for the life of the process */
static bool shadows;

ambit_status ambit_trust_folder(const char *name, ambit_failure *f) {
  struct stat about;
  char *real = realpath(name, NULL);
  if (!real || stat(real, &about) != 0 || !S_ISDIR(about.st_mode)) {
    int problem = real ? ENOTDIR : errno;
    free(real);
    return ambit_fail(f, AMBIT_INVALID, "cannot trust %s: %s", name, strerror(problem));
  }
  folder *made = malloc(sizeof *made + strlen(real) + 1);
  if (made) {
    memcpy(made->name, real, strlen(real) + 1);
    pthread_mutex_lock(&lock);
    made->next = trusted;
    trusted = made;
    pthread_mutex_unlock(&lock);
  }
  free(real);
  return made ? AMBIT_OK : ambit_no_memory(f);
}

void ambit_trust_shadows(void) {
  pthread_mutex_lock(&lock);
  shadows = true;
  pthread_mutex_unlock(&lock);
}

bool ambit_trust_has_shadows(void) {
  pthread_mutex_lock(&lock);
  bool has = shadows;
  pthread_mutex_unlock(&lock);
  return has;
}

static folder *first(void) {
  pthread_mutex_lock(&lock);
  folder *list = trusted;
  pthread_mutex_unlock(&lock);
  return list;
}

void ambit_trust_each(void (*tell)(void *user, const char *folder), void *user) {
  for (const folder *t = first(); t; t = t->next) tell(user, t->name);
}

char *ambit_trust_kernel(void) {
  Dl_info about;
  struct link_map *map = NULL; /* its name is empty for the program itself */
  if (!dladdr1(&shadows, &about, (void **)&map, RTLD_DL_LINKMAP) || !map) return NULL;
  return realpath(map->l_name[0] ? map->l_name : "/proc/self/exe", NULL);
}

bool ambit_trust_same(const struct stat *a, const struct stat *b) {
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino && a->st_size == b->st_size &&
         a->st_mtim.tv_sec == b->st_mtim.tv_sec && a->st_mtim.tv_nsec == b->st_mtim.tv_nsec &&
         a->st_ctim.tv_sec == b->st_ctim.tv_sec && a->st_ctim.tv_nsec == b->st_ctim.tv_nsec;
}

/* name is `inside`, or lies below it; both are real names */
static bool lies_in(const char *name, const char *inside) {
  size_t n = strlen(inside);
  if (n == 1) return true; /* "/" */
  return strncmp(name, inside, n) == 0 && (name[n] == '\0' || name[n] == '/');
}

/* The group has nobody but this user in it, by the custom that gives each user a group of the same name. */
static bool is_private_group(gid_t group, uid_t user) {
  char room[4096], more[4096];
  struct passwd who, *found = NULL;
  struct group set, *known = NULL;
  if (getpwuid_r(user, &who, room, sizeof room, &found) != 0 || !found) return false;
  if (getgrgid_r(group, &set, more, sizeof more, &known) != 0 || !known) return false;
  if (who.pw_gid != group || strcmp(who.pw_name, set.gr_name) != 0) return false;
  for (char **member = set.gr_mem; *member; member++)
    if (strcmp(*member, who.pw_name) != 0) return false;
  return true;
}

/* NULL, or what is wrong with this file or folder. */
static const char *find_fault(const struct stat *about, const struct stat *kernel) {
  uid_t owner = about->st_uid;
  bool owned = owner == 0 || owner == geteuid() || (kernel && owner == kernel->st_uid);
  if (!owned) return "belongs to somebody else";
  if (S_ISDIR(about->st_mode) && (about->st_mode & S_ISVTX)) return NULL;
  if (about->st_mode & S_IWOTH) return "may be written by everybody";
  if ((about->st_mode & S_IWGRP) && !is_private_group(about->st_gid, owner)) return "may be written by its group";
  return NULL;
}

static bool check_one(const char *name, const struct stat *kernel, char *reason, size_t room) {
  struct stat about;
  if (stat(name, &about) != 0) {
    snprintf(reason, room, "%s: %s", name, strerror(errno));
    return false;
  }
  const char *fault = find_fault(&about, kernel);
  if (!fault) return true;
  snprintf(reason, room, "%s %s (mode %04o): whoever can may have changed it; %s, or trust its folder (--trust %s)",
      name, fault, (unsigned)(about.st_mode & 07777), about.st_uid == geteuid() ? "chmod go-w it" : "copy it",
      S_ISDIR(about.st_mode) ? name : "FOLDER");
  return false;
}

/* The file and the folders above it, up to one that holds the kernel too. Cuts `name` up. */
static bool check_all(char *name, const char *kernel, char *reason, size_t room) {
  struct stat about;
  bool known = kernel && stat(kernel, &about) == 0;
  for (;;) {
    if (known && lies_in(kernel, name)) return true;
    if (!check_one(name, known ? &about : NULL, reason, room)) return false;
    char *slash = strrchr(name, '/');
    if (!slash || strcmp(name, "/") == 0) return true;
    slash[slash == name] = '\0'; /* the last one is "/" */
  }
}

bool ambit_trust_file(const char *file, char *reason, size_t room) {
  char *real = realpath(file, NULL);
  if (!real) {
    snprintf(reason, room, "%s", strerror(errno));
    return false;
  }
  for (const folder *t = first(); t; t = t->next)
    if (lies_in(real, t->name)) {
      free(real);
      return true;
    }
  char *kernel = ambit_trust_kernel();
  bool good = check_all(real, kernel, reason, room);
  free(kernel);
  free(real);
  return good;
}
