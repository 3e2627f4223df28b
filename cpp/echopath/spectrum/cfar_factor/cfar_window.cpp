#include "echopath/spectrum/cfar_factor/cfar_window.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

void require_half_width(int value, const char* name, int reach, int64_t num_cells) {
  require(value >= 0, name, "must be at least 0", value);
  require(2 * int64_t{reach} + 1 <= num_cells, name,
          "guard and training cells of both sides must fit into the " + std::to_string(num_cells) + " cells of the axis",
          value);
}

}  // namespace

int64_t CfarWindow::num_training() const {
  return int64_t{num_rows()} * num_columns() - (2 * int64_t{guard_velocity} + 1) * (2 * int64_t{guard_range} + 1);
}

std::optional<int> CfarWindow::half_of(int rows, int columns) const {
  const int along = training_range > 0 ? columns : rows;
  return along == 0 ? std::nullopt : std::optional(along > 0 ? 1 : 0);
}

int64_t CfarWindow::num_in_half() const {
  if (training_range == 0) return int64_t{training_velocity} * num_columns();
  return (2 * int64_t{guard_velocity} + 1) * training_range + 2 * int64_t{training_velocity} * reach_range();
}

void CfarWindow::validate(int64_t num_velocities, int64_t num_ranges) const {
  require_half_width(guard_velocity, "guard_velocity", guard_velocity, num_velocities);
  require_half_width(guard_range, "guard_range", guard_range, num_ranges);
  require_half_width(training_velocity, "training_velocity", reach_velocity(), num_velocities);
  require_half_width(training_range, "training_range", reach_range(), num_ranges);
  require(num_training() > 0, "training_range", "must be at least 1 unless training_velocity is", training_range);
}

std::array<CellSpan, 2> inner_spans(const CfarWindow& window, int64_t range, int64_t num_ranges) {
  const int64_t guard = window.guard_range, training = window.training_range;
  const int64_t room_left = std::max<int64_t>(0, range - guard);
  const int64_t room_right = std::max<int64_t>(0, num_ranges - 1 - range - guard);
  const int64_t left = std::min(room_left, std::max(training, 2 * training - room_right));
  // Spans of no cells stand on the axis, too.
  return {
      {{std::max<int64_t>(0, range - guard - left), left}, {std::min(range + guard + 1, num_ranges), 2 * training - left}}};
}

CellSpan outer_span(const CfarWindow& window, int64_t range, int64_t num_ranges) {
  const int64_t count = window.num_columns();
  return {std::clamp<int64_t>(range - window.reach_range(), 0, num_ranges - count), count};
}

int main_lobe_cells(const Window& window, int num_samples, int zero_pad) {
  constexpr double kTolerance = 0.02;  // of a cell
  const double bins = main_lobe_half_width(window_samples(window, num_samples));
  return static_cast<int>(std::ceil(bins * zero_pad - kTolerance));
}

}  // namespace echopath
