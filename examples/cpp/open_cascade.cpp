// A CAD model from Open CASCADE: one octree of its STEP file from triangles, and another one from distances.
//
// CMake builds it if it finds Open CASCADE (tested with 7.6) and Leafless, which include/README.md describes how to
// install:
//
//     cmake -S examples/cpp -B build -DCMAKE_PREFIX_PATH=$HOME/.local
//     cmake --build build
//     build/open_cascade MODEL.step [DEFLECTION]
//
// Without arguments it makes a STEP file of its own, a block with a bore. It writes open_cascade.lfl to the
// current folder.

#include <leafless.hpp>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Solid.hxx>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

using leafless::octree;
using leafless::point;
using leafless::solid;

namespace {

void print(const char *name, const leafless_interval &volume) {
    std::printf("%-28s %.3f to %.3f\n", name, volume.lower, volume.upper);
}

// ---- The model ----------------------------------------------------------------------------------------------------

void write_part(const std::string &path) {
    const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Pnt(-20, -12, -8), gp_Pnt(20, 12, 8)).Shape();
    const gp_Ax2 axis(gp_Pnt(4, 0, -10), gp_Dir(0, 0, 1));
    const TopoDS_Shape part = BRepAlgoAPI_Cut(block, BRepPrimAPI_MakeCylinder(axis, 6, 20).Shape()).Shape();
    STEPControl_Writer writer;
    if (writer.Transfer(part, STEPControl_AsIs) != IFSelect_RetDone || writer.Write(path.c_str()) != IFSelect_RetDone) {
        throw std::runtime_error(path + ": Open CASCADE cannot write it");
    }
}

// The solids of a STEP file, in millimetres, which are Open CASCADE's own unit.
std::vector<TopoDS_Solid> read_solids(const std::string &path) {
    if (!std::ifstream(path)) throw std::runtime_error(path + ": the file cannot be opened");
    STEPControl_Reader reader;
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
        throw std::runtime_error(path + ": Open CASCADE cannot read it as STEP");
    }
    reader.TransferRoots();
    std::vector<TopoDS_Solid> solids;
    for (TopExp_Explorer it(reader.OneShape(), TopAbs_SOLID); it.More(); it.Next()) {
        TopoDS_Solid solid = TopoDS::Solid(it.Current());
        // Some files have inside-out solids.
        if (!BRepLib::OrientClosedSolid(solid)) throw std::runtime_error(path + ": a solid in it has no inside");
        solids.push_back(solid);
    }
    if (solids.empty()) {
        throw std::runtime_error(path + ": no closed solid is in it; BRepBuilderAPI_Sewing makes shells of loose faces, "
                                        "BRepBuilderAPI_MakeSolid solids of shells");
    }
    return solids;
}

TopoDS_Compound compound_of(const std::vector<TopoDS_Solid> &solids) {
    const BRep_Builder builder;
    TopoDS_Compound compound;
    builder.MakeCompound(compound);
    for (const TopoDS_Solid &solid : solids) builder.Add(compound, solid);
    return compound;
}

// The corners of a box around the model, with its tolerances.
std::pair<point, point> bounds(const TopoDS_Shape &model) {
    Bnd_Box box;
    BRepBndLib::Add(model, box);
    const gp_Pnt low = box.CornerMin(), high = box.CornerMax();
    return {{low.X(), low.Y(), low.Z()}, {high.X(), high.Y(), high.Z()}};
}

// ---- By triangles -------------------------------------------------------------------------------------------------

// The triangles of all faces, each no further from its face than the deflection.
leafless::mesh tessellation(const TopoDS_Shape &model, double deflection) {
    // The angle in radians from one segment of an edge to the next.
    BRepMesh_IncrementalMesh(model, deflection, Standard_False, 0.3);
    std::vector<point> corners;
    std::vector<leafless::cell_index> triangles;
    for (TopExp_Explorer it(model, TopAbs_FACE); it.More(); it.Next()) {
        const TopoDS_Face &face = TopoDS::Face(it.Current());
        TopLoc_Location location;
        const Handle(Poly_Triangulation) part = BRep_Tool::Triangulation(face, location);
        if (part.IsNull()) throw std::runtime_error("Open CASCADE has no triangles for a face");
        // Poly_Triangulation counts from 1.
        const auto first = static_cast<std::uint32_t>(corners.size()) - 1;
        for (int i = 1; i <= part->NbNodes(); i++) {
            const gp_Pnt at = part->Node(i).Transformed(location.Transformation());
            corners.push_back({at.X(), at.Y(), at.Z()});
        }
        for (int i = 1; i <= part->NbTriangles(); i++) {
            int a = 0, b = 0, c = 0;
            part->Triangle(i).Get(a, b, c);
            // A reversed face bounds the solid with the back of its surface.
            if (face.Orientation() == TopAbs_REVERSED) std::swap(b, c);
            triangles.push_back({first + a, first + b, first + c});
        }
    }
    leafless_mesh_arrays arrays = LEAFLESS_INIT(leafless_mesh_arrays);
    arrays.vertices = corners.data();
    arrays.vertex_count = corners.size();
    arrays.indices = triangles.data();
    arrays.triangle_count = triangles.size();
    // Each face has corners of its own. Equal corners are welded; corners that rounding or the tolerance of an edge
    // keeps apart are sewn. The faces of the model lie within the deflection of the triangles.
    return leafless::mesh::make(arrays).sewn().with_deviation(deflection);
}

// Every answer is certified for each solid whose boundary lies within the deflection of the triangles. Open CASCADE
// ensures this for the model only at the points that it checks. The octree keeps the planes of the triangles as layers
// that are no thicker than four deflections.
void by_triangles(const TopoDS_Shape &model, const leafless_frame &frame, double deflection) {
    const leafless::mesh mesh = tessellation(model, deflection);
    mesh.check_closed(LEAFLESS_FILL_NON_ZERO);
    std::printf("%-28s %llu, deflection %g\n", "triangles",
                static_cast<unsigned long long>(mesh.describe().triangles), deflection);

    leafless_cut_options cuts = LEAFLESS_INIT(leafless_cut_options);
    cuts.tolerance_model = 4 * deflection;
    octree::build_extended(solid::from_mesh(mesh, LEAFLESS_FILL_NON_ZERO), frame, &cuts)
        .write(leafless_to_file("open_cascade.lfl"));

    const octree part = octree::read(leafless_from_file("open_cascade.lfl", LEAFLESS_ACCESS_MAP));
    print("volume by triangles", solid::from_octree(part).measure(frame, 1e-6, 0).volume_model);
}

// ---- By distances -------------------------------------------------------------------------------------------------

// Bounds the distances of points from the model's faces: no face reaches into the ball of that radius around the point.
// The octree is certified for the model itself, without triangles, if Open CASCADE's distances and its inside and
// outside verdicts are right.
class distances {
public:
    explicit distances(const std::vector<TopoDS_Solid> &solids)
        : search_(std::make_unique<BRepExtrema_DistShapeShape>()) {
        // Points inside a solid have the distance 0 from it, so the faces are searched.
        const BRep_Builder builder;
        TopoDS_Compound faces;
        builder.MakeCompound(faces);
        for (const TopoDS_Solid &solid : solids) {
            classifiers_.push_back(std::make_unique<BRepClass3d_SolidClassifier>(solid));
            for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) builder.Add(faces, it.Current());
        }
        search_->LoadS2(faces);
        // The gaps between faces, edges and vertices that belong together are at most their greatest tolerance.
        tolerance_ = ShapeAnalysis_ShapeTolerance().Tolerance(faces, 1);
    }

    void distance_many(leafless::span<const point> points, leafless::span<double> distances) const {
        for (std::size_t i = 0; i < points.size(); i++) distances[i] = distance(points[i]);
    }

private:
    // Negative inside, positive outside, and 0 where the tolerance allows both.
    double distance(const point &at) const {
        const gp_Pnt centre(at[0], at[1], at[2]);
        search_->LoadS1(BRepBuilderAPI_MakeVertex(centre).Vertex());
        if (!search_->Perform()) throw std::runtime_error("Open CASCADE finds no distance");
        const double free = search_->Value() - tolerance_;
        if (free <= 0) return 0;
        const bool inside = std::any_of(classifiers_.begin(), classifiers_.end(), [&](const auto &classifier) {
            classifier->Perform(centre, tolerance_);
            return classifier->State() == TopAbs_IN;
        });
        return inside ? -free : free;
    }

    std::unique_ptr<BRepExtrema_DistShapeShape> search_;
    std::vector<std::unique_ptr<BRepClass3d_SolidClassifier>> classifiers_;
    double tolerance_ = 0;
};

void by_distances(const std::vector<TopoDS_Solid> &solids, const leafless_frame &frame) {
    // Open CASCADE's search objects change during a search, so only one thread uses them.
    leafless_options options = LEAFLESS_INIT(leafless_options);
    options.threads = 1;
    const solid model = leafless::solid_of(distances(solids), LEAFLESS_EXTERIOR_EMPTY);
    const octree part = octree::build(model, frame, LEAFLESS_RULE_CERTIFIED, &options);
    print("volume by distances", part.statistics().volume_model);
}

void take_in(const std::string &path, double deflection) {
    const std::vector<TopoDS_Solid> solids = read_solids(path);
    const TopoDS_Compound model = compound_of(solids);
    // Open CASCADE counts the common part of two solids twice, Leafless once.
    GProp_GProps properties;
    BRepGProp::VolumeProperties(model, properties);
    std::printf("%-28s %zu, of %s\n", "solids", solids.size(), path.c_str());
    std::printf("%-28s %.3f\n", "volume by Open CASCADE", properties.Mass());

    const auto [low, high] = bounds(model);
    by_triangles(model, leafless::frame_around(low, high, 10), deflection);
    // Every further level needs four times as many distances, of about a tenth of a millisecond each.
    by_distances(solids, leafless::frame_around(low, high, 6));
}

} // namespace

int main(int argc, char **argv) {
    // Standard output is for results.
    Message::DefaultMessenger()->ChangePrinters().Clear();
    try {
        const std::string path = argc > 1 ? argv[1] : "open_cascade.step";
        if (argc == 1) write_part(path);
        const double deflection = argc > 2 ? std::atof(argv[2]) : 0.01;
        if (!(deflection > 0)) throw std::runtime_error("the deflection is to be a length in millimetres, such as 0.01");
        take_in(path, deflection);
    } catch (const Standard_Failure &failure) {
        std::fprintf(stderr, "Open CASCADE: %s\n", failure.GetMessageString());
        return 1;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
