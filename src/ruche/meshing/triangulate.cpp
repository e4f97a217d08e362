// The only file that includes CGAL: it takes long to compile and its arithmetic needs -frounding-math.
#include "ruche/meshing/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_2/Face_badness.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ruche/core/error.hpp"

namespace ruche {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceInfo = CGAL::Triangulation_face_base_with_info_2<int, Kernel>;
using FaceBase =
    CGAL::Delaunay_mesh_face_base_2<Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel, FaceInfo>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;

constexpr double smallest_angle_sine_squared = 0.124;  // 20.6 degrees: below what refinement always reaches
constexpr double longest_edge = 1.45;                  // of the wanted size; admits a square's diagonal

Vec2 to_vec(const Kernel::Point_2& p) { return {p.x(), p.y()}; }

/// What CGAL's mesher asks of a triangle: is it too long for its place, is it too pointed?
class Criteria {
  public:
    using Size = std::function<double(const Vec2&)>;
    using Face_handle = Cdt::Face_handle;

    struct Quality {
        double length = 0.0;  ///< longest edge over the longest allowed, squared
        double sine = 1.0;    ///< of the smallest angle, squared

        // The worst comes first: too long before too pointed.
        bool operator<(const Quality& other) const {
            if (length > 1.0 || other.length > 1.0) return length > other.length;
            return sine < other.sine;
        }
    };

    class Is_bad {
      public:
        explicit Is_bad(const Size* size) : size_(size) {}

        CGAL::Mesh_2::Face_badness operator()(const Quality& quality) const {
            if (quality.length > 1.0) return CGAL::Mesh_2::IMPERATIVELY_BAD;
            return quality.sine < smallest_angle_sine_squared ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
        }

        CGAL::Mesh_2::Face_badness operator()(const Face_handle& face, Quality& quality) const {
            const Vec2 p = to_vec(face->vertex(0)->point());
            const Vec2 q = to_vec(face->vertex(1)->point());
            const Vec2 r = to_vec(face->vertex(2)->point());
            std::array<double, 3> squares = {(q - p).squaredNorm(), (r - q).squaredNorm(),
                                             (p - r).squaredNorm()};
            std::sort(squares.begin(), squares.end());
            const double allowed = longest_edge * (*size_)((p + q + r) / 3.0);
            const double twice_area = (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x();
            quality.length = squares[2] / (allowed * allowed);
            quality.sine = twice_area * twice_area / (squares[1] * squares[2]);
            return (*this)(quality);
        }

      private:
        const Size* size_;
    };

    explicit Criteria(const Size& size) : size_(&size) {}
    Is_bad is_bad_object() const { return Is_bad(size_); }

  private:
    const Size* size_;
};

struct Input {
    Cdt cdt;
    std::vector<Cdt::Vertex_handle> vertices;
};

void insert(Input& input, const SegmentGraph& graph) {
    Cdt::Face_handle near;
    for (int i = 0; i < static_cast<int>(graph.points.size()); ++i) {
        const Cdt::Vertex_handle v = input.cdt.insert({graph.points[i].x(), graph.points[i].y()}, near);
        near = v->face();
        input.vertices.push_back(v);
    }
    for (const std::array<int, 2>& s : graph.segments) {
        input.cdt.insert_constraint(input.vertices[s[0]], input.vertices[s[1]]);
    }
}

/// The two faces beside the first part of a segment.
struct Beside {
    Cdt::Face_handle left, right;
};

// Refinement divides segments at points rounded to doubles: the part that goes on from the first point is the
// constrained edge whose direction fits best.
Beside faces_beside(const Cdt& cdt, Cdt::Vertex_handle from, Cdt::Vertex_handle to) {
    const Vec2 direction = (to_vec(to->point()) - to_vec(from->point())).normalized();
    Beside best;
    double best_fit = -2.0;
    Cdt::Face_circulator face = cdt.incident_faces(from);
    const Cdt::Face_circulator end = face;
    do {
        const int i = face->index(from);
        const Cdt::Vertex_handle next = face->vertex(Cdt::ccw(i));
        if (!cdt.is_infinite(next) && face->is_constrained(Cdt::cw(i))) {
            const Vec2 along = (to_vec(next->point()) - to_vec(from->point())).normalized();
            // The sine tells directions apart that differ by less than the square root of rounding.
            const double sine = std::abs(direction.x() * along.y() - direction.y() * along.x());
            const double fit = direction.dot(along) > 0.0 ? 1.0 - sine : -1.0;
            if (fit > best_fit) {
                best_fit = fit;
                best = {face, face->neighbor(Cdt::cw(i))};
            }
        }
    } while (++face != end);
    return best;
}

// Numbers the pieces of the plane between constrained edges (in every face's info); 0 is the unbounded one.
int number_pieces(Cdt& cdt) {
    for (Cdt::Face_handle face : cdt.all_face_handles()) face->info() = -1;
    int count = 0;
    std::vector<Cdt::Face_handle> open;
    const auto flood = [&](Cdt::Face_handle start) {
        if (start->info() >= 0) return;
        start->info() = count;
        open.push_back(start);
        while (!open.empty()) {
            const Cdt::Face_handle face = open.back();
            open.pop_back();
            for (int i = 0; i < 3; ++i) {
                const Cdt::Face_handle next = face->neighbor(i);
                if (face->is_constrained(i) || next->info() >= 0) continue;
                next->info() = count;
                open.push_back(next);
            }
        }
        ++count;
    };
    flood(cdt.infinite_face());
    for (Cdt::Face_handle face : cdt.finite_face_handles()) flood(face);
    return count;
}

std::vector<std::array<int, 2>> pieces_beside(const Input& input, const SegmentGraph& graph) {
    std::vector<std::array<int, 2>> beside;
    beside.reserve(graph.segments.size());
    for (const std::array<int, 2>& s : graph.segments) {
        const Beside faces = faces_beside(input.cdt, input.vertices[s[0]], input.vertices[s[1]]);
        beside.push_back({faces.left->info(), faces.right->info()});
    }
    return beside;
}

// Pieces that a path from outside reaches by crossing the outline an odd number of times.
std::vector<char> pieces_inside(const std::vector<std::array<int, 2>>& beside,
                                const std::vector<bool>& outline, int piece_count) {
    std::vector<std::vector<std::pair<int, bool>>> next(piece_count);
    for (std::size_t s = 0; s < beside.size(); ++s) {
        const auto [left, right] = beside[s];
        next[left].emplace_back(right, outline[s]);
        next[right].emplace_back(left, outline[s]);
    }
    std::vector<char> inside(piece_count, 0);
    std::vector<char> known(piece_count, 0);
    std::vector<int> open = {0};
    known[0] = 1;
    while (!open.empty()) {
        const int piece = open.back();
        open.pop_back();
        for (const auto& [other, crosses] : next[piece]) {
            if (known[other]) continue;
            known[other] = 1;
            inside[other] = static_cast<char>(inside[piece] != static_cast<char>(crosses));
            open.push_back(other);
        }
    }
    return inside;
}

void refine(Cdt& cdt, const Criteria::Size& size, int most_triangles) {
    CGAL::Delaunay_mesher_2<Cdt, Criteria> mesher(cdt, Criteria(size));
    mesher.init(true);
    const auto most_vertices = static_cast<std::size_t>(most_triangles) / 2;
    // A step inserts one point or finds that one is not needed: the second bound only guards against a loop.
    for (std::size_t steps = 0; !mesher.is_refinement_done(); ++steps) {
        if (cdt.number_of_vertices() > most_vertices || steps > 20 * most_vertices) {
            const Vec2 at = to_vec(mesher.next_refinement_point());
            throw InputError({},
                             fmt::format("the mesh takes more than {} triangles; the last was needed near "
                                         "x = {:.5g}, y = {:.5g} mm",
                                         most_triangles, at.x(), at.y()));
        }
        mesher.try_one_step_refine_mesh();
    }
}

Triangulation extract(Input& input, const SegmentGraph& graph) {
    Triangulation result;
    result.piece_count = number_pieces(input.cdt);
    result.beside = pieces_beside(input, graph);
    for (Cdt::Vertex_handle v : input.cdt.finite_vertex_handles()) v->info() = -1;
    for (Cdt::Face_handle face : input.cdt.finite_face_handles()) {
        if (!face->is_in_domain()) continue;
        Triangle triangle{};
        for (int i = 0; i < 3; ++i) {
            int& number = face->vertex(i)->info();
            if (number < 0) {
                number = result.mesh.vertex_count();
                result.mesh.vertices.push_back(to_vec(face->vertex(i)->point()));
            }
            triangle[i] = number;
        }
        result.mesh.triangles.push_back(triangle);
        result.piece.push_back(face->info());
    }
    return result;
}

/// Inserts the points and segments and marks the domain; false when they span no area.
bool mark(Input& input, const SegmentGraph& graph) {
    insert(input, graph);
    if (input.cdt.dimension() < 2) return false;
    const int pieces = number_pieces(input.cdt);
    const std::vector<char> inside = pieces_inside(pieces_beside(input, graph), graph.outline, pieces);
    for (Cdt::Face_handle face : input.cdt.all_face_handles()) {
        face->set_in_domain(!input.cdt.is_infinite(face) && inside[face->info()]);
    }
    return true;
}

}  // namespace

Triangulation triangulate(const SegmentGraph& graph, const std::function<double(const Vec2&)>& size,
                          int most_triangles) {
    Input input;
    if (!mark(input, graph)) return {};
    refine(input.cdt, size, most_triangles);
    return extract(input, graph);
}

Triangulation triangulate_coarsely(const SegmentGraph& graph) {
    Input input;
    if (!mark(input, graph)) return {};
    return extract(input, graph);
}

}  // namespace ruche
