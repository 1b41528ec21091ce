// A drilled plate in shards, as made by the machines of a cluster. Each machine builds, counts and measures one shard,
// and sends numbers. The sums of these numbers describe the whole plate, though no machine has the whole plate. Here
// each machine is a thread.
//
// include/README.md describes how to build it.

#include <leafless.hpp>

#include <cstdio>
#include <future>
#include <vector>

using leafless::octree;
using leafless::solid;

namespace {

constexpr std::uint32_t DEPTH = 9, LEVEL = 2;

// Every machine can make the plate.
solid drilled_plate() {
    std::vector<solid> parts;
    parts.push_back(solid::new_box({0, 0, 0}, {96, 80, 10}));
    for (int k = 0; k < 30; k++) {
        const double x = 8.0 + 16.0 * (k % 6), y = 8.0 + 16.0 * (k / 6);
        parts.push_back(solid::new_cylinder({x, y, -1}, {x, y, 11}, 3 + k % 4));
    }
    std::vector<const leafless_solid *> handles;
    for (const solid &part : parts) handles.push_back(part.get());
    return solid::combine(LEAFLESS_OPERATION_DIFFERENCE, handles);
}

// The message of a machine: only numbers.
struct report {
    std::vector<leafless_statistics> levels;
    leafless_mass_sum sum;
};

report machine(const leafless_frame &frame, std::uint64_t code, octree &kept) {
    const leafless_shard own = {code, LEVEL, LEAFLESS_SHARD_KIND_BELOW};
    leafless_options options = LEAFLESS_INIT(leafless_options);
    options.threads = 1;
    kept = octree::build_shard(drilled_plate(), frame, LEAFLESS_RULE_CERTIFIED, own, &options);
    const solid stored = solid::from_octree(kept);
    return {kept.levels(), stored.measure_cell(frame, LEVEL, code, 0, 0, &options)};
}

void build_in_shards() {
    const leafless_frame frame = leafless::frame_around({0, 0, 0}, {96, 80, 10}, DEPTH);
    const solid plate = drilled_plate();
    const leafless_shard top_cells = {0, LEVEL, LEAFLESS_SHARD_KIND_TOP};
    octree top = octree::build_shard(plate, frame, LEAFLESS_RULE_CERTIFIED, top_cells);
    std::vector<std::uint64_t> codes = top.open_cells(LEVEL);
    std::printf("cells that are open:  %lu of %d\n", static_cast<unsigned long>(codes.size()), 1 << 3 * LEVEL);

    // One machine for each open cell.
    std::vector<octree> shards(codes.size());
    std::vector<std::future<report>> machines;
    for (std::size_t i = 0; i < codes.size(); i++) {
        machines.push_back(std::async(std::launch::async, machine, frame, codes[i], std::ref(shards[i])));
    }
    std::vector<report> reports;
    for (std::future<report> &sent : machines) reports.push_back(sent.get());

    // A shard that does not split its cell is joined with the top.
    std::vector<const leafless_octree *> small{top.get()};
    std::vector<std::size_t> large;
    for (std::size_t i = 0; i < codes.size(); i++) {
        if (reports[i].levels[LEVEL].nodes == 0) {
            small.push_back(shards[i].get());
        } else {
            large.push_back(i);
        }
    }
    top = octree::join(small);

    // Statistics and measures of the whole, from the numbers.
    std::vector<std::uint64_t> told_codes;
    std::vector<leafless_statistics> told;
    std::vector<const leafless_octree *> told_shards, all{top.get()};
    leafless_mass_sum sum = solid::from_octree(top).measure_cell(frame, 0, 0, 0, 0);
    for (const std::size_t i : large) {
        told_codes.push_back(codes[i]);
        told_shards.push_back(shards[i].get());
        all.push_back(shards[i].get());
        told.insert(told.end(), reports[i].levels.begin(), reports[i].levels.end());
        sum = leafless::mass_sum_subtract(sum, leafless::mass_sum_unknown(frame, LEVEL, codes[i]));
        sum = leafless::mass_sum_add(sum, reports[i].sum);
    }
    const leafless_statistics last = top.statistics_with(LEVEL, told_codes, told).back();
    const leafless_measures measures = leafless::mass_sum_measures(sum);
    std::printf("volume by the cells:  %.3f to %.3f\n", last.volume_model.lower, last.volume_model.upper);
    std::printf("centroid along x:     %.3f to %.3f\n", measures.centroid_model[0].lower, measures.centroid_model[0].upper);

    // The shards can be used as a solid without joining ...
    const solid sharded = solid::from_shards(top, LEVEL, told_codes, told_shards);
    const leafless_measures asked = sharded.measure(frame, 0, 0);
    std::printf("volume, unjoined:     %.3f to %.3f\n", asked.volume_model.lower, asked.volume_model.upper);

    // ... and joined they are the octree that one machine would build.
    const octree whole = octree::build(plate, frame, LEAFLESS_RULE_CERTIFIED);
    std::printf("joined:               %s\n", octree::join(all).equal(whole) ? "the octree of one machine" : "another octree");
}

} // namespace

int main() {
    try {
        build_in_shards();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
