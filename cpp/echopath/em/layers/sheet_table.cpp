#include "echopath/em/layers/sheet_table.h"

#include <algorithm>
#include <cmath>

namespace echopath {
namespace {

constexpr double kTurn = 0.01;  // rad, of the phases within the sheet from row to row
constexpr double kFewestRows = 512.0, kMostRows = 65536.0;

}  // namespace

SheetTable::SheetTable(const SheetModel& model) {
  const auto steps = static_cast<size_t>(std::clamp(model.most_phase() / kTurn, kFewestRows, kMostRows));
  for (size_t i = 0; i <= steps; ++i) {
    const SheetPassage at = model.passage(static_cast<double>(i) / static_cast<double>(steps));
    rows_.push_back({at.te.real(), at.te.imag(), at.tm.real(), at.tm.imag(), at.te_delay, at.tm_delay, at.offset});
  }
}

// Evaluates the polynomial of Lagrange through the four rows about the cosine.
SheetPassage SheetTable::passage(double cos_incidence) const {
  const auto steps = static_cast<double>(rows_.size() - 1);
  const double place = std::clamp(cos_incidence, 0.0, 1.0) * steps;
  const double first = std::clamp(std::floor(place) - 1.0, 0.0, steps - 3.0), x = place - first;
  const double weights[] = {-(x - 1.0) * (x - 2.0) * (x - 3.0) / 6.0, x * (x - 2.0) * (x - 3.0) / 2.0,
                            -x * (x - 1.0) * (x - 3.0) / 2.0, x * (x - 1.0) * (x - 2.0) / 6.0};
  Row sum{};
  for (size_t k = 0; k < 4; ++k) {
    const Row& row = rows_[static_cast<size_t>(first) + k];
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += weights[k] * row[i];
  }
  return {{sum[0], sum[1]}, {sum[2], sum[3]}, sum[4], sum[5], sum[6]};
}

}  // namespace echopath
