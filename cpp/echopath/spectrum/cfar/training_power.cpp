#include "echopath/spectrum/cfar/training_power.h"

#include <algorithm>
#include <cstdlib>

#include "echopath/base/lanes/simd.h"
#include "echopath/spectrum/cfar/moving_sums.h"

namespace echopath {
namespace {

ECHOPATH_INLINE void count_below(const double* values, int64_t count, double limit, int64_t* below) {
  int64_t found = 0;
  for (int64_t i = 0; i < count; ++i) found += values[i] < limit;
  *below = found;
}

}  // namespace

TrainingPower::TrainingPower(const std::vector<double>& power, int64_t num_velocities, int64_t num_ranges,
                             const CfarWindow& window)
    : power_(power), num_velocities_(num_velocities), num_ranges_(num_ranges), window_(window), inner_(power.size()),
      outer_(power.size()) {}

const double* TrainingPower::row(int64_t velocity) const {
  return power_.data() + (velocity + num_velocities_) % num_velocities_ * num_ranges_;
}

void TrainingPower::prepare_row(int64_t velocity) {
  const int64_t reach = window_.reach_range(), end = num_ranges_ - reach, training = window_.training_range;
  double *inner = inner_.data() + velocity * num_ranges_, *outer = outer_.data() + velocity * num_ranges_;
  std::vector<double> sums(num_ranges_);
  moving_sums(row(velocity), num_ranges_, window_.num_columns(), sums.data());
  for (int64_t r = 0; r < num_ranges_; ++r) outer[r] = sums[outer_span(window_, r, num_ranges_).first];
  moving_sums(row(velocity), num_ranges_, training, sums.data());
  for (int64_t r = 0; r < num_ranges_; ++r) {
    const bool is_whole = training > 0 && r >= reach && r < end;
    const auto [left, right] = inner_spans(window_, r, num_ranges_);
    inner[r] =
        is_whole ? sums[left.first] + sums[right.first] : span_sum(row(velocity), left) + span_sum(row(velocity), right);
  }
}

void TrainingPower::sums(int64_t velocity, double* sum) const {
  std::fill(sum, sum + num_ranges_, 0.0);
  for (int64_t shift = -window_.reach_velocity(); shift <= window_.reach_velocity(); ++shift) {
    const std::vector<double>& spans = std::abs(shift) > window_.guard_velocity ? outer_ : inner_;
    add_row(spans.data() + (velocity + shift + num_velocities_) % num_velocities_ * num_ranges_, num_ranges_, sum);
  }
}

// Calls visit(values, count) for the spans of a cell until it returns false; returns whether it never did.
template <class Visit>
bool TrainingPower::visit_spans(int64_t velocity, int64_t range, Visit visit) const {
  const CellSpan outer = outer_span(window_, range, num_ranges_);
  const auto [left, right] = inner_spans(window_, range, num_ranges_);
  for (int64_t shift = -window_.reach_velocity(); shift <= window_.reach_velocity(); ++shift) {
    const double* values = row(velocity + shift);
    if (std::abs(shift) > window_.guard_velocity) {
      if (!visit(values + outer.first, outer.count)) return false;
    } else if (!visit(values + left.first, left.count) || !visit(values + right.first, right.count)) {
      return false;
    }
  }
  return true;
}

bool TrainingPower::is_order_below(int64_t velocity, int64_t range, int64_t order, double limit) const {
  int64_t may_be_above = window_.num_training() - order;  // at most this many
  return visit_spans(velocity, range, [&](const double* values, int64_t count) {
    int64_t below = 0;
    run_simd<count_below>(values, count, limit, &below);
    may_be_above -= count - below;
    return may_be_above >= 0;
  });
}

double TrainingPower::ordered(int64_t velocity, int64_t range, int64_t order) const {
  std::vector<double> training;
  visit_spans(velocity, range, [&](const double* values, int64_t count) {
    training.insert(training.end(), values, values + count);
    return true;
  });
  const auto place = training.begin() + (order - 1);
  std::nth_element(training.begin(), place, training.end());
  return *place;
}

}  // namespace echopath
