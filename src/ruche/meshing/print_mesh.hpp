#pragma once

#include <string>
#include <vector>

#include "ruche/core/fields.hpp"
#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/pattern/pattern.hpp"

namespace ruche {

/// The plastic on one triangle: thickness in mm on each side, 0 where there is none; Young's modulus in MPa,
/// 0 = the card's.
struct Print {
    double front = 0.0;
    double back = 0.0;
    double front_modulus = 0.0;
    double back_modulus = 0.0;

    bool bare() const { return front == 0.0 && back == 0.0; }
    bool operator==(const Print&) const = default;
};

/// The strips on the two sides of a triangle: indices into PrintMesh::strips, -1 where there is none.
struct StripPair {
    int front = -1;
    int back = -1;

    int& on(Side side) { return side == Side::front ? front : back; }
    int on(Side side) const { return side == Side::front ? front : back; }
    bool has(int strip) const { return front == strip || back == strip; }
    bool operator==(const StripPair&) const = default;
};

/// A point of the layout on the mesh: a triangle and barycentric coordinates.
struct MeshPoint {
    int triangle = -1;
    double weights[3] = {0, 0, 0};
};

/// A strip as the mesh carries it: where its centre line runs.
struct MeshedStrip {
    std::string id;
    Side side = Side::front;
    double thickness = 0.0;
    std::vector<std::vector<MeshPoint>> centreline;  ///< evenly spaced, at most half an element apart
    double youngs_modulus = 0.0;                     ///< MPa; 0 = the material's
    /// Vertices along each centre line, neighbours joined by an edge; only with MeshOptions::centre_lines.
    struct EdgeLine {
        std::vector<int> vertices;
        double width = 0.0;  ///< mm, of the strip there
    };
    std::vector<EdgeLine> edge_lines;
};

/// The conforming mesh of a pattern: every border of a strip is made of edges.
struct PrintMesh {
    TriangleMesh mesh;
    std::vector<Print> print;      ///< per triangle
    std::vector<StripPair> strip;  ///< per triangle; of several on one side the thickest
    std::vector<MeshedStrip> strips;
    std::string outline_layer;  ///< as in Pattern
    std::vector<std::string> warnings;
};

/// The one strip that stands for a triangle where only one can: that of the thicker print, the front's when
/// both are equal; -1 on bare fabric.
int main_strip(const PrintMesh& layout, int triangle);

struct MeshOptions {
    double size_mm = 1.0;          ///< edge length of plastic elements
    double elements_across = 1.0;  ///< at least so many elements across a strip's width
    double fabric_size_mm = 2.0;   ///< edge length far from plastic
    double grading = 0.3;          ///< growth of edge length per length away from plastic
    int subdivisions = 0;          ///< times that every triangle is then divided into four
    bool centre_lines = false;     ///< the strips' centre lines are made of edges too; no key of a scene
};

/// About the same edge lengths without subdivisions.
MeshOptions undivided(MeshOptions options);

template <>
std::span<const Field<MeshOptions>> fields<MeshOptions>();

/// Conforming constrained Delaunay mesh with minimum angle above 20 degrees away from sharper input angles,
/// triangle and vertex numbers deterministic and spatially coherent. Throws InputError.
PrintMesh mesh_pattern(const Pattern& pattern, const MeshOptions& options = {});

/// Reads a layout mesh with print thickness per triangle from a PLY with face properties (`front_mm`,
/// `back_mm`) or an OBJ (+ `thickness_table`: a CSV of triangle, front_mm, back_mm). Throws InputError.
PrintMesh read_print_mesh(const std::string& path, const std::string& thickness_table = {});

}  // namespace ruche
