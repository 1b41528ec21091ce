// Eight threads read one octree, ask one solid, take references and give them back, and fail each for itself.
#include "check.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr int THREADS = 8;
constexpr int POINTS = 2000;

template <typename Work>
void in_all_threads(const Work &work) {
    std::atomic<int> ready{0};
    std::vector<std::thread> threads;
    for (int number = 0; number < THREADS; number++) {
        threads.emplace_back([&, number] {
            // All at once.
            ready++;
            while (ready < THREADS) {
                std::this_thread::yield();
            }
            work(number);
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
}

std::vector<double> points() {
    std::vector<double> numbers;
    uint64_t state = 7;
    for (int i = 0; i < 3 * POINTS; i++) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        numbers.push_back(double(state >> 11) / 9007199254740992.0 * 2.2 - 1.1);
    }
    return numbers;
}

// `octree` is read in every way there is; its statistics are not known yet.
void reads(const leafless_octree *octree) {
    const std::vector<double> numbers = points();
    std::vector<leafless_membership> expected(POINTS);
    OK(leafless_octree_contains_many(octree, numbers.data(), POINTS, expected.data()));
    leafless_statistics statistics[THREADS];
    in_all_threads([&](int number) {
        OK(leafless_octree_statistics(octree, &statistics[number]));
        std::vector<leafless_membership> found(POINTS);
        OK(leafless_octree_contains_many(octree, numbers.data(), POINTS, found.data()));
        CHECK(found == expected);
        leafless_point_cursor *near = nullptr;
        OK(leafless_point_cursor_new(octree, &near));
        for (int i = 0; i < POINTS; i++) {
            leafless_membership one, other;
            OK(leafless_octree_contains(octree, &numbers[3 * i], &one));
            OK(leafless_point_cursor_contains(near, &numbers[3 * i], &other));
            CHECK(one == expected[i] && other == expected[i]);
            if (i % 16 == number) {
                leafless_region region;
                const double *const p = &numbers[3 * i];
                const double low[3] = {p[0] - 0.1, p[1] - 0.1, p[2] - 0.1};
                OK(leafless_octree_classify_box(octree, low, p, &region));
                CHECK(region != LEAFLESS_REGION_INSIDE || expected[i] != LEAFLESS_MEMBERSHIP_OUTSIDE);
            }
        }
        leafless_point_cursor_free(near);

        // A walk over all cells down to a level: as many as the counts say.
        leafless_cursor *cursor = nullptr;
        OK(leafless_cursor_new(octree, &cursor));
        uint64_t cells = 0, branches = 0;
        unsigned path[4] = {0, 0, 0, 0};
        int level = 0;
        for (;;) {
            leafless_cursor_info state = LEAFLESS_INIT(leafless_cursor_info);
            bool moved = false;
            if (level < 4 && path[level] < 8) {
                OK(leafless_cursor_descend(cursor, path[level]++, &moved));
                if (moved) {
                    OK(leafless_cursor_describe(cursor, &state));
                    CHECK(int(state.level) == level + 1);
                    cells++;
                    branches += state.tag == LEAFLESS_TAG_BRANCH;
                    if (++level < 4) {
                        path[level] = 0;
                    }
                }
            } else {
                OK(leafless_cursor_ascend(cursor, &moved));
                if (!moved) {
                    break;
                }
                level--;
            }
        }
        leafless_cursor_free(cursor);
        leafless_statistics levels[32];
        uint64_t count = 0;
        OK(leafless_octree_levels(octree, levels, 32, &count));
        uint64_t nodes = 0;
        for (int l = 1; l <= 4; l++) {
            nodes += levels[l].nodes;
        }
        CHECK(cells > 0 && branches > 0 && nodes > 0);
        OK(leafless_octree_check(octree));

        // Booleans of it, each with threads of its own.
        leafless_options options;
        OK(leafless_init(&options, sizeof options));
        options.threads = 1 + number % 2;
        leafless_octree *complement = nullptr, *nothing = nullptr;
        OK(leafless_octree_complement(octree, &options, &complement));
        OK(check_octrees(LEAFLESS_OPERATION_DIFFERENCE, octree, octree, &options, &nothing));
        leafless_octree_free(complement);
        leafless_octree_free(nothing);
    });
    for (const leafless_statistics &each : statistics) {
        CHECK(each.nodes == statistics[0].nodes && each.lower_cells == statistics[0].lower_cells);
    }
}

// Every thread takes references and frees its own; the last one frees the octree.
void references() {
    leafless_octree *octree = check_ball(5, LEAFLESS_RULE_CERTIFIED);
    leafless_octree *own[THREADS];
    for (leafless_octree *&reference : own) {
        OK(leafless_octree_ref(octree, &reference));
    }
    leafless_octree_free(octree);
    in_all_threads([&](int number) {
        for (int i = 0; i < 1000; i++) {
            leafless_octree *again = nullptr;
            OK(leafless_octree_ref(own[number], &again));
            leafless_octree_free(again);
        }
        leafless_cursor *cursor = nullptr;
        OK(leafless_cursor_new(own[number], &cursor));
        leafless_octree_free(own[number]);
        OK(leafless_cursor_descend(cursor, 3, nullptr));
        leafless_cursor_free(cursor);
    });
}

std::atomic<int> destroyed{0};

void gone(void *) {
    destroyed++;
}

int32_t half(void *, const double *min, const double *max) {
    return min[0] >= 0.0 ? LEAFLESS_TAG_FULL : max[0] <= 0.0 ? LEAFLESS_TAG_EMPTY : LEAFLESS_TAG_PARTIAL;
}

// A solid and a mesh in all threads; the host's context goes once, with the last reference.
void solids() {
    leafless_solid_callbacks callbacks = {};
    callbacks.struct_size = sizeof callbacks;
    callbacks.classify = half;
    callbacks.destroy = gone;
    leafless_solid *solid = nullptr;
    OK(leafless_solid_new_callbacks(&callbacks, &solid));
    leafless_mesh *mesh = check_cube();
    leafless_solid *own[THREADS];
    leafless_octree *built[THREADS];
    for (leafless_solid *&reference : own) {
        OK(leafless_solid_ref(solid, &reference));
    }
    leafless_solid_free(solid);
    in_all_threads([&](int number) {
        const leafless_frame frame = check_frame(4);
        leafless_options options;
        OK(leafless_init(&options, sizeof options));
        options.threads = 1 + number % 3;
        OK(leafless_octree_build(own[number], &frame, LEAFLESS_RULE_CERTIFIED, &options, &built[number]));
        leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
        // The first query analyses its edges, once.
        OK(leafless_mesh_inspect(mesh, &report));
        CHECK(report.bodies == 1 && report.boundary_edges == 0);
        leafless_solid *cube = nullptr;
        OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &cube));
        leafless_solid_free(cube);
        leafless_solid_free(own[number]);
    });
    CHECK(destroyed == 1);
    for (leafless_octree *octree : built) {
        CHECK(check_same(octree, built[0]));
    }
    for (leafless_octree *octree : built) {
        leafless_octree_free(octree);
    }
    leafless_mesh_free(mesh);
}

// Every thread has its own last error.
void messages() {
    leafless_octree *octree = check_ball(3, LEAFLESS_RULE_CERTIFIED);
    FAILS(LEAFLESS_E_NULL, leafless_octree_check(nullptr));
    in_all_threads([&](int number) {
        CHECK(leafless_last_status() == LEAFLESS_OK && leafless_last_error(nullptr, 0) == 0);
        for (int i = 0; i < 500; i++) {
            leafless_octree *result = nullptr;
            char message[512];
            const std::string path = "no/such/file/of/thread/" + std::to_string(number);
            if (number % 2 == 0) {
                FAILS(LEAFLESS_E_IO, octree_open(path.data(), path.size(), &result));
            } else {
                FAILS(LEAFLESS_E_ARGUMENT, leafless_octree_resolve(octree, static_cast<leafless_rule>(99), nullptr, &result));
            }
            const leafless_status expected = number % 2 == 0 ? LEAFLESS_E_IO : LEAFLESS_E_ARGUMENT;
            CHECK(leafless_last_status() == expected);
            CHECK(leafless_last_error(message, sizeof message) == strlen(message));
            CHECK(strstr(message, number % 2 == 0 ? "No such file" : "rule") != nullptr);
        }
    });
    CHECK(leafless_last_status() == LEAFLESS_E_NULL);
    leafless_octree_free(octree);
}

// The number of threads of this process, or 0 if it is unknown.
long threads_of_the_process() {
    long threads = 0;
    if (FILE *status = fopen("/proc/self/status", "r")) {
        char line[256];
        while (fgets(line, sizeof line, status) != nullptr) {
            if (sscanf(line, "Threads: %ld", &threads) == 1) {
                break;
            }
        }
        fclose(status);
    }
    return threads;
}

// Whether there are as many threads as there were; the system may count a thread for a moment after it was joined.
bool back_to(long before) {
    for (int tries = 0; tries < 1000 && threads_of_the_process() != before; tries++) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return threads_of_the_process() == before;
}

int32_t asks_back(void *ctx, double fraction) {
    const leafless_control *control = static_cast<const leafless_control *>(ctx);
    bool cancelled = true;
    double found = -1.0;
    // A function that hears of progress may call the library.
    OK(leafless_control_state(control, &cancelled, &found));
    CHECK(!cancelled && found >= 0.0 && found <= 1.0 && fraction >= 0.0 && fraction <= 1.0);
    return 0;
}

// The result is the same for any number of threads, and none of them stays.
void numbers_of_threads(const std::vector<uint32_t> &numbers) {
    const leafless_frame frame = check_frame(7);
    leafless_solid *solid = check_ball_solid();
    // A checker may start a thread of its own beside the first one.
    std::thread([] {}).join();
    const long before = threads_of_the_process();
    leafless_octree *expected = check_ball(7, LEAFLESS_RULE_CERTIFIED);
    leafless_control *control = nullptr;
    OK(leafless_control_new(&control));
    for (const uint32_t threads : numbers) {
        leafless_options options;
        OK(leafless_init(&options, sizeof options));
        options.threads = threads;
        options.control = control;
        options.progress = asks_back;
        options.progress_ctx = control;
        leafless_octree *octree = nullptr, *both = nullptr;
        OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
        OK(check_octrees(LEAFLESS_OPERATION_UNION, octree, expected, &options, &both));
        CHECK(check_same(octree, expected) && check_same(both, expected));
        leafless_octree_free(octree);
        leafless_octree_free(both);
        if (!back_to(before)) {
            fprintf(stderr, "with %u threads %ld stay\n", threads, threads_of_the_process() - before);
            exit(1);
        }
    }
    leafless_control_free(control);
    leafless_octree_free(expected);
    leafless_solid_free(solid);
}

// A fresh open mesh. Its octree is the same for any number of threads.
void open_mesh() {
    const leafless_frame frame = check_frame(6);
    leafless_mesh *mesh = check_some_of_cube(9);
    leafless_octree *octrees[THREADS] = {};
    in_all_threads([&](int number) {
        leafless_mesh_report report = LEAFLESS_INIT(leafless_mesh_report);
        leafless_mesh_defect defect;
        uint64_t count = 0;
        const bool asks_first = number % 2 == 0;
        if (asks_first) {
            OK(leafless_mesh_inspect(mesh, &report));
        }
        OK(leafless_mesh_defects(mesh, 1, &defect, 1, &count));
        CHECK(count == 1 && defect.kind == LEAFLESS_DEFECT_HOLE);
        FAILS(LEAFLESS_E_MESH, leafless_mesh_check_closed(mesh, LEAFLESS_FILL_NON_ZERO));
        leafless_solid *solid = nullptr;
        OK(leafless_solid_from_mesh(mesh, LEAFLESS_FILL_NON_ZERO, &solid));
        leafless_options options;
        OK(leafless_init(&options, sizeof options));
        options.threads = uint32_t(number) % 4 + 1;
        OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octrees[number]));
        leafless_solid_free(solid);
        OK(leafless_mesh_inspect(mesh, &report));
        CHECK(report.boundary_edges > 0 && report.open_bodies == 1 && report.triangles == 9);
    });
    for (leafless_octree *octree : octrees) {
        CHECK(check_same(octree, octrees[0]));
    }
    for (leafless_octree *octree : octrees) {
        leafless_octree_free(octree);
    }
    leafless_mesh_free(mesh);
}

// What a solid says on one frame.
struct Answers {
    std::vector<leafless_membership> memberships = std::vector<leafless_membership>(POINTS);
    std::vector<leafless_region> regions;
    leafless_interval volume = {};
    uint64_t splits = 0;
    leafless_interval box[6] = {};
    uint64_t cells[2] = {};

    bool operator==(const Answers &other) const {
        return memberships == other.memberships && regions == other.regions &&
               memcmp(&volume, &other.volume, sizeof volume) == 0 && splits == other.splits &&
               memcmp(box, other.box, sizeof box) == 0 && memcmp(cells, other.cells, sizeof cells) == 0;
    }
};

Answers ask(const leafless_solid *solid, const leafless_frame &frame, uint32_t threads) {
    static const std::vector<double> numbers = points();
    Answers answers;
    leafless_options options;
    OK(leafless_init(&options, sizeof options));
    options.threads = threads;
    OK(leafless_solid_contains_many(solid, &frame, numbers.data(), POINTS, &options, answers.memberships.data()));
    for (int i = 0; i < POINTS; i += 50) {
        const double *const p = &numbers[3 * i];
        const double high[3] = {p[0] + 0.2, p[1] + 0.1, p[2] + 0.3};
        leafless_region region;
        OK(leafless_solid_classify_box(solid, &frame, p, high, &options, &region));
        answers.regions.push_back(region);
    }
    leafless_measures measures = LEAFLESS_INIT(leafless_measures);
    OK(leafless_solid_measure(solid, &frame, 0.05, 0.0, &options, &measures));
    answers.volume = measures.volume_model;
    answers.splits = measures.splits;
    leafless_extent extent = LEAFLESS_INIT(leafless_extent);
    OK(leafless_solid_bounding_box(solid, &frame, 0.1, &options, &extent));
    std::copy(extent.min_model, extent.min_model + 3, answers.box);
    std::copy(extent.max_model, extent.max_model + 3, answers.box + 3);
    leafless_octree *octree = nullptr;
    OK(leafless_octree_build(solid, &frame, LEAFLESS_RULE_CERTIFIED, &options, &octree));
    leafless_statistics statistics;
    OK(leafless_octree_statistics(octree, &statistics));
    answers.cells[0] = statistics.lower_cells;
    answers.cells[1] = statistics.upper_cells;
    leafless_octree_free(octree);
    return answers;
}

// Threads query one solid on one frame, and on frames of their own. Its cache of the last frame never serves another.
// `solid_of` makes the same solid anew.
template <typename Make>
void on_frames(const Make &solid_of) {
    const leafless_frame frames[] = {
        {{-1, -1, -1}, 2, 5}, {{-1, -1, -1}, 2, 4}, {{-1.25, -1, -1.125}, 2.5, 5}, {{-1, -1, -1}, 2, 3}};
    std::vector<Answers> expected;
    for (const leafless_frame &frame : frames) {
        leafless_solid *const alone = solid_of();
        expected.push_back(ask(alone, frame, 1));
        leafless_solid_free(alone);
    }
    CHECK(!(expected[0] == expected[1]) && !(expected[0] == expected[2]));
    leafless_solid *const solid = solid_of();
    // Nobody has prepared it yet.
    in_all_threads([&](int number) {
        for (int i = 0; i < 3; i++) {
            CHECK(ask(solid, frames[0], 1 + uint32_t(number) % 2) == expected[0]);
        }
    });
    in_all_threads([&](int number) {
        for (size_t i = 0; i < 8; i++) {
            const size_t f = (i * (1 + size_t(number) % 3) + size_t(number)) % expected.size();
            CHECK(ask(solid, frames[f], 1 + uint32_t(number) % 2) == expected[f]);
        }
    });
    // What is kept for one frame serves while the solid goes on to others, and after it is gone.
    leafless_lazy *lazy = nullptr;
    OK(leafless_lazy_new(solid, &frames[0], &lazy));
    CHECK(ask(solid, frames[1], 1) == expected[1]);
    leafless_solid_free(solid);
    OK(leafless_lazy_refine(lazy, nullptr, 5, nullptr, nullptr));
    leafless_octree *octree = nullptr;
    OK(leafless_lazy_freeze(lazy, nullptr, &octree));
    leafless_lazy_free(lazy);
    leafless_statistics statistics;
    OK(leafless_octree_statistics(octree, &statistics));
    CHECK(statistics.lower_cells == expected[0].cells[0] && statistics.upper_cells == expected[0].cells[1]);
    leafless_octree_free(octree);
}

void one_solid() {
    const double turn[12] = {0.8, -0.6, 0, 0.1, 0.6, 0.8, 0, -0.5, 0, 0, 1, -0.4};
    leafless_mesh *const cube = check_cube(), *const open = check_some_of_cube(11);
    for (const leafless_mesh *mesh : {cube, open}) {
        on_frames([&] {
            leafless_mesh *moved = nullptr;
            leafless_solid *solid = nullptr;
            OK(leafless_mesh_transformed(mesh, turn, &moved));
            OK(leafless_solid_from_mesh(moved, LEAFLESS_FILL_NON_ZERO, &solid));
            leafless_mesh_free(moved);
            return solid;
        });
    }
    // An expression that holds a mesh, moved.
    on_frames([&] {
        leafless_solid *solid = nullptr, *ball = check_ball_solid(), *both = nullptr, *moved = nullptr;
        OK(leafless_solid_from_mesh(cube, LEAFLESS_FILL_NON_ZERO, &solid));
        OK(check_solids(LEAFLESS_OPERATION_DIFFERENCE, solid, ball, &both));
        OK(leafless_solid_placed(both, turn, nullptr, &moved));
        leafless_solid_free(both);
        leafless_solid_free(ball);
        leafless_solid_free(solid);
        return moved;
    });
    leafless_mesh_free(open);
    leafless_mesh_free(cube);
}

bool is_done_or_busy(leafless_status status) {
    if (status == LEAFLESS_E_BUSY) {
        char message[512];
        leafless_last_error(message, sizeof message);
        CHECK(leafless_last_status() == LEAFLESS_E_BUSY && strstr(message, "lazy: is in use") != nullptr);
    }
    CHECK(status == LEAFLESS_OK || status == LEAFLESS_E_BUSY);
    return status == LEAFLESS_OK;
}

struct Asking {
    leafless_lazy *lazy;
    std::atomic<int> busy;
};

// A ball of radius 0.75 that meanwhile uses the octree which is being split.
int32_t asks_back(void *ctx, const double *min, const double *max) {
    Asking *const asking = static_cast<Asking *>(ctx);
    leafless_lazy_info counts = LEAFLESS_INIT(leafless_lazy_info);
    if (asking->lazy != nullptr) {
        FAILS(LEAFLESS_E_BUSY, leafless_lazy_describe(asking->lazy, &counts));
        FAILS(LEAFLESS_E_BUSY, leafless_lazy_refine(asking->lazy, nullptr, 2, nullptr, nullptr));
        asking->busy++;
    }
    double near = 0, far = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double low = std::max({0.0, min[axis], -max[axis]}), high = std::max(max[axis], -min[axis]);
        near += low * low, far += high * high;
    }
    return far <= 0.5625 ? LEAFLESS_TAG_FULL : near >= 0.5625 ? LEAFLESS_TAG_EMPTY : LEAFLESS_TAG_PARTIAL;
}

// One lazy octree in all threads: each call does all of its work, or says that the octree is busy and does nothing.
void lazy_at_once() {
    const leafless_frame frame = check_frame(6);
    leafless_solid *const solid = check_ball_solid();
    leafless_lazy *lazy = nullptr;
    OK(leafless_lazy_new(solid, &frame, &lazy));
    std::atomic<int> done{0};
    in_all_threads([&](int number) {
        const double at[3] = {0.1 * number, 0.5, 0.0};
        const double from[3] = {-1, 0.01 * number, 0.02}, along[3] = {1, 0.3, 0.2};
        const uint32_t root[3] = {0, 0, 0};
        for (int i = 0; i < 400; i++) {
            leafless_tag tags[8];
            leafless_membership membership;
            leafless_lazy_info statistics = LEAFLESS_INIT(leafless_lazy_info);
            leafless_octree *octree = nullptr;
            done += is_done_or_busy(check_refine(lazy, check_zone_point(at), uint32_t(1 + i % 6), nullptr));
            done += is_done_or_busy(check_refine(lazy, check_zone_ray(from, along, 0, 3), uint32_t(1 + i % 6), nullptr));
            done += is_done_or_busy(leafless_lazy_split(lazy, root, 0, tags));
            done += is_done_or_busy(leafless_lazy_contains(lazy, at, &membership));
            done += is_done_or_busy(leafless_lazy_describe(lazy, &statistics));
            if (i % 50 == number && is_done_or_busy(leafless_lazy_freeze(lazy, nullptr, &octree))) {
                OK(leafless_octree_check(octree));
                leafless_octree_free(octree);
            }
        }
    });
    CHECK(done > 0);
    // As if one thread had done all of it.
    leafless_octree *found = nullptr, *expected = check_ball(6, LEAFLESS_RULE_CERTIFIED);
    leafless_statistics statistics[2];
    OK(leafless_lazy_refine(lazy, nullptr, 6, nullptr, nullptr));
    OK(leafless_lazy_freeze(lazy, nullptr, &found));
    OK(leafless_octree_check(found));
    OK(leafless_octree_statistics(found, &statistics[0]));
    OK(leafless_octree_statistics(expected, &statistics[1]));
    CHECK(memcmp(&statistics[0], &statistics[1], sizeof statistics[0]) == 0);
    leafless_octree_free(expected);
    leafless_octree_free(found);
    leafless_lazy_free(lazy);
    leafless_solid_free(solid);

    // The host's function, called for a cell, calls the octree again.
    Asking asking{nullptr, {0}};
    leafless_solid_callbacks callbacks;
    leafless_solid *host = nullptr;
    OK(leafless_init(&callbacks, sizeof callbacks));
    callbacks.classify = asks_back;
    callbacks.ctx = &asking;
    OK(leafless_solid_new_callbacks(&callbacks, &host));
    OK(leafless_lazy_new(host, &frame, &lazy));
    asking.lazy = lazy;
    OK(leafless_lazy_refine(lazy, nullptr, 3, nullptr, nullptr));
    CHECK(asking.busy > 8);
    leafless_lazy_info counts = LEAFLESS_INIT(leafless_lazy_info);
    OK(leafless_lazy_describe(lazy, &counts));
    CHECK(counts.splits > 0);
    leafless_lazy_free(lazy);
    leafless_solid_free(host);
}

}  // namespace

int main(int argc, char **) {
    std::vector<uint32_t> numbers = {1, 2, 3, 8};
    if (argc > 1) {
        // More than checkers can bear.
        numbers.push_back(UINT32_MAX);
    }
    numbers_of_threads(numbers);
    leafless_octree *octree = check_ball(6, LEAFLESS_RULE_CERTIFIED), *mapped = nullptr;
    reads(octree);
    OK(octree_save(octree, "threads.lfl", 11));
    leafless_octree_free(octree);
    OK(octree_map("threads.lfl", 11, &mapped));
    reads(mapped);
    leafless_octree_free(mapped);
    references();
    solids();
    open_mesh();
    one_solid();
    lazy_at_once();
    messages();
    return 0;
}
