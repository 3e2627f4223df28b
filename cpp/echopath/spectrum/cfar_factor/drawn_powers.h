#pragma once
// Draws the powers of the training cells of a CFAR window, and evaluates what a method makes of them.
#include <Eigen/Cholesky>
#include <array>
#include <vector>

#include "echopath/spectrum/cfar_factor/training_cells.h"
#include "echopath/spectrum/cfar_factor/training_noise.h"

namespace echopath {

// Holds the powers of the cells of the window's rectangle, summed over the channels, for cells of unit mean power per
// channel.
using CellPowers = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Noise that is tilted by e^{-tilt times the sum of the powers of some cells} is Gaussian again, of covariance (1 + tilt
// B)^-1 with B the quadratic form of the sum.
struct TiltedNoise {
  Eigen::LLT<Eigen::MatrixXd> root;  // of 1 + tilt B
  double log_mean = 0.0;             // of e^{-tilt times the sum} over the noise

  TiltedNoise(const Eigen::MatrixXd& form, double tilt, int num_channels);
};

class DrawnPowers {
 public:
  // Both must outlive it.
  DrawnPowers(const CfarDesign& design, const TrainingNoise& noise);

  // Returns the powers of the draw with this index, which are always the same.
  CellPowers draw(int64_t index, const TiltedNoise& tilted) const;
  // Returns what the method makes of the powers.
  double statistic(const CellPowers& powers) const;

 private:
  Eigen::MatrixXd white_numbers(int64_t index, Eigen::Index count) const;

  const CfarDesign& design_;
  const TrainingNoise& noise_;
  const CellGroup training_;
  const std::array<CellGroup, 2> halves_;
};

double sum_of(const CellPowers& powers, const CellGroup& cells);

}  // namespace echopath
