/* object.c -- the parts of an ELF header that decide whether dlopen is safe to try (System V ABI, chapters 4 and 5).
**
** glibc maps the segments that the program headers name; a page behind the end of a truncated file is a SIGBUS as
** soon as the loader reads it. So every header table and every loaded segment must lie inside the file. What is
** right is this very library: class, byte order and machine are compared with its own header, which the linker maps
** as __ehdr_start.
*/
#include "host/object.h"
#include <elf.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

extern const ElfW(Ehdr) __ehdr_start __attribute__((visibility("hidden")));

typedef struct object {
  FILE *stream;
  uint64_t bytes;
  ElfW(Ehdr) header;
} object;

static bool refuse(char *reason, size_t room, const char *why) {
  snprintf(reason, room, "%s", why);
  return false;
}

/* offset + count * size <= bytes, without overflow */
static bool lies_inside(const object *o, uint64_t offset, uint64_t count, uint64_t size) {
  if (offset > o->bytes) return false;
  return size == 0 || count <= (o->bytes - offset) / size;
}

static bool check_kind(const object *o, char *reason, size_t room) {
  const ElfW(Ehdr) *h = &o->header, *own = &__ehdr_start;
  if (memcmp(h->e_ident, ELFMAG, SELFMAG) != 0) return refuse(reason, room, "not a shared object (no ELF header)");
  if (h->e_ident[EI_CLASS] != own->e_ident[EI_CLASS] || h->e_ident[EI_DATA] != own->e_ident[EI_DATA])
    return refuse(reason, room, "built for another architecture (word size or byte order)");
  if (h->e_machine != own->e_machine) {
    snprintf(reason, room, "built for another architecture (ELF machine %u, this is %u)", (unsigned)h->e_machine,
        (unsigned)own->e_machine);
    return false;
  }
  if (h->e_type != ET_DYN) return refuse(reason, room, "not a shared object (an executable or an object file)");
  return true;
}

static bool check_segments(const object *o, char *reason, size_t room) {
  const ElfW(Ehdr) *h = &o->header;
  const char *truncated = "truncated: the file ends before what its header announces";
  if (h->e_phnum == 0 || h->e_phentsize != sizeof(ElfW(Phdr))) return refuse(reason, room, "damaged program headers");
  if (!lies_inside(o, h->e_phoff, h->e_phnum, h->e_phentsize)) return refuse(reason, room, truncated);
  if (h->e_shoff && !lies_inside(o, h->e_shoff, h->e_shnum, h->e_shentsize)) return refuse(reason, room, truncated);
  if (fseek(o->stream, (long)h->e_phoff, SEEK_SET) != 0) return refuse(reason, room, truncated);
  for (unsigned i = 0; i < h->e_phnum; i++) {
    ElfW(Phdr) segment;
    if (fread(&segment, sizeof segment, 1, o->stream) != 1) return refuse(reason, room, truncated);
    if (!lies_inside(o, segment.p_offset, 1, segment.p_filesz)) return refuse(reason, room, truncated);
  }
  return true;
}

static bool check_stream(FILE *stream, char *reason, size_t room) {
  object o = { .stream = stream };
  struct stat about;
  if (fstat(fileno(stream), &about) != 0) return refuse(reason, room, strerror(errno));
  if (!S_ISREG(about.st_mode)) return refuse(reason, room, "not a regular file");
  o.bytes = (uint64_t)about.st_size;
  if (o.bytes == 0) return refuse(reason, room, "the file is empty");
  if (fread(&o.header, 1, sizeof o.header, stream) != sizeof o.header) {
    bool elf = o.bytes >= SELFMAG && memcmp(o.header.e_ident, ELFMAG, SELFMAG) == 0;
    return refuse(reason, room, elf ? "truncated: not even an ELF header" : "not a shared object (no ELF header)");
  }
  return check_kind(&o, reason, room) && check_segments(&o, reason, room);
}

bool ambit_object_check(const char *file, char *reason, size_t room) {
  int number = open(file, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY); /* a pipe without a writer must not wait */
  FILE *stream = number < 0 ? NULL : fdopen(number, "rb");
  if (!stream) {
    refuse(reason, room, errno == ENOENT ? "no such file" : strerror(errno));
    if (number >= 0) close(number);
    return false;
  }
  bool good = check_stream(stream, reason, room);
  fclose(stream);
  return good;
}
