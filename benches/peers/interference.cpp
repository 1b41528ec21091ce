// Collisions of two octrees under rigid placements, asked of FCL; see benches/README.md. One thread, one call a placement,
// which ends with the first contact.
//
//     interference FIRST.bt SECOND.bt POSES VERDICTS
//
// Both trees are files of OctoMap of one depth, which DEPTH of the first line of POSES tells, and their universe has its centre at
// the origin. POSES has a line of twelve numbers for each placement of the second tree: rows of [R | t]. A byte for each is
// written to VERDICTS: 1 for a collision. Then each line that is read asks for a round, and is answered with the processor
// time of it in nanoseconds a placement, and the number of collisions.

#include "mesh_queries.h"

#include <fcl/fcl.h>
#include <octomap/octomap.h>

#include <fstream>
#include <iostream>
#include <string>
#include <vector>

// A tree of OctoMap has sixteen levels, and FCL begins at the root. The levels above the universe are cut off, so that FCL
// looks at no cell that we do not look at.
struct Cut : octomap::OcTree {
    Cut(double resolution, unsigned depth) : octomap::OcTree(resolution)
    {
        const_cast<unsigned&>(tree_depth) = depth;
        const_cast<unsigned&>(tree_max_val) = 1u << (depth - 1);
        init();
    }
};

static std::shared_ptr<fcl::OcTree<double>> read(const char* path, double resolution, unsigned depth)
{
    std::ifstream in(path, std::ios::binary);
    const auto tree = std::make_shared<Cut>(resolution, depth);
    if (!tree->readBinary(in)) std::fprintf(stderr, "%s cannot be read\n", path), std::exit(1);
    tree->setResolution(resolution);
    return std::make_shared<fcl::OcTree<double>>(std::static_pointer_cast<const octomap::OcTree>(tree));
}

int main(int, char** arguments)
{
    std::ifstream in(arguments[3]);
    unsigned depth;
    double resolution;
    std::size_t count;
    in >> depth >> resolution >> count;
    std::vector<fcl::Transform3<double>> poses(count, fcl::Transform3<double>::Identity());
    for (auto& pose : poses)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) in >> pose.matrix()(i, j);
    const auto first = read(arguments[1], resolution, depth), second = read(arguments[2], resolution, depth);
    const auto still = fcl::Transform3<double>::Identity();
    const fcl::CollisionRequest<double> request(1, false);
    const auto collides = [&](const fcl::Transform3<double>& pose) {
        fcl::CollisionResult<double> result;
        return fcl::collide(first.get(), still, second.get(), pose, request, result) > 0;
    };
    std::ofstream out(arguments[4], std::ios::binary);
    for (const auto& pose : poses) out.put(char(collides(pose)));
    out.close();
    for (std::string line; std::getline(std::cin, line);) {
        const double start = now();
        std::size_t hits = 0;
        for (const auto& pose : poses) hits += collides(pose);
        std::cout << (now() - start) / double(count) << ' ' << hits << std::endl;
    }
}
