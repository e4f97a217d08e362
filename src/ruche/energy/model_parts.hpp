#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ruche/energy/contact.hpp"
#include "ruche/energy/fabric_bending.hpp"
#include "ruche/energy/fabric_membrane.hpp"
#include "ruche/energy/laminate_term.hpp"
#include "ruche/energy/loads.hpp"
#include "ruche/energy/model.hpp"
#include "ruche/energy/rod_edge.hpp"
#include "ruche/energy/rod_joint.hpp"

namespace ruche {

/// What a Model is made of; for the files that implement it.
struct Model::Parts {
    ModelInput input;
    MeshEdges edges;
    std::vector<int> bare;                          // triangle of each membrane element
    std::vector<int> printed;                       // triangle of each laminate element
    std::vector<std::array<int, 4>> edge_unknowns;  // vertices around each
    // Shared among models that differ in their law only.
    std::shared_ptr<const NodePattern> pattern;
    std::shared_ptr<const TermAssembly<FabricMembrane>> membrane;
    std::shared_ptr<const TermAssembly<FabricBending>> bending;
    std::shared_ptr<const TermAssembly<LaminateTerm>> laminate;
    std::shared_ptr<const TermAssembly<RodEdge>> rod_edges;
    std::shared_ptr<const TermAssembly<RodJoint>> rod_joints;
    std::shared_ptr<const TermAssembly<TableContact>> table;
    std::shared_ptr<const TermAssembly<ContactBarrier>> contact;
    Eigen::VectorXd dead_load;  // N, on positions: gravity and nodal forces

    Unknowns unknowns(const Eigen::VectorXd& x) const { return {x.data(), input.mesh.vertex_count()}; }

    template <class Visit>
    void for_each_term(const Visit& visit) const {
        visit(*membrane), visit(*bending), visit(*laminate), visit(*rod_edges), visit(*rod_joints);
        visit(*table), visit(*contact);
    }

    FabricLaw law() const;
    void build_elastic_terms();
    void build_loads();
    void build_contact(std::vector<ContactPair> pairs);
    void build_pattern();
};

}  // namespace ruche
