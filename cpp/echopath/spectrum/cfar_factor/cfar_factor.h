#pragma once
// Computes threshold factors for a false-alarm rate. They allow exactly for the correlation that windows and zero padding
// make between neighbouring cells.
#include <vector>

#include "echopath/base/threads/job.h"
#include "echopath/spectrum/cfar_factor/cfar_window.h"

namespace echopath {

inline constexpr double kLeastRate = 1e-15;  // of false alarms

// What a cell is held against: the mean of its training cells, one of them in the order of their powers, or the greater or
// the smaller of the means of their two halves (CfarWindow::half_of).
enum class CfarMethod { kCellAveraging, kOrderedStatistic, kGreatestOf, kSmallestOf };

// Models the noise of a map: circular Gaussian cells, independent between channels, whose correlation is the product of
// those along the axes.
struct MapNoise {
  MapWindows window;
  int num_chirps = 1, num_samples = 1;
  int zero_pad = 1;
  int num_channels = 1;  // their powers are summed

  bool operator==(const MapNoise&) const = default;
};

struct CfarDesign {
  CfarMethod method = CfarMethod::kCellAveraging;
  double false_alarm_rate = 1e-6;  // of each cell
  double rank = 0.75;              // kOrderedStatistic: share of the training cells up to the statistic
  CfarWindow cells;
  MapNoise noise;

  int64_t order() const;  // kOrderedStatistic: rank times the number of training cells, rounded, at least 1
  // Raises invalid_argument naming the field; also where the window has more than 2000 cells, counted without padding, and
  // where guard cells do not cover the main lobe of the window along an axis with training cells.
  void validate() const;
  bool operator==(const CfarDesign&) const = default;
};

// A cell is detected where its power, summed over channels, exceeds factor times the statistic: the mean of the training
// cells (CA), the order()-th of them in ascending order (OS), or the greater or the smaller mean of two halves (GO, SO).
struct CfarFactors {
  std::vector<double> factor;  // [reach_range + 1] by the cell's distance from the nearer end of the range axis
  double statistic = 1.0;      // for noise of unit mean power: noise level = statistic / this
};

// Returns the probability that a sum of `num_channels` unit exponential powers exceeds alpha times an independent training
// sum of as many exponential powers of each mean in `eigenvalues`. For one channel and N eigenvalues of 1 it is the textbook
// (1 + alpha)^-N.
double false_alarm_probability(double alpha, const std::vector<double>& eigenvalues, int num_channels);

// CA is exact, from the eigenvalues of the training cells' covariance and their correlation with the cell under test. For
// windows of more than 400 degrees of freedom (about their cells without padding) this holds for cells within twice the
// guard cells of the end of the range axis, for those in the middle, and at distances between that double each time;
// elsewhere factors lie on straight lines, where the rate is right to 0.2 % (without taper, padded: 1 %).
// The others take the mean over 8192 / num_channels (at least 512) draws of the training cells; given a draw, the
// probability has a closed form. Draws come from tilted distributions in which false alarms happen (training_draws.h): the
// standard error is about 1 % of a false-alarm rate of 1e-3 and 2 % of 1e-6, of few cells 3 % down to 1e-9; of more than 128
// cells at ranks below a half it grows as rates fall. They take from CA how the factor changes near the ends of the range
// axis, and the correlation with the cell under test that remains beyond the guard cells. The result does not depend on the
// number of threads. Raises as CfarDesign::validate.
CfarFactors cfar_factors(const CfarDesign& design, Job* job = nullptr);

}  // namespace echopath
