/* Linked to programs that run under ThreadSanitizer: tells it that a thread that waited on a futex comes after the one
 * that woke it. Rust's standard library makes its condition variables and mutexes of futexes by calling `syscall`, in
 * code that comes compiled without ThreadSanitizer; this function stands in front of the system's. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <linux/futex.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/syscall.h>

void __tsan_acquire(void *address);
void __tsan_release(void *address);
long syscall(long number, ...);

typedef long (*syscall_fn)(long, ...);

long syscall(long number, ...) {
    static void *system_function;
    void *function = __atomic_load_n(&system_function, __ATOMIC_ACQUIRE);
    syscall_fn call;
    va_list list;
    long arguments[6], result;
    int i, operation;
    if (function == NULL) {
        function = dlsym(RTLD_NEXT, "syscall");
        __atomic_store_n(&system_function, function, __ATOMIC_RELEASE);
    }
    /* ISO C converts no object pointer to a function's; POSIX says that their bytes are the same. */
    __builtin_memcpy(&call, &function, sizeof call);
    va_start(list, number);
    for (i = 0; i < 6; i++) {
        arguments[i] = va_arg(list, long);
    }
    va_end(list);
    operation = number == SYS_futex ? (int)arguments[1] & FUTEX_CMD_MASK : -1;
    if (operation == FUTEX_WAKE || operation == FUTEX_WAKE_BITSET) {
        __tsan_release((void *)arguments[0]);
    }
    result = call(number, arguments[0], arguments[1], arguments[2], arguments[3], arguments[4], arguments[5]);
    if (operation == FUTEX_WAIT || operation == FUTEX_WAIT_BITSET) {
        __tsan_acquire((void *)arguments[0]);
    }
    return result;
}
