#include "echopath/replay/time/time_grids.h"

#include <algorithm>
#include <array>

namespace echopath {
namespace {

constexpr std::array<int, 13> kOrders = {4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 24, TimeGrids::kHighestOrder};
static_assert(2 * kOrders.size() == GridIndex::kMostPolynomials);  // of both kinds of pieces

using Pieces = PolynomialGrid::Pieces;

// Returns whether pieces between knots are other ones than those between breakpoints.
bool has_knots(const Cuts& cuts) { return cuts.knots.size() > cuts.breakpoints.size(); }

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
    : start_time_(paths.frame.start_time), trace_time_(paths.frame.trace_time), frame_duration_(radar.frame_duration()),
      num_chirps_(radar.waveform.num_chirps), sample_order_(settings.per_sample ? 5 : 3),
      derivatives_(settings.per_sample ? ChirpDerivatives::kThird : ChirpDerivatives::kFirst),
      has_polynomials_(!settings.exact), cuts_(*paths.scene, radar, {start_time_, start_time_ + frame_duration_}) {
  add_polynomials();
}

uint32_t TimeGrids::join(uint32_t a, uint32_t b) {
  const uint32_t cuts = cuts_.join(a, b);
  add_polynomials();
  return cuts;
}

void TimeGrids::add_polynomials() {
  while (polynomials_.size() < cuts_.size()) {
    const auto next = static_cast<uint32_t>(polynomials_.size());
    polynomials_.push_back(has_polynomials_ ? polynomials_of(cuts_[next]) : std::vector<PolynomialGrid>());
  }
}

std::vector<PolynomialGrid> TimeGrids::polynomials_of(const Cuts& cuts) const {
  const double end = start_time_ + frame_duration_;
  std::vector<PolynomialGrid> grids;
  const auto add = [&](int order, Pieces pieces, const std::vector<double>& at) {
    const int64_t num_nodes = order * (std::ssize(at) + 1);
    if (num_nodes <= num_sample_nodes())
      grids.push_back({order, pieces, at, num_nodes, longest_piece(start_time_, end, at)});
  };
  for (const int order : kOrders) {
    add(order, Pieces::kSmooth, cuts.breakpoints);
    if (has_knots(cuts)) add(order, Pieces::kAnalytic, cuts.knots);
  }
  std::ranges::stable_sort(grids, {}, &PolynomialGrid::num_nodes);
  return grids;
}

std::vector<GridIndex> TimeGrids::polynomials() const {
  std::vector<GridIndex> all;
  for (uint32_t cuts = 0; cuts < polynomials_.size(); ++cuts) {
    for (size_t number = 0; number < num_polynomials(cuts); ++number) all.push_back(GridIndex::polynomial(number, cuts));
  }
  return all;
}

GridIndex TimeGrids::in_cuts(GridIndex index, uint32_t cuts) const {
  if (!index.is_polynomial() || index.cuts() == cuts) return index;
  const PolynomialGrid& own = polynomial(index);
  const Pieces pieces = has_knots(cuts_[cuts]) ? own.pieces : Pieces::kSmooth;
  for (size_t number = 0; number < num_polynomials(cuts); ++number) {
    const PolynomialGrid& other = polynomials_[cuts][number];
    if (other.order == own.order && other.pieces == pieces) return GridIndex::polynomial(number, cuts);
  }
  return GridIndex::none();
}

GridIndex TimeGrids::next_polynomial(GridIndex index, double needed_order) const {
  const Pieces pieces = polynomial(index).pieces;
  const std::vector<PolynomialGrid>& grids = polynomials_[index.cuts()];
  for (size_t next = index.number() + 1; next < grids.size(); ++next) {
    if (grids[next].order >= needed_order || grids[next].pieces != pieces) return GridIndex::polynomial(next, index.cuts());
  }
  return GridIndex::none();
}

}  // namespace echopath
