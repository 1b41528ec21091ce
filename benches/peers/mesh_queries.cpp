// Single questions to a triangle mesh, asked of Embree and FCL: the first hit of a ray, all of its hits, the distance of a
// point from the surface, and whether a point is inside; see benches/README.md. One thread, one call for each question.
//
//     mesh_queries MESH.stl [QUESTIONS [ANSWERS]]
//
// Behind the time of a question stand how many hit, or how many hits there are, and a sum: of t, of numbers of hits that are
// odd, of distances. With a path ANSWERS, the answers of Embree are written there for src/bin/mesh_queries.rs: first hits of
// both lists of rays (-1 for none), then numbers of all hits, distances, and numbers of crossings from each point on, as
// doubles.

#include "mesh_queries.h"

#include <embree3/rtcore.h>
#include <fcl/fcl.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <map>
#include <vector>

using Corner = std::array<float, 3>;

struct Mesh {
    std::vector<Corner> corners;
    std::vector<std::array<unsigned, 3>> triangles;
    double min[3], max[3];
};

// A binary STL; equal corners are one, and nothing else is sewn.
static Mesh read(const char* path)
{
    std::ifstream in(path, std::ios::binary);
    in.ignore(80);
    std::uint32_t count = 0;
    in.read(reinterpret_cast<char*>(&count), 4);
    Mesh mesh;
    std::map<Corner, unsigned> known;
    for (std::uint32_t i = 0; i < count; ++i) {
        float facet[12];
        in.read(reinterpret_cast<char*>(facet), sizeof facet);
        in.ignore(2);
        std::array<unsigned, 3> triangle;
        for (int k = 0; k < 3; ++k) {
            const Corner corner = {facet[3 * k + 3], facet[3 * k + 4], facet[3 * k + 5]};
            const auto found = known.try_emplace(corner, unsigned(mesh.corners.size()));
            if (found.second) mesh.corners.push_back(corner);
            triangle[k] = found.first->second;
        }
        mesh.triangles.push_back(triangle);
    }
    if (!in || !count) std::fprintf(stderr, "%s is no binary STL\n", path), std::exit(1);
    for (int axis = 0; axis < 3; ++axis) {
        mesh.min[axis] = mesh.max[axis] = mesh.corners[0][axis];
        for (const Corner& corner : mesh.corners) {
            mesh.min[axis] = std::min(mesh.min[axis], double(corner[axis]));
            mesh.max[axis] = std::max(mesh.max[axis], double(corner[axis]));
        }
    }
    return mesh;
}

// Prints the median time of a question. `all` asks all of them and returns what every round must return: how many hit, and
// a sum.
template<typename All> static void asked(const char* name, std::size_t count, All all)
{
    double times[ROUNDS];
    std::pair<std::size_t, double> sums;
    for (double& time : times) {
        const double start = now();
        sums = all();
        time = now() - start;
    }
    qsort(times, ROUNDS, sizeof times[0], ascending);
    std::printf("%-38s %10.1f ns  %9zu  %.9g\n", name, times[ROUNDS / 2] / double(count), sums.first, sums.second);
    std::fflush(stdout);
}

static RTCScene scene(RTCDevice device, const Mesh& mesh, RTCSceneFlags flags, RTCBuildQuality quality)
{
    const double start = now();
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, flags);
    rtcSetSceneBuildQuality(scene, quality);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* corners = rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Corner), mesh.corners.size());
    void* triangles = rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles.size());
    std::memcpy(corners, mesh.corners.data(), sizeof(Corner) * mesh.corners.size());
    std::memcpy(triangles, mesh.triangles.data(), 3 * sizeof(unsigned) * mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    std::printf("%-38s %10.2f ms\n", "Embree, tree", 1e-6 * (now() - start));
    return scene;
}

static RTCRayHit ray_of(const float* from, const float* along)
{
    RTCRayHit ray;
    ray.ray.org_x = from[0], ray.ray.org_y = from[1], ray.ray.org_z = from[2];
    ray.ray.dir_x = along[0], ray.ray.dir_y = along[1], ray.ray.dir_z = along[2];
    ray.ray.tnear = 0.0f, ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.time = 0.0f, ray.ray.mask = ~0u, ray.ray.id = 0, ray.ray.flags = 0;
    ray.hit.geomID = ray.hit.primID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
}

// Infinity for none.
static float first_hit(RTCScene scene, const question_ray& question)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray = ray_of(question.from, question.along);
    rtcIntersect1(scene, &context, &ray);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : ray.ray.tfar;
}

struct Counting {
    RTCIntersectContext context;
    unsigned hits;
};

// Counts a hit, and lets the ray pass.
static void count(const RTCFilterFunctionNArguments* arguments)
{
    reinterpret_cast<Counting*>(arguments->context)->hits += 1;
    arguments->valid[0] = 0;
}

static unsigned all_hits(RTCScene scene, const float* from, const float* along)
{
    Counting counting;
    rtcInitIntersectContext(&counting.context);
    counting.context.filter = count;
    counting.hits = 0;
    RTCRayHit ray = ray_of(from, along);
    rtcIntersect1(scene, &counting.context, &ray);
    return counting.hits;
}

// A direction that lies along no edges: crossings from a point on are odd inside.
static const float AWAY[3] = {0.36f, 0.48f, 0.8f};

struct Vector {
    float x, y, z;
    Vector operator-(Vector o) const { return {x - o.x, y - o.y, z - o.z}; }
    Vector operator+(Vector o) const { return {x + o.x, y + o.y, z + o.z}; }
    Vector operator*(float f) const { return {x * f, y * f, z * f}; }
    float operator*(Vector o) const { return x * o.x + y * o.y + z * o.z; }
};

// The point of a triangle that is nearest to p, as in Embree's tutorials (Ericson, Real-Time Collision Detection).
static Vector nearest(Vector p, Vector a, Vector b, Vector c)
{
    const Vector ab = b - a, ac = c - a, ap = p - a;
    const float d1 = ab * ap, d2 = ac * ap;
    if (d1 <= 0.0f && d2 <= 0.0f) return a;
    const Vector bp = p - b;
    const float d3 = ab * bp, d4 = ac * bp;
    if (d3 >= 0.0f && d4 <= d3) return b;
    const Vector cp = p - c;
    const float d5 = ab * cp, d6 = ac * cp;
    if (d6 >= 0.0f && d5 <= d6) return c;
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return a + ab * (d1 / (d1 - d3));
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return a + ac * (d2 / (d2 - d6));
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) return b + (c - b) * ((d4 - d3) / (d4 - d3 + d5 - d6));
    const float denominator = 1.0f / (va + vb + vc);
    return a + ab * (vb * denominator) + ac * (vc * denominator);
}

static bool nearer(RTCPointQueryFunctionArguments* arguments)
{
    const Mesh& mesh = *static_cast<const Mesh*>(arguments->userPtr);
    const auto& triangle = mesh.triangles[arguments->primID];
    const auto corner = [&](int k) {
        const Corner& c = mesh.corners[triangle[k]];
        return Vector{c[0], c[1], c[2]};
    };
    const Vector p = {arguments->query->x, arguments->query->y, arguments->query->z};
    const Vector away = nearest(p, corner(0), corner(1), corner(2)) - p;
    const float distance = std::sqrt(away * away);
    if (distance >= arguments->query->radius) return false;
    arguments->query->radius = distance;
    return true;
}

static float distance(RTCScene scene, const Mesh& mesh, const question_point& point)
{
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query = {};
    query.x = point.at[0], query.y = point.at[1], query.z = point.at[2];
    query.radius = std::numeric_limits<float>::infinity();
    rtcPointQuery(scene, &query, &context, nearer, const_cast<Mesh*>(&mesh));
    return query.radius;
}

static void embree(const Mesh& mesh, const std::vector<question_ray> (&rays)[2],
                   const std::vector<question_point>& points, const char* path)
{
    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene first = scene(device, mesh, RTC_SCENE_FLAG_ROBUST, RTC_BUILD_QUALITY_MEDIUM);
    // A filter would make first hits slower, too.
    const auto flags = RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    RTCScene all = scene(device, mesh, flags, RTC_BUILD_QUALITY_MEDIUM);
    const char* const names[2] = {"from afar", "from within"};
    for (int list = 0; list < 2; ++list) {
        asked((std::string("Embree, first hit, ") + names[list]).c_str(), rays[list].size(), [&] {
            std::pair<std::size_t, double> sums(0, 0.0);
            for (const question_ray& ray : rays[list]) {
                const float t = first_hit(first, ray);
                if (t < std::numeric_limits<float>::infinity()) sums.first += 1, sums.second += t;
            }
            return sums;
        });
        asked((std::string("Embree, all hits, ") + names[list]).c_str(), rays[list].size(), [&] {
            // From outside of a closed surface no number of hits is odd.
            std::pair<std::size_t, double> hits_and_odd(0, 0.0);
            for (const question_ray& ray : rays[list]) {
                const unsigned hits = all_hits(all, ray.from, ray.along);
                hits_and_odd.first += hits, hits_and_odd.second += hits % 2;
            }
            return hits_and_odd;
        });
    }
    asked("Embree, distance", points.size(), [&] {
        double sum = 0.0;
        for (const question_point& point : points) sum += distance(first, mesh, point);
        return std::pair<std::size_t, double>(0, sum);
    });
    asked("Embree, inside by parity", points.size(), [&] {
        std::size_t inside = 0;
        for (const question_point& point : points) inside += all_hits(all, point.at, AWAY) % 2;
        return std::pair<std::size_t, double>(inside, 0.0);
    });
    if (path) {
        std::ofstream out(path, std::ios::binary);
        const auto write = [&](double answer) { out.write(reinterpret_cast<const char*>(&answer), sizeof answer); };
        for (const auto& list : rays) {
            for (const question_ray& ray : list) {
                const float t = first_hit(first, ray);
                write(t < std::numeric_limits<float>::infinity() ? t : -1.0);
            }
        }
        for (const auto& list : rays) {
            for (const question_ray& ray : list) write(all_hits(all, ray.from, ray.along));
        }
        for (const question_point& point : points) write(distance(first, mesh, point));
        for (const question_point& point : points) write(all_hits(all, point.at, AWAY));
    }
    rtcReleaseScene(first), rtcReleaseScene(all), rtcReleaseDevice(device);
}

// The distance of the surface from a ball of no size, in double precision.
static void fcl_distance(const Mesh& mesh, const std::vector<question_point>& points)
{
    const double start = now();
    auto model = std::make_shared<fcl::BVHModel<fcl::RSSd>>();
    std::vector<fcl::Vector3d> corners;
    std::vector<fcl::Triangle> triangles;
    for (const Corner& corner : mesh.corners) corners.emplace_back(corner[0], corner[1], corner[2]);
    for (const auto& triangle : mesh.triangles) triangles.emplace_back(triangle[0], triangle[1], triangle[2]);
    model->beginModel();
    model->addSubModel(corners, triangles);
    model->endModel();
    std::printf("%-38s %10.2f ms\n", "FCL, tree", 1e-6 * (now() - start));
    const fcl::CollisionObjectd surface(model);
    fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(0.0));
    // It takes a hundred times as long as the others.
    const std::size_t some = std::max<std::size_t>(points.size() / 100, std::min<std::size_t>(points.size(), 1000));
    asked("FCL, distance, of the first", some, [&] {
        double sum = 0.0;
        for (std::size_t i = 0; i < some; ++i) {
            ball.setTranslation(fcl::Vector3d(points[i].at[0], points[i].at[1], points[i].at[2]));
            const fcl::DistanceRequestd request;
            fcl::DistanceResultd result;
            sum += fcl::distance(&surface, &ball, request, result);
        }
        return std::pair<std::size_t, double>(some, sum);
    });
}

int main(int count, char** arguments)
{
    if (count < 2) return std::fprintf(stderr, "which mesh?\n"), 1;
    const Mesh mesh = read(arguments[1]);
    const std::size_t questions = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1000000;
    std::vector<question_ray> rays[2] = {std::vector<question_ray>(questions), std::vector<question_ray>(questions)};
    std::vector<question_point> points(questions);
    rays_from_afar(mesh.min, mesh.max, questions, rays[0].data());
    rays_from_within(mesh.min, mesh.max, questions, rays[1].data());
    points_within(mesh.min, mesh.max, questions, points.data());
    std::printf("%s, %zu corners, %zu triangles; %zu questions: %llu %llu %llu\n", arguments[1], mesh.corners.size(),
                mesh.triangles.size(), questions,
                (unsigned long long)sum_of_bits(rays[0].data(), sizeof(question_ray) * questions),
                (unsigned long long)sum_of_bits(rays[1].data(), sizeof(question_ray) * questions),
                (unsigned long long)sum_of_bits(points.data(), sizeof(question_point) * questions));
    embree(mesh, rays, points, count > 3 ? arguments[3] : nullptr);
    fcl_distance(mesh, points);
}
