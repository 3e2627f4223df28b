#pragma once
// Threshold factors for a false-alarm rate, exact in the correlation that windows and zero padding make between
// neighbouring cells.
#include <vector>

#include "echopath/base/job.h"
#include "echopath/spectrum/cfar_window.h"

namespace echopath {

enum class CfarMethod { kCellAveraging, kOrderedStatistic };

// Noise of a map: circular Gaussian cells, independent between channels, whose correlation is the product of those
// along the axes.
struct MapNoise {
  Window window;
  int num_chirps = 1, num_samples = 1;
  int zero_pad = 1;
  int num_channels = 1;  // summed by power

  bool operator==(const MapNoise&) const = default;
};

struct CfarDesign {
  CfarMethod method = CfarMethod::kCellAveraging;
  double false_alarm_rate = 1e-6;  // of one cell
  double rank = 0.75;              // kOrderedStatistic: the share of training cells that the statistic is not below
  CfarWindow cells;
  MapNoise noise;

  int64_t order() const;  // of the ordered statistic: rank times the number of training cells, rounded, at least 1
  // Raises invalid_argument naming the field; also where the window has more than 2000 cells, counted without padding, and
  // where guard cells are fewer than the main lobe of the window, with
  // training cells beyond them.
  void validate() const;
  bool operator==(const CfarDesign&) const = default;
};

// A cell is detected where its power, summed over channels, exceeds factor times the statistic: the mean of the training
// cells (CA), or the order()-th of them in ascending order (OS).
struct CfarFactors {
  std::vector<double> factor;  // [reach_range + 1] by the cell's distance from the nearer end of the range axis
  double statistic = 1.0;      // of noise of unit mean power: noise level = value of the statistic / this
};

// Probability that a sum of `num_channels` unit exponential powers exceeds alpha times an independent training
// sum of as many exponential powers of each mean in `eigenvalues`. For one channel and N eigenvalues 1 it is the textbook
// (1 + alpha)^-N.
double false_alarm_probability(double alpha, const std::vector<double>& eigenvalues, int num_channels);

// CA: exact, from the eigenvalues of the training cells' covariance and their correlation with the cell under test. Windows
// of more than 400 degrees of freedom (about their cells without padding): for cells within twice the guard cells of the end
// of the range axis, in the middle, and at twice the distance each time between; on straight lines elsewhere, where the rate
// is right to 0.2 % (without taper, padded: 1 %).
// OS: mean over 8192 / num_channels (at least 512) draws of the training cells, conditional on which the probability is
// closed; drawn from the tilted distribution in which false alarms happen: the standard error is about 1 % of a false-alarm
// rate of 1e-3, 2 % of 1e-6. Near the ends of the range axis, and in what correlation with the cell under test is left
// beyond the guard cells, OS follows CA.
// Independent of threads. Raises as CfarDesign::validate.
CfarFactors cfar_factors(const CfarDesign& design, Job* job = nullptr);

}  // namespace echopath
