#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ruche/energy/model.hpp"

namespace ruche {

/// A piece of a sheet as a sheet of its own, with so much around it that what is free in it feels the same
/// forces as in the whole sheet. All around is held where it is.
struct SheetPiece {
    Model model;
    std::vector<char> held;     ///< one flag per unknown of the piece
    std::vector<int> unknowns;  ///< each one's number in the whole sheet

    /// Its part of a state of the whole sheet.
    Eigen::VectorXd take(const Eigen::VectorXd& whole) const;
    /// Puts what is free of a state of the piece into one of the whole sheet.
    void place(const Eigen::VectorXd& piece, Eigen::VectorXd& whole) const;
};

/// Cuts out the piece in which `vertices` are free, with the edge unknowns that feel them, from a sheet in
/// the state `x`. None of them may be held in the whole sheet, which has neither rods nor contacts.
SheetPiece cut_out(const Model& whole, std::span<const int> vertices, const Eigen::VectorXd& x);

}  // namespace ruche
