#include "echopath/radar/gain_axis.h"

#include "echopath/base/constants.h"

namespace echopath {
namespace {

// Returns the weights of four samples in the slopes at the middle two, times the step between these. A sample that is not
// there has none.
void set_slopes(const std::array<double, 4>& at, bool has_before, bool has_behind, GainAxis::Cell& cell) {
  const double step = cell.step;
  constexpr std::array<double, 4> kSecant = {0.0, -1.0, 1.0, 0.0};
  auto& [first, last] = cell.slopes;
  first = last = {};
  if (has_before) {
    const double before = at[1] - at[0], sum = before + step;
    first[0] = -step / before * (step / sum);
    first[1] = step / before * (step / sum) - before / sum;
    first[2] = before / sum;
  }
  if (has_behind) {
    const double behind = at[3] - at[2], sum = behind + step;
    last[3] = step / behind * (step / sum);
    last[2] = behind / sum - step / behind * (step / sum);
    last[1] = -behind / sum;
  }
  for (size_t i = 0; i < 4; ++i) {
    if (!has_before) first[i] = has_behind ? 2.0 * kSecant[i] - last[i] : kSecant[i];
    if (!has_behind) last[i] = has_before ? 2.0 * kSecant[i] - first[i] : kSecant[i];
  }
}

}  // namespace

GainAxis::GainAxis(const std::vector<double>& angles, int period) {
  const int num_samples = static_cast<int>(angles.size()), num_cells = period > 0 ? period : num_samples - 1;
  const auto angle_of = [&](int sample) {
    if (period == 0) return angles[sample];
    const int turns = sample < 0 ? -1 : sample / period;
    return angles[sample - turns * period] + turns * kTwoPi;
  };
  for (int number = 0; number < num_cells; ++number) {
    const bool has_before = period > 0 || number > 0, has_behind = period > 0 || number + 2 < num_samples;
    Cell& cell = cells_.emplace_back();
    std::array<double, 4> at;
    for (int i = 0; i < 4; ++i) {
      const bool exists = (i > 0 || has_before) && (i < 3 || has_behind);
      const int sample = exists ? number + i - 1 : number;
      at[i] = angle_of(sample);
      cell.index[i] = period > 0 ? (sample + period) % period : sample;
    }
    cell.begin = at[1];
    cell.step = at[2] - at[1];
    set_slopes(at, has_before, has_behind, cell);
  }
  cells_per_radian_ = num_cells / (cells_.back().begin + cells_.back().step - cells_.front().begin);
}

}  // namespace echopath
