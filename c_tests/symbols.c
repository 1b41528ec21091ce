/* Every function of the header exists in the library. symbols.h is made of the header: FUNCTION(name) for each. */
#include "check.h"

typedef void (*any_function)(void);

static const struct {
    const char *name;
    any_function address;
} FUNCTIONS[] = {
#define FUNCTION(name) {#name, (any_function)name},
#include "symbols.h"
#undef FUNCTION
};

int main(void) {
    size_t i;
    for (i = 0; i < COUNT(FUNCTIONS); i++) {
        CHECK(FUNCTIONS[i].address != NULL);
        printf("%s\n", FUNCTIONS[i].name);
    }
    return 0;
}
