#include "sheet.hpp"

#include <cmath>

namespace ruche::bench {

ModelInput staggered_sheet(int triangles) {
    constexpr double cell_mm = 0.5;
    constexpr int pitch_rows = 5;     // strips repeat every 2.5 mm across
    constexpr int printed_rows = 2;   // and are 1 mm wide
    constexpr int period_cells = 28;  // 12 mm of strip, 2 mm of gap
    constexpr int strip_cells = 24;
    const int cells = static_cast<int>(std::lround(std::sqrt(0.5 * triangles)));
    ModelInput input;
    for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) input.mesh.vertices.emplace_back(cell_mm * i, cell_mm * j);
    }
    for (int j = 0; j < cells; ++j) {
        const int shift = j / pitch_rows % 2 == 0 ? 0 : period_cells / 2;
        for (int i = 0; i < cells; ++i) {
            const int v00 = j * (cells + 1) + i;
            const int v10 = v00 + 1;
            const int v01 = v00 + cells + 1;
            const int v11 = v01 + 1;
            if ((i + j) % 2 == 0) {
                input.mesh.triangles.push_back({v00, v10, v11});
                input.mesh.triangles.push_back({v00, v11, v01});
            } else {
                input.mesh.triangles.push_back({v00, v10, v01});
                input.mesh.triangles.push_back({v10, v11, v01});
            }
            const bool printed = j % pitch_rows < printed_rows && (i + shift) % period_cells < strip_cells;
            const Print print{.front = printed ? 0.6 : 0.0};
            input.print.insert(input.print.end(), 2, print);
        }
    }
    return input;
}

Eigen::VectorXd rolled_state(const Model& model, double radius_mm) {
    Eigen::VectorXd x = model.initial();
    for (int v = 0; v < model.vertex_count(); ++v) {
        const double angle = 0.95 * x[3 * v] / radius_mm;
        x[3 * v] = radius_mm * std::sin(angle);
        x[3 * v + 1] *= 0.9;
        x[3 * v + 2] = radius_mm * (std::cos(angle) - 1.0);
    }
    for (int k = 3 * model.vertex_count(); k < model.size(); ++k) x[k] = 1e-3 * std::sin(k);
    return x;
}

}  // namespace ruche::bench
