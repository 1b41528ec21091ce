// The surface of a mesh by way of an OpenVDB level set, for surfaces.py: reads an OFF of triangles, and writes one.
//
//     volume_to_mesh IN.off OUT.off VOXEL_SIZE ADAPTIVITY
//
// Tells the seconds that meshToLevelSet and volumeToMesh take on the wall clock, and the number of triangles: quadrilaterals count
// twice.

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

static double now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int main(int, char** arguments)
{
    openvdb::initialize();
    std::ifstream in(arguments[1]);
    std::string word;
    std::size_t corners, faces, edges, sides;
    in >> word >> corners >> faces >> edges;
    std::vector<openvdb::Vec3s> points(corners);
    std::vector<openvdb::Vec3I> triangles(faces);
    for (auto& p : points) in >> p[0] >> p[1] >> p[2];
    for (auto& t : triangles) in >> sides >> t[0] >> t[1] >> t[2];
    const double voxel = std::atof(arguments[3]), adaptivity = std::atof(arguments[4]);

    const double start = now();
    const auto place = openvdb::math::Transform::createLinearTransform(voxel);
    const auto grid = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*place, points, triangles);
    const double made = now();
    std::vector<openvdb::Vec3s> vertices;
    std::vector<openvdb::Vec3I> three;
    std::vector<openvdb::Vec4I> four;
    openvdb::tools::volumeToMesh(*grid, vertices, three, four, 0.0, adaptivity);
    const double done = now();

    // (Its triangles turn the other way.)
    std::ofstream out(arguments[2]);
    out.precision(9);
    out << "OFF\n" << vertices.size() << ' ' << three.size() + 2 * four.size() << " 0\n";
    for (const auto& p : vertices) out << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    for (const auto& t : three) out << "3 " << t[2] << ' ' << t[1] << ' ' << t[0] << '\n';
    for (const auto& q : four) {
        out << "3 " << q[2] << ' ' << q[1] << ' ' << q[0] << '\n';
        out << "3 " << q[3] << ' ' << q[2] << ' ' << q[0] << '\n';
    }
    std::printf("%f %f %zu\n", made - start, done - made, three.size() + 2 * four.size());
    return 0;
}
