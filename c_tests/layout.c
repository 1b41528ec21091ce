/* The layouts of the header's structs and the values of its constants in C; with any argument, those of the library.
   layout.h is made from the header: STRUCT(name), FIELD(struct, name) and VALUE(name) for each. */
#include "check.h"

int main(int argc, char **argv) {
    (void)argv;
    if (argc > 1) {
        const size_t length = leafless_test_layout(NULL, 0);
        char *text = (char *)malloc(length + 1);
        CHECK(text != NULL);
        CHECK(leafless_test_layout(text, length + 1) == length);
        CHECK(strlen(text) == length);
        fputs(text, stdout);
        free(text);
        return 0;
    }
#define STRUCT(name) printf(#name " %lu\n", (unsigned long)sizeof(name));
#define FIELD(name, field)                                                                                       \
    printf(#name "." #field " %lu %lu\n", (unsigned long)offsetof(name, field),                                  \
           (unsigned long)sizeof(((name *)0)->field));
#define VALUE(name) printf(#name " %ld\n", (long)name);
#include "layout.h"
    return 0;
}
