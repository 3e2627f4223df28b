#include "echopath/replay/time/time_grids.h"

#include <algorithm>
#include <array>

#include "echopath/replay/time/motion_knots.h"

namespace echopath {
namespace {

constexpr std::array<int, 13> kOrders = {4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, TimeGrids::kHighestOrder};
static_assert(2 * kOrders.size() == GridIndex::kMostPolynomials);  // of both kinds of pieces

// Returns the longest distance between neighbours of start, cuts (s, ascending) and end.
double longest_piece(double start, double end, const std::vector<double>& cuts) {
  double longest = 0.0, from = start;
  for (const double cut : cuts) {
    longest = std::max(longest, cut - from);
    from = cut;
  }
  return std::max(longest, end - from);
}

}  // namespace

// With three nodes a chirp has the value and the slope in its middle; with five its delay is known throughout.
TimeGrids::TimeGrids(const Paths& paths, const Radar& radar, const ReplaySettings& settings)
    : start_time_(paths.frame.start_time), trace_time_(paths.frame.trace_time), num_chirps_(radar.waveform.num_chirps),
      sample_order_(settings.per_sample ? 5 : 3),
      derivatives_(settings.per_sample ? ChirpDerivatives::kThird : ChirpDerivatives::kFirst) {
  if (!settings.exact) find_polynomials(*paths.scene, radar);
}

void TimeGrids::find_polynomials(const Scene& scene, const Radar& radar) {
  const double start = start_time_, end = start + radar.frame_duration();
  std::vector<double> breakpoints = motion_breakpoints(scene, radar, {start, end});
  std::vector<double> knots = motion_knots(scene, radar, {start, end});
  for (std::vector<double>* cuts : {&breakpoints, &knots}) {
    std::erase_if(*cuts, [&](double time) { return time <= start || time >= end; });
  }
  const int64_t smooth = num_pieces(radar, start, breakpoints), analytic = num_pieces(radar, start, knots);
  const double longest_smooth = longest_piece(start, end, breakpoints), longest_analytic = longest_piece(start, end, knots);
  const auto add = [&](const PolynomialGrid& grid) {
    if (grid.num_nodes <= num_sample_nodes()) polynomials_.push_back(grid);
  };
  for (const int order : kOrders) {
    add({order, PolynomialGrid::Pieces::kSmooth, breakpoints, order * smooth, longest_smooth});
    if (analytic > smooth) add({order, PolynomialGrid::Pieces::kAnalytic, knots, order * analytic, longest_analytic});
  }
  std::stable_sort(polynomials_.begin(), polynomials_.end(),
                   [](const PolynomialGrid& a, const PolynomialGrid& b) { return a.num_nodes < b.num_nodes; });
}

GridIndex TimeGrids::next_polynomial(GridIndex index, double needed_order) const {
  const PolynomialGrid::Pieces pieces = polynomial(index).pieces;
  for (size_t next = index.number() + 1; next < num_polynomials(); ++next) {
    if (polynomials_[next].order >= needed_order || polynomials_[next].pieces != pieces) return GridIndex::polynomial(next);
  }
  return GridIndex::none();
}

}  // namespace echopath
