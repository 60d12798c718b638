/* sanitized.h -- AMBIT_SANITIZED in builds with the address sanitizer: it reserves address space by the terabyte, so
** that limits of the system's for memory cannot be used. */
#ifndef AMBIT_LUA_SANITIZED_H
#define AMBIT_LUA_SANITIZED_H

#if defined(__SANITIZE_ADDRESS__)
#define AMBIT_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define AMBIT_SANITIZED 1
#endif
#endif
#endif
