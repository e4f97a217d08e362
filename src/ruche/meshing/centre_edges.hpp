#pragma once

#include <span>
#include <vector>

#include "ruche/meshing/print_mesh.hpp"
#include "ruche/meshing/size_field.hpp"

namespace ruche {

/// Centre lines of strips that are to be edges of the mesh: before it is made, the lines to make it with;
/// after, the vertices along them.
class CentreEdges {
  public:
    /// Strips in their order. Lines are simplified (their points become vertices), and led to the strip's
    /// border where they end just before it. Throws InputError for a strip without a centre line.
    void add(const Strip& strip, const std::vector<Polyline>& lines, const SizeField& sizes);

    const std::vector<Polyline>& lines() const { return lines_; }

    /// Fills edge_lines of the mesh's strips.
    void find(PrintMesh& layout) const;

  private:
    std::vector<Polyline> lines_;
    std::vector<double> widths_;  // of the strip, per line
    std::vector<int> strips_;     // per line
    int strip_count_ = 0;
};

}  // namespace ruche
