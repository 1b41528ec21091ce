// The Booleans of OpenVDB's masks, for src/bin/booleans.rs: reads the two masks whose files it is given, then answers
// each line "union", "intersection" or "difference" with the milliseconds of processor time that a copy of the first
// mask and the operation on that copy take, and with the cells of the result.

#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <time.h>

using Tree = openvdb::MaskTree;

// A mask of full cells: x, y, z and edge of each.
static Tree::Ptr read(const char* path)
{
    std::ifstream in(path, std::ios::binary);
    auto tree = std::make_shared<Tree>();
    std::int32_t cell[4];
    while (in.read(reinterpret_cast<char*>(cell), sizeof cell)) {
        const openvdb::Coord low(cell[0], cell[1], cell[2]);
        tree->sparseFill(openvdb::CoordBBox::createCube(low, cell[3]), true, true);
    }
    tree->prune();
    return tree;
}

static double now()
{
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

int main(int, char** arguments)
{
    tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    openvdb::initialize();
    const Tree::Ptr a = read(arguments[1]), b = read(arguments[2]);
    std::string line;
    while (std::getline(std::cin, line)) {
        const double start = now();
        Tree copy(*a);
        const double copied = now();
        if (line == "union") {
            copy.topologyUnion(*b);
        } else if (line == "intersection") {
            copy.topologyIntersection(*b);
        } else {
            copy.topologyDifference(*b);
        }
        const double done = now();
        std::printf("%f %f %llu\n", copied - start, done - copied,
                    static_cast<unsigned long long>(copy.activeVoxelCount()));
        std::fflush(stdout);
    }
    return 0;
}
