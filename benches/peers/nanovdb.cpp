// Rays and points on a mask of NanoVDB, for src/bin/queries.rs: is given a file of full cells, the origin of the lattice
// and the edge of a cell; answers each line "KIND FILE" with the milliseconds of processor time that the queries in the
// file take and with the number of those that hit. Of a kind "rays" a query is an origin and a direction, of "tree" and
// "accessor" it is a point, asked for from the root or through an accessor.

#include <nanovdb/util/HDDA.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <nanovdb/util/Ray.h>
#include <openvdb/openvdb.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <time.h>
#include <vector>

using Ray = nanovdb::Ray<float>;

static double now()
{
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

template<std::size_t n> static std::vector<std::array<double, n>> read(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    std::vector<std::array<double, n>> all;
    for (std::array<double, n> one; in.read(reinterpret_cast<char*>(one.data()), sizeof one);) all.push_back(one);
    return all;
}

int main(int, char** arguments)
{
    openvdb::initialize();
    auto mask = openvdb::MaskGrid::create();
    std::ifstream in(arguments[1], std::ios::binary);
    for (std::int32_t cell[4]; in.read(reinterpret_cast<char*>(cell), sizeof cell);) {
        const openvdb::Coord low(cell[0], cell[1], cell[2]);
        mask->tree().sparseFill(openvdb::CoordBBox::createCube(low, cell[3]), true, true);
    }
    mask->tree().prune();
    const auto handle = nanovdb::openToNanoVDB(*mask);
    const auto* grid = handle.grid<nanovdb::ValueMask>();
    const double origin[3] = {std::atof(arguments[2]), std::atof(arguments[3]), std::atof(arguments[4])};
    const double scale = 1.0 / std::atof(arguments[5]);
    const auto place = [&](const double* p) {
        return nanovdb::Vec3d((p[0] - origin[0]) * scale, (p[1] - origin[1]) * scale, (p[2] - origin[2]) * scale);
    };
    const auto cell = [&](const double* p) { return nanovdb::RoundDown<nanovdb::Coord>(place(p)); };
    for (std::string kind, path; std::cin >> kind >> path;) {
        std::size_t hits = 0;
        double start = 0.0, end = 0.0;
        if (kind == "rays") {
            const auto rays = read<6>(path);
            std::vector<float> times(rays.size());
            start = now();
            auto accessor = grid->getAccessor();
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const nanovdb::Vec3d from = place(rays[i].data());
                const nanovdb::Vec3f to(rays[i][3], rays[i][4], rays[i][5]);
                Ray ray(nanovdb::Vec3f(from[0], from[1], from[2]), to);
                nanovdb::Coord at;
                float t = 0.0f;
                times[i] = nanovdb::firstActive(ray, accessor, at, t) ? t : -1.0f;
            }
            end = now();
            for (const float t : times) hits += t >= 0.0f;
        } else {
            const auto points = read<3>(path);
            start = now();
            if (kind == "tree") {
                const auto& tree = grid->tree();
                for (const auto& point : points) hits += tree.isActive(cell(point.data()));
            } else {
                auto accessor = grid->getAccessor();
                for (const auto& point : points) hits += accessor.isActive(cell(point.data()));
            }
            end = now();
        }
        std::printf("%f %zu\n", end - start, hits);
        std::fflush(stdout);
    }
}
