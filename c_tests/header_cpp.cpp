// The header stands alone, before any other, and may be included twice. Its functions in C please those who look closely.
#pragma GCC diagnostic error "-Wconversion"
#pragma GCC diagnostic error "-Wshadow"
#pragma GCC diagnostic error "-Wcast-qual"
#pragma GCC diagnostic error "-Wold-style-cast"
#include <leafless.h>
#include <leafless.h>

#include <type_traits>

// Enumerations have the size that the structs and the library count on.
static_assert(std::is_same<std::underlying_type<leafless_status>::type, int32_t>::value, "leafless_status");
static_assert(std::is_same<std::underlying_type<leafless_tag>::type, uint8_t>::value, "leafless_tag");
static_assert(std::is_same<std::underlying_type<leafless_membership>::type, uint8_t>::value, "leafless_membership");
static_assert(std::is_same<std::underlying_type<leafless_region>::type, uint8_t>::value, "leafless_region");
static_assert(std::is_same<std::underlying_type<leafless_rule>::type, uint32_t>::value, "leafless_rule");
static_assert(std::is_same<std::underlying_type<leafless_operation>::type, uint32_t>::value, "leafless_operation");
// A number of another enumeration, and one of none, is seen by the compiler.
static_assert(std::is_same<decltype(&leafless_octree_build),
                           leafless_status (*)(const leafless_solid *, const leafless_frame *, leafless_rule,
                                               const leafless_options *, leafless_octree **)>::value,
              "leafless_octree_build");
static_assert(!std::is_convertible<leafless_facets, leafless_rule>::value, "leafless_rule");
static_assert(!std::is_convertible<uint32_t, leafless_rule>::value, "leafless_rule");
static_assert(std::is_same<decltype(leafless_source::access), leafless_access>::value, "leafless_source");
static_assert(std::is_standard_layout<leafless_octree_info>::value, "leafless_octree_info");
static_assert(std::is_trivial<leafless_options>::value, "leafless_options");
static_assert(std::is_trivial<leafless_source>::value && std::is_trivial<leafless_sink>::value, "leafless_source");

int main() {
    leafless_frame frame = {{0.0, 0.0, 0.0}, 1.0, 4};
    const leafless_options options = LEAFLESS_INIT(leafless_options);
    if (options.struct_size != sizeof options || options.max_nodes != 0) {
        return 4;
    }
    leafless_octree *octree = nullptr;
    // Enumerators convert to the numbers that functions take.
    if (leafless_octree_new_uniform(&frame, LEAFLESS_TAG_FULL, LEAFLESS_TAG_EMPTY, &octree) != LEAFLESS_OK) {
        return 1;
    }
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    if (leafless_octree_describe(octree, &info) != LEAFLESS_OK) {
        return 2;
    }
    uint64_t length = 0;
    const leafless_sink sink = leafless_to_buffer(nullptr, 0, &length);
    if (leafless_octree_write(octree, &sink) != LEAFLESS_OK || length == 0) {
        return 5;
    }
    leafless_octree_free(octree);
    const leafless_source file = leafless_from_file("no/such/file", LEAFLESS_ACCESS_MAP);
    const leafless_source bytes = leafless_from_bytes(&frame, 1, LEAFLESS_ACCESS_COPY);
    if (leafless_octree_read(&file, &octree) != LEAFLESS_E_IO || leafless_octree_read(&bytes, &octree) != LEAFLESS_E_FORMAT) {
        return 6;
    }
    return info.root == LEAFLESS_TAG_FULL && info.frame.depth == 4 && LEAFLESS_COMPATIBLE() ? 0 : 3;
}
