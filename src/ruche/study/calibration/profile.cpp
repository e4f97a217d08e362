#include "ruche/study/calibration/profile.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ruche {
namespace {

/// The profile of one parameter: sqrt(S(v) - S_best), which is linear in v for a linear model.
class Profile {
  public:
    Profile(const LeastSquares& problem, const LeastSquaresFit& best, int index, const Covariance& covariance)
        : problem_(problem), best_(best), index_(index), along_(best.p.size()), last_(best.p) {
        const Eigen::VectorXd& deviation = covariance.deviation;
        along_.setZero();
        if (deviation[index] > 0.0)
            along_ = covariance.correlation.col(index).cwiseProduct(deviation) / deviation[index];
    }

    double operator()(double value) {
        Eigen::VectorXd start = last_ + along_ * (value - last_[index_]);
        start[index_] = value;
        // The height is wanted to a hundredth, of a sum of squares of about the number of rows.
        constexpr double enough = 1e-7;
        const LeastSquaresFit fit = minimise(problem_, start, {index_}, enough);
        last_ = fit.p;
        if (fit.sum_of_squares < lowest_ && fit.converged) {
            lowest_ = fit.sum_of_squares;
            lowest_p_ = fit.p;
        }
        return std::sqrt(std::max(fit.sum_of_squares - best_.sum_of_squares, 0.0));
    }

    void restart() { last_ = best_.p; }
    Eigen::VectorXd better() const {
        return lowest_ < best_.sum_of_squares * (1.0 - 1e-9) - 1e-3 ? lowest_p_ : Eigen::VectorXd();
    }

  private:
    const LeastSquares& problem_;
    const LeastSquaresFit& best_;
    int index_;
    Eigen::VectorXd along_;  // how the others' optimum moves with the value, to first order
    Eigen::VectorXd last_;   // optimum of the others at the value tried last
    double lowest_ = std::numeric_limits<double>::infinity();
    Eigen::VectorXd lowest_p_;
};

struct End {
    double value;
    bool open;
};

/// From `from` outwards, first by `step`: the value where the profile reaches `target`, or the bound.
End find_end(Profile& profile, double from, double step, double bound, double target) {
    profile.restart();
    double inside = from;
    double inside_height = 0.0;
    double outside = from;
    double outside_height = -1.0;
    constexpr int most_steps = 24;  // doublings: a parameter that is free over 2^24 steps is free
    for (int i = 0; i < most_steps; ++i) {
        const double next = step > 0.0 ? std::min(from + step, bound) : std::max(from + step, bound);
        const double height = profile(next);
        if (height >= target) {
            outside = next;
            outside_height = height;
            break;
        }
        if (next == bound) return {bound, true};
        inside = next;
        inside_height = height;
        step *= height > 0.3 * target ? std::clamp(1.2 * target / height, 1.1, 2.0) : 2.0;
    }
    if (outside_height < 0.0) return {bound, true};
    constexpr double close = 0.01;  // of the target: a hundredth of the interval's width
    for (int i = 0; i < 20 && std::abs(outside_height - target) > close * target; ++i) {
        double share = (target - inside_height) / (outside_height - inside_height);
        share = std::clamp(share, 0.1, 0.9);
        const double middle = inside + share * (outside - inside);
        const double height = profile(middle);
        if (std::abs(height - target) <= close * target) return {middle, false};
        if (height < target) {
            inside = middle;
            inside_height = height;
        } else {
            outside = middle;
            outside_height = height;
        }
    }
    return {outside, false};
}

}  // namespace

ProfileInterval profile_interval(const LeastSquares& problem, const LeastSquaresFit& best, int index,
                                 double threshold) {
    const double value = best.p[index];
    const double target = std::sqrt(threshold);
    const Covariance about = covariance(problem, best);
    double step = about.deviation[index] * target;
    if (!(step > 0.0) || !std::isfinite(step)) step = 0.1 * std::abs(value) + 1e-6;
    step = std::min(step, 0.5 * (std::abs(value) + 1e-3));
    Profile profile(problem, best, index, about);
    const End low = find_end(profile, value, -step, problem.low[index], target);
    const End high = find_end(profile, value, step, problem.high[index], target);
    return {low.value, high.value, low.open, high.open, profile.better()};
}

Covariance covariance(const LeastSquares& problem, const LeastSquaresFit& fit) {
    const Eigen::Index count = fit.p.size();
    std::vector<int> free;
    for (Eigen::Index i = 0; i < count; ++i) {
        const bool at_bound = fit.p[i] <= problem.low[i] || fit.p[i] >= problem.high[i];
        if (!at_bound && fit.jacobian.col(i).norm() > 0.0) free.push_back(static_cast<int>(i));
    }
    Covariance result{Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Identity(count, count)};
    if (free.empty()) return result;
    const auto size = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd columns(fit.jacobian.rows(), size);
    Eigen::VectorXd scale(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        scale[i] = fit.jacobian.col(free[static_cast<std::size_t>(i)]).norm();
        columns.col(i) = fit.jacobian.col(free[static_cast<std::size_t>(i)]) / scale[i];
    }
    const Eigen::MatrixXd normal = columns.transpose() * columns;
    const Eigen::MatrixXd inverse = normal.completeOrthogonalDecomposition().pseudoInverse();
    for (Eigen::Index i = 0; i < size; ++i) {
        const int a = free[static_cast<std::size_t>(i)];
        result.deviation[a] = std::sqrt(std::max(inverse(i, i), 0.0)) / scale[i];
        for (Eigen::Index j = 0; j < size; ++j) {
            const double product = inverse(i, i) * inverse(j, j);
            if (i != j && product > 0.0)
                result.correlation(a, free[static_cast<std::size_t>(j)]) = inverse(i, j) / std::sqrt(product);
        }
    }
    return result;
}

}  // namespace ruche
