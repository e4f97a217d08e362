#pragma once

#include <Eigen/SparseCore>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "ruche/core/fields.hpp"
#include "ruche/energy/assembly.hpp"
#include "ruche/energy/contact.hpp"
#include "ruche/geometry/triangle_mesh.hpp"
#include "ruche/material/material.hpp"
#include "ruche/meshing/print_mesh.hpp"

namespace ruche {

enum class EdgeNormals { free, averaged };
enum class BendingNormalisation { plate, as_printed };
enum class LaminateThickness { true_thickness, as_printed };
enum class ShearStrain { engineering, tensor };
enum class FabricPlyLaw { linear, same_law };
enum class StripModel { shell, rods };

/// Choices of the model that model.md names; the defaults are the ones that converge under refinement.
struct ModelOptions {
    EdgeNormals edge_normals = EdgeNormals::free;
    BendingNormalisation bending_normalisation = BendingNormalisation::plate;
    LaminateThickness laminate_thickness = LaminateThickness::true_thickness;
    ShearStrain shear_strain = ShearStrain::engineering;
    FabricPlyLaw fabric_ply = FabricPlyLaw::linear;  ///< of the fabric under plastic
    StripModel strips = StripModel::shell;           ///< what printed strips are: print or rods of ModelInput
    double log_extension = 1e-3;    ///< delta: the stress goes on linearly beyond E_ii = gamma_i - delta
    bool contact = false;           ///< parts of the sheet that come close repel each other
    double contact_distance = 0.5;  ///< mm, from which on
};

template <>
std::span<const Field<ModelOptions>> fields<ModelOptions>();

/// A vertex held in space: where `fixed` is set, the coordinate keeps the value `at`.
struct Support {
    int vertex = 0;
    std::array<bool, 3> fixed = {true, true, true};
    Vec3 at = Vec3::Zero();
};

/// A strip as an elastic rod without width, along edges inside the mesh (StripModel::rods; see the theory
/// page).
struct Rod {
    std::vector<int>
        vertices;            ///< along its line, neighbours share an edge; closed when the first is the last
    double width = 0.0;      ///< mm, of its section
    double thickness = 0.0;  ///< mm
    Side side = Side::front;
    double youngs_modulus = 0.0;  ///< MPa; 0 = the material's
};

/// A force that does not change with the shape, N.
struct NodalForce {
    int vertex = 0;
    Vec3 force = Vec3::Zero();
};

/// A frictionless horizontal plane below the sheet, perpendicular to gravity.
struct Table {
    bool present = false;
    double height = 0.0;               ///< mm, along -gravity
    double stiffness_per_area = 1e-3;  ///< N/mm per mm^2 of layout and mm of penetration
};

/// Everything that defines the energy of one printed sheet.
struct ModelInput {
    TriangleMesh mesh;
    std::vector<Print> print;  ///< per triangle; empty = bare fabric, as it must be with rods
    std::vector<Rod> rods;
    Material material;
    std::array<double, 2> prestretch = {1.7, 1.7};
    double fabric_axis_deg = 0.0;
    std::array<double, 3> gravity = {0, 0, 0};  ///< mm/s^2
    std::vector<Support> supports;
    std::vector<NodalForce> forces;
    Table table;
    ModelOptions options;
};

/// Energy by term, mJ.
struct EnergyTerms {
    double fabric_membrane = 0.0;
    double fabric_bending = 0.0;
    double plastic = 0.0;  ///< the whole laminate, its fabric ply included; or rods
    double gravity = 0.0;  ///< with dead forces and the table
    double contact = 0.0;  ///< between parts of the sheet
    double total() const { return fabric_membrane + fabric_bending + plastic + gravity + contact; }
    /// Sum of magnitudes: what rounding errors of the total are relative to.
    double scale() const {
        return std::abs(fabric_membrane) + std::abs(fabric_bending) + std::abs(plastic) + std::abs(gravity) +
               std::abs(contact);
    }
};

/// What a careful reader of a result has to know about a state.
struct Health {
    /// Largest E_ii - gamma_i of fabric that follows the law (negative: inside it): bare fabric and, with
    /// fabric_ply = same_law, that under plastic too.
    double max_strain_margin = 0.0;
    int beyond_law = 0;           ///< elements with such fabric in the law's linear extension
    double min_area_ratio = 1.0;  ///< smallest area over rest area (relaxed fabric; layout where printed)
    double max_dihedral_deg = 0.0;
    double max_edge_rotation_deg = 0.0;  ///< max |theta/2 +- xi|, must stay below 90
    int self_intersections = 0;          ///< pairs of triangles that pass through each other
    int contact_pairs = 0;               ///< parts of the sheet that repel each other
    double smallest_gap = infinity;      ///< mm, between those
    bool tangled = false;                ///< a knot of the mesh and no shape of the sheet; see statics/tangle
};

/// The elastic energy of one printed sheet and its exact derivatives. Unknowns x: positions, three per vertex
/// (mm), then, when edge normals are free, edge unknowns (mm; in the order of find_edges): one y per edge
/// between two printed triangles and, when the fabric under plastic has the fabric's own law, one c per rim
/// of a printed triangle. Rods have one y per edge, rod by rod. Const member functions may be called from
/// several threads.
class Model {
  public:
    /// Throws InputError for an empty or inverted mesh, a print of the wrong size, or material values without
    /// meaning.
    explicit Model(ModelInput input);
    ~Model();
    Model(const Model&);
    Model(Model&&) noexcept;
    Model& operator=(Model&&) noexcept;

    /// The same sheet with another extension of its fabric's law; cheap. Throws InputError for one without
    /// meaning.
    Model with_log_extension(double log_extension) const;

    int size() const;
    int vertex_count() const;
    const ModelInput& input() const;
    const MeshEdges& edges() const;
    const NodePattern& pattern() const;
    /// Ends of the k-th edge unknown's edge and the two vertices opposite it; on a rim, twice the printed
    /// triangle's.
    std::array<int, 4> vertices_of_edge_unknown(int k) const;

    /// The pairs of parts that contact acts between; none in a new model, whatever the options say (the
    /// solver finds them, see ContactSearch). Changes the pattern.
    void set_contacts(std::vector<ContactPair> pairs);
    const std::vector<ContactPair>& contacts() const;

    /// Flat as printed, without noise; edge unknowns zero.
    Eigen::VectorXd initial() const;

    /// Takes whole turns of normals about edges of printed triangles out of the edge unknowns, which leaves
    /// the shape and its energy as they are. (Steps may wind them up where an edge's normal hardly matters.)
    void unwind(Eigen::VectorXd& x) const;

    /// Energy, and in `sums` the gradient (N) and the Hessian's values on `pattern()` (N/mm) as far as
    /// `order` asks. Non-finite when a bare element is inverted. `sums` is resized when needed, so keep it
    /// between calls.
    EnergyTerms evaluate(const Eigen::VectorXd& x, Order order, AssembledSums& sums) const;
    /// The same without plastic, loads and contact: energy of the bare fabric alone, which is all that a
    /// vertex feels that no printed triangle has.
    EnergyTerms evaluate_fabric(const Eigen::VectorXd& x, Order order, AssembledSums& sums) const;

    /// Some unknowns that may move while all others stay.
    class Patch {
      public:
        int size() const { return static_cast<int>(unknowns_.size()); }
        const std::vector<int>& unknowns() const { return unknowns_; }  ///< global numbers

      private:
        friend class Model;
        /// The elements of one term that touch the patch, and where their unknowns stand in it.
        struct Elements {
            std::vector<int> numbers;
            std::vector<int> local;
        };
        std::vector<int> unknowns_;
        std::array<Elements, 7> terms_;
    };
    /// The unknowns of `nodes`, without those in `held` (one flag per unknown; empty = none).
    Patch patch(std::span<const int> nodes, std::span<const char> held = {}) const;
    /// Energy of the elements that touch the patch, up to a constant; `sums` over the patch's unknowns, in
    /// their order. Costs in proportion to the patch, not to the sheet.
    double evaluate(const Patch& patch, const Eigen::VectorXd& x, Order order, DenseSums& sums) const;
    /// Adds `factor` times the gradient of the elements that touch the patch to one over all unknowns.
    void add_gradient(const Patch& patch, const Eigen::VectorXd& x, double factor,
                      Eigen::VectorXd& gradient) const;

    EnergyTerms energy_terms(const Eigen::VectorXd& x) const;
    double energy(const Eigen::VectorXd& x) const { return energy_terms(x).total(); }
    Eigen::VectorXd gradient(const Eigen::VectorXd& x) const;
    Eigen::SparseMatrix<double> hessian(const Eigen::VectorXd& x) const;  ///< full, symmetric

    /// Elastic energy of each triangle per area of layout (membrane or laminate, without hinges), mJ/mm^2.
    std::vector<double> energy_density(const Eigen::VectorXd& x) const;

    /// What a residual is to be compared with: root mean square over elements and corners of the internal
    /// force, N.
    double typical_force(const Eigen::VectorXd& x) const;

    /// How many elements have fabric in the linear extension of its law.
    int elements_beyond_law(const Eigen::VectorXd& x) const;

    /// Everything in Health that can be measured here: not self-intersections, nor the verdict `tangled`.
    Health health(const Eigen::VectorXd& x) const;

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace ruche
