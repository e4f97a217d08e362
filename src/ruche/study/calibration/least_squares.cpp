#include "ruche/study/calibration/least_squares.hpp"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>

namespace ruche {
namespace {

/// All residuals as one function of as many one-number blocks as there are parameters, so that each can be
/// held by itself.
class Residuals final : public ceres::CostFunction {
  public:
    explicit Residuals(const LeastSquares& problem) : problem_(problem) {
        set_num_residuals(problem.residual_count);
        mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(problem.low.size()), 1);
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        const Eigen::Index count = problem_.low.size();
        Eigen::VectorXd p(count);
        for (Eigen::Index i = 0; i < count; ++i) p[i] = parameters[i][0];
        Eigen::VectorXd r(problem_.residual_count);
        Eigen::MatrixXd jacobian;
        if (jacobians != nullptr) jacobian.resize(problem_.residual_count, count);
        if (!problem_.evaluate(p, r, jacobians != nullptr ? &jacobian : nullptr) || !r.allFinite())
            return false;
        Eigen::Map<Eigen::VectorXd>(residuals, problem_.residual_count) = r;
        for (Eigen::Index i = 0; jacobians != nullptr && i < count; ++i) {
            if (jacobians[i] != nullptr)
                Eigen::Map<Eigen::VectorXd>(jacobians[i], problem_.residual_count) = jacobian.col(i);
        }
        return true;
    }

  private:
    const LeastSquares& problem_;
};

ceres::Solver::Options solver_options(double tolerance) {
    // The library never prints.
    [[maybe_unused]] static const bool silent = [] {
        FLAGS_minloglevel = google::GLOG_FATAL;
        return true;
    }();
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.max_num_iterations = tolerance > 1e-10 ? 60 : 300;
    options.function_tolerance = tolerance;
    options.gradient_tolerance = 1e-16;
    options.parameter_tolerance = 1e-12;
    options.num_threads = 1;
    return options;
}

}  // namespace

LeastSquaresFit minimise(const LeastSquares& problem, const Eigen::VectorXd& start,
                         const std::vector<int>& held, double tolerance) {
    LeastSquaresFit fit{.p = start.cwiseMax(problem.low).cwiseMin(problem.high)};
    ceres::Problem ceres_problem;
    std::vector<double*> blocks;
    for (double& value : fit.p) blocks.push_back(&value);
    ceres_problem.AddResidualBlock(new Residuals(problem), nullptr, blocks);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        ceres_problem.SetParameterLowerBound(blocks[i], 0, problem.low[k]);
        ceres_problem.SetParameterUpperBound(blocks[i], 0, problem.high[k]);
    }
    for (const int i : held) ceres_problem.SetParameterBlockConstant(blocks[static_cast<std::size_t>(i)]);
    if (held.size() < blocks.size()) {
        ceres::Solver::Summary summary;
        ceres::Solve(solver_options(tolerance), &ceres_problem, &summary);
        fit.converged = summary.IsSolutionUsable();
        fit.message = summary.message;
    } else {
        fit.converged = true;
    }
    fit.residuals.setZero(problem.residual_count);
    fit.jacobian.setZero(problem.residual_count, fit.p.size());
    if (!problem.evaluate(fit.p, fit.residuals, &fit.jacobian)) fit.converged = false;
    fit.sum_of_squares = fit.residuals.squaredNorm();
    return fit;
}

}  // namespace ruche
