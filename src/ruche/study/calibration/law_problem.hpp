#pragma once

#include <array>

#include "ruche/study/calibration/law_fit.hpp"
#include "ruche/study/calibration/least_squares.hpp"

namespace ruche {

/// The fit of fit_law as a least-squares problem: curves, weights and which parameters are free.
class LawProblem {
  public:
    LawProblem(std::span<const LawCurve> curves, const LawFitOptions& options);
    LawProblem(const LawProblem&) = delete;
    LawProblem& operator=(const LawProblem&) = delete;

    const LeastSquares& problem() const { return problem_; }
    /// Where a fit may begin: at what each axis says by itself, and where the straight and the locking part
    /// of the law share an axis's stiffness. Few noisy readings can lead from either into a local minimum.
    std::vector<Eigen::VectorXd> starts() const;
    Material material(const Eigen::VectorXd& p) const;
    std::size_t parameter(int index) const { return free_[static_cast<std::size_t>(index)]; }
    int parameter_count() const { return static_cast<int>(free_.size()); }
    std::size_t curve_count() const { return rows_.size(); }

    /// Standard deviations of stress and transverse strain from the residuals of a fit.
    void weigh(const LeastSquaresFit& fit);
    /// Mean number of rows that resemble each other.
    double correlation(const LeastSquaresFit& fit) const;
    /// Rms of a curve's stress over its largest.
    double relative_rms(const LeastSquaresFit& fit, std::size_t curve) const;
    /// What a matrix of squared half widths of the parameters means along a curve.
    CurveBand band(const LeastSquaresFit& fit, const Eigen::MatrixXd& squared, std::size_t curve) const;
    /// Curves of an orientation get no weight.
    void leave_out(double angle_deg);

  private:
    struct Rows {
        int begin = 0;       // of its residuals
        int stress = 0;      // rows
        int transverse = 0;  // rows, 0 without widths
        double stress_scale = 1.0;
        double mean_slope = 1.0;  // stress_scale over the largest stretch beyond 1
        double stress_deviation = 1.0;
        double transverse_deviation = 1.0;
        bool left_out = false;
    };

    bool evaluate(const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* jacobian) const;
    /// The free parameters, within their bounds, for the axes' alpha~, beta and gamma.
    Eigen::VectorXd start(const std::array<AxisFit, 2>& axes) const;
    /// The law's answer to a row: residual (MPa) and, per parameter, its derivatives; false where it has
    /// none.
    struct Answer {
        double residual = 0.0;
        double transverse = 0.0;  ///< Green strain, without the grips' ratio
        LawGradient residual_by_parameter, transverse_by_parameter;
    };
    static bool answer_to_stretch(Pull& pull, const LawCurve& curve, std::size_t row, bool derivatives,
                                  Answer& answer);
    static bool answer_to_force(Pull& pull, const LawCurve& curve, std::size_t row, double slope,
                                Answer& answer);
    bool evaluate_curve(std::size_t index, const Material& m, Eigen::VectorXd& r, Eigen::MatrixXd* j) const;
    std::vector<double> block(const Eigen::VectorXd& r, int begin, int count, double scale) const;
    /// One kind of rows (stresses or transverse strains): where they are, and in what the noise is alike.
    struct Kind {
        int Rows::*count;
        double Rows::*deviation;
        bool behind;  ///< the curve's stresses
    };
    void weigh(const LeastSquaresFit& fit, const Kind& kind, double floor);

    std::span<const LawCurve> curves_;
    LawFitOptions options_;
    std::vector<std::size_t> free_;
    std::vector<Rows> rows_;
    LeastSquares problem_;
};

}  // namespace ruche
