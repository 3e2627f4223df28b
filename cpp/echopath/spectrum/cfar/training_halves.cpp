#include "echopath/spectrum/cfar/training_halves.h"

#include <algorithm>
#include <cstdlib>

#include "echopath/spectrum/cfar/moving_sums.h"

namespace echopath {
TrainingHalves::TrainingHalves(const std::vector<double>& power, int64_t num_velocities, int64_t num_ranges,
                               const CfarWindow& window)
    : power_(power), num_velocities_(num_velocities), num_ranges_(num_ranges), window_(window) {
  for (auto* sums : {&inner_, &outer_}) sums->fill(std::vector<double>(power.size()));
}

std::array<std::array<CellSpan, 2>, 2> TrainingHalves::inner_halves(int64_t range) const {
  const auto [left, right] = inner_spans(window_, range, num_ranges_);
  const int64_t surplus = left.count - window_.training_range;  // cells left of the one under test that the right half takes
  const int64_t from_left = std::max<int64_t>(surplus, 0), from_right = std::max<int64_t>(-surplus, 0);
  return {{{{{left.first, left.count - from_left}, {right.first, from_right}}},
           {{{left.first + left.count - from_left, from_left}, {right.first + from_right, right.count - from_right}}}}};
}

std::array<CellSpan, 2> TrainingHalves::outer_halves(int64_t range) const {
  const CellSpan outer = outer_span(window_, range, num_ranges_);
  const int64_t count = is_split_in_range() ? window_.reach_range() : outer.count;
  return {{{outer.first, count}, {outer.first + outer.count - count, count}}};
}

void TrainingHalves::prepare_row(int64_t velocity) {
  const double* row = power_.data() + velocity * num_ranges_;
  std::vector<double> of_outer(num_ranges_), of_inner(num_ranges_);
  moving_sums(row, num_ranges_, outer_halves(0)[0].count, of_outer.data());
  moving_sums(row, num_ranges_, window_.training_range, of_inner.data());
  for (int64_t range = 0; range < num_ranges_; ++range) {
    const auto outer = outer_halves(range);
    const auto inner = inner_halves(range);
    for (size_t half = 0; half < 2; ++half) {
      const auto& [first, second] = inner[half];
      const bool is_one_span = std::max(first.count, second.count) == window_.training_range;
      const int64_t begin = first.count > 0 ? first.first : second.first;
      const int64_t cell = velocity * num_ranges_ + range;
      outer_[half][cell] = of_outer[outer[half].first];
      if (is_split_in_range())
        inner_[half][cell] = is_one_span ? of_inner[begin] : span_sum(row, first) + span_sum(row, second);
    }
  }
}

void TrainingHalves::sums(int64_t velocity, const std::array<double*, 2>& sum) const {
  for (double* values : sum) std::fill(values, values + num_ranges_, 0.0);
  for (int64_t shift = -window_.reach_velocity(); shift <= window_.reach_velocity(); ++shift) {
    const int64_t row = (velocity + shift + num_velocities_) % num_velocities_ * num_ranges_;
    const bool is_inner = std::abs(shift) <= window_.guard_velocity;
    for (size_t half = 0; half < 2; ++half) {
      const bool is_of_half = is_split_in_range() || (!is_inner && (shift > 0) == (half == 1));
      if (is_of_half) add_row((is_inner ? inner_ : outer_)[half].data() + row, num_ranges_, sum[half]);
    }
  }
}

}  // namespace echopath
