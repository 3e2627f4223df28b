#include "echopath/spectrum/tone_offset.h"

#include <algorithm>

#include "echopath/base/constants.h"
#include "echopath/spectrum/window.h"

namespace echopath {
namespace {

constexpr int kNodes = 129;
constexpr double kLargest = 0.75;  // cells: noise may make the neighbour of the tone's own cell the higher one
constexpr double kFlat = 1e-9;     // of a response that is the same in all cells, as of a single sample: above rounding

double node(int i) { return kLargest * (2.0 * i / (kNodes - 1) - 1.0); }

// Evaluates Lagrange's polynomial through four points (x, y) at `at`.
double cubic(const double* x, const double (&y)[4], double at) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    double term = y[i];
    for (int j = 0; j < 4; ++j) {
      if (j != i) term *= (at - x[j]) / (x[i] - x[j]);
    }
    sum += term;
  }
  return sum;
}

}  // namespace

ToneOffset::ToneOffset(const std::vector<double>& samples, int zero_pad)
    : samples_(samples), step_(1.0 / zero_pad),
      // A response one cell away turns by the window's middle, (n - 1) / 2.
      phasor_(
          std::polar(1.0, kPi * step_ * (static_cast<double>(samples.size()) - 1.0) / static_cast<double>(samples.size()))) {
  for (int i = 0; i < kNodes; ++i) difference_.push_back(difference(node(i)));
}

bool ToneOffset::is_flat() const { return difference_.back() - difference_.front() < kFlat; }

double ToneOffset::difference(double offset) const {
  const std::complex<double> own = tone_response(samples_, -offset * step_);
  const std::complex<double> above = tone_response(samples_, (1.0 - offset) * step_);
  const std::complex<double> below = tone_response(samples_, (-1.0 - offset) * step_);
  return ((above - below) / own).real();
}

double ToneOffset::offset(double above, double below) const {
  if (is_flat()) return 0.0;
  const double value = std::clamp(above - below, difference_.front(), difference_.back());
  const auto next = std::ranges::upper_bound(difference_, value) - difference_.begin();
  const int first = std::clamp(static_cast<int>(next) - 2, 0, kNodes - 4);
  return cubic(difference_.data() + first, {node(first), node(first + 1), node(first + 2), node(first + 3)}, value);
}

double ToneOffset::power(double offset) const { return std::norm(tone_response(samples_, -offset * step_)); }

}  // namespace echopath
