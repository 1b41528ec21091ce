/* The header's versions and those of the library that is linked are the same, in all three forms. */
#include "check.h"

int main(int argc, char **argv) {
    char text[64];
    CHECK(LEAFLESS_VERSION == LEAFLESS_VERSION_MAJOR * 1000000 + LEAFLESS_VERSION_MINOR * 1000 + LEAFLESS_VERSION_PATCH);
    CHECK(leafless_version() == LEAFLESS_VERSION);
    CHECK(leafless_version() / 1000000 == LEAFLESS_VERSION_MAJOR);
    CHECK(leafless_version() / 1000 % 1000 == LEAFLESS_VERSION_MINOR);
    CHECK(leafless_version() % 1000 == LEAFLESS_VERSION_PATCH);
    snprintf(text, sizeof text, "%d.%d.%d", LEAFLESS_VERSION_MAJOR, LEAFLESS_VERSION_MINOR, LEAFLESS_VERSION_PATCH);
    CHECK(strcmp(leafless_version_string(), text) == 0);
    /* The package's version, from outside. */
    CHECK(argc == 2 && strcmp(leafless_version_string(), argv[1]) == 0);
    CHECK(leafless_version_string() == leafless_version_string());
    CHECK(leafless_abi() == LEAFLESS_ABI);
    CHECK(LEAFLESS_COMPATIBLE());
    /* The macro is one expression. */
    CHECK(1 == LEAFLESS_COMPATIBLE() && LEAFLESS_VERSION % 1000 == LEAFLESS_VERSION_PATCH);
    return 0;
}
