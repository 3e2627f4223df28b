#pragma once
// Draws the powers of the training cells of a CFAR window from the distribution in which false alarms happen.
#include <Eigen/Cholesky>
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/spectrum/cfar/training_noise.h"

namespace echopath {

struct TrainingDraw {
  double statistic = 0.0;   // what the method makes of the training powers, for cells of unit mean power per channel
  double log_weight = 0.0;  // a mean over the noise weighs the draw by e^this
};

// Draws from the distribution of the noise tilted by e^{-tilt times the sum of the training powers}. That is Gaussian again,
// of covariance (1 + tilt B)^-1 with B the quadratic form; weights undo the tilt exactly. A false alarm needs low training
// cells: the tilt puts the draws there, so that weight times probability hardly varies.
class TrainingDraws {
 public:
  // All arguments must outlive it. `form` is noise.quadratic_form(reach_range), and `eigenvalues` are those of `form`.
  TrainingDraws(const CfarDesign& design, const TrainingNoise& noise, const Eigen::MatrixXd& form,
                const std::vector<double>& eigenvalues, double tilt);
  // Returns draws 0 to count - 1, which are always the same and do not depend on the number of threads. Raises Cancelled.
  std::vector<TrainingDraw> draw(int count, Job* job) const;

 private:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::MatrixXd white_numbers(int64_t index) const;
  TrainingDraw one(int64_t index) const;
  TrainingDraw summed_up(const RowMatrix& power) const;
  double ordered(std::vector<double> training) const;

  const CfarDesign& design_;
  const TrainingNoise& noise_;
  const double tilt_;
  const Eigen::LLT<Eigen::MatrixXd> root_;
  double log_mean_ = 0.0;
};

}  // namespace echopath
