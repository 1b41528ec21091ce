// The self-intersections that CGAL finds in the mesh whose file it is given, for src/bin/intersections.rs: answers each
// line with the milliseconds of processor time that the search takes and with the pairs found.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <iostream>
#include <iterator>
#include <string>
#include <time.h>
#include <utility>
#include <vector>

namespace PMP = CGAL::Polygon_mesh_processing;
using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

static double now()
{
    timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

int main(int, char** arguments)
{
    std::vector<Point> points;
    std::vector<std::vector<std::size_t>> polygons;
    if (!CGAL::IO::read_polygon_soup(arguments[1], points, polygons)) return 1;
    PMP::repair_polygon_soup(points, polygons);
    Mesh mesh;
    PMP::polygon_soup_to_polygon_mesh(points, polygons, mesh);
    for (std::string line; std::getline(std::cin, line);) {
        std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
        const double start = now();
        PMP::self_intersections(mesh, std::back_inserter(pairs));
        std::cout << now() - start << ' ' << pairs.size() << std::endl;
    }
}
