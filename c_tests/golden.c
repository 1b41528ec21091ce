/* The test vectors of the format's specification, read by the library through C. Arguments: files whose names end in
   .lfl, each with a .txt beside it that says what must come of it (format_spec/vectors/README.md). */
#include "check.h"

static size_t valid, invalid, points;

/* The rest of a line after "key: ", or NULL if it has another key. */
static const char *value_of(const char *line, const char *key) {
    const size_t length = strlen(key);
    return strncmp(line, key, length) == 0 && strncmp(line + length, ": ", 2) == 0 ? line + length + 2 : NULL;
}

static const char *tag_name(leafless_tag tag) {
    static const char *const NAMES[] = {"EMPTY", "BRANCH", "PARTIAL", "FULL"};
    return NAMES[tag];
}

static void numbers(const char *text, double *out, size_t count) {
    char *end;
    size_t i;
    for (i = 0; i < count; i++) {
        out[i] = strtod(text, &end);
        CHECK(end != text);
        text = end;
    }
}

static uint64_t whole(const char *text, char **end) {
    return (uint64_t)strtoull(text, end, 10);
}

static void check_fact(const char *line, const leafless_octree *octree, const leafless_file_info *probe,
                       const leafless_file_section *sections, uint64_t *metadata) {
    static const char *const ANSWERS[] = {"outside", "inside", "undecided"};
    leafless_octree_info info = LEAFLESS_INIT(leafless_octree_info);
    leafless_cut_counts cuts = LEAFLESS_INIT(leafless_cut_counts);
    leafless_statistics all, levels[32];
    const char *value;
    char *end;
    double parsed[3];
    uint64_t count, i;
    OK(leafless_octree_describe(octree, &info));
    OK(leafless_octree_count_cuts(octree, &cuts));
    if ((value = value_of(line, "length")) != NULL) {
        CHECK(probe->file_length == whole(value, &end));
    } else if ((value = value_of(line, "version")) != NULL) {
        CHECK(probe->major == whole(value, &end) && *end == '.' && probe->minor == whole(end + 1, &end));
    } else if ((value = value_of(line, "origin")) != NULL || (value = value_of(line, "origin-decimal")) != NULL) {
        numbers(value, parsed, 3);
        CHECK(memcmp(parsed, info.frame.origin, sizeof parsed) == 0);
        CHECK(memcmp(parsed, probe->frame.origin, sizeof parsed) == 0);
    } else if ((value = value_of(line, "edge")) != NULL || (value = value_of(line, "edge-decimal")) != NULL) {
        numbers(value, parsed, 1);
        CHECK(parsed[0] == info.frame.edge && parsed[0] == probe->frame.edge);
    } else if ((value = value_of(line, "depth")) != NULL) {
        CHECK(info.frame.depth == whole(value, &end) && probe->frame.depth == info.frame.depth);
    } else if ((value = value_of(line, "root")) != NULL) {
        CHECK(strcmp(value, tag_name(info.root)) == 0 && probe->root == info.root);
    } else if ((value = value_of(line, "exterior")) != NULL) {
        CHECK(strcmp(value, tag_name(info.exterior)) == 0 && probe->exterior == info.exterior);
    } else if ((value = value_of(line, "proof")) != NULL) {
        count = whole(value, &end);
        CHECK(count < 4 && info.proof.full == (count % 2 == 1) && info.proof.empty == (count / 2 == 1));
        CHECK(probe->proof.full == info.proof.full && probe->proof.empty == info.proof.empty);
    } else if ((value = value_of(line, "displacement")) != NULL) {
        numbers(value, parsed, 1);
        CHECK(info.proof.displacement_model == parsed[0] && probe->proof.displacement_model == parsed[0]);
    } else if ((value = value_of(line, "planes")) != NULL) {
        CHECK(info.is_binary == (whole(value, &end) == 1) && probe->is_binary == info.is_binary);
    } else if ((value = value_of(line, "elements")) != NULL) {
        CHECK(info.elements == whole(value, &end) && probe->elements == info.elements);
    } else if ((value = value_of(line, "bricks")) != NULL) {
        CHECK(info.bricks == whole(value, &end) && probe->bricks == info.bricks);
    } else if ((value = value_of(line, "sections")) != NULL) {
        for (i = 0; i < probe->sections; i++) {
            CHECK(sections[i].kind == whole(value, &end));
            value = end;
        }
        CHECK(*value == '\0');
    } else if ((value = value_of(line, "owners")) != NULL) {
        for (i = 0; i < probe->sections; i++) {
            CHECK(sections[i].owner == whole(value, &end));
            CHECK(sections[i].owner == 0 || sections[i].name[0] == '\0');
            value = end;
        }
        CHECK(*value == '\0');
    } else if ((value = value_of(line, "objects")) != NULL) {
        CHECK(sections[0].kind == 1 && sections[0].count == whole(value, &end) && sections[0].is_required);
    } else if ((value = value_of(line, "level")) != NULL) {
        OK(leafless_octree_levels(octree, levels, COUNT(levels), &count));
        i = whole(value, &end);
        CHECK(i < count && levels[i].nodes == whole(end, &end));
        /* The file counts the cells of a level, the library the cells of the tree cut there. */
        (void)whole(end, &end);
    } else if ((value = value_of(line, "cells")) != NULL) {
        OK(leafless_octree_statistics(octree, &all));
        CHECK(all.lower_cells == whole(value, &end) && all.upper_cells == whole(end, &end));
    } else if ((value = value_of(line, "metadata")) != NULL) {
        const char *key, *found, *tab = strchr(value, '\t');
        size_t key_length, found_length;
        CHECK(tab != NULL);
        OK(leafless_octree_peek_metadata_at(octree, (*metadata)++, &count, &key, &key_length, &found, &found_length));
        CHECK(key_length == (size_t)(tab - value) && memcmp(key, value, key_length) == 0);
        CHECK(found_length == strlen(tab + 1) && memcmp(found, tab + 1, found_length) == 0);
    } else if ((value = value_of(line, "point")) != NULL) {
        leafless_membership answer;
        numbers(value, parsed, 3);
        OK(leafless_octree_contains(octree, parsed, &answer));
        /* The line is about tags alone: cuts decide points of PARTIAL cells. */
        if (cuts.surfaces == 0 || strcmp(strrchr(value, ' ') + 1, "undecided") != 0) {
            CHECK(strcmp(strrchr(value, ' ') + 1, ANSWERS[answer]) == 0);
        }
        points++;
    } else if ((value = value_of(line, "cut-point")) != NULL) {
        leafless_membership answer;
        numbers(value, parsed, 3);
        OK(leafless_octree_contains(octree, parsed, &answer));
        CHECK(strcmp(strrchr(value, ' ') + 1, ANSWERS[answer]) == 0);
        points++;
    }
}

static void read_valid(const char *path, char *text) {
    leafless_octree *octrees[6];
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    leafless_file_section sections[64];
    size_t length, i;
    uint8_t *bytes = check_read(path, &length);
    char *line;
    uint64_t metadata[6] = {0, 0, 0, 0, 0, 0}, count;
    OK(probe_path(path, strlen(path), &probe, sections, COUNT(sections)));
    OK(verify_bytes(bytes, length));
    OK(octree_open(path, strlen(path), &octrees[0]));
    OK(octree_map(path, strlen(path), &octrees[1]));
    OK(octree_map_verified(path, strlen(path), &octrees[2]));
    OK(octree_from_bytes(bytes, length, &octrees[3]));
    OK(octree_view_bytes(bytes, length, &octrees[4]));
    OK(octree_view_verified(bytes, length, &octrees[5]));
    OK(verify_path(path, strlen(path), LEAFLESS_ACCESS_COPY));
    OK(verify_path(path, strlen(path), LEAFLESS_ACCESS_MAP));
    CHECK(probe.file_length == length);
    for (line = strtok(text, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        const char *canonical = value_of(line, "canonical");
        for (i = 0; i < COUNT(octrees); i++) {
            check_fact(line, octrees[i], &probe, sections, &metadata[i]);
        }
        if (canonical != NULL && strcmp(canonical, "yes") == 0) {
            uint64_t again_length;
            uint8_t *again = check_bytes(octrees[0], &again_length);
            CHECK(again_length == length && memcmp(again, bytes, length) == 0);
            free(again);
        }
    }
    for (i = 0; i < COUNT(octrees); i++) {
        OK(leafless_octree_check(octrees[i]));
        CHECK(check_same(octrees[0], octrees[i]));
        OK(leafless_octree_peek_metadata_at(octrees[i], 0, &count, NULL, NULL, NULL, NULL));
        CHECK(count == metadata[i]);
    }
    for (i = 0; i < COUNT(octrees); i++) {
        leafless_octree_free(octrees[i]);
    }
    free(bytes);
    valid++;
}

static void one_of(leafless_status status) {
    CHECK(status == LEAFLESS_E_FORMAT || status == LEAFLESS_E_VERSION || status == LEAFLESS_E_DAMAGED);
}

/* Vectors of tri-dexel models say so in their names. */
static bool is_tridexel(const char *path) {
    const char *name = strrchr(path, '/');
    return strstr(name != NULL ? name : path, "dexel") != NULL;
}

static void read_valid_tridexel(const char *path, const char *text) {
    leafless_tridexel *models[6];
    leafless_octree *octree = NULL;
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    size_t length, i;
    uint64_t again_length = 0;
    uint8_t *again, *bytes = check_read(path, &length);
    uint32_t axis;
    OK(probe_path(path, strlen(path), &probe, NULL, 0));
    OK(verify_bytes(bytes, length));
    OK(tridexel_open(path, strlen(path), &models[0]));
    OK(tridexel_map(path, strlen(path), &models[1]));
    OK(tridexel_map_verified(path, strlen(path), &models[2]));
    OK(tridexel_from_bytes(bytes, length, &models[3]));
    OK(tridexel_view_bytes(bytes, length, &models[4]));
    OK(tridexel_view_verified(bytes, length, &models[5]));
    OK(verify_path(path, strlen(path), LEAFLESS_ACCESS_COPY));
    OK(verify_path(path, strlen(path), LEAFLESS_ACCESS_MAP));
    CHECK(probe.file_length == length && probe.tridexel.directions != 0);
    for (i = 0; i < COUNT(models); i++) {
        bool equal = false;
        OK(leafless_tridexel_check(models[i]));
        OK(leafless_tridexel_equal(models[0], models[i], &equal));
        CHECK(equal);
        for (axis = 0; axis < 3; axis++) {
            leafless_dexel_statistics statistics = LEAFLESS_INIT(leafless_dexel_statistics);
            if ((probe.tridexel.directions >> axis & 1) != 0) {
                OK(leafless_tridexel_statistics(models[i], axis, &statistics));
                CHECK(statistics.intervals == probe.tridexel.intervals[axis]);
            }
        }
    }
    CHECK(octree_open(path, strlen(path), &octree) == LEAFLESS_E_ARGUMENT && octree == NULL);
    if (strstr(text, "canonical: yes") != NULL) {
        OK(tridexel_to_bytes(models[1], NULL, 0, &again_length));
        CHECK(again_length == length);
        again = (uint8_t *)malloc((size_t)again_length);
        CHECK(again != NULL);
        OK(tridexel_to_bytes(models[1], again, again_length, &again_length));
        CHECK(memcmp(again, bytes, length) == 0);
        free(again);
    }
    for (i = 0; i < COUNT(models); i++) {
        leafless_tridexel_free(models[i]);
    }
    free(bytes);
    valid++;
}

static void read_invalid(const char *path, char *text) {
    leafless_octree *octree = NULL;
    leafless_tridexel *model = NULL;
    leafless_file_info probe = LEAFLESS_INIT(leafless_file_info);
    size_t length;
    uint8_t *bytes = check_read(path, &length);
    const char *by = NULL;
    bool wrong_length = false, version = false;
    char *line;
    int level;
    leafless_status status;
    for (line = strtok(text, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        by = value_of(line, "refused-by") != NULL ? value_of(line, "refused-by") : by;
        wrong_length = wrong_length || value_of(line, "error-of-length") != NULL ||
                       (value_of(line, "error") != NULL && strncmp(value_of(line, "error"), "Format(Length", 13) == 0);
        if (value_of(line, "error") != NULL) {
            version = strncmp(value_of(line, "error"), "Format(Version", 14) == 0 ||
                      strncmp(value_of(line, "error"), "Format(Required", 15) == 0;
        }
    }
    CHECK(by != NULL);
    level = strcmp(by, "probing") == 0      ? 0
            : strcmp(by, "plain") == 0      ? 1
            : strcmp(by, "metadata") == 0   ? 2
            : strcmp(by, "verification") == 0 ? 3
                                              : -1;
    CHECK(level >= 0);
    status = probe_bytes(bytes, length, &probe, NULL, 0);
    if (level == 0) {
        one_of(status);
        CHECK(!version || status == LEAFLESS_E_VERSION);
    } else {
        CHECK(status == LEAFLESS_OK);
    }
    if (is_tridexel(path)) {
        status = tridexel_map(path, strlen(path), &model);
        if (level <= 2) {
            one_of(status);
            CHECK(model == NULL);
            one_of(tridexel_view_bytes(bytes, length, &model));
        } else {
            CHECK(status == LEAFLESS_OK && model != NULL && !wrong_length);
            leafless_tridexel_free(model);
            model = NULL;
        }
        one_of(tridexel_open(path, strlen(path), &model));
        one_of(tridexel_map_verified(path, strlen(path), &model));
        one_of(tridexel_from_bytes(bytes, length, &model));
        one_of(tridexel_view_verified(bytes, length, &model));
    } else {
        status = octree_map(path, strlen(path), &octree);
        if (level <= 2) {
            one_of(status);
            CHECK(octree == NULL);
            one_of(octree_view_bytes(bytes, length, &octree));
        } else {
            CHECK(status == LEAFLESS_OK && octree != NULL && !wrong_length);
            leafless_octree_free(octree);
            octree = NULL;
        }
        one_of(octree_open(path, strlen(path), &octree));
        one_of(octree_map_verified(path, strlen(path), &octree));
        one_of(octree_from_bytes(bytes, length, &octree));
        one_of(octree_view_verified(bytes, length, &octree));
    }
    one_of(verify_bytes(bytes, length));
    one_of(verify_path(path, strlen(path), LEAFLESS_ACCESS_COPY));
    one_of(verify_path(path, strlen(path), LEAFLESS_ACCESS_MAP));
    CHECK(octree == NULL && model == NULL);
    free(bytes);
    invalid++;
}

int main(int argc, char **argv) {
    int i;
    for (i = 1; i < argc; i++) {
        char beside[1024];
        size_t length;
        char *text;
        CHECK(strlen(argv[i]) < sizeof beside && strcmp(argv[i] + strlen(argv[i]) - 4, ".lfl") == 0);
        strcpy(beside, argv[i]);
        strcpy(beside + strlen(beside) - 4, ".txt");
        text = (char *)check_read(beside, &length);
        text[length] = '\0';
        fprintf(stderr, "%s\n", argv[i]);
        if (strstr(text, "refused-by: ") != NULL) {
            read_invalid(argv[i], text);
        } else if (is_tridexel(argv[i])) {
            read_valid_tridexel(argv[i], text);
        } else {
            read_valid(argv[i], text);
        }
        free(text);
    }
    printf("%lu valid with %lu points, %lu invalid\n", (unsigned long)valid, (unsigned long)points,
           (unsigned long)invalid);
    return 0;
}
