// What queries cost through the interface for C++, with the ball and the points of boundary.c:
//
//     ./boundary_cpp [POINTS]
#include <leafless.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

namespace {

constexpr int ROUNDS = 11;

/// Prints the median processor time of `work` for each of `count` queries. All rounds must return the same.
template <class F> double timed(const char *name, std::size_t count, F &&work) {
    std::vector<double> times;
    double first = 0;
    for (int round = 0; round < ROUNDS; round++) {
        const std::clock_t start = std::clock();
        const double found = work();
        times.push_back(static_cast<double>(std::clock() - start) * 1e9 / CLOCKS_PER_SEC);
        if (round == 0) first = found;
        if (found != first) std::abort();
    }
    std::sort(times.begin(), times.end());
    std::printf("%-22s %9.2f ns\n", name, times[ROUNDS / 2] / static_cast<double>(count));
    return first;
}

void same(double a, double b) {
    if (a != b) std::abort();
}

} // namespace

int main(int argc, char **argv) {
    const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 1000000;
    const leafless_frame frame = {{-1, -1, -1}, 2, 10};
    const leafless::octree ball =
        leafless::octree::build(leafless::solid::new_ball({0, 0, 0}, 0.75), frame, LEAFLESS_RULE_CERTIFIED);
    std::vector<leafless::point> points(count);
    std::uint64_t state = 1;
    for (leafless::point &point : points) {
        for (double &x : point) {
            state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
            x = static_cast<double>(state >> 11) / 9007199254740992.0 * 2.0 - 1.0;
        }
    }

    std::vector<leafless_membership> answers(count);
    const double inside = timed("points one by one", count, [&] {
        return static_cast<double>(std::count_if(points.begin(), points.end(), [&](const leafless::point &point) {
            return ball.contains(point) == LEAFLESS_MEMBERSHIP_INSIDE;
        }));
    });
    timed("points batch", count, [&] {
        ball.contains_many(points, answers);
        return 0;
    });
    same(inside, static_cast<double>(std::count(answers.begin(), answers.end(), LEAFLESS_MEMBERSHIP_INSIDE)));
    leafless::point_cursor cursor = leafless::point_cursor::make(ball);
    timed("points on lines", count, [&] {
        std::size_t found = 0;
        for (std::size_t i = 0; i < count; i++) {
            const leafless::point &line = points[i / 1000 * 1000];
            const double x = (static_cast<double>(i % 1000) + 0.5) / 500.0 - 1.0;
            found += cursor.contains({x, line[0], line[1]}) == LEAFLESS_MEMBERSHIP_INSIDE;
        }
        return static_cast<double>(found);
    });

    std::vector<leafless_ray> rays(count / 10);
    std::vector<leafless_ray_hit> hits(rays.size());
    for (std::size_t i = 0; i < rays.size(); i++) {
        const leafless::point &from = points[i], &to = points[(i + 1) % rays.size()];
        rays[i] = {{from[0], from[1], from[2]}, {to[0] - from[0], to[1] - from[1], to[2] - from[2]}, INFINITY};
    }
    const auto met = [](const leafless_ray_hit &hit) { return hit.is_hit; };
    const double one_by_one = timed("rays one by one", rays.size(), [&] {
        std::size_t found = 0;
        for (const leafless_ray &ray : rays) {
            ball.cast_rays({&ray, 1}, LEAFLESS_OBSTACLE_UPPER, {hits.data(), 1});
            found += met(hits[0]);
        }
        return static_cast<double>(found);
    });
    timed("rays batch", rays.size(), [&] {
        ball.cast_rays(rays, LEAFLESS_OBSTACLE_UPPER, hits);
        return 0;
    });
    same(one_by_one, static_cast<double>(std::count_if(hits.begin(), hits.end(), met)));

    leafless_options options = LEAFLESS_INIT(leafless_options);
    options.threads = 1;
    const leafless::span<const leafless::point> far(points.data(), count / 1000);
    std::vector<leafless_interval> distances(far.size());
    timed("distances one by one", far.size(), [&] {
        double sum = 0;
        for (const leafless::point &point : far) {
            leafless_interval distance;
            ball.distances({&point, 1}, LEAFLESS_DISTANCE_TO_BOUNDARY, &options, {&distance, 1});
            sum += distance.lower;
        }
        return sum;
    });
    timed("distances batch", far.size(), [&] {
        ball.distances(far, LEAFLESS_DISTANCE_TO_BOUNDARY, &options, distances);
        return 0;
    });
    return 0;
}
