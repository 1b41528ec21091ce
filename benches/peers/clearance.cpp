// Distances of two meshes under rigid placements, asked of FCL; see benches/README.md. One thread, one call a placement.
//
//     clearance MESH POSES DISTANCES
//
// MESH has its numbers of vertices and triangles in its first line, then a line for each vertex and each triangle. POSES has their
// number, and a line of twelve numbers for each placement of the second copy: rows of [R | t]. The distances are written to DISTANCES as
// doubles, -1 where FCL finds the meshes in contact. Then each line that is read asks for a round, and is answered with the processor
// time of it in nanoseconds a placement.

#include "mesh_queries.h"

#include <fcl/fcl.h>

#include <fstream>
#include <iostream>
#include <string>
#include <vector>

int main(int, char** arguments)
{
    std::ifstream in(arguments[1]);
    std::size_t vertex_count, triangle_count, count;
    in >> vertex_count >> triangle_count;
    std::vector<fcl::Vector3<double>> vertices(vertex_count);
    for (auto& vertex : vertices)
        for (int axis = 0; axis < 3; ++axis) in >> vertex[axis];
    std::vector<fcl::Triangle> triangles(triangle_count);
    for (auto& triangle : triangles)
        for (int k = 0; k < 3; ++k) in >> triangle[k];
    fcl::BVHModel<fcl::OBBRSS<double>> model;
    model.beginModel();
    model.addSubModel(vertices, triangles);
    model.endModel();
    std::ifstream places(arguments[2]);
    places >> count;
    std::vector<fcl::Transform3<double>> poses(count, fcl::Transform3<double>::Identity());
    for (auto& pose : poses)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) places >> pose.matrix()(i, j);
    const auto still = fcl::Transform3<double>::Identity();
    const fcl::DistanceRequest<double> request(true);
    const auto distance = [&](const fcl::Transform3<double>& pose) {
        fcl::DistanceResult<double> result;
        const double found = fcl::distance(&model, still, &model, pose, request, result);
        return found <= 0.0 ? -1.0 : found;
    };
    std::ofstream out(arguments[3], std::ios::binary);
    for (const auto& pose : poses) {
        const double found = distance(pose);
        out.write(reinterpret_cast<const char*>(&found), sizeof found);
    }
    out.close();
    for (std::string line; std::getline(std::cin, line);) {
        const double start = now();
        double sum = 0.0;
        for (const auto& pose : poses) sum += distance(pose);
        std::cout << (now() - start) / double(count) << ' ' << sum << std::endl;
    }
}
