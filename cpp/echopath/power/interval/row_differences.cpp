#include "echopath/power/interval/row_differences.h"

#include <algorithm>
#include <cmath>

#include "echopath/record/paths.h"

namespace echopath {
namespace {

constexpr double kAtOutlines = 0.34;  // of a disc: what a lattice errs there over what its rows differ
constexpr int kFarApart = 3;          // rays between which no difference counts

}  // namespace

void RowDifferences::add(int place, double power) {
  if (place != place_) {
    const int steps = place_ == 0 ? kFarApart : (place - place_ + kPlacesInRow) % kPlacesInRow;
    end_ray();
    for (int i = 1; i < std::min(steps, kFarApart); ++i) push(0.0);
    place_ = place;
  }
  open_ += power;
}

double RowDifferences::variance() const {
  const RowDifferences all = ended();
  return all.variance_of(all.next_);
}

double RowDifferences::variance_of_jumps() const {
  const RowDifferences all = ended();
  return all.variance_of(std::clamp(2.0 * all.next_ - 0.5 * all.second_, 0.0, all.next_));
}

RowDifferences RowDifferences::ended() const {
  RowDifferences all = *this;
  all.end_ray();
  for (int i = 1; i < kFarApart; ++i) all.push(0.0);
  return all;
}

// `next`: as much of g1 as counts.
double RowDifferences::variance_of(double next) const {
  if (next_ == 0.0) return 0.0;
  const double exponent = std::clamp(std::log2(second_ / next_), 0.0, 1.0);
  return next * std::pow(kAtOutlines, exponent);
}

void RowDifferences::push(double power) {
  const double to_last = power - last_, to_before = power - before_;
  next_ += 0.5 * to_last * to_last;
  second_ += 0.5 * to_before * to_before;
  before_ = last_;
  last_ = power;
}

void RowDifferences::end_ray() {
  push(open_);
  open_ = 0.0;
}

}  // namespace echopath
