/* What null.c and the programs beside it have in common: calls with a parameter that is NULL, misaligned or out of range
   are refused, by a status and a message that names the parameter, and nothing is written. */
#ifndef NULL_H
#define NULL_H

#include "check.h"

#define WRONG(bytes) ((void *)((char *)(bytes) + 1))

/* `call` with the parameter NULL is refused; `wrong`, the same with it misaligned, too. */
#define NULL_POINTER(function, parameter, call) refused(LEAFLESS_E_NULL, #function, #parameter, (call))
#define MISALIGNED(function, parameter, call) refused(LEAFLESS_E_ARGUMENT, #function, #parameter, (call))
#define MAY_BE_NULL(function, parameter, call) refused(LEAFLESS_OK, #function, #parameter, (call))
#define BAD_NUMBER(function, parameter, call) refused(LEAFLESS_E_ARGUMENT, #function, #parameter, (call))

static void *const UNTOUCHED = (void *)(uintptr_t)0x5a5a5a58;

static inline void refused(leafless_status expected, const char *function, const char *parameter, leafless_status found) {
    char message[512];
    if (found != expected) {
        fprintf(stderr, "%s with a bad `%s`: %s instead of %s\n", function, parameter, leafless_status_name(found),
                leafless_status_name(expected));
        exit(1);
    }
    if (expected != LEAFLESS_OK) {
        CHECK(leafless_last_status() == expected);
        (void)leafless_last_error(message, sizeof message);
        if (strstr(message, parameter) == NULL) {
            fprintf(stderr, "%s with a bad `%s` says only \"%s\"\n", function, parameter, message);
            exit(1);
        }
    }
}

/* A buffer for any result. No function may change a byte of it here: all are 0x5a behind a valid struct_size. */
static double room[64];

static inline void *fresh(void) {
    const uint32_t struct_size = sizeof room;
    memset(room, 0x5a, sizeof room);
    memcpy(room, &struct_size, sizeof struct_size);
    return room;
}

static inline void untouched(void) {
    const unsigned char *bytes = (const unsigned char *)room;
    const uint32_t struct_size = sizeof room;
    size_t i;
    CHECK(memcmp(room, &struct_size, sizeof struct_size) == 0);
    for (i = sizeof struct_size; i < sizeof room; i++) {
        CHECK(bytes[i] == 0x5a);
    }
}

#endif
